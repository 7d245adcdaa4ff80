"""A master that has gone back to a point, or on from a checkpoint, is the one that was there in all it decides by."""

import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from built import Built

from benchmarks.models import build, systems
from system_models.master import System, simulate
from system_models.master.coupled import Coupled
from system_models.master.stepping import Stepper
from system_models.store.checkpoint import Checkpoint

MODULE = sys.modules["system_models.master.simulate"]
# what an attempt sets anew before it is used, or only counts
LEFT = {"_held", "magnitudes", "expected", "iteration_tolerance", "steps", "events", "derivative_order"}


def plain(thing: Any) -> Any:
    """All numbers, texts and arrays in it and in what it keeps, to be compared bit for bit."""
    if isinstance(thing, np.ndarray):
        return thing.dtype.str, thing.shape, thing.tobytes()
    if thing is None or isinstance(thing, bool | int | float | str | bytes):
        return repr(thing)
    if isinstance(thing, Mapping):
        return {key: plain(value) for key, value in thing.items()}
    if isinstance(thing, list | tuple):
        return [plain(each) for each in thing]
    kept = ("control", "hold", "stepping")
    if type(thing).__module__ in [f"system_models.master.{name}" for name in kept]:
        return {key: plain(value) for key, value in vars(thing).items()}
    return type(thing).__name__


def seen(coupled: Coupled) -> dict[str, Any]:
    """What the FMUs and the master are now."""
    names = ("terminated", "next_event", "steps", "events", "derivative_order")
    instances = {
        name: {"state": instance.serialised()} | {key: getattr(instance, key) for key in names}
        for name, instance in coupled.instances.items()
    }
    methods = plain([each.copy() for each in coupled._methods])
    return {**plain(vars(coupled)), "instances": instances, "_methods": methods}


def differing(one: Any, other: Any, where: str = "") -> list[str]:
    """Where two of them differ."""
    if isinstance(one, dict) and isinstance(other, dict):
        names = sorted({*one, *other} - LEFT)
        return [place for name in names for place in differing(one.get(name), other.get(name), f"{where}.{name}")]
    return [] if one == other else [where]


def lagging(folder: Path) -> System:
    """A friction that answers only in steps, which the error control finds out by and by, and names no nominal."""
    case = systems.stick_slip(folder)
    case.system.port("friction.F").variable.nominal = None
    case.system.models["friction"].dependencies = {"F": frozenset(), "dF_du": frozenset()}
    return case.system


def mixed(folder: Path) -> System:
    """A loop to be iterated, beside it a count that is passed on and an FMU that announces events."""
    models = {"one": "mass_1_force", "two": "mass_2_spring", "teeth": "tooth", "echo": "echo"}
    fmus = {name: build(model, folder) for name, model in models.items()}
    fmus["early"] = build("early", folder, fmi=3, start={"period": 0.26})
    wires = [("one.x", "two.x1"), ("one.v", "two.v1"), ("two.F", "one.F"), ("teeth.tooth", "echo.integer_in")]
    return System(fmus, [*wires, ("one.v", "early.u")])


CASES = {
    "lagging": (lagging, {"stop_time": 0.4, "order": 2, "tolerance": 1e-3}),
    "mixed": (mixed, {"stop_time": 0.6, "order": 1, "tolerance": 1e-3, "iterate": "quasi_newton"}),
    "mixed, relaxed": (mixed, {"stop_time": 0.3, "order": 2, "tolerance": 1e-2, "iterate": "aitken"}),
}


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest, built: Built) -> tuple[System, dict[str, Any]]:
    build_system, settings = CASES[request.param]
    return build_system(built.models), {"step_size": 1e-3, **settings}


def test_after_going_back_all_is_as_it_was_at_the_point(
    case: tuple[System, dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    system, settings = case
    points: dict[int, Any] = {}
    found: list[list[str]] = []
    save, restore = Coupled.save, Coupled.restore

    def saved(self: Coupled) -> Any:
        point = save(self)
        points[id(point)] = seen(self)
        return point

    def restored(self: Coupled, point: Any) -> None:
        restore(self, point)
        found.append(differing(points[id(point)], seen(self)))

    monkeypatch.setattr(Coupled, "save", saved)
    monkeypatch.setattr(Coupled, "restore", restored)
    simulate(system, **settings)
    assert len(found) > 10
    assert [each for each in found if each] == []


class Enough(Exception):  # noqa: N818 - no error
    """The master has begun."""


def test_a_checkpoint_gives_back_all_that_there_was(
    case: tuple[System, dict[str, Any]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    system, settings = case
    there: list[Any] = []
    folder, save = tmp_path / "run", MODULE._save

    def saved(store: Checkpoint, coupled: Coupled, recorder: Any, stepper: Stepper) -> None:
        save(store, coupled, recorder, stepper)
        shutil.copytree(folder, tmp_path / f"left {len(there)}")
        there.append((seen(coupled), plain(vars(stepper)), recorder.count))

    def begun(coupled: Coupled, recorder: Any, stepper: Stepper, *others: Any) -> None:
        there.append((seen(coupled), plain(vars(stepper)), recorder.count))
        raise Enough

    with monkeypatch.context() as patch:
        patch.setattr(MODULE, "_save", saved)
        patch.setattr(Checkpoint, "due", lambda self: True)
        simulate(system, **settings, checkpoint=folder)
    count = len(there)
    monkeypatch.setattr(MODULE, "_run", begun)
    if "iterate" not in settings:
        assert any(np.frombuffer(coupled["expected"][2]).any() for coupled, _, _ in there)
        assert any(np.frombuffer(stepper["lags"][2], stepper["lags"][0]).any() for _, stepper, _ in there)
    for k in range(0, count, max(1, count // 10)):
        with pytest.raises(Enough):
            simulate(system, **settings, checkpoint=tmp_path / f"left {k}", resume=True)
        (coupled, stepper, rows), (coupled_again, stepper_again, rows_again) = there[k], there.pop()
        assert differing(stepper, stepper_again) == []
        coupled["iteration_tolerance"] = coupled_again["iteration_tolerance"]  # set anew by each attempt
        assert coupled == coupled_again
        assert rows == rows_again


def test_a_count_is_passed_on_in_every_step_however_often_it_is_repeated(built: Built) -> None:
    """The FMU that is told goes back to the count of the point, and must be told again."""
    found = simulate(
        mixed(built.models), 0.6, 1e-3, order=2, tolerance=1e-3, outputs=["teeth.tooth", "echo.integer_out"]
    )
    assert np.unique(found["teeth.tooth"].values).tolist() == [*range(int(found["teeth.tooth"].values[-1]) + 1)]
    assert found["teeth.tooth"].values[-1] > 3
    assert found["echo.integer_out"].values.tolist() == found["teeth.tooth"].values.tolist()
