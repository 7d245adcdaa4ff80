"""Bad input neither crashes the host nor loses the state: status OK, valid = false, the log gives the reason."""

import math
from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2Error, fmi2Terminated, fmi2Warning

from contact_core import Outputs
from fmu_src.runtime import slave


@pytest.mark.parametrize(
    ("inputs", "named"),
    [
        ({"load": -5.0}, "load = -5 N"),
        ({"load": math.nan}, "load = nan N"),
        ({"speed_1": math.inf}, "speed_1 = inf m/s"),
        ({"temperature": 20.0}, "temperature = 20 K"),
    ],
)
def test_an_unusable_input_is_named_and_the_next_good_one_recovers(stepped, inputs, named):
    before = stepped.outputs()
    good = {name: stepped.get(name) for name in inputs}
    handle = stepped.fmu.getFMUstate()
    expected = stepped.step(60.0)
    stepped.fmu.setFMUstate(handle)
    stepped.fmu.freeFMUstate(handle)

    began = stepped.get("time")
    assert stepped.step(60.0, **inputs) == before | {"valid": False}
    assert stepped.get("time") == began + 60.0
    assert len(stepped.log) == 1
    assert named in stepped.log[0][1]
    assert stepped.step(60.0, **good) == expected


@pytest.mark.parametrize("dt", [-1.0, math.nan, math.inf])
def test_an_unusable_step_size_is_refused(stepped, dt):
    before, time = stepped.outputs(), stepped.get("time")
    stepped.fmu.doStep(stepped.time, dt)
    assert stepped.outputs() == before | {"valid": False}
    assert stepped.get("time") == time
    assert len(stepped.log) == 1
    assert stepped.step(60.0)["valid"]


def test_unusable_inputs_at_initialisation_recover_in_the_first_good_step(host):
    host.initialise(load=-1.0)
    assert not host.get("valid")
    assert all(value == 0 for value in host.outputs().values())
    assert "load = -1 N" in host.log[0][1]
    outputs = host.step(60.0, load=50.0)
    assert outputs["valid"]
    assert outputs["friction_coefficient"] > 0.0


@pytest.mark.parametrize(
    ("parameters", "named"),
    [
        ({"plasticity__hardness": -1e9}, "plasticity.hardness = -1e+09 Pa"),
        ({"wear__bare": math.nan}, "wear.bare = nan"),
        ({"initial_state": "/nowhere/50%s.state"}, "initial_state = '/nowhere/50%s.state' cannot be read"),
    ],
)
def test_an_unusable_parameter_is_named_at_every_step_until_a_reset(host, parameters, named):
    host.initialise(**parameters)
    assert named in host.log[0][1]
    outputs = host.step(60.0)
    assert not outputs["valid"]
    assert named in host.log[1][1]
    host.fmu.reset()
    assert host.initialise().step(60.0)["valid"]


def test_an_initial_state_of_another_contact_is_refused(host, other_scene, tmp_path):
    file = tmp_path / "other.state"
    file.write_bytes(slave.initial_state(other_scene).to_bytes())
    host.initialise(initial_state=str(file))
    assert not host.get("valid")
    assert "belongs to another contact" in host.log[0][1]


def test_a_parameter_is_refused_after_initialisation(stepped):
    before = stepped.get("wear.bare")
    stepped.set(wear__bare=0.5)
    assert stepped.get("wear.bare") == before
    assert "wear.bare is a parameter" in stepped.log[0][1]


def test_an_output_cannot_be_set(stepped):
    before = stepped.get("h_c")
    stepped.set(h_c=1.0)
    assert stepped.get("h_c") == before
    assert "h_c is an output" in stepped.log[0][1]


def test_time_cannot_be_set(stepped):
    before = stepped.get("time")
    stepped.set(time=1.0)
    assert stepped.get("time") == before
    assert "time is the independent variable" in stepped.log[0][1]


def test_an_unknown_value_reference_is_refused(stepped):
    assert list(stepped.fmu.getReal([9999])) == [0.0]
    stepped.fmu.setReal([9999], [1.0])
    stepped.fmu.setBoolean([stepped.variables["load"].valueReference], [True])
    assert [text.rpartition(" ")[2] for _, text in stepped.log[:2]] == ["9999.", "9999."]
    assert "no Boolean variable" in stepped.log[2][1]


def test_of_values_set_together_those_that_can_be_are_taken_over(stepped):
    references = [stepped.variables[name].valueReference for name in ("load", "h_c", "speed_1")]
    before = stepped.get("h_c")
    stepped.fmu.setReal([*references, 9999], [21.0, 1.0, 0.3, 2.0])
    assert [stepped.get(name) for name in ("load", "h_c", "speed_1")] == [21.0, before, 0.3]
    assert not stepped.get("valid")
    assert ["9999" in text for _, text in stepped.log] == [False, True]


