"""A running FMU behaves the same through FMI 2 and FMI 3, as far as both can."""

import logging
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from built import Built
from comparison import approx
from fmpy.fmi1 import FMICallException

from benchmarks.models import build
from system_models.fmu.errors import CouplingError
from system_models.fmu.fmi2 import Fmi2Instance
from system_models.fmu.fmi3 import Fmi3Instance
from system_models.fmu.instance import Instance
from system_models.fmu.model import Model

Start = Callable[..., Instance]


@pytest.fixture
def start(built: Built, tmp_path: Path) -> Iterator[Start]:
    """Builds a model and starts it at time 0 with all its Real inputs and outputs."""
    running: list[Instance] = []

    def started(name: str, fmi: int, early_return: bool = False, **options: Any) -> Instance:
        path = build(name, built.models, fmi, **options)
        folder = tmp_path / path.stem
        if not folder.exists():
            with zipfile.ZipFile(path) as archive:
                archive.extractall(folder)
        model = Model("one", path)
        real = [v for v in model.variables.values() if v.type in ("Real", "Float64")]
        inputs, outputs = ([v for v in real if v.causality == c] for c in ("input", "output"))
        if fmi == 3:
            instance: Instance = Fmi3Instance(model, str(folder), inputs, outputs, early_return=early_return)
        else:
            instance = Fmi2Instance(model, str(folder), inputs, outputs)
        running.append(instance)
        instance.enter_initialization(0.0, 10.0, None)
        instance.exit_initialization()
        return instance

    yield started
    for instance in running:
        instance.free()


def held(*values: float) -> np.ndarray:
    return np.array([values])


def trajectory(instance: Instance, first: int, last: int) -> np.ndarray:
    """Outputs under inputs that are held over uneven steps."""
    random = np.random.default_rng(5)
    steps, inputs = random.uniform(0.01, 0.1, last), random.normal(size=(last, instance.inputs.count))
    time, rows = float(steps[:first].sum()), []
    for size, values in zip(steps[first:], inputs[first:], strict=True):
        time = instance.step(time, size, values[None])
        instance.read()
        rows.append(instance.outputs.values.copy())
    return np.array(rows)


def test_both_give_bitwise_the_same_trajectory_under_held_inputs(start: Start) -> None:
    second, third = (trajectory(start("mass_1_displacement", fmi), 0, 50) for fmi in (2, 3))
    assert np.array_equal(second, third)
    assert np.ptp(second, axis=0).min() > 0.1


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_state_is_restored_any_number_of_times_and_in_another_instance(start: Start, fmi: int) -> None:
    instance = start("mass_1_displacement", fmi)
    trajectory(instance, 0, 10)
    state, data = instance.save(), instance.serialised()
    after = trajectory(instance, 10, 30)
    for _ in range(2):
        instance.restore(state)
        assert np.array_equal(trajectory(instance, 10, 30), after)
    instance.release(state)
    other = start("mass_1_displacement", fmi)
    other.deserialise(data)
    assert np.array_equal(trajectory(other, 10, 30), after)


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("rollback", [True, False])
def test_whether_it_restores_is_read_from_its_description(built: Built, fmi: int, rollback: bool) -> None:
    model = Model("one", build("gain", built.models, fmi, rollback=rollback))
    assert model.restores is model.serialises is rollback


@pytest.mark.parametrize("fmi", [2, 3])
def test_values_of_all_types_pass(start: Start, fmi: int) -> None:
    instance = start("echo", fmi)
    given = {"integer": -7, "boolean": True, "string": "Öl, 40 °C", "real": 0.1}
    variables = instance.model.variables
    for kind, value in given.items():
        instance.set(variables[f"{kind}_in"], value)
    instance.step(0.0, 0.1, held(0.3))
    given["real"] = 0.3
    for kind, value in given.items():
        got = instance.get(variables[f"{kind}_out"])
        assert got == value and type(got) is type(value)


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_discarded_step_says_how_far_it_came_and_can_be_shorter(start: Start, fmi: int) -> None:
    instance = start("discard", fmi)
    assert instance.step(0.0, 0.5, held(2.0)) == 0.0
    assert not instance.terminated
    assert instance.step(0.0, 0.1, held(2.0)) == 0.1
    instance.read()
    assert instance.outputs.values == approx([0.2], rel=1e-14)


