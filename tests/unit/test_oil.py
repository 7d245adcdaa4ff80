"""Heat and shear in scenes: what they do to the film, and that a scene without them pays nothing."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap, settled
from comparison import approx

from contact_core import OperatingPointError, RangeFlag, Scene, Transient, advance, initial_state, solve
from contact_core.deterministic import oil_temperature as oil_module
from contact_core.deterministic.oil_temperature import inlet_factor
from contact_core.kernels import moving_source, thinning
from contact_core.regression.oil import MeanHeat
from contact_core.regression.smooth_film import smooth_film
from contact_core.scene import Case
from contact_core.state import flags_of_tribofilm

SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "tribofilm.model": "none", "film.tolerance": "1e-4"}
FIELD = {"heat.model": "field"}
LOCAL = {"lubricant.flow": "local"}
CARREAU = {
    "lubricant.rheology.model": "carreau",
    "lubricant.rheology.critical_stress": "0.01 MPa",
    "lubricant.rheology.exponent": "0.6",
}
LUMPED = {
    "heat.bulk.model": "lumped",
    "heat.bulk.heat_capacity_1": "2 J/K",
    "heat.bulk.heat_capacity_2": "5 J/K",
    "heat.bulk.conductance_1": "0.5 W/K",
    "heat.bulk.conductance_2": "1 W/K",
}


def smooth(*more, points=65):
    changes = {"film.points": str(points), "film.domain": "0.4 mm", "operation.load": "5 N"} | SMOOTH
    for part in more:
        changes |= part
    scene = Scene.from_toml("azam_case_a", changes)
    return scene, initial_state(scene)


def sliding(scene, speed, ratio, **more):
    return replace(scene.operation.point, speed_1=speed * (1 + ratio / 2), speed_2=speed * (1 - ratio / 2), **more)


def central(scene, state, op):
    fields = solve(scene, op, state)
    assert fields.converged, fields.shortfall
    return float(fields.gap[fields.y.size // 2, fields.x.size // 2])


def test_a_scene_without_heat_and_thinning_calls_nothing_of_them(monkeypatch):
    def forbidden(*args, **kwargs):
        raise AssertionError("paid for")

    for module, name in (
        (oil_module, "eased"),
        (oil_module, "Agreement"),
        (thinning, "stress_of_flow"),
        (moving_source, "moving_influence"),
        (oil_module, "inlet_factor"),
    ):
        monkeypatch.setattr(module, name, forbidden)
    scene, state, point = cheap(CHEAP | {"heat.model": "none"})
    assert (scene.lubricant.flow, scene.heat.name, scene.heat.bulk.name) == ("newtonian", "none", "oil")
    state, outputs = advance(scene, point, state, 1.0)
    assert outputs.friction_coefficient > 0.0
    assert state.film is None or state.film.ease.shape == state.film.warmth.shape == (1, 1)


@pytest.mark.parametrize("name", ["moving_influence", "eased"])
def test_a_scene_that_asks_for_them_calls_them(name, monkeypatch):
    module = moving_source if name == "moving_influence" else oil_module
    calls, real = [], getattr(module, name)
    monkeypatch.setattr(module, name, lambda *args, **kwargs: calls.append(1) or real(*args, **kwargs))
    moving_source._spectrum.cache_clear()
    scene, state = smooth(FIELD, LOCAL, CARREAU, points=33)
    solve(scene, sliding(scene, 1.0, 0.3), state)
    assert calls


@pytest.mark.parametrize(
    "heat", [*(pytest.param(each, marks=pytest.mark.long) for each in ({"heat.model": "none"}, {})), FIELD]
)
def test_all_power_leaves_as_heat_through_the_bodies(heat):
    scene, state, _ = cheap(CHEAP | heat)
    op = sliding(scene, 0.5, 0.8)
    fields = solve(scene, op, state)
    warm = fields.temperatures
    assert warm.into_1 + warm.into_2 == approx(fields.friction.power, rel=1e-12)
    _, outputs = advance(scene, op, state, 1.0)
    assert outputs.heat_flow_1 + outputs.heat_flow_2 == approx(outputs.power_loss, rel=1e-14)
    assert outputs.power_loss == approx(-outputs.friction_force * op.sliding_speed, rel=1e-12)
    assert outputs.heat_flow_1 > 0.0 and outputs.heat_flow_2 > 0.0


def test_the_faster_body_takes_more_heat():
    scene, state, _ = cheap(CHEAP | FIELD)
    _, outputs = advance(scene, sliding(scene, 1.0, 1.0), state, 0.0)
    assert outputs.heat_flow_1 > 1.1 * outputs.heat_flow_2


def test_warm_oil_rubs_less_and_a_march_finds_the_temperature_of_the_steady_film():
    cold, state = smooth({"heat.model": "none"}, points=65)
    hot, _ = smooth(FIELD, points=65)
    op = sliding(cold, 10.0, 1.0)
    isothermal, steady = solve(cold, op, state), solve(hot, op, state)
    assert steady.converged, steady.shortfall
    rise = steady.film.warmth
    assert rise.max() > 10.0
    assert abs(steady.friction.force_fluid) < 0.95 * abs(isothermal.friction.force_fluid)
    marched = replace(state, film=replace(steady.film, warmth=np.zeros((1, 1))))
    for _ in range(14):
        fields = solve(hot, op, marched, Transient(1e-6, 0, 40))
        marched = replace(marched, film=fields.film)
    assert fields.film.warmth == approx(rise, abs=0.01 * rise.max())


def test_local_flow_thins_the_film_and_a_march_finds_the_steady_one():
    scene, state = smooth(CARREAU, points=33)
    local, _ = smooth(CARREAU, LOCAL, points=33)
    op = sliding(scene, 4.0, 0.2)
    newtonian, thinned = central(scene, state, op), central(local, state, op)
    assert 0.3 * newtonian < thinned < 0.9 * newtonian
    marched = replace(state, film=solve(local, op, state).film)
    for _ in range(6):
        fields = solve(local, op, marched, Transient(1e-4, 0, 40))
        marched = replace(marched, film=fields.film)
    middle = fields.y.size // 2
    assert fields.gap[middle, middle] == approx(thinned, rel=5e-3)


def test_local_flow_of_a_newtonian_isothermal_oil_is_the_flow_of_the_viscosity():
    newtonian = {"lubricant.rheology.model": "newtonian", "heat.model": "none"}
    one, state = smooth(newtonian)
    other, _ = smooth(newtonian, LOCAL)
    op = sliding(one, 4.0, 0.2)
    assert central(other, state, op) == approx(central(one, state, op), rel=1e-4)


@pytest.mark.parametrize("flow", [{}, LOCAL])
def test_shear_heat_in_the_inlet_thins_the_film_by_its_factor(flow):
    oil = {"lubricant.rheology.model": "newtonian", "lubricant.conductivity": "0.05 W/(m K)"}
    cold, state = smooth(oil, flow)
    hot, _ = smooth(oil, flow, {"heat.inlet_shear": "gupta"})
    op = sliding(cold, 6.0, 1.0)
    factor = inlet_factor(Case(hot, op))
    assert 0.3 < factor < 0.95
    assert central(hot, state, op) / central(cold, state, op) == approx(factor, rel=0.02)


@pytest.mark.parametrize(("speed", "ratio"), [(6.0, 1.0), (0.5, 1.5), (-6.0, 0.2)])
def test_the_regression_level_has_the_same_factor(speed, ratio):
    cold, _ = smooth({"lubricant.conductivity": "0.05 W/(m K)"})
    hot, _ = smooth({"lubricant.conductivity": "0.05 W/(m K)"}, {"heat.inlet_shear": "gupta"})
    op = sliding(cold, speed, ratio)
    films = [smooth_film(Case(scene.at_level("regression"), op), 1e-6).film for scene in (cold, hot)]
    assert films[1] / films[0] == approx(inlet_factor(Case(hot, op)), rel=1e-3)


def test_equal_bodies_of_different_temperature_meet_halfway_and_share_the_power():
    """The surfaces are as far above the bodies' mean as half of the power warms one of them."""
    conductance, area, power, bodies = 2e5, 1e-8, 0.4, (350.0, 310.0)
    column = [np.array([value]) for value in (conductance, conductance, *bodies, area, 1e-7)]
    heat = MeanHeat(*column, 2.0 * conductance)
    rise, into_1 = heat.surface(power)
    assert rise == approx(0.5 * power / (conductance * area))
    assert into_1 - (power - into_1) == approx(conductance * area * (bodies[1] - bodies[0]))


