"""A scene with several surfaces, run as an ensemble: means, bands, what is kept, what refuses it."""

import math
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from system_models.cli.main import main
from system_models.html_report.opened import open_run
from system_models.html_report.page import page
from system_models.sweep import points

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "surfaces.md"
QUICK = ["film.model=regression", "operation.duration=2 min", "surface_2.rq=0 nm"]
FILES = [*QUICK, "surface_2.files=a.npy,b.npy,c.npy", "surface_2.heights.spacing=1 um", "surface_2.heights.unit=nm"]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def opened(file: str) -> xr.Dataset:
    with xr.open_dataset(file, engine="h5netcdf") as found:
        return found.load()


@pytest.fixture
def patches(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    wave = np.cos(2.0 * np.pi * np.arange(96) / 16.0)
    for name, height in (("a", 100.0), ("b", 120.0), ("c", 160.0)):
        np.save(f"{name}.npy", height * np.outer(wave, wave))


@pytest.mark.usefixtures("patches")
def test_an_ensemble_is_the_mean_of_its_members_with_a_band_by_their_scatter(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "mtm_zddp", "--set", *FILES, "--out", "all"]) == 0
    out = capsys.readouterr().out
    assert "Ensemble of 3 surfaces (surface_2.files): a.npy, b.npy, c.npy." in out
    assert "Student's t" in out and "+- surfaces" in out
    whole = opened("all/result.nc")
    for name in "abc":
        assert main(["run", "mtm_zddp", "--set", *FILES, f"surface_2.file={name}.npy", "--out", name]) == 0
    each = xr.concat([opened(f"{name}/result.nc") for name in "abc"], "member", combine_attrs="drop_conflicts")
    assert opened("all/members.nc")["h_c"].values == approx(each["h_c"].values, rel=1e-12)
    for name in ("h_c", "friction_coefficient", "wear_depth_1"):
        assert whole[name].values == approx(each[name].mean("member").values, rel=1e-12)
        band = 4.302653 * each[name].std("member", ddof=1) / math.sqrt(3.0)
        assert whole[f"{name}_band"].values[1:] == approx(band.values[1:], rel=1e-6)
        assert whole[f"{name}_error"].values == approx(each[f"{name}_error"].mean("member").values, rel=1e-12)
    assert float(whole["h_c_band"][-1]) > 0.05 * float(whole["h_c"][-1])  # the members differ
    assert whole["valid"].values.all() and whole["range_flags"].dtype.kind == "i"

    ran: list[object] = []
    original = points.run
    monkeypatch.setattr(points, "run", lambda *given: ran.append(given) or original(*given))
    file = Path("all/members/000001.npz")
    file.write_bytes(file.read_bytes()[:1000])  # cut by a kill
    assert main(["run", "mtm_zddp", "--set", *FILES, "--out", "all", "--resume"]) == 0
    assert len(ran) == 1
    xr.testing.assert_identical(opened("all/result.nc"), whole)


@pytest.mark.usefixtures("patches")
def test_the_report_shows_each_member_and_the_band_of_both_parts(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "mtm_zddp", "--set", *FILES, "--out", "all"]) == 0
    shown = page(open_run(Path("all")))
    assert "Ensemble of surfaces" in shown
    for name in ("a.npy", "b.npy", "c.npy", "± surfaces", "± stated"):
        assert name in shown
    whole = opened("all/result.nc").isel(time=-1)
    both = math.hypot(float(whole["h_c_band"]), float(whole["h_c_error"])) / float(whole["h_c"])
    assert f"Central film thickness is uncertain by {both:.0%}" in shown
    Path("all/members.nc").unlink()
    assert "results of its members, members.nc, are not there" in page(open_run(Path("all")))


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


@pytest.mark.usefixtures("patches")
def test_seeds_make_an_ensemble_that_says_where_they_have_no_effect(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "mtm_zddp", "--set", *QUICK[:2], "surface_2.seeds=1,2", "--out", "seeds"]) == 0
    assert "The members do not differ" in capsys.readouterr().out
    assert main(["explain", "mtm_zddp", "--set", "surface_2.seeds=1,2"]) == 0
    assert "Ensemble of 2 surfaces (surface_2.seeds): 1, 2." in " ".join(capsys.readouterr().out.split())


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
