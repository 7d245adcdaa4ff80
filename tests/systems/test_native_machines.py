"""Machines with native FMUs: the answers of those in Python, and no Python in an exported file."""

import io
import shutil
import zipfile
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp

from contact_core.errors import ContactError, SceneError
from system_models.cli.main import main
from system_models.machines import reading
from system_models.machines.assembly import Assembly
from system_models.machines.export import with_timetable
from system_models.master import System, export_ssp, simulate

pytestmark = [
    pytest.mark.systems,
    pytest.mark.usefixtures("unoptimised"),
    pytest.mark.skipif(shutil.which("cc") is None, reason="needs cc"),
]

FEW = {"mesh.stations": "4"}
END, STEP = 4.0, 0.1  # s
SAME = 1e-7  # of the largest value: rounding, after 40 steps


@pytest.mark.parametrize(("machine", "changes"), [("bearing_218", {}), ("bearing_209", {"duty.axial_load": "500 N"})])
def test_a_bearing_whose_contact_angles_change_is_refused_with_a_way_out(
    machine: str, changes: dict[str, str], tmp_path: Path
) -> None:
    """Its radii change with them; before, the FMUs were built and refused every step."""
    assembly = reading.assemble(reading.read(machine, changes))
    with pytest.raises(SceneError, match=r"inner_1\.radius_x changes during this duty.*--flavour embedded"):
        assembly.system(tmp_path, "native", here=True)
    assert list(tmp_path.iterdir()) == []


def test_the_radii_of_a_bearing_under_radial_load_stay_those_of_its_contacts() -> None:
    contacts = reading.assemble(reading.read("bearing_209", {})).contacts
    assert {contact.moved for contact in contacts.values()} == {()}


def test_native_contacts_of_gears_have_the_radii_and_tracks_of_their_stations() -> None:
    """They take no parameters."""
    for contact in reading.assemble(reading.read("gear_fzg_c", FEW)).contacts.values():
        own = contact.own_scene
        assert own.operation.point.radius_x == contact.parameters["radius_x"] != own.geometry.radius_x
        for i in (1, 2):
            track = f"track_length_{i}"
            assert getattr(own.geometry, track) == contact.parameters[f"geometry.{track}"]


@pytest.mark.parametrize("export", [[], ["--ssp", "rig.ssp"]])
@pytest.mark.parametrize(
    "contact", ["film.model = 'deterministic'", "film.model = 'regression'\nfilm.correction = 'blocks'", ""]
)
def test_contacts_with_a_solver_take_a_level_that_native_fmus_can_have_and_say_so(
    contact: str, export: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    rig = reading.shipped_files()["mtm_rig"]
    shutil.copy(rig.with_name("mtm_rig.csv"), tmp_path)
    listed = "" if contact else "deterministic = ['contact']\n"
    Path("rig.toml").write_text(listed + rig.read_text("utf-8").replace('film.model = "regression"', contact), "utf-8")
    levels: list[str] = []

    def built(assembly: Assembly, *_: object, **__: object) -> System:
        levels.extend(each.own_scene.film.fidelity for each in assembly.contacts.values())
        raise ContactError("enough")

    monkeypatch.setattr(Assembly, "system", built)
    command = ["run", "rig.toml", "--flavour", "native", *export]
    assert (
        main(command)
        == main(
            [*command, "--set", "contact.film.model=regression", "contact.film.correction=blocks", "deterministic=[]"]
        )
        == 2
    )
    assert levels == ["regression", "auto"]  # the second one is asked for, and refused by the build
    said = capsys.readouterr().err
    assert said.count("contact: the level 'regression' in place of") == 1
    assert "friction_coefficient +- " in said


@pytest.mark.long
def test_a_native_gear_pair_answers_as_the_python_and_is_exported_without_it(tmp_path: Path) -> None:
    """In the master, and as SSP in fmpy: its contacts, too, have the values of their stations."""
    assembly = reading.assemble(reading.read("gear_fzg_c", FEW))
    runs = []
    for flavour in ("embedded", "native"):
        system = assembly.system(tmp_path / flavour, flavour, here=True)
        runs.append(simulate(system, END, STEP, algorithm="gauss_seidel", outputs=assembly.outputs()))
    python, native = runs
    for name in python.data_vars:
        expected, found = (run[name].values.astype(float) for run in (python, native))
        assert np.abs(expected - found).max() <= SAME * np.abs(expected).max(), name
    timed = with_timetable(assembly)
    file = export_ssp(timed.system(tmp_path / "ssp", "native", here=True), tmp_path / "gear.ssp", 1.0, 0.1)
    with zipfile.ZipFile(file) as archive:
        fmus = [name for name in archive.namelist() if name.endswith(".fmu")]
        assert len(fmus) == len(timed.parts) + len(timed.contacts)
        for name in fmus:
            inside = zipfile.ZipFile(io.BytesIO(archive.read(name))).namelist()
            assert not [each for each in inside if each.endswith(".py") or each.startswith("resources/")], name
    rows = simulate_ssp(str(file), stop_time=1.0, step_size=0.1)
    assert rows["flank_02.friction_force"][-1] != 0.0
    assert rows["flank_02.valid"][-1]
