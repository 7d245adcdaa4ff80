"""A scene with several surfaces, run as an ensemble: means, bands, what is kept, what refuses it."""

import contextlib
import io
import math
import re
import shlex
import shutil
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from contact_core import Scene, advance, initial_state
from contact_core.quantities import STATED
from contact_core.scene.ensemble import Members
from system_models.cli.main import main
from system_models.html_report.opened import open_run
from system_models.html_report.page import page
from system_models.store import results
from system_models.sweep import members, points

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "surfaces.md"
QUICK = ["film.model=regression", "operation.duration=2 min", "surface_2.rq=0 nm"]
FILES = [*QUICK, "surface_2.files=a.npy,b.npy,c.npy", "surface_2.heights.spacing=1 um", "surface_2.heights.unit=nm"]
AVERAGED = ("h_c", "friction_coefficient", "wear_depth_1")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def opened(file: Path) -> xr.Dataset:
    return results.read(file)


class Ran(NamedTuple):
    """A run of an ensemble: what it printed, its folder and its result."""

    out: str
    folder: Path
    whole: xr.Dataset


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("patches")
    wave = np.cos(2.0 * np.pi * np.arange(96) / 16.0)
    for name, height in (("a", 100.0), ("b", 120.0), ("c", 160.0)):
        np.save(folder / f"{name}.npy", height * np.outer(wave, wave))
    return folder


