"""Times that differ by rounding alone are one time: of schedules, points, announced events and the end."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from built import Built
from comparison import approx
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.models import build
from system_models.master import CouplingError, System, simulate

STEP, STOP = 0.1, 1.0
WAYS = [{}, {"tolerance": 1e-2}, {"points": [0.3, 0.55]}]
ROUNDING = st.integers(-2, 2)


@pytest.fixture(scope="session")
def folder(built: Built) -> Path:
    return built.models


def moved(time: float, units: int) -> float:
    """A time some units in the last place away."""
    for _ in range(abs(units)):
        time = math.nextafter(time, math.copysign(math.inf, units))
    return time


def integrators(folder: Path, changes: dict[str, list[tuple[float, float]]], **system: Any) -> System:
    """Two of y' = u by a schedule, beside a coupled pair that a tolerance can control."""
    fmus = dict.fromkeys("ab", build("nan", folder, start={"t_nan": 9.0}))
    fmus |= {"m": build("mass_1_force", folder), "mm": build("millimetre", folder)}
    schedule = {f"{name}.u": [(0.0, 1.0), *steps] for name, steps in changes.items()}
    return System(fmus, [("m.x", "mm.u")], schedule=schedule, **system)


@given(st.sampled_from([0.3, 0.7, 0.9, 0.25, 1e-17, 1.0]), ROUNDING, ROUNDING, ROUNDING, st.sampled_from(WAYS))
@settings(max_examples=8)
def test_no_step_lies_between_times_that_rounding_parts(
    folder: Path, time: float, first: int, second: int, end: int, way: dict[str, Any]
) -> None:
    changes = {name: [(moved(time, by), 3.0)] for name, by in (("a", first), ("b", second))}
    stop = moved(STOP, end)
    result = simulate(integrators(folder, changes), stop, STEP, outputs=["a.y", "b.y"], **way)
    times = result["time"].values
    assert np.diff(times).min() > 1e-4
    assert times[-1] == approx(STOP, rel=1e-15)
    for name in "ab":
        assert result[f"{name}.y"].values[-1] == approx(time + 3.0 * (1.0 - time))


@pytest.mark.parametrize("way", [{}, {"points": [0.1 * (n + 1) for n in range(10)]}])
def test_an_fmu_of_one_step_size_gets_none_of_rounding(folder: Path, way: dict[str, Any]) -> None:
    system = integrators(folder, {"a": [(0.7, 2.0)], "b": [(0.7000000000000001, 2.0)]})
    system.models["a"].capabilities.canHandleVariableCommunicationStepSize = False
    result = simulate(system, STOP, STEP, outputs=["a.y", "b.y"], **way)
    assert result["time"].values == approx(np.arange(11) * STEP)
    assert result["a.y"].values[-1] == result["b.y"].values[-1] == approx(1.3)


@pytest.mark.parametrize("by", [-1, 0, 1])
def test_an_announced_event_is_met_at_its_very_time(folder: Path, by: int) -> None:
    early = build("early", folder, fmi=3, start={"period": 0.3, "u": 1.0})
    system = System({"early": early}, schedule={"early.u": [(0.0, 1.0), (moved(0.3, by), 2.0)]})
    result = simulate(system, 0.5, STEP, outputs=["early.y", "early.events"])
    assert np.diff(result["time"].values).min() > 1e-4
    assert result["early.events"].values.tolist() == [0, 0, 0, 1, 1, 1]
    assert result["early.y"].values[-1] == approx(0.3 + 2.0 * 0.2 + 1.0)


def test_an_event_that_an_fmu_of_one_step_size_cannot_meet_is_refused(folder: Path) -> None:
    fmus = {"a": build("nan", folder), "early": build("early", folder, fmi=3, start={"period": 0.26})}
    system = System(fmus)
    system.models["a"].capabilities.canHandleVariableCommunicationStepSize = False
    with pytest.raises(CouplingError, match=r"'a' takes steps of one size only.*0\.1 s here, but the step from 0\.2 s"):
        simulate(system, 0.5, STEP)
    with pytest.raises(CouplingError, match=r"0\.25 s is no multiple of step_size"):
        simulate(system, 0.5, STEP, points=[0.1, 0.25])