def test_bodies_as_inputs_warm_the_oil_that_they_draw_in():
    scene, state, point = cheap(CHEAP | {"heat.bulk": "inputs", "tribofilm.model": "none"})
    warm = replace(point, body_temperature_1=point.temperature + 30.0, body_temperature_2=point.temperature + 10.0)
    _, outputs = advance(scene, warm, state, 0.0)
    _, same = advance(scene, replace(point, temperature=point.temperature + 20.0), state, 0.0)
    assert (outputs.temperature_1, outputs.temperature_2) == (point.temperature + 30.0, point.temperature + 10.0)
    assert outputs.h_c == approx(same.h_c, rel=1e-12)
    _, unsaid = advance(scene, point, state, 0.0)
    assert unsaid.temperature_1 == unsaid.temperature_2 == point.temperature


def test_where_bodies_are_as_warm_as_the_oil_inputs_say_nothing():
    scene, state, point = settled()
    _, other = advance(scene, replace(point, body_temperature_1=point.temperature + 50.0), initial_state(scene), 0.0)
    assert state.outputs == other


@pytest.mark.parametrize("level", ["deterministic", "regression"])
def test_lumped_bodies_warm_up_to_where_they_pass_their_heat_on(level):
    scene, state, _ = cheap(CHEAP | LUMPED | {"tribofilm.model": "none", "wear.model": "none"})
    scene = scene.at_level(level)
    op = sliding(scene, 0.25, 0.5)
    outputs = None
    for _ in range(8):
        state, outputs = advance(scene, op, state, 10.0)
    state, outputs = advance(scene, op, state, 0.0)
    law = scene.heat.bulk
    assert outputs.temperature_1 - op.temperature == approx(outputs.heat_flow_1 / law.conductance_1, rel=0.03)
    assert outputs.temperature_2 - op.temperature == approx(outputs.heat_flow_2 / law.conductance_2, rel=0.03)
    assert outputs.temperature_1 > op.temperature + 0.1
    assert (outputs.temperature_1, outputs.temperature_2) == state.temperatures