@pytest.fixture
def patches(measured: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A working folder of its own with the patches."""
    shutil.copytree(measured, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)


@pytest.fixture(scope="module")
def ran(measured: Path, tmp_path_factory: pytest.TempPathFactory) -> Ran:
    folder, said = tmp_path_factory.mktemp("ensemble") / "all", io.StringIO()
    with contextlib.chdir(measured), contextlib.redirect_stdout(said):
        assert main(["run", "mtm_zddp", "--set", *FILES, "--out", str(folder)]) == 0
    return Ran(said.getvalue(), folder, opened(folder / "result.nc"))


def alone(name: str) -> xr.Dataset:
    """A member at the rows of the ensemble."""
    changes = dict(each.split("=", 1) for each in [*FILES, f"surface_2.file={name}.npy"])
    scene = Scene.from_toml("mtm_zddp", changes)
    state, outs = initial_state(scene), []
    for step in (0.0, 60.0, 60.0):
        state, out = advance(scene, scene.operation.point, state, step)
        outs.append(out)
    return xr.Dataset(
        {key: ("time", [getattr(out, key) for out in outs]) for name in AVERAGED for key in (name, STATED[name])}
    )


@pytest.mark.usefixtures("patches")
def test_an_ensemble_is_the_mean_of_its_members_with_a_band_by_their_scatter(ran: Ran) -> None:
    assert "Ensemble of 3 surfaces (surface_2.files): a.npy, b.npy, c.npy." in ran.out
    assert "Student's t" in ran.out and "+- surfaces" in ran.out
    whole, each = ran.whole, xr.concat([alone(name) for name in "abc"], "member")
    assert opened(ran.folder / "members.nc")["h_c"].values == approx(each["h_c"].values, rel=1e-12)
    for name in AVERAGED:
        assert whole[name].values == approx(each[name].mean("member").values, rel=1e-12)
        band = 4.302653 * each[name].std("member", ddof=1) / math.sqrt(3.0)
        assert whole[f"{name}_band"].values[1:] == approx(band.values[1:], rel=1e-6)
        half = (each[STATED[name]] * abs(each[name])).mean("member")
        assert whole[f"{name}_error"].values == approx(half.values, rel=1e-12)
    assert float(whole["h_c_band"][-1]) > 0.05 * float(whole["h_c"][-1])  # the members differ
    assert whole["valid"].values.all() and whole["range_flags"].dtype.kind == "i"


@pytest.mark.long
@pytest.mark.usefixtures("patches")
def test_an_ensemble_goes_on_with_the_member_that_is_missing(ran: Ran, monkeypatch: pytest.MonkeyPatch) -> None:
    anew: list[object] = []
    original = points.run
    monkeypatch.setattr(points, "run", lambda *given: anew.append(given) or original(*given))
    shutil.copytree(ran.folder, "all")
    file = Path("all/members/000001.npz")
    file.write_bytes(file.read_bytes()[:1000])  # cut by a kill
    assert main(["run", "mtm_zddp", "--set", *FILES, "--out", "all", "--resume"]) == 0
    assert len(anew) == 1
    xr.testing.assert_identical(opened(Path("all/result.nc")), ran.whole)


def test_the_report_shows_each_member_and_the_band_of_both_parts(ran: Ran, tmp_path: Path) -> None:
    shown = page(open_run(ran.folder))
    assert "Ensemble of surfaces" in shown
    for name in ("a.npy", "b.npy", "c.npy", "± surfaces", "± stated"):
        assert name in shown
    whole = ran.whole.isel(time=-1)
    both = math.hypot(float(whole["h_c_band"]), float(whole["h_c_error"])) / float(whole["h_c"])
    assert f"Central film thickness is uncertain by {both:.0%}" in shown
    shutil.copy(ran.folder / "result.nc", tmp_path)
    assert "results of its members, members.nc, are not there" in page(open_run(tmp_path))


@pytest.mark.usefixtures("patches")
@pytest.mark.parametrize(
    ("command", "said"),
    [
        (["build", "mtm_zddp", "--set", *FILES], "pick a member, such as --set surface_2.file=a.npy"),
        (["stribeck", "mtm_zddp", "--set", *FILES], "pick a member, such as --set surface_2.file=a.npy"),
        (["map", "mtm_zddp", "--set", *FILES], "pick a member, such as --set surface_2.file=a.npy"),
        (["sweep", "mtm_zddp", "--set", *FILES, "--vary", "operation.load=1 N,2 N"], "pick a member"),
        (["run", "gear_fzg_c", "--set", "contact.surface_2.files=a.npy,b.npy"], "pick a member"),
        (["run", "mtm_zddp", "--set", *FILES, "--fields", "3"], "pick a member by --set surface_2.file=a.npy"),
        (["run", "mtm_zddp", "--set", *QUICK, "--processes", "2"], "members of an ensemble"),
        (["run", "mtm_zddp", "--set", *FILES, "surface_2.files=a.npy,z.npy"], "Member 'z.npy' of the ensemble"),
    ],
)
def test_what_needs_one_contact_names_the_way_out(
    command: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(command) == 2
    assert said in capsys.readouterr().err


def test_members_that_do_not_differ_are_told(ran: Ran) -> None:
    """As of seeds, which have no effect at the regression level."""
    three = Members(("surface_2.files",), ("a", "b", "c"), ((),) * 3)
    each = opened(ran.folder / "members.nc")
    for found, alike in ((each, False), (each.isel(member=[0, 0, 0]), True)):
        mean = members.mean_of(three, members.plan_of_members(three), found)
        assert ("The members do not differ" in members.table(three, mean, found)[1]) == alike


def test_seeds_make_an_ensemble(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "mtm_zddp", "--set", "surface_2.seeds=1,2"]) == 0
    assert "Ensemble of 2 surfaces (surface_2.seeds): 1, 2." in " ".join(capsys.readouterr().out.split())


@pytest.mark.long
def test_the_example_of_the_page_works(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    text = PAGE.read_text("utf-8")
    blocks = BLOCK.findall(text[text.index("## Several surfaces") :])
    for language, body in blocks:
        if language == "python":
            exec(compile(body, PAGE.name, "exec"), {})
        for line in body.splitlines() if language == "sh" else ():
            program, *arguments = shlex.split(line)
            assert (program, main(arguments)) == ("tribofmu", 0)
    out = capsys.readouterr().out
    (header,) = (body.strip() for language, body in blocks if language == "text")
    assert header in [line.strip() for line in out.splitlines()]
    assert Path("rough/report.html").exists()
