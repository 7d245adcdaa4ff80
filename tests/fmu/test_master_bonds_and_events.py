"""What a bond says, which events are found, when a schedule begins, which loops one pass after a step cannot solve."""

import logging
from pathlib import Path

import numpy as np
import pytest
from built import Built
from comparison import approx

from benchmarks.models import build
from system_models.master import CouplingError, System, simulate


@pytest.fixture(scope="session")
def folder(built: Built) -> Path:
    return built.models


def oscillator(folder: Path, force: str, spring: str, **more: object) -> System:
    fmus = {force: build("mass_1_force", folder), spring: build("mass_2_spring", folder)}
    wires = [(f"{force}.x", f"{spring}.x1"), (f"{force}.v", f"{spring}.v1"), (f"{spring}.F", f"{force}.F")]
    return System(fmus, wires, **more)


def test_a_power_residual_does_not_depend_on_the_names_of_the_fmus(folder: Path) -> None:
    one = simulate(oscillator(folder, "a", "b", bonds=[("b.F", "a.v")]), 1.0, 0.01)["bond.b.F*a.v"]
    other = simulate(oscillator(folder, "b", "a", bonds=[("a.F", "b.v")]), 1.0, 0.01)["bond.a.F*b.v"]
    assert np.abs(one.values).max() > 0.0
    assert np.array_equal(one.values, other.values)


def test_a_power_residual_is_what_the_mass_takes_less_what_the_spring_gives(folder: Path) -> None:
    result = simulate(oscillator(folder, "a", "b", bonds=[("b.F", "a.v")]), 1.0, 0.01)
    force, speed = result["b.F"].values, result["a.v"].values
    expected = force[:-1] * speed[1:] - force[1:] * speed[:-1]  # held: what was given a step ago
    assert result["bond.b.F*a.v"].values[1:] == approx(expected, abs=1e-12)


def test_a_power_residual_vanishes_where_the_step_is_iterated(folder: Path) -> None:
    system = oscillator(folder, "a", "b", bonds=[("b.F", "a.v")])
    explicit = simulate(system, 1.0, 0.01)["bond.b.F*a.v"].values
    iterated = simulate(system, 1.0, 0.01, iterate="quasi_newton")["bond.b.F*a.v"].values
    assert np.abs(iterated).max() < 1e-4 * np.abs(explicit).max()


def test_a_controlled_step_finds_events_between_its_halves(folder: Path) -> None:
    system = oscillator(folder, "a", "b", events=["a.x"], parameters={"b.m": 1e6, "b.kc": 1e-6, "b.dc": 0.0})
    result = simulate(system, 4.0, 2.0, order=1, tolerance=1e-1, outputs=["a.x"])
    signs = np.sign(result["a.x"].values)
    assert result.attrs["events"] == np.count_nonzero(np.diff(signs)) == 4  # of cos(3.16 t) until 4 s
    assert result["a.x"].values[np.flatnonzero(np.diff(signs)) + 1] == approx(0.0, abs=1e-4)


def test_what_starts_at_zero_is_no_event(folder: Path) -> None:
    system = System({"y": build("nan", folder, start={"t_nan": 9.0})}, [], {"y.u": 1.0}, events=["y.y"])
    assert simulate(system, 1.0, 0.1).attrs["events"] == 0


def test_a_schedule_that_began_before_the_start_holds_its_last_value(folder: Path) -> None:
    schedule = {"y.u": [(-2.0, 7.0), (-1.0, 2.0), (0.5, 3.0)]}
    system = System({"y": build("nan", folder, start={"t_nan": 9.0})}, [], schedule=schedule)
    assert simulate(system, 1.0, 0.1, outputs=["y.y"])["y.y"].values[-1] == approx(2.5)


def test_a_direct_loop_is_warned_of_unless_it_is_iterated(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    fmus = {"a": build("gain", folder, a=-0.5, b=1.0), "b": build("gain", folder, a=0.5)}
    system = System(fmus, [("a.y", "b.u"), ("b.y", "a.u")])
    with caplog.at_level(logging.WARNING):
        simulate(system, 0.1, 0.1, iterate="quasi_newton")
        assert not caplog.messages
        simulate(system, 0.1, 0.1)
    (message,) = caplog.messages
    assert "a.u, b.u depend on one another without delay" in message


def measured(folder: Path, motion: dict[str, float]) -> System:
    """A mass whose place is an event, and an FMU that reads it."""
    fmus = {"m": build("point_mass", folder), "mm": build("millimetre", folder)}
    return System(fmus, [("m.x", "mm.u")], motion, events=["m.x"])


@pytest.mark.parametrize("options", [{}, {"tolerance": 1e-3}, {"tolerance": 1e-3, "order": 1}])
@pytest.mark.parametrize("step", [0.25, 0.3125, 0.5, 1.0])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_crossing_is_found_wherever_the_steps_meet_zero(
    folder: Path, step: float, sign: float, options: dict[str, float]
) -> None:
    motion = {"m.m": 1.0, "m.F0": 0.0, "m.x0": -sign, "m.v0": sign}
    result = simulate(measured(folder, motion), 2.0, step, outputs=["m.x"], **options)
    sides = result["m.x"].values > 0.0
    assert result.attrs["events"] == 1
    assert result["time"].values[np.flatnonzero(np.diff(sides)) + 1] == approx(1.0, abs=1e-6)


def test_a_crossing_in_the_second_half_of_the_first_step_is_found(folder: Path) -> None:
    motion = {"m.m": 1.0, "m.F0": -2.0, "m.x0": 0.0, "m.v0": 1.0}  # x = t - t^2
    assert simulate(measured(folder, motion), 1.5, 1.5, tolerance=1e-3).attrs["events"] == 1


def test_an_fmu_of_one_step_size_gets_no_other(folder: Path) -> None:
    system = System({"y": build("nan", folder, start={"t_nan": 9.0})}, [], schedule={"y.u": [(0.0, 1.0), (0.37, 2.0)]})
    system.models["y"].capabilities.canHandleVariableCommunicationStepSize = False
    with pytest.raises(CouplingError, match=r"one size only .* 0\.37 s is no multiple of step_size = 0\.25 s"):
        simulate(system, 1.0, 0.25)


def test_a_bond_of_integers_is_refused(folder: Path) -> None:
    fmus = dict.fromkeys("ab", build("echo", folder))
    wires = [("a.integer_out", "b.integer_in"), ("b.integer_out", "a.integer_in")]
    with pytest.raises(CouplingError, match="both must be continuous Real"):
        System(fmus, wires, bonds=[("a.integer_out", "b.integer_out")])
