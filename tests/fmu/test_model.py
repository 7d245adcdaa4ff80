"""What a master reads of an FMU before anything runs."""

import zipfile
from pathlib import Path

import pytest
from comparison import approx

from benchmarks.models import build
from system_models.fmu.errors import CouplingError
from system_models.fmu.kinds import discrete, kind
from system_models.fmu.model import Model
from system_models.master import simulate
from system_models.master.system import System

TYPES = {
    2: '<TypeDefinitions><SimpleType name="T"><Real unit="degC" nominal="20" {}/></SimpleType></TypeDefinitions>',
    3: '<TypeDefinitions><Float64Type name="T" unit="degC" nominal="20" {}/></TypeDefinitions>',
}


def edited(path: Path, *replacements: tuple[str, str]) -> Path:
    """The FMU with another description."""
    result = path.with_name(f"edited_{path.name}")
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(result, "w") as target:
        for entry in source.infolist():
            data = source.read(entry)
            if entry.filename == "modelDescription.xml":
                text = data.decode()
                for old, new in replacements:
                    assert old in text
                    text = text.replace(old, new)
                data = text.encode()
            target.writestr(entry, data)
    return result


def with_type(folder: Path, fmi: int, of_type: str = "", of_variable: str = "") -> Path:
    """A gain in degC whose output has its unit and nominal from a declared type."""
    path = build("celsius", folder, fmi)
    with zipfile.ZipFile(path) as archive:
        lines = archive.read("modelDescription.xml").decode().splitlines()
    (start,) = (n for n, line in enumerate(lines) if 'name="y"' in line)
    own = next(line for line in lines[start:] if 'unit="degC"' in line)
    declared = own.replace('unit="degC"', 'declaredType="T"').replace('nominal="1.0"', of_variable)
    types = TYPES[fmi].format(of_type)
    old = "\n".join(lines[start : lines.index(own, start) + 1])
    return edited(path, (old, old.replace(own, declared)), ("<ModelVariables>", f"{types}<ModelVariables>"))


@pytest.mark.parametrize("fmi", [2, 3])
def test_unit_and_nominal_come_from_the_declared_type_too(tmp_path: Path, fmi: int) -> None:
    path = with_type(tmp_path, fmi)
    system = System({"a": path, "b": build("kelvin", tmp_path)}, [("a.y", "b.u")])
    assert system.connections[0].source.nominal == 20.0
    assert system.connections[0].result(20.0) == approx(293.15, rel=1e-15)


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("place", ["of_type", "of_variable"])
def test_a_difference_of_temperatures_is_taken_as_one(tmp_path: Path, fmi: int, place: str) -> None:
    path = with_type(tmp_path, fmi, **{place: 'relativeQuantity="true"'})
    assert Model("a", path).variables["y"].relativeQuantity is True


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_discrete_real_holds_its_value_between_communication_points(tmp_path: Path, fmi: int) -> None:
    path = build("gain", tmp_path, fmi)
    model = Model(
        "a", edited(path, ('causality="input" variability="continuous"', 'causality="input" variability="discrete"'))
    )
    assert kind(model.variables["u"]) == kind(model.variables["y"]) == "real"
    assert discrete(model.variables["u"])
    assert not discrete(model.variables["y"])


def test_inputs_that_may_be_set_within_a_step_are_known(tmp_path: Path) -> None:
    for intermediate in (True, False):
        model = Model("a", build("gain", tmp_path, 3, intermediate=intermediate))
        assert model.variables["u"].intermediateUpdate is intermediate
        assert not model.variables["y"].intermediateUpdate


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(("there", "said"), [("win64", "only for win64"), ("", "nor for any other")])
def test_a_library_for_another_platform_is_named(fmi: int, there: str, said: str, tmp_path: Path) -> None:
    other = tmp_path / "other.fmu"
    with zipfile.ZipFile(build("gain", tmp_path, fmi)) as old, zipfile.ZipFile(other, "w") as new:
        for name in old.namelist():
            kept = name if not name.startswith("binaries/") else f"binaries/{there}/gain.dll"
            if there or name == kept:
                new.writestr(kept, old.read(name))
    with pytest.raises(CouplingError, match=f"'a' has no library for this platform, .*linux.*, {said}. Export it for"):
        simulate(System({"a": other}), stop_time=1.0, step_size=0.1)


def test_a_failure_does_not_point_to_messages_that_are_not_there(tmp_path: Path) -> None:
    broken, before = tmp_path / "broken.fmu", Path.cwd()
    with zipfile.ZipFile(build("gain", tmp_path)) as old, zipfile.ZipFile(broken, "w") as new:
        for name in old.namelist():
            new.writestr(name, b"no library" if name.startswith("binaries/") else old.read(name))
    with pytest.raises(CouplingError, match=r"'a' failed to start: .* It gave no message; ask who made it\."):
        simulate(System({"a": broken}), stop_time=1.0, step_size=0.1)
    assert Path.cwd() == before
