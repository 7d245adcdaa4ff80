"""The thermal network against closed forms, its energy balance and another integrator."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from component_examples import BATH, EXAMPLES, NETWORK, marched
from scipy.integrate import solve_ivp

from contact_core.errors import SceneError
from system_models.parts.thermal import Link, Node, ThermalNetwork, Thermostat

ONE = ThermalNetwork((Node("oil", 500.0, 290.0),), (Link("oil", "ambient", 4.0),))


def test_one_node_warms_up_exponentially():
    inputs = {"heat_oil": 80.0, "temperature_ambient": 300.0}
    state = ONE.advance(ONE.initial(inputs), inputs, 200.0)
    outputs = ONE.outputs(state, inputs)
    assert outputs["temperature_oil"] == approx(320.0 - 30.0 * np.exp(-200.0 * 4.0 / 500.0), rel=1e-14)
    assert outputs["heat_to_ambient"] == approx(4.0 * (outputs["temperature_oil"] - 300.0), rel=1e-12)


def test_a_node_without_links_takes_up_all_heat():
    alone = ThermalNetwork((Node("oil", 500.0, 290.0),), ())
    inputs = {"heat_oil": 80.0, "temperature_ambient": 300.0}
    state = alone.advance(alone.initial(inputs), inputs, 600.0)
    assert state == approx((290.0 + 80.0 * 600.0 / 500.0, 0.0), rel=1e-14)
    assert alone.heat_stored(state[:1]) == approx(80.0 * 600.0, rel=1e-12)
    assert alone.heat_stored([290.0]) == 0.0
    assert alone.outputs(state, inputs)["heat_to_ambient"] == 0.0


def test_in_the_end_heat_leaves_through_conductances_in_series():
    inputs = EXAMPLES["network"][1]
    outputs = NETWORK.outputs(marched(NETWORK, NETWORK.initial(inputs), inputs, 600.0, 200), inputs)
    assert outputs["heat_to_ambient"] == approx(270.0, rel=1e-12)
    housing = 288.0 + 270.0 / 6.0
    oil = housing + 300.0 / 50.0
    assert outputs["temperature_housing"] == approx(housing, rel=1e-13)
    assert outputs["temperature_oil"] == approx(oil, rel=1e-13)
    assert outputs["temperature_ring"] == approx(oil + 100.0 / 20.0, rel=1e-13)


@pytest.mark.parametrize("step", [1e-4, 0.5, 600.0])
@pytest.mark.parametrize("name", ["network", "bath"])
def test_stored_energy_and_heat_out_are_heat_in(name, step):
    network, inputs = EXAMPLES[name]
    names = [node.name for node in network.nodes]
    state = network.initial(inputs)
    came, moved = 0.0, 0.0
    for k in range(40):
        now = inputs | {f"heat_{names[0]}": 100.0 * np.sin(k), "temperature_ambient": 290.0 + 5.0 * np.cos(k)}
        state = network.advance(state, now, step)
        heats = [value for name, value in now.items() if name.startswith("heat_")]
        came, moved = came + sum(heats) * step, moved + sum(map(abs, heats)) * step
    outputs = network.outputs(state, inputs)
    stored = sum(
        node.heat_capacity * (outputs[f"temperature_{node.name}"] - node.temperature) for node in network.nodes
    )
    given = sum(outputs[f"heater_energy_{held.node}"] for held in network.thermostats)
    content = sum(node.heat_capacity * node.temperature for node in network.nodes)
    assert stored + outputs["energy_to_ambient"] == approx(
        came + given,
        abs=2e-14 * (moved + abs(given)) + 8e-14 * content,  # rounding differs from machine to machine
    )
    assert abs(outputs["energy_to_ambient"]) > 1e-9 * moved


def test_a_stiff_network_keeps_its_digits():
    stiff = ThermalNetwork(
        (Node("film", 1e-6, 300.0), Node("oil", 1e4, 300.0)), (Link("film", "oil", 1e3), Link("oil", "ambient", 1e-2))
    )
    inputs = {"heat_film": 5.0, "heat_oil": 0.0, "temperature_ambient": 300.0}
    film, oil, lost = stiff.advance(stiff.initial(inputs), inputs, 600.0)
    share = 600.0 * 1e-2 / 1e4
    assert oil == approx(300.0 + 500.0 * -np.expm1(-share), rel=1e-12)
    assert film == approx(oil + 5.0 / 1e3, rel=1e-13)
    assert lost == approx(5.0 * (600.0 + 1e4 / 1e-2 * np.expm1(-share)), rel=1e-9)


def _bath(**inputs: float) -> dict[str, float]:
    return {"heat_oil": 0.0, "heat_bath": 0.0, "temperature_ambient": 295.0, "setpoint_bath": 353.15} | inputs


def test_a_thermostat_heats_at_its_limit_and_then_in_proportion():
    def course(_: float, t: np.ndarray) -> list[float]:
        power = min(max(40.0 * (353.15 - t[1]), -15.0), 120.0)
        between = 4.0 * (t[0] - t[1])
        return [(-between - 0.2 * (t[0] - 295.0)) / 60.0, (between - 0.8 * (t[1] - 295.0) + power) / 900.0, power]

    inputs = _bath()
    solution = solve_ivp(course, (0.0, 900.0), [298.0, 298.0, 0.0], rtol=1e-11, atol=1e-9, max_step=2.0)
    outputs = BATH.outputs(BATH.advance(BATH.initial(inputs), inputs, 900.0), inputs)
    assert outputs["temperature_oil"] == approx(solution.y[0, -1], rel=1e-8)
    assert outputs["temperature_bath"] == approx(solution.y[1, -1], rel=1e-8)
    assert outputs["heater_energy_bath"] == approx(solution.y[2, -1], rel=1e-6)
    assert outputs["heater_power_bath"] == approx(40.0 * (353.15 - outputs["temperature_bath"]), rel=1e-12)


@pytest.mark.parametrize(
    ("bath", "heat", "first", "last"),
    [
        (370.0, 0.0, -15.0, 67.7),  # too warm: cools, then heats in proportion
        (345.0, 60.0, 120.0, -15.0),  # too cold: heats, then cools, both as much as it can
        (349.0, -300.0, 40.0, 120.0),  # held in proportion until it cannot
    ],
)
def test_one_step_finds_all_changes_of_a_thermostat(bath, heat, first, last):
    state = (bath, bath, 0.0, 0.0)
    inputs = _bath(setpoint_bath=350.0, temperature_ambient=280.0, heat_bath=heat, heat_oil=2.0 * max(heat, 0.0))
    assert BATH.outputs(state, inputs)["heater_power_bath"] == approx(first)
    once = BATH.advance(state, inputs, 600.0)
    assert BATH.outputs(once, inputs)["heater_power_bath"] == approx(last, abs=0.1)
    assert once == approx(marched(BATH, state, inputs, 0.5, 1200), rel=1e-11)


def test_a_setpoint_is_met_to_the_power_over_the_gain():
    inputs = _bath()
    outputs = BATH.outputs(marched(BATH, BATH.initial(inputs), inputs, 600.0, 30), inputs)
    assert outputs["heater_power_bath"] == approx(outputs["heat_to_ambient"], rel=1e-10)
    assert outputs["temperature_bath"] == approx(353.15 - outputs["heater_power_bath"] / 40.0, rel=1e-13)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"nodes": ()}, ["nodes is empty", "at least one"]),
        ({"nodes": (*NETWORK.nodes, Node("oil", 1.0, 300.0))}, ["2 nodes", "'oil'", "own name"]),
        ({"nodes": (*NETWORK.nodes, Node("ambient", 1.0, 300.0))}, ["'ambient'", "another name"]),
        ({"nodes": (*NETWORK.nodes, Node("the oil", 1.0, 300.0))}, ["'the oil'", "letters"]),
        ({"links": (Link("oil", "housin", 1.0),)}, ["links[0]", "Did you mean 'housing'", "ambient"]),
        ({"links": (Link("oil", "oil", 1.0),)}, ["links[0]", "to itself"]),
        ({"thermostats": (Thermostat("ambient", 300.0, 1.0, 1.0),)}, ["thermostats[0]", "'ambient'", "oil, housing"]),
        ({"thermostats": (Thermostat("oil", 300.0, 1.0, 1.0),) * 2}, ["'oil'", "more than one", "Leave one"]),
    ],
)
def test_what_does_not_go_together_is_refused_with_a_way_out(change, words):
    with pytest.raises(SceneError) as refusal:
        replace(NETWORK, **change).check()
    for word in words:
        assert word in str(refusal.value)