def test_what_is_refused_in_initialisation_mode_stays_refused_when_outputs_are_read(host):
    host.fmu.setupExperiment()
    host.fmu.enterInitializationMode()
    assert host.get("valid")
    host.set(h_c=1.0)
    assert not host.get("valid")
    host.set(load=20.0)
    assert host.get("valid")


def test_a_step_before_initialisation_is_refused(host):
    assert not host.step(60.0)["valid"]
    assert "fmi2DoStep is not allowed before initialisation" in host.log[0][1]


def test_initialisation_cannot_begin_again_while_stepping(stepped):
    """Contact and outputs do not change; only a reset begins again."""
    before = stepped.outputs()
    for call in (stepped.fmu.enterInitializationMode, stepped.fmu.exitInitializationMode, stepped.fmu.setupExperiment):
        stepped.log.clear()
        call()
        assert stepped.outputs() == before | {"valid": False}
        assert "is not allowed after initialisation. Nothing was done." in stepped.log[0][1]
    assert stepped.step(60.0)["wear_volume_1"] > before["wear_volume_1"]


def test_a_step_after_the_end_is_refused_until_a_state_is_restored(stepped):
    handle, before = stepped.fmu.getFMUstate(), stepped.outputs()
    stepped.fmu.terminate()
    assert stepped.step(60.0) == before | {"valid": False}
    assert "fmi2DoStep is not allowed after fmi2Terminate" in stepped.log[0][1]
    stepped.fmu.setFMUstate(handle)
    stepped.fmu.freeFMUstate(handle)
    assert stepped.step(60.0)["valid"]


@pytest.mark.parametrize("time", [0.0, 30.0, 60.001, 7200.0, math.nan, math.inf])
def test_a_step_that_leaves_out_time_or_repeats_it_is_refused(stepped, time):
    assert stepped.time == 60.0
    before = stepped.outputs()
    stepped.fmu.doStep(time, 60.0)
    assert stepped.outputs() == before | {"valid": False}
    status, text = stepped.log[0]
    assert status == fmi2Error
    assert f"currentCommunicationPoint = {time}" in text
    assert stepped.step(60.0)["valid"]


@pytest.mark.parametrize("time", [60.0 + 1e-12, 60.0 - 1e-9])
def test_what_a_host_rounds_is_no_gap_in_time(stepped, time):
    """libcosim counts in nanoseconds."""
    stepped.fmu.doStep(time, 60.0)
    assert stepped.get("valid")


@pytest.mark.parametrize("gap", [5e-7, -5e-7])
def test_a_gap_is_judged_by_the_step_that_follows(stepped, gap):
    stepped.fmu.doStep(60.0 + gap, 1e-3)
    assert "must be 60.0 s" in stepped.log[0][1]
    stepped.fmu.doStep(60.0 + gap, 10.0)
    assert stepped.get("valid")


def started_until(host, stop):
    host.fmu.setupExperiment(startTime=10.0, stopTime=stop)
    host.fmu.enterInitializationMode()
    host.fmu.exitInitializationMode()
    host.time = 10.0


def test_a_step_beyond_the_stop_time_is_refused_and_one_that_ends_there_is_not(host):
    started_until(host, 11.0)
    assert host.step(0.5)["valid"]
    before = host.outputs()
    host.fmu.doStep(10.5, 0.6)
    assert host.outputs() == before | {"valid": False}
    assert host.log[0][0] == fmi2Error
    assert "goes beyond stopTime = 11.0 s" in host.log[0][1]
    assert host.step(0.5 + 9e-6)["valid"]  # as fmusim rounds
    assert host.get("time") == approx(11.0, rel=1e-6)


def test_what_is_rounding_grows_with_the_stop_time(host):
    host.fmu.setupExperiment(startTime=0.0, stopTime=1000.0)
    host.fmu.enterInitializationMode()
    host.fmu.exitInitializationMode()
    assert host.step(1000.0 * (1.0 + 9e-6))["valid"]
    assert not host.step(1000.0 * 3e-6)["valid"]


def test_a_step_as_small_as_rounding_is_one_step(host):
    host.fmu.setupExperiment(startTime=0.0, stopTime=1e-6)
    host.fmu.enterInitializationMode()
    host.fmu.exitInitializationMode()
    assert host.step(1e-6)["valid"]
    assert not host.step(1e-6)["valid"]


def test_the_first_step_begins_at_the_start_time(host):
    started_until(host, None)
    host.fmu.doStep(0.0, 1.0)
    assert "currentCommunicationPoint = 0.0 s must be 10.0 s" in host.log[0][1]
    assert host.step(1.0)["valid"]


def test_no_nan_leaves_and_the_state_that_came_with_it_is_dropped(stepped, monkeypatch):
    before, state, sound = stepped.outputs(), stepped.state(), slave.advance
    expected = stepped.step(60.0)
    stepped.restore(state)

    def broken(scene, point, state, dt):
        moved, outputs = sound(scene, point, state, dt)
        return moved, replace(outputs, h_c=math.nan)

    with monkeypatch.context() as patch:
        patch.setattr(slave, "advance", broken)
        assert stepped.step(60.0) == before | {"valid": False}
    assert "No finite h_c" in stepped.log[0][1]
    assert stepped.step(60.0) == expected


