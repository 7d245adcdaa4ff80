"""Isolated FMUs of components: the embedded flavour's bits, and a host in C that sees inputs act at once."""

import json
import math
import os
import signal
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from fmu_host import Host, hosted, unpacked
from test_parts_fmu import EXAMPLES, STEPS, SYSTEMS, at_rest

from benchmarks.hosts.native_host import ERROR, NONE, OK, WARNING, Fmu, Instance, NativeHost, plain_environment
from benchmarks.hosts.processes import children
from fmu_src.flavours import WITH_PYTHON
from system_models.check import deep
from system_models.cli.main import main
from system_models.parts.build import build
from system_models.parts.part import Part
from system_models.parts.shaft import Shaft

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the processes are looked at as Linux shows them")

COUPLING, DRIVE = 3.0, 80.0
SHAFT = Shaft(0.02, 0.01, coupling=COUPLING, initial_speed=-5.0)


def life(host: Host, part: Part, inputs: dict[str, float]) -> dict[str, list[object]]:
    """A run with inputs set between steps, states, restored states, a bad input, and a reset."""
    host.initialise(**at_rest(part))
    told = {"run": [host.outputs(), *(host.step(step, **inputs) for step in STEPS)], "time": [host.get("time")]}
    handle, data = host.fmu.getFMUstate(), host.state()
    told["between steps"] = [host.outputs()]
    for name, value in inputs.items():
        host.set(**{name: value + 1.0})
        told["between steps"].append(host.outputs())
    told["states"] = [data, host.state()]
    host.step(0.1)
    for number, (restore, state) in enumerate(((host.fmu.setFMUstate, handle), (host.restore, data))):
        restore(state)
        told[f"restored {number}"] = [host.outputs(), host.get("time"), host.state(), host.step(0.1)]
    told["bad input"] = [host.step(0.1, **{q.name: math.inf}) for q in part.inputs[-1:]]
    host.fmu.reset()
    told["reset"] = [host.initialise(**at_rest(part)).outputs()]
    return told | {"log": list(host.log)}


@pytest.mark.parametrize("kind", [*EXAMPLES, *SYSTEMS])
def test_both_flavours_give_the_same_bits(kind: str, tmp_path: Path) -> None:
    part, given = (EXAMPLES | SYSTEMS)[kind]
    lives = []
    for flavour in WITH_PYTHON:
        folder = unpacked(build(part, tmp_path / f"{flavour}.fmu", flavour), tmp_path / flavour)
        with hosted(folder) as host:
            lives.append(life(host, part, at_rest(part) | given))
    told, embedded = lives
    assert told == embedded
    assert told["run"][-1] != told["run"][0] == told["reset"][0]
    assert told["restored 0"] == told["restored 1"]
    assert told["time"] == [math.fsum(STEPS)]
    assert told["restored 0"][:3] == [told["run"][-1], *told["time"], told["states"][0]]
    assert len(told["log"]) == len(told["bad input"]) == min(1, len(part.inputs))
    moved = [before != after for before, after in pairwise(told["between steps"])]
    assert any(moved) == (kind != "shaft" and any(q.direct for q in part.responses))  # this shaft has no coupling


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(SHAFT, tmp_path_factory.mktemp("shaft") / "shaft.fmu")


@pytest.fixture(scope="module")
def shaft_folder(file: Path) -> Path:
    return unpacked(file, file.parent / "shaft")


@pytest.fixture
def host(native_program: Path) -> Iterator[NativeHost]:
    with NativeHost(native_program, plain_environment()) as host:
        yield host
    assert host.code == 0


@pytest.fixture
def shaft(host: NativeHost, shaft_folder: Path) -> Instance:
    return stepped(host.load(shaft_folder))


def stepped(fmu: Fmu, number: int = 0) -> Instance:
    """A shaft after its first step."""
    instance = fmu.instance(number)
    assert instance.created.status == OK, instance.log
    assert set(instance.initialise()) == {OK}
    assert instance.step(0.001, speed_drive=DRIVE) == OK
    return instance


def torque(instance: Instance, drive: float) -> float:
    return COUPLING * (drive - instance.get("speed")[0])


