"""The host in C runs FMUs of FMI 3.0: every type, states, derivatives, the end of a simulation."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from fmu_host import unpacked

from benchmarks import models
from benchmarks.hosts.native_host import ERROR, NONE, OK, Instance, NativeHost, plain_environment


@pytest.fixture
def c_host(native_program: Path) -> Iterator[NativeHost]:
    with NativeHost(native_program, plain_environment()) as host:
        yield host


def started(host: NativeHost, folder: Path, name: str, **variant: object) -> Instance:
    instance = host.load(unpacked(models.build(name, folder, fmi=3, **variant), folder / name)).instance()
    assert instance.initialise() == [OK] * 3
    return instance


def test_every_type_is_set_and_read(c_host: NativeHost, tmp_path: Path) -> None:
    instance = started(c_host, tmp_path, "echo")
    assert instance.set(real_in=1.5, integer_in=-7, boolean_in=1, string_in="ü x") == [OK] * 4
    assert instance.step(1.0) == OK
    assert instance.outputs() == {"real_out": 1.5, "integer_out": -7, "boolean_out": 1, "string_out": "ü x"}


def test_states_go_back_and_outlive_the_instance(c_host: NativeHost, tmp_path: Path) -> None:
    instance = started(c_host, tmp_path, "mass_1_force")
    stored = tmp_path / "state"
    assert instance.step(0.1, F=2.0) == OK
    assert instance.ask("save", 0).status == OK
    assert instance.ask("serialize", 0, stored).status == OK
    assert instance.step(0.1, F=3.0) == OK
    expected = instance.outputs()
    assert instance.ask("restore", 0).status == OK
    other = instance.fmu.instance(1)
    assert other.initialise() == [OK] * 3
    assert other.ask("deserialize", 1, stored).status == OK
    assert other.ask("restore", 1).status == OK
    for one in (instance, other):
        assert one.ask("step", 0.1, 0.1).status == OK  # with the input of the state
        assert one.outputs() != expected
    assert instance.outputs() == other.outputs()
    assert [one.ask("freestate", k).status for k, one in enumerate((instance, other))] == [OK] * 2


def test_derivatives_are_read(c_host: NativeHost, tmp_path: Path) -> None:
    instance = started(c_host, tmp_path, "gain", start={"a": 3.0})
    known, unknown = (instance.fmu.variables[name].valueReference for name in ("u", "y"))
    assert instance.ask("derivative", unknown, known).reals == [3.0]


def test_the_end_that_an_fmu_asks_for_is_seen(c_host: NativeHost, tmp_path: Path) -> None:
    instance = started(c_host, tmp_path, "terminator", start={"t_end": 0.5})
    assert instance.step(0.25) == OK
    assert instance.ask("terminated").values == ["0"]
    instance.step(0.5)
    assert instance.ask("terminated").values == ["1"]


def test_errors_and_their_reasons_are_seen(c_host: NativeHost, tmp_path: Path) -> None:
    instance = started(c_host, tmp_path, "failing", start={"t_fail": 0.0})
    assert instance.step(0.5) == ERROR
    assert instance.log[-1][1] == ERROR
    assert instance.log[-1][3]
    assert c_host.load(tmp_path / "failing", guid="another").instance(1).created.status == NONE