@pytest.mark.parametrize("level", ["deterministic", "regression"])
def test_spin_wears_and_grows_film_without_sliding(level):
    scene, state, point = cheap()
    scene = scene.at_level(level)
    rolling = replace(point, speed_1=point.speed_2)
    _, still = advance(scene, rolling, state, 30.0)
    _, spun = advance(scene, replace(rolling, spin=500.0), state, 30.0)
    assert still.wear_volume_1 == still.tribofilm_1 == still.power_loss == 0.0
    assert spun.wear_volume_1 > 0.0 and spun.wear_volume_2 > 0.0 and spun.tribofilm_1 > 0.0
    assert spun.power_loss == approx(-spun.spin_torque * 500.0, rel=1e-9)
    assert abs(spun.friction_force) < 4e-3 * point.load  # what few asperities of a coarse grid leave over


def test_a_solution_knows_the_temperatures_that_the_scene_gives_its_bodies():
    scene, state = smooth()
    point = sliding(scene, 4.0, 0.2)
    warm = replace(point, body_temperature_1=420.0, body_temperature_2=420.0)
    assert central(scene, state, warm) == central(scene, state, point)  # bodies are as warm as the oil
    inputs, _ = smooth({"heat.bulk": "inputs"})
    assert central(inputs, state, warm) < 0.7 * central(inputs, state, point)


@pytest.mark.parametrize("level", [pytest.param("deterministic", marks=pytest.mark.long), "regression"])
def test_bodies_that_would_melt_are_refused_by_name(level):
    changes = {name: "0 W/K" if "conductance" in name else "1e-3 J/K" for name in LUMPED if name[-1].isdigit()}
    scene, state, _ = cheap(CHEAP | LUMPED | changes | {"tribofilm.model": "none", "wear.model": "none"})
    op, hot = sliding(scene, 0.25, 0.5), replace(state, temperatures=(890.0, 890.0))
    with pytest.raises(OperatingPointError, match=r"bodies have warmed to .* above 900 K.*heat\.bulk\.conductance_1"):
        advance(scene.at_level(level), op, hot, 600.0)


def test_body_temperatures_that_nobody_uses_are_told():
    told = cheap(CHEAP | {"operation.body_temperature_1": "100 degC"})[0].warnings()
    assert any("operation.body_temperature_1" in sentence and "heat.bulk = 'oil'" in sentence for sentence in told)
    used = cheap(CHEAP | {"operation.body_temperature_1": "92 degC", "heat.bulk": "inputs"})[0].warnings()
    assert not any("body_temperature" in sentence for sentence in used)


