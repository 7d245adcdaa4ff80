"""An FMU carries the heights of its scene's files, and is known by their numbers."""

import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmu_host import SMALL, hosted, unpacked
from test_run import STEPS, bits, direct

from contact_core import Scene, SceneError
from fmu_src.package.build import build
from fmu_src.package.document.page import documentation
from fmu_src.runtime import resources
from fmu_src.variables import variables


def scene_of(file: Path) -> Scene:
    given = {"file": str(file), "spacing": "5 um", "unit": "nm"}
    heights = {f"surface_2.heights.{key}": value for key, value in given.items()}
    return Scene.from_toml("mtm_zddp", SMALL | heights).at_level("regression")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    x = np.arange(80)
    np.save(tmp_path / "patch.npy", np.round(40.0 * np.sin(0.21 * x)[:, None] * np.cos(0.17 * x), 3))
    return tmp_path / "patch.npy"


@pytest.mark.parametrize("flavour", ["embedded", "isolated"])
def test_an_fmu_runs_without_the_file_it_was_built_from(file, tmp_path, flavour):
    scene = scene_of(file)
    folder = unpacked(build(scene, tmp_path / "rough.fmu", flavour), tmp_path / "elsewhere")
    file.unlink()
    with hosted(folder) as host:
        host.initialise()
        rows = [host.outputs(), host.step(60.0)]
    for row, expected in zip(rows, direct(scene, STEPS[:1])[0], strict=True):
        found = bits(row)
        assert found == {name: expected[name] for name in found}  # outputs of this level
    plain = direct(Scene.from_toml("mtm_zddp", SMALL).at_level("regression"), STEPS[:1])[0]
    assert bits(rows[0])["friction_force"] != plain[0]["friction_force"]


def test_the_numbers_of_a_file_decide_on_the_guid_and_its_name_does_not(file, tmp_path):
    np.savetxt(tmp_path / "same.csv", np.load(file), delimiter=",")
    np.save(tmp_path / "other.npy", np.load(file) + np.eye(80))
    mine, same, other = (scene_of(tmp_path / name) for name in ("patch.npy", "same.csv", "other.npy"))
    assert resources.guid(mine, "isolated") == resources.guid(same, "isolated")
    assert resources.guid(mine, "isolated") != resources.guid(other, "isolated")
    assert resources.files(mine) == resources.files(same)
    builds = [build(scene, tmp_path / f"{i}.fmu", "embedded").read_bytes() for i, scene in enumerate((mine, same))]
    assert builds[0] == builds[1]


def test_changed_heights_in_an_fmu_are_refused(file, tmp_path):
    scene = scene_of(file)
    fmu = build(scene, tmp_path / "rough.fmu", "embedded")
    with zipfile.ZipFile(fmu) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".npy"))
    folder = unpacked(fmu, tmp_path / "elsewhere")
    found = resources.read(str(folder / "resources"), resources.module_name(scene))
    assert found.digest() == scene.digest()
    resources.read.cache_clear()
    np.save(folder / name, np.load(file) * 1.1)
    with pytest.raises(SceneError, match="holds other numbers than before"):
        resources.read(str(folder / "resources"), resources.module_name(scene))


def test_the_page_of_an_fmu_names_spectrum_and_file(file):
    spectrum = {"model": "self_affine", "hurst": "0.8", "roll_off": "0.2 mm", "cut_off": "40 um"}
    changes = {f"surface_1.{key}": value for key, value in spectrum.items()}
    rough = Scene.from_toml("mtm_zddp", {"film.points": "17", "surface_2.correlation_length": "32 um"} | changes)
    page = documentation(replace(scene_of(file), surface_1=rough.surface_1), "isolated", reference=False).decode()
    assert "surface_1: self_affine" in page
    assert "doi:10.1088/2051-672X/aa51f8" in page
    assert "surface_2.heights.beyond" in page
    assert "heights of resources/heights_" in page


def test_the_spacing_of_a_file_is_no_parameter(file):
    assert not [v.name for v in variables(scene_of(file)) if "heights" in v.name]
