"""The isolated flavour in FMI 3.0: the bits, states and refusals of FMI 2.0, in FMI 3.0's words."""

import math
import shutil
import sys
from collections.abc import Iterator
from ctypes import c_float
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmi3_host import Host3, hosted3
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import (
    FMU3Slave,
    fmi3ClockUpdateCallback,
    fmi3Error,
    fmi3InstanceEnvironment,
    fmi3IntermediateUpdateCallback,
    fmi3LockPreemptionCallback,
    fmi3LogMessageCallback,
    fmi3OK,
    fmi3UnlockPreemptionCallback,
    fmi3Warning,
)
from fmu_host import hosted, unpacked
from isolated import FAULTS, SCRIPT, STEPS, UNSAVED

from contact_core import Scene
from fmu_src.package.build import build
from fmu_src.runtime.resources import module_name

pytestmark = [
    pytest.mark.fmu,
    pytest.mark.skipif(sys.platform != "linux", reason="the processes are looked at as Linux shows them"),
]


@pytest.fixture(scope="module")
def file(quick: Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(quick, tmp_path_factory.mktemp("fmi3") / "quick.fmu", fmi=3)


@pytest.fixture(scope="module")
def folder(file: Path) -> Path:
    return unpacked(file, file.with_suffix(""))


@pytest.fixture
def host(folder: Path) -> Iterator[Host3]:
    with hosted3(folder) as host:
        yield host


def refused(host: Host3, call: str, *arguments: object, **named: object) -> str:
    """The log of a call that fails."""
    host.log.clear()
    with pytest.raises(FMICallException, match="error"):
        getattr(host.fmu, call)(*arguments, **named)
    assert {(status, category) for status, category, _ in host.log} == {(fmi3Error, "logStatusError")}
    return "\n".join(text for _, _, text in host.log)


def test_both_versions_give_the_same_bits_and_exchange_states(host: Host3, isolated_folder: Path) -> None:
    with hosted(isolated_folder) as other:
        assert host.initialise().outputs() == other.initialise().outputs()
        for step, inputs in STEPS:
            assert host.step(step, **inputs) == other.step(step, **inputs)
            assert host.last.value == host.time == host.get("time") == other.get("time")
        data = host.state()
        assert data == other.state()
        expected = other.step(3.0, load=35.0)
        assert host.step(3.0, load=35.0) == expected
        for each in (host, other):
            each.restore(data)
            assert each.step(3.0, load=35.0) == expected
    assert not any(flag.value for flag in host.flags)


def test_fmpy_simulates_both_versions_alike(file: Path, quick: Scene, tmp_path: Path) -> None:
    inputs = np.array([(0.0, 50.0), (5.0, 40.0)], dtype=[("time", float), ("load", float)])
    three, two = (
        fmpy.simulate_fmu(
            str(fmu), stop_time=5.0, output_interval=0.5, input=inputs, start_values={"speed_1": 0.11, "seed": 3}
        )
        for fmu in (file, build(quick, tmp_path / "two.fmu"))
    )
    assert len(three) == 11
    assert three.dtype.names == two.dtype.names
    assert three.tobytes() == two.tobytes()


def test_a_reset_begins_anew(host: Host3) -> None:
    first = host.initialise().step(1.0, load=30.0)
    host.fmu.terminate()
    assert "fmi3DoStep is not allowed after fmi3Terminate" in refused(host, "doStep", 1.0, 1.0)
    host.fmu.reset()
    assert host.initialise(load=50.0).step(1.0, load=30.0) == first


def test_an_unusable_input_is_a_warning_and_time_goes_on(host: Host3) -> None:
    before = host.initialise().step(1.0)
    assert before["valid"] is True
    for load in (-1.0, math.nan):
        host.log.clear()
        assert host.step(1.0, load=load) == before | {"valid": False}
        assert host.last.value == host.time == host.get("time")
        assert [entry[:2] for entry in host.log] == [(fmi3Warning, "logValidity")]
    assert host.step(1.0, load=30.0)["valid"] is True


def test_a_step_beyond_the_stop_time_is_an_error_that_names_the_call_of_fmi_3(host: Host3) -> None:
    host.initialise(start=10.0, stop=12.0).step(1.0)
    assert host.get("time") == 11.0
    said = refused(host, "doStep", 11.0, 5.0)
    assert "in fmi3EnterInitializationMode" in said
    assert "fmi2" not in said
    assert host.get("time") == 11.0


def test_calls_out_of_turn_and_wrong_values_are_refused(host: Host3) -> None:
    assert "fmi3DoStep is not allowed before initialisation" in refused(host, "doStep", 0.0, 1.0)
    host.initialise()
    assert "fmi3EnterInitializationMode is not allowed after" in refused(host, "enterInitializationMode")
    number = {name: v.valueReference for name, v in host.variables.items()}
    assert "no Int32 variable with value reference 0" in refused(host, "getInt32", [0])
    assert "no Float64 variable with value reference 9999" in refused(host, "setFloat64", [9999], [1.0])
    assert "fixed parameter" in refused(host, "setInt32", [number["seed"]], [1])
    assert "is an output" in refused(host, "setBoolean", [number["valid"]], [True])
    assert "1 value references come with 2 values" in refused(host, "setFloat64", [number["load"]], [1.0, 2.0])
    assert "1 value references come with 2 values" in refused(host, "getBoolean", [number["valid"]], nValues=2)
    host.set(fidelity=1, load=45.0)
    assert (host.get("fidelity"), host.get("load")) == (1, 45.0)


def test_what_the_fmu_does_without_is_refused(host: Host3) -> None:
    host.initialise()
    for call in ("enterEventMode", "enterStepMode", "enterConfigurationMode", "updateDiscreteStates"):
        assert f"fmi3{call[0].upper()}{call[1:]} is not supported" in refused(host, call)
    assert "fmi3GetFloat32 is not supported" in refused(host, "getFloat32", [0])
    assert host.fmu.fmi3GetFloat32(host.fmu.component, None, 0, (c_float * 0)(), 0) == fmi3OK


def test_text_goes_both_ways(host: Host3) -> None:
    host.set(initial_state="/nowhere/Öl 50 %")
    assert host.get("initial_state") == "/nowhere/Öl 50 %"
    host.initialise()
    assert any("/nowhere/Öl 50 %'" in text for _, _, text in host.log), host.log


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"eventModeUsed": True}, "no event mode"),
        ({"requiredIntermediateVariables": [0]}, "no intermediate updates"),
        ({"token": "another"}, "The host asks for the FMU with guid 'another'"),
    ],
)
def test_an_instance_that_cannot_work_is_refused_with_its_reason(
    options: dict[str, object], reason: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[str] = []
    monkeypatch.setattr(Host3, "_logged", lambda host, environment, status, category, message: said.append(message))
    with pytest.raises(Exception, match="Failed to instantiate"):
        Host3(folder, **options)
    assert any(reason in text.decode() for text in said), said


def test_other_kinds_of_instances_are_refused(host: Host3) -> None:
    said: list[str] = []
    log = fmi3LogMessageCallback(lambda environment, status, category, message: said.append(message.decode()))
    texts = (b"other", b"", b"", False, True, fmi3InstanceEnvironment(), log)
    callbacks = (fmi3ClockUpdateCallback(), fmi3LockPreemptionCallback(), fmi3UnlockPreemptionCallback())
    assert not host.fmu.fmi3InstantiateModelExchange(*texts)
    assert not host.fmu.fmi3InstantiateScheduledExecution(*texts, *callbacks)
    assert ["model exchange" in said[0], "scheduled execution" in said[1]] == [True, True]


def test_resources_elsewhere_are_found_by_their_path(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder / "binaries", tmp_path / "binaries")
    token = fmpy.read_model_description(str(folder)).guid
    fmu = FMU3Slave(guid=token, unzipDirectory=str(tmp_path), modelIdentifier="MixedContact", instanceName="fmu")
    log, update = fmi3LogMessageCallback(lambda *entry: None), fmi3IntermediateUpdateCallback()

    def instance(resources: Path) -> int | None:
        texts = (b"fmu", token.encode(), f"{resources}/".encode())
        options = (False, True, False, False, None, 0, fmi3InstanceEnvironment())
        return fmu.fmi3InstantiateCoSimulation(*texts, *options, log, update)

    assert instance(tmp_path / "resources") is None
    found = instance(folder / "resources")
    assert found is not None
    fmu.fmi3FreeInstance(found)


# failures of the model


@pytest.fixture
def faulty(folder: Path, quick: Scene, tmp_path: Path) -> Iterator[Host3]:
    shutil.copytree(folder, tmp_path / "fmu")
    faults = "".join(f"\n        if load == {load}:\n            {what}" for load, (what, _) in FAULTS.items())
    script = SCRIPT.format(faults=faults, unsaved=UNSAVED)
    (tmp_path / "fmu" / "resources" / f"{module_name(quick)}.py").write_text(script)
    with hosted3(tmp_path / "fmu") as host:
        yield host


@pytest.mark.parametrize("load", [1001.0, 1005.0, 1006.0])
def test_a_fault_of_the_model_is_an_error_and_the_saved_state_goes_on_bit_for_bit(faulty: Host3, load: float) -> None:
    faulty.initialise().step(1.0, load=50.0)
    data = faulty.state()
    expected = faulty.step(1.0, load=40.0)
    faulty.restore(data)
    faulty.log.clear()
    with pytest.raises(FMICallException, match="error"):
        faulty.step(1.0, load=load)
    assert faulty.last.value == faulty.time == 1.0
    assert any(status == fmi3Error and FAULTS[load][1] in text for status, _, text in faulty.log), faulty.log
    faulty.restore(data)
    assert faulty.step(1.0, load=40.0) == expected


def test_a_freed_instance_is_an_error(folder: Path) -> None:
    with hosted3(folder) as host, hosted3(folder) as other:
        component, library = other.fmu.component, other.fmu
        host.initialise()
        library.fmi3FreeInstance(component)
        for call in (library.fmi3Terminate, library.fmi3Reset, library.fmi3EnterEventMode):
            with pytest.raises(FMICallException, match="error"):
                call(component)
        with pytest.raises(FMICallException, match="error"):  # which would succeed by itself
            library.fmi3SetDebugLogging(component, False, 0, None)
        assert host.step(1.0)["valid"]