def test_the_tribofilms_constants_are_asked_for_the_temperature_that_it_feels():
    scene, state, point = cheap(CHEAP | {"heat.bulk": "inputs"})
    hot = replace(point, body_temperature_1=point.temperature + 40.0)
    with pytest.raises(OperatingPointError, match="fit_temperature"):
        advance(scene, hot, state, 0.0)
    bodies = {"body_temperature_1": point.temperature, "body_temperature_2": point.temperature}
    advance(scene, replace(point, temperature=point.temperature + 40.0, **bodies), state, 0.0)
    law, warm = scene.tribofilm, point.temperature
    assert not flags_of_tribofilm(law, (warm, warm)) & RangeFlag.TRIBOFILM_TEMPERATURE
    for pair in ((warm, warm + 40.0), (warm + 40.0, warm)):  # one body is enough
        assert RangeFlag.TRIBOFILM_TEMPERATURE in flags_of_tribofilm(law, pair)


def test_the_order_of_changes_does_not_matter():
    changes = {
        "lubricant.flow": "local",
        "lubricant.set": "fva3",
        "tribofilm.edge_weight": "20",
        "tribofilm.set": "gosvami",
    }
    scene = Scene.from_toml("mtm_zddp", changes)
    assert scene == Scene.from_toml("mtm_zddp", dict(reversed(changes.items())))
    assert (scene.lubricant.flow, scene.tribofilm.edge_weight) == ("local", 20.0)
    chosen = {"tribofilm.model": "none", "tribofilm.set": "gosvami"}  # a model is chosen of what a set says
    for pair in (chosen, dict(reversed(chosen.items()))):
        assert Scene.from_toml("mtm_zddp", pair).tribofilm.name == "none"


def test_a_short_form_is_a_model_in_any_order():
    changes = {"lubricant.rheology.limiting_coefficient": "0.02", "lubricant.rheology": "newtonian"}
    assert Scene.from_toml("mtm_zddp", changes).lubricant.rheology.limiting_coefficient == 0.02
    lumped = LUMPED | {"heat.bulk": LUMPED["heat.bulk.model"]}
    del lumped["heat.bulk.model"]
    assert Scene.from_toml("mtm_zddp", dict(reversed(lumped.items()))).heat == Scene.from_toml("mtm_zddp", LUMPED).heat


def test_the_formula_film_of_warm_bodies_is_that_of_the_oil_they_draw_in():
    changes = {"heat.bulk": "inputs", "tribofilm.model": "none", "control.driver": "dry"}
    scene, state, point = cheap(CHEAP | changes)
    warm = replace(point, body_temperature_1=point.temperature + 40.0, body_temperature_2=point.temperature + 40.0)
    _, told = advance(scene, warm, state, 0.0)
    _, same = advance(scene, replace(point, temperature=point.temperature + 40.0), state, 0.0)
    assert told.lambda_conventional == approx(same.lambda_conventional, rel=1e-12)


RISE = {"lubricant.conductivity_rise": "1.72 GPa^-1", "lubricant.conductivity_bend": "0.54 GPa^-1"}


def test_oil_conducts_better_under_pressure():
    oil, _ = smooth(RISE)
    found = oil.lubricant.conductivity_under(np.array([0.0, 1e9]))
    assert found == approx([0.14, 0.14 * (1.0 + 1.72 / 1.54)], rel=1e-12)
    assert smooth({})[0].lubricant.conductivity_under(np.array([1e9])) == 0.14


def test_friction_of_the_regression_level_is_that_of_the_conductivity_at_the_mean_pressure():
    hot = {"heat.model": "field"}
    rising, state = smooth(hot | RISE)
    op = sliding(rising, 6.0, 1.0)
    rising = rising.at_level("regression")
    mean = rising.hertz(op.load)
    under = rising.lubricant.conductivity_under(mean.mean_share * mean.pressure_max)
    even = smooth(hot | {"lubricant.conductivity": f"{under} W/(m K)"})[0].at_level("regression")
    plain = smooth(hot)[0].at_level("regression")
    found, same, less = (advance(scene, op, state, 0.0)[1].friction_coefficient for scene in (rising, even, plain))
    assert found == approx(same, rel=0.01)  # a thick film carries its load at a little less than Hertz's pressure
    assert abs(found) > 1.01 * abs(less)


def test_the_heat_of_a_solved_film_leaves_by_the_conductivity_under_its_pressure():
    rising, state = smooth({"heat.model": "field"} | RISE)
    plain, _ = smooth({"heat.model": "field"})
    op = sliding(rising, 6.0, 1.0)
    cool, warm = (solve(scene, op, state).temperatures.film.max() for scene in (rising, plain))
    assert cool < warm - 1.0