@pytest.mark.parametrize("fmi", [2, 3])
def test_the_end_that_an_fmu_asks_for_is_seen_and_taken_back_with_its_state(start: Start, fmi: int) -> None:
    instance = start("terminator", fmi, early_return=True)
    assert instance.step(0.0, 0.4, held(1.0)) == 0.4
    assert not instance.terminated
    state = instance.save()
    assert instance.step(0.4, 0.4, held(1.0)) == approx(0.5, rel=1e-14)
    assert instance.terminated
    instance.read()
    assert instance.outputs.values == approx([0.5], rel=1e-14)
    instance.restore(state)
    assert not instance.terminated
    instance.release(state)


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_error_is_raised_and_what_the_fmu_says_is_logged(
    start: Start, fmi: int, caplog: pytest.LogCaptureFixture
) -> None:
    instance = start("failing", fmi)
    with pytest.raises(FMICallException):
        instance.step(0.0, 0.6, held(1.0))
    (record,) = (r for r in caplog.records if r.levelno >= logging.ERROR)
    assert record.getMessage() == "one: The model fails after t_fail, as it was asked to."


def test_a_step_that_may_return_early_ends_at_the_event(start: Start) -> None:
    instance = start("early", 3, early_return=True)
    instance.read()
    assert instance.outputs.values == [0.0] and instance.next_event == 0.25
    assert instance.step(0.0, 1.0, held(2.0)) == approx(0.25, rel=1e-14)
    instance.read()
    assert instance.outputs.values == approx([0.5 + 1.0], rel=1e-14)  # ramp and jump
    assert instance.event and instance.next_event == 0.5 and not instance.terminated
    assert instance.step(0.25, 0.125, held(2.0)) == 0.375
    assert not instance.event


def test_a_step_that_may_not_return_early_ends_where_it_should_and_asks_for_the_next_event(start: Start) -> None:
    instance = start("early", 3)
    before = instance.events
    assert instance.step(0.0, 0.6, held(2.0)) == 0.6
    instance.read()
    assert instance.outputs.values == approx([1.2 + 2.0], rel=1e-14)  # both events were within the step
    assert instance.event and instance.events == before + 1 and instance.next_event == 0.75
    instance.step(0.6, 0.1, held(2.0))
    assert not instance.event
    instance.step(0.7, 0.05, held(2.0))
    instance.read()
    assert instance.event and instance.outputs.values == approx([1.5 + 3.0], rel=1e-14)


def test_an_announced_event_comes_back_with_the_state(start: Start) -> None:
    instance = start("early", 3)
    instance.step(0.0, 0.25, held(0.0))
    state, data = instance.save(), instance.serialised()
    instance.step(0.25, 0.25, held(0.0))
    assert instance.next_event == 0.75
    instance.restore(state)
    assert instance.next_event == 0.5
    instance.release(state)
    other = start("early", 3)
    other.deserialise(data)
    assert other.next_event == 0.5
    silent = start("echo", 3, events=True)
    silent.deserialise(silent.serialised())
    assert silent.next_event is None


def test_discrete_inputs_that_change_are_set_in_event_mode(start: Start) -> None:
    instance = start("echo", 3, events=True)  # which refuses them elsewhere
    variables, before = instance.model.variables, instance.events
    instance.step(0.0, 0.1, held(1.0))
    assert not instance.event
    instance.set(variables["integer_in"], 3)
    instance.set(variables["string_in"], "three")
    assert instance.get(variables["integer_out"]) == 3
    assert instance.event and instance.events == before + 1
    assert instance.get(variables["string_out"]) == "three"
    instance.step(0.1, 0.1, held(1.0))
    instance.set(variables["integer_in"], 3)
    instance.set(variables["string_in"], "three")
    instance.step(0.2, 0.1, held(1.0))
    assert not instance.event and instance.events == before + 1


def test_updates_without_end_are_refused(start: Start) -> None:
    instance = start("echo", 3, events=True)
    instance._fmu.updateDiscreteStates = lambda: (True, False, False, False, False, 0.0)
    instance.set(instance.model.variables["integer_in"], 3)
    with pytest.raises(CouplingError, match="'one' still changes its discrete states after 100 updates"):
        instance.read()


PARABOLA = np.array([[1.0], [-2.0], [9.0]])  # coefficients; its mean over 0.5 s is 1.25


@pytest.mark.parametrize(
    ("fmi", "options", "interpolates"),
    [
        (2, {}, True),
        (2, {"interpolates": False}, False),
        (3, {}, False),
        (3, {"intermediate": True}, True),
    ],
)
def test_inputs_follow_a_parabola_or_are_held_at_its_mean(
    start: Start, fmi: int, options: dict[str, bool], interpolates: bool
) -> None:
    instance = start("mass_1_force", fmi, start={"k": 0.0, "d": 0.0, "x0": 0.0}, **options)  # x'' = F
    assert instance.interpolates is interpolates
    instance.step(0.0, 0.5, PARABOLA)
    instance.read()
    position = 1 / 8 - 2 / 48 + 9 / 192 if interpolates else 1.25 / 8
    assert instance.outputs.names == ["x", "v"]
    assert instance.outputs.values == approx([position, 0.625], rel=1e-13)