def test_a_state_saved_before_its_outputs_were_read_comes_back_with_them(shaft: Instance) -> None:
    shaft.set(speed_drive=-20.0)
    shaft.ask("save", 0)
    expected = torque(shaft, -20.0)
    for drive in (7.0, 8.0):
        shaft.set(speed_drive=drive)
        shaft.ask("restore", 0)
        assert shaft.get("speed_drive", "torque_coupling") == [-20.0, expected]


def test_outputs_follow_at_once_the_inputs_they_name(shaft: Instance) -> None:
    before = shaft.outputs()
    assert before["torque_coupling"] == torque(shaft, DRIVE)
    shaft.set(torque_drive=2.0)
    assert shaft.outputs() == before
    shaft.set(speed_drive=-20.0)
    assert shaft.outputs() == before | {"torque_coupling": torque(shaft, -20.0)}
    shaft.set(speed_drive=7.0)
    assert shaft.ask("terminate").status == OK
    assert shaft.outputs() == before | {"torque_coupling": torque(shaft, 7.0)}
    assert shaft.log == []


def test_a_state_saved_between_setting_and_reading_has_the_new_outputs(shaft: Instance, tmp_path: Path) -> None:
    shaft.set(speed_drive=-20.0)
    calls = (("save", 0), ("serialize", 0, tmp_path / "state"))
    assert [shaft.ask(*call).status for call in calls] == [OK, OK]
    expected = shaft.outputs()
    assert expected["torque_coupling"] == torque(shaft, -20.0)
    shaft.step(0.01, speed_drive=5.0)
    assert shaft.ask("restore", 0).status == OK
    assert shaft.outputs() == expected
    other = stepped(shaft.fmu, 1)
    assert [other.ask(*call).status for call in (("deserialize", 1, tmp_path / "state"), ("restore", 1))] == [OK, OK]
    assert other.outputs() == expected


def test_what_cannot_be_used_is_told_and_outputs_stand(shaft: Instance) -> None:
    before = shaft.outputs()
    for drive in (math.nan, math.inf):
        shaft.set(speed_drive=drive)
        assert shaft.outputs() == before | {"valid": 0}
        assert f"speed_drive = {drive} must be a finite number." in shaft.log[-1][3]
        assert shaft.step(0.01) == WARNING
        assert shaft.outputs() == before | {"valid": 0}
    shaft.set(speed_drive=DRIVE)
    assert shaft.outputs() == before


def test_a_parameter_out_of_its_range_is_told(host: NativeHost, shaft_folder: Path) -> None:
    instance = host.load(shaft_folder).instance()
    assert instance.initialise(inertia=-1.0) == [OK, OK, OK, WARNING]
    assert instance.get("valid") == [0]
    assert any("inertia = -1 kg m2" in text for *_, text in instance.log)


def test_a_killed_process_is_an_error_until_a_state_is_restored(host: NativeHost, shaft: Instance) -> None:
    shaft.ask("save", 0)
    expected = [(shaft.step(0.01), shaft.outputs()) for _ in range(2)]
    (supervisor,) = host.supervisors()
    (worker,) = children(supervisor)
    os.kill(worker, signal.SIGKILL)
    assert shaft.step(0.01) == ERROR
    assert "was lost: It was killed by signal 9 (Killed)" in shaft.log[-1][3]
    assert shaft.ask("restore", 0).status == OK
    assert [(shaft.step(0.01), shaft.outputs()) for _ in range(2)] == expected


def test_a_component_that_was_changed_after_building_is_refused(host: NativeHost, file: Path, tmp_path: Path) -> None:
    folder = unpacked(file, tmp_path)
    table = json.loads((folder / "resources" / "part.json").read_text())
    table["values"]["inertia"] = "0.5 kg m2"
    (folder / "resources" / "part.json").write_text(json.dumps(table))
    instance = host.load(folder).instance()
    assert instance.created.status == NONE
    assert "was changed after building. Build it again." in instance.log[0][3]


@pytest.mark.long
def test_the_check_finds_no_fault(file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    rules = ("run", "feedthrough", "reset")
    monkeypatch.setattr(deep, "RULES", {rule: deep.RULES[rule] for rule in rules})
    assert main(["check", str(file), "--deep", "--limit", "inf", "--budget", "inf"]) == 0
    verdicts = {line.split()[0]: line.split()[1] for line in capsys.readouterr().out.splitlines() if line.split()}
    assert {verdicts[rule] for rule in rules} == {"pass"}
