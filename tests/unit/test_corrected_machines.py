"""A machine's run corrected by states that are solved again."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from contact_core import OperatingPoint, Outputs, RangeFlag, Scene, advance, initial_state
from contact_core.corrections.correction import CORRECTED
from contact_core.corrections.kriging import pair_of
from contact_core.scene import Case
from system_models.machines import corrected as machines
from system_models.machines.assembly import Contact
from system_models.machines.resolve import Resolved, place_at

SCENE = Scene.from_toml("mtm_zddp", {"film.points": "65", "film.model": "regression"})
OFF = {"friction_coefficient": 1.1, "h_c": 0.85, "contact_load_ratio": 1.05}  # of the solutions, at all rows
SPEEDS = np.geomspace(0.05, 0.4, 8)  # m/s, of the rows
NEEDED = (*CORRECTED, *CORRECTED.values(), "lambda_ratio", "friction_force", "friction_solid", "power_loss")


def point(speed: float) -> OperatingPoint:
    return replace(SCENE.operation.point, speed_1=1.05 * speed, speed_2=0.95 * speed)


def fast(speed: float) -> Outputs:
    return advance(SCENE, point(speed), initial_state(SCENE), 0.0)[1]


def state(row: int, flags: int = 0) -> Resolved:
    """A row solved again."""
    out = fast(SPEEDS[row])
    off: dict[str, Any] = {name: factor * getattr(out, name) for name, factor in OFF.items()}
    deep = replace(out, **off, **dict.fromkeys(CORRECTED.values(), 0.002), range_flags=flags)
    where = place_at(Case.bind(SCENE, point(SPEEDS[row])), out)
    return Resolved("contact", row, float(row), out, deep, 0.0, pair=pair_of(SCENE), place=where)


def run(fidelity: int = 1) -> tuple[Any, xr.Dataset]:
    outs = [fast(speed) for speed in SPEEDS]
    columns = {name: np.array([getattr(out, name) for out in outs]) for name in NEEDED}
    columns |= {"speed_1": 1.05 * SPEEDS, "speed_2": 0.95 * SPEEDS, "fidelity_used": np.full(len(SPEEDS), fidelity)}
    named = {f"contact.{name}": ("time", values) for name, values in columns.items()}
    assembly = SimpleNamespace(
        contacts={"contact": Contact(SCENE)}, parts={}, inputs_of=lambda name: ["speed_1", "speed_2"]
    )
    return assembly, xr.Dataset(named, {"time": np.arange(float(len(SPEEDS)))})


def test_all_rows_come_nearer_to_what_states_say_and_the_run_stays_as_it_is() -> None:
    assembly, dataset = run()
    before = dataset.copy(deep=True)
    better = machines.corrected(assembly, dataset, [state(row) for row in (1, 3, 5)])
    assert dataset.equals(before)
    for name, factor in OFF.items():
        raw, now = (each[f"contact.{name}"].values for each in (dataset, better))
        assert (np.abs(now / raw - factor) < abs(1.0 - factor)).all(), name
        stated, left = (each[f"contact.{CORRECTED[name]}"].values for each in (dataset, better))
        sizes = (np.ones_like(raw),) * 2 if name == "contact_load_ratio" else (raw, now)
        assert (left * sizes[1] <= stated * sizes[0] * (1.0 + 1e-12)).all()
        assert (left * sizes[1] < 0.8 * stated * sizes[0]).any()


def test_rows_of_the_deterministic_level_are_left_alone() -> None:
    assembly, dataset = run(fidelity=2)
    better = machines.corrected(assembly, dataset, [state(3)])
    assert all((better[name].values == dataset[name].values).all() for name in better.data_vars)


def test_a_state_that_judges_does_not_condition() -> None:
    alone = machines.without_itself([state(3)])[0]
    assert alone is not None
    assert alone["friction_coefficient"] == fast(SPEEDS[3]).friction_coefficient
    assert alone["error_friction"] == fast(SPEEDS[3]).error_friction
    both = machines.without_itself([state(3), state(4)])[0]
    assert both is not None
    assert both["friction_coefficient"] > alone["friction_coefficient"]
    assert both["error_friction"] < alone["error_friction"]


@pytest.mark.parametrize("flag", [RangeFlag.NOT_CONVERGED, RangeFlag.FALLBACK])
def test_a_solution_that_has_not_converged_is_no_knot(flag: RangeFlag) -> None:
    assert machines.knots_of([state(3, int(flag)), state(4)]).count == 1
    assert machines.without_itself([state(3, int(flag)), state(4)])[0] is None


def test_the_loss_is_that_of_the_corrected_friction_and_is_told() -> None:
    assembly, dataset = run()
    states = [state(row) for row in (1, 3, 5)]
    better = machines.corrected(assembly, dataset, states)
    both = machines.with_corrected(dataset, better)
    mu = "contact.friction_coefficient"
    expected = dataset["contact.power_loss"].values * better[mu].values / dataset[mu].values
    assert both["contact.power_loss"].values == approx(expected)
    told = list(machines.lines(assembly, dataset, better, states))
    assert told[0] == "Each state corrected by the others:"
    assert len(told) == 3 + len(states)
    assert f"{machines.lost(assembly, both):.4g} J in place of {machines.lost(assembly, dataset):.4g} J" in told[-1]
    assert not list(machines.lines(assembly, dataset, better, states[:1]))


@pytest.mark.parametrize("judged", [0, 1, 2])
def test_no_state_is_judged_by_itself_wherever_it_stands(judged: int) -> None:
    """Its own solution may be anything: the others say the same of it."""
    states = [state(row) for row in (1, 3, 5)]
    other = replace(states[judged].deep, friction_coefficient=2.0 * states[judged].deep.friction_coefficient)
    changed = [replace(one, deep=other) if k == judged else one for k, one in enumerate(states)]
    assert machines.without_itself(changed)[judged] == machines.without_itself(states)[judged]