def test_an_unexpected_error_is_logged_with_its_traceback_and_the_state_stands(stepped, monkeypatch):
    before = stepped.outputs()

    def broken(scene, point, state, dt):
        raise ZeroDivisionError("100 %s surprising")

    with monkeypatch.context() as patch:
        patch.setattr(slave, "advance", broken)
        assert stepped.step(60.0) == before | {"valid": False}
    status, text = stepped.log[0]
    assert status == 3
    assert "ZeroDivisionError: 100 %s surprising" in text
    assert "Traceback" in text
    assert stepped.step(60.0)["valid"]


@pytest.mark.parametrize(
    ("broken", "error"),
    [
        ("with_values", ValueError),
        ("initial_state", SystemExit),
        ("advance", ValueError),
        ("advance", MemoryError),
        ("advance", RecursionError),
    ],
)
def test_an_unexpected_error_at_initialisation_is_logged_and_a_reset_recovers(host, monkeypatch, broken, error):
    def surprise(*arguments):
        raise error("surprising")

    with monkeypatch.context() as patch:
        patch.setattr(slave, broken, surprise)
        host.initialise()
        assert not host.get("valid")
    status, category, text = host.entries[0]
    assert (status, category) == (fmi2Error, "logStatusError")
    assert f"{error.__name__}: surprising" in text
    assert "Traceback" in text
    host.fmu.reset()
    assert host.initialise().step(60.0)["valid"]


def test_an_unexpected_error_in_an_evaluation_between_leaves_the_next_one_whole(host, monkeypatch):
    def surprise(*arguments):
        raise ValueError("surprising")

    host.fmu.setupExperiment()
    host.fmu.enterInitializationMode()
    with monkeypatch.context() as patch:
        patch.setattr(slave, "advance", surprise)
        assert host.get("friction_force") == 0.0
    host.set(load=30.0)
    assert host.get("friction_force") != 0.0
    assert host.get("valid")
    assert [status for status, _ in host.log] == [fmi2Error]


def test_an_unexpected_error_while_a_state_is_set_is_logged_and_the_contact_stands(stepped, monkeypatch):
    state, before = stepped.state(), stepped.outputs()

    def surprise(*arguments):
        raise KeyError("surprising")

    with monkeypatch.context() as patch:
        patch.setattr(slave.Snapshot, "from_bytes", surprise)
        stepped.restore(state)
    assert stepped.outputs() == before | {"valid": False}
    assert "KeyError: 'surprising'" in stepped.log[0][1]
    first = stepped.step(60.0)
    stepped.restore(state)
    assert stepped.step(60.0) == first


def test_an_unexpected_error_while_a_value_is_set_is_logged_and_the_contact_stands(stepped, monkeypatch):
    before = stepped.outputs()

    def surprise(*arguments):
        raise KeyError("surprising")

    with monkeypatch.context() as patch:
        patch.setattr(slave.ContactSlave, "_store", surprise)
        stepped.set(load=10.0)
    assert stepped.outputs() == before | {"valid": False}
    assert [status for status, _ in stepped.log] == [fmi2Error]
    assert stepped.step(60.0)["valid"]


def test_an_answer_that_cannot_be_told_in_part_is_not_told_at_all(stepped, monkeypatch):
    before = stepped.outputs()

    def broken(scene, point, state, dt):
        return state, replace(Outputs(), friction_force=1.0, iterations="many")

    monkeypatch.setattr(slave, "advance", broken)
    assert stepped.step(60.0) == before | {"valid": False}
    assert [status for status, _ in stepped.log] == [fmi2Error]


def test_numbers_too_large_for_numpy_leave_no_warning_on_the_stderr_of_the_host(stepped, monkeypatch):
    def overflowing(scene, point, state, dt):
        return state, replace(Outputs(), friction_force=float(np.float64(1e300) * 1e300))

    monkeypatch.setattr(slave, "advance", overflowing)
    assert not stepped.step(60.0)["valid"]  # where a warning is an error, as in tests, it would be an unexpected one
    assert [status for status, _ in stepped.log] == [fmi2Warning]


def test_the_users_interrupt_ends_the_simulation_until_a_state_is_restored(stepped, monkeypatch):
    state = stepped.state()
    expected = stepped.step(60.0)
    stepped.restore(state)

    def interrupted(scene, point, state, dt):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(slave, "advance", interrupted)
        with pytest.raises(FMICallException, match="discard"):
            stepped.step(60.0)
    assert stepped.fmu.getBooleanStatus(fmi2Terminated)
    with pytest.raises(FMICallException, match="discard"):
        stepped.step(60.0)
    stepped.restore(state)
    assert stepped.step(60.0) == expected
