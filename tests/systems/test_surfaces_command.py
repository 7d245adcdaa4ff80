import re
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from system_models.cli.main import main

NO_ROUGHNESS = ["--set", "surface_2.rq=0 nm"]


def numbers(out: str, row: str) -> list[list[float]]:
    """The numbers of each line that begins with `row`."""
    lines = [line.strip() for line in out.splitlines()]
    return [[float(cell) for cell in line[len(row) :].split()] for line in lines if line.startswith(row)]


def test_surfaces_of_a_shipped_scene_are_told_as_asked_and_as_on_the_grid(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["surfaces", "azam_case_a", "--grid", "65", "--set", "surface_1.correlation_length=16 um",
                 "surface_2.correlation_length=8 um"]) == 0  # fmt: skip
    out, err = capsys.readouterr()
    assert "Grid of 65 nodes, 7.81 um apart" in out
    assert "surface_2 has 1.02 nodes per correlation length" in err
    assert numbers(out, "rms height, nm")[0] == [12.0, 12.0]
    asked, shown = numbers(out, "rms height, nm")[1]
    assert asked == 127.0
    (lost,) = numbers(out, "cut by the grid, nm rms")[1]
    assert lost == approx(np.sqrt(asked**2 - shown**2), rel=0.02)


def test_surfaces_of_a_file_are_told_before_and_after(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    np.savetxt("noise.csv", np.random.default_rng(0).normal(scale=50.0, size=(250, 250)), delimiter=",")
    given = ["surface_2.heights.file=noise.csv", "surface_2.heights.spacing=2 um", "surface_2.heights.unit=nm"]
    assert main(["surfaces", "mtm_zddp", *NO_ROUGHNESS, *given, "surface_2.heights.beyond=repeated"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"Body 2: noise\.csv\n +file +all waves +on the grid", out)
    file, waves, shown = numbers(out, "rms height, nm")[1]
    assert file == waves == approx(50.0, rel=0.02)
    assert 20.0 < shown < 30.0
    assert len(numbers(out, "skewness")[1]) == len(numbers(out, "peak to valley, nm")[1]) == 2


def test_heights_in_a_wrong_unit_end_the_command_with_a_sentence(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    np.save("noise.npy", np.random.default_rng(0).normal(scale=50e-6, size=(250, 250)))  # in mm
    given = ["surface_2.heights.file=noise.npy", "surface_2.heights.spacing=2 um", "surface_2.heights.unit=m"]
    assert main(["surfaces", "mtm_zddp", "--set", *given]) == 2
    assert "surface_2.heights.unit = 'm' with spacing = 2e-06 m makes the rms" in capsys.readouterr().err


def test_smooth_surfaces_are_called_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["surfaces", "dimple_rolling"]) == 0
    assert "Body 1: smooth\nno microroughness: solids touch at the floor\n" in capsys.readouterr().out


def test_roughness_below_the_grid_is_told_of_each_body(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["surfaces", "mtm_zddp", *NO_ROUGHNESS, "surface_1.microroughness.rms=0 nm"]) == 0
    out = capsys.readouterr().out
    assert "\nno microroughness\n\nBody 2: smooth\n" in out
    assert out.endswith("microroughness 16 nm rms, waves below 4 um (assumed: ground steel)\n")


def test_microroughness_of_a_measured_set_is_not_called_assumed(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    layer = 'microroughness = { rms = "3 nm", longest = "4 um" }  # waves that the image resolves'
    Path("disc.toml").write_text(
        f'[disc.surface_2]  # measured: Zygo\nmodel = "gaussian"\nrq = "50 nm"\n{layer}\n', "utf-8"
    )
    given = ["surface_2.set=disc.toml:disc", "surface_1.microroughness.rms=2 nm"]
    assert main(["surfaces", "mtm_zddp", "--set", *given]) == 0
    out = capsys.readouterr().out
    assert "microroughness 2 nm rms, waves below 4 um (from a setting of the command, without a source)\n" in out
    assert out.endswith("microroughness 3 nm rms, waves below 4 um (measured: Zygo; set disc, disc.toml)\n")


AFFINE = ["surface_1.model=self_affine", "surface_1.hurst=0.8", "surface_1.roll_off=60 um", "surface_1.cut_off=3 um"]


@pytest.mark.parametrize(
    ("changes", "shown"),
    [
        (["film.points=257"], None),
        (["film.points=257", "surface_1.microroughness.longest=8 um"], "5.59e-06"),  # of Gaussian roughness none below
        (["film.points=129", "surface_1.microroughness.longest=8 um"], "7.81e-06"),  # two nodes
        (["film.points=513", *AFFINE], "3e-06"),
        (["film.points=257", *AFFINE], "3.91e-06"),
        (["film.points=129", *AFFINE], None),
        (["film.points=513", *AFFINE, "surface_1.microroughness.rms=0 nm"], None),
        (["film.points=129", "surface_1.rq=0 nm", "surface_1.microroughness.longest=8 um"], None),
    ],
)
def test_waves_that_count_twice_are_warned_about(
    capsys: pytest.CaptureFixture[str], changes: list[str], shown: str | None
) -> None:
    assert main(["surfaces", "mtm_zddp", "--set", *changes]) == 0
    err = capsys.readouterr().err
    assert ("count twice" in err) == (shown is not None)
    if shown:
        assert f"but the grid shows waves down to {shown} m: those between count twice." in err
        assert f"Set microroughness.longest to {shown} m at most" in err
        assert main(["surfaces", "mtm_zddp", "--set", *changes, f"surface_1.microroughness.longest={shown} m"]) == 0
        assert "count twice" not in capsys.readouterr().err
