"""Units of angles: rad counts among the exponents of our FMUs, and couples with FMUs that leave it out."""

import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import fmpy
import pytest

from benchmarks.models import build as build_model
from contact_core import Scene
from fmu_src.package.build import build
from system_models.master import CouplingError, System, export_ssp, simulate
from system_models.parts.build import build as build_part
from system_models.parts.shaft import Shaft

UNIT = "{http://ssp-standard.org/SSP1/SystemStructureCommon}Unit"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("angular")


@pytest.fixture(scope="module")
def contact(quick: Scene, folder: Path) -> Path:
    return build(quick, folder / "contact.fmu")


@pytest.fixture(scope="module")
def shaft(folder: Path) -> Path:
    return build_part(Shaft(0.02, 0.01, coupling=3.0, initial_speed=25.0), folder / "shaft.fmu")


def exponents(fmu: Path) -> dict[str, dict[str, int]]:
    """Nonzero exponents of every unit."""
    units = {u.name: u.baseUnit for u in fmpy.read_model_description(str(fmu)).unitDefinitions}
    axes = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
    return {name: {axis: n for axis in axes if (n := getattr(base, axis))} for name, base in units.items()}


def test_angles_are_among_the_exponents(contact: Path, shaft: Path) -> None:
    assert exponents(contact)["rad/s"] == exponents(shaft)["rad/s"] == {"s": -1, "rad": 1}
    assert exponents(shaft)["N m s/rad"] == {"kg": 1, "m": 2, "s": -1, "rad": -1}
    assert exponents(shaft)["N m"] == {"kg": 1, "m": 2, "s": -2}


@pytest.mark.parametrize("unit", ["rad/s", "1/s"])
def test_a_contact_takes_its_spin_from_a_source_with_rad_and_without(unit: str, contact: Path, folder: Path) -> None:
    source = build_model("gain", folder, unit_y=unit)
    assert exponents(source)[unit] == ({"s": -1, "rad": 1} if unit == "rad/s" else {"s": -1})
    system = System({"source": source, "contact": contact}, [("source.y", "contact.spin")], {"source.u": 40.0})
    (connection,) = system.connections
    assert (connection.factor, connection.offset) == (1.0, 0.0)
    alone = System({"contact": contact}, [], {"contact.spin": 40.0})
    torques = [simulate(s, 2.0, 1.0, outputs=["contact.spin_torque"])["contact.spin_torque"] for s in (system, alone)]
    assert torques[0].values[-1] == torques[1].values[-1] != 0.0


@pytest.mark.parametrize("unit", ["rad/s", "1/s"])
def test_a_component_gives_its_speed_to_a_target_with_rad_and_without(unit: str, shaft: Path, folder: Path) -> None:
    target = build_model("gain", folder, unit_u=unit)
    system = System({"shaft": shaft, "target": target}, [("shaft.speed", "target.u")])
    result = simulate(system, 0.01, 0.01, outputs=["target.y"])
    assert result["target.y"].values[0] == 25.0


def test_turns_are_connected_to_angles_by_a_factor_alone(contact: Path, folder: Path) -> None:
    path = build_model("gain", folder, unit_y="1/s")
    source = path.with_name("hertz.fmu")
    with zipfile.ZipFile(path) as archive, zipfile.ZipFile(source, "w") as changed:
        for name in archive.namelist():
            content = archive.read(name)
            changed.writestr(name, content.replace(b'"1/s"', b'"Hz"') if name.endswith(".xml") else content)
    fmus = {"source": source, "contact": contact}
    with pytest.raises(CouplingError, match=r"one counts turns.*Give it the factor 6\.283185307179586"):
        System(fmus, [("source.y", "contact.spin")])
    (connection,) = System(fmus, [("source.y", "contact.spin", 6.283185307179586)]).connections
    assert (connection.factor, connection.offset) == (6.283185307179586, 0.0)


def test_an_exported_system_says_the_same(contact: Path, folder: Path) -> None:
    source = build_model("gain", folder, unit_y="rad/s")
    system = System({"source": source, "contact": contact}, [("source.y", "contact.spin")])
    with zipfile.ZipFile(export_ssp(system, folder / "spinning.ssp")) as archive:
        root = ET.fromstring(archive.read("SystemStructure.ssd"))
    bases = {unit.get("name"): unit[0].attrib for unit in root.iter(UNIT)}
    assert {axis: float(n) for axis, n in bases["rad/s"].items()} == {"s": -1.0, "rad": 1.0}
