"""`tribofmu sweep`: which points a plan has, what a killed sweep keeps, and which key an output is due to."""

import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from contact_core.errors import ContactError
from system_models.cli.main import main
from system_models.store import results
from system_models.sweep import points
from system_models.sweep.ensemble import averaged, patches_of
from system_models.sweep.plan import Plan, plan_of
from system_models.sweep.points import Outcome, Task, gathered, solve
from system_models.sweep.sensitivity import indices

QUICK = ["--set", "film.model=regression", "operation.duration=2 min"]


def settings(plan: Plan) -> list[dict[str, str]]:
    return [point.settings for point in plan.points()]


def test_grids_and_choices_are_crossed() -> None:
    plan = plan_of(["operation.load=10 N:40 N:3:log", "tribofilm.model=none,ghanbarzadeh"], None, "lhs")
    assert plan.shape == (3, 2)
    assert settings(plan)[2:4] == [
        {"operation.load": "20 N", "tribofilm.model": "none"},
        {"operation.load": "20 N", "tribofilm.model": "ghanbarzadeh"},
    ]


@pytest.mark.parametrize("method", ["lhs", "sobol"])
def test_samples_fill_every_part_of_a_range_once(method: str) -> None:
    plan = plan_of(["surface_2.rq=100:200 nm", "operation.load=1 N:100 N:log"], 16, method)
    rough = [float(point["surface_2.rq"].removesuffix(" nm")) for point in settings(plan)]
    load = [math.log10(float(point["operation.load"].removesuffix(" N"))) for point in settings(plan)]
    for values, low, high in ((rough, 100.0, 200.0), (load, 0.0, 2.0)):
        parts = np.floor((np.array(values) - low) / (high - low) * 16).astype(int)
        assert sorted(parts.tolist()) == list(range(16))


@pytest.mark.parametrize(
    ("texts", "samples", "said"),
    [
        (["surface_2.rq=50 nm:200 nm"], None, "Give --samples N"),
        (["surface_2.rq=50 nm:200 nm:3"], 8, "no key has one"),
        (["surface_2.rq=200 nm:50 nm:3"], None, "begin below its end"),
        (["surface_2.rq=50 nm:1 um:3"], None, "two units"),
        (["surface_2.rq=0 nm:1 nm:3:log"], None, "begin above 0"),
        (["surface_2.rq"], None, "is not KEY=VALUES"),
        (["surface_2.rq=50 nm"], None, "two or more"),
        (["a=1:2:3", "a=1:2:4"], None, "twice"),
        (["a=1:2:1000", "b=1:2:1000"], None, "1,000,000 runs"),
        ([], None, "Nothing is varied"),
    ],
)
def test_what_cannot_be_varied_is_refused_with_a_way_out(texts: list[str], samples: int | None, said: str) -> None:
    with pytest.raises(ContactError, match=said):
        plan_of(texts, samples, "lhs")


def test_sobols_sequence_needs_a_power_of_two() -> None:
    with pytest.raises(ContactError, match="power of 2, such as 8"):
        plan_of(["a=1:2"], 9, "sobol")


def test_indices_are_those_of_ishigamis_function() -> None:
    keys = [f"{name}={-math.pi!r}:{math.pi!r}" for name in "abc"]
    plan = plan_of(keys, 4096, "indices")
    a, b, c = (-math.pi + 2.0 * math.pi * plan.shares).T
    values = np.sin(a) + 7.0 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a)
    found = indices(plan, xr.Dataset({"y": ("sample", values), "same": ("sample", np.ones_like(a))}), ("y", "same"))
    exact = {"a": (0.3139, 0.5576), "b": (0.4424, 0.4424), "c": (0.0, 0.2437)}  # Ishigami & Homma 1990
    assert [each.key for each in found] == ["a", "b", "c"]
    for each in found:
        for (value, low, high), truth in zip((each.first, each.total), exact[each.key], strict=True):
            assert value == approx(truth, abs=0.02)
            assert low - 1e-3 <= truth <= high + 1e-3


def test_a_sweep_is_one_dataset_and_goes_on_from_what_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], drawn: bool
) -> None:
    vary = ["--vary", "operation.load=20 N:60 N:2", "tribofilm.model=none,ghanbarzadeh", "--out", str(tmp_path)]
    assert main(["sweep", "mtm_zddp", *vary, *QUICK]) == 0
    first = results.read(tmp_path / "sweep.nc")
    assert first["h_c"].dims == ("operation.load", "tribofilm.model", "time")
    assert first["operation.load"].values.tolist() == [20.0, 60.0]
    assert (first["tribofilm_1"].sel({"tribofilm.model": "none"}) == 0.0).all()
    grown = first["tribofilm_1"].isel(time=-1).sel({"tribofilm.model": "ghanbarzadeh"})
    assert 0.0 < grown[0] < grown[1]
    assert first["wear_depth_1_error"].shape == first["wear_depth_1"].shape
    assert (tmp_path / "sweep.png").stat().st_size > (10_000 if drawn else 0)
    assert len((tmp_path / "sweep.csv").read_text().splitlines()) == 5

    files = sorted((tmp_path / "points").glob("*.npz"))
    files[1].write_bytes(files[1].read_bytes()[:1000])  # cut by a kill
    ran: list[object] = []
    original = points.run
    monkeypatch.setattr(points, "run", lambda *given: ran.append(given) or original(*given))
    assert main(["sweep", "mtm_zddp", *vary, *QUICK]) == 0
    assert len(ran) == 1
    xr.testing.assert_identical(results.read(tmp_path / "sweep.nc"), first)
    assert main(["sweep", "mtm_zddp", *vary, *QUICK[:-1], "operation.duration=1 min"]) == 0
    assert len(ran) == 5  # another scene: nothing of it is kept
    capsys.readouterr()


def test_a_refused_point_is_named_and_leaves_the_others(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    vary = ["--vary", "operation.temperature=80 degC,200 degC", "--out", str(tmp_path)]
    assert main(["sweep", "mtm_zddp", *vary, *QUICK]) == 1
    out = capsys.readouterr().out
    assert "Refused: 1 of 2 points" in out and "temperature" in out
    found = results.read(tmp_path / "sweep.nc")
    assert np.isfinite(found["h_c"].values[0]).all() and np.isnan(found["h_c"].values[1]).all()
    assert not found["valid"].values[1].any()


def test_a_run_that_knows_nothing_of_an_output_is_not_called_valid(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bare = [f"surface_{i}.microroughness.rms=0 nm" for i in (1, 2)]
    fast = ["operation.speed_1=1.1 m/s", "operation.speed_2=0.9 m/s", "tribofilm.model=none"]
    vary = ["--vary", "operation.load=20 N,60 N", "--out", str(tmp_path)]
    assert main(["sweep", "mtm_zddp", *vary, *QUICK, *bare, *fast]) == 0
    out = capsys.readouterr().out
    assert "valid" not in out
    assert "all rows of all 2 runs were computed. W_c is unknown in 2 of them." in out
    assert "no body has microroughness" in out and "Range, 2 of 2 runs: outside the points" in out
    assert all(line.rstrip().endswith("unknown") for line in out.splitlines()[2:4])
    (known,) = (line for line in out.splitlines() if line.startswith("A run alone"))
    assert "W_c" not in known


def test_runs_of_unlike_length_are_kept_at_their_end(tmp_path: Path) -> None:
    plan = plan_of(["operation.duration=1 min,2 min"], None, "lhs")
    task = Task("mtm_zddp", (("film.model", "regression"),), Path(), tmp_path)
    outcomes = {k: solve(task, k, point) for k, point in enumerate(plan.points())}
    assert outcomes == {0: Outcome(0), 1: Outcome(1)}
    found = gathered(task, plan, outcomes)
    assert found["wear_depth_1"].dims == ("operation.duration",)
    assert found["wear_depth_1"].values[0] < found["wear_depth_1"].values[1]


def test_sets_of_files_are_choices_and_patches_of_a_surface_have_a_mean_and_a_band() -> None:
    plan = plan_of(["surface_2.set=a.toml:a,b.toml:b,c.toml:c", "operation.load=10 N:20 N:2"], None, "lhs")
    assert plan.shape == (3, 2)
    values = np.array([[0.10, 0.20], [0.11, 0.20], [0.12, np.nan]])
    runs = xr.Dataset({"friction_coefficient": (("surface_2.set", "operation.load"), values, {"units": "1"})})
    found = averaged(plan, runs, ["friction_coefficient"])
    assert found["friction_coefficient"].values == approx([0.11, 0.20], rel=1e-12)
    assert found["friction_coefficient_sd"].values == approx([0.01, 0.0], rel=1e-9, abs=1e-15)
    assert float(found["friction_coefficient_band"][0]) == approx(4.302653 * 0.01 / math.sqrt(3.0), rel=1e-6)
    assert found["count"].values.tolist() == [3, 2]
    assert patches_of(plan_of(["surface_2.rq=1 nm,2 nm"], None, "lhs")) == ()


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="looks for children in /proc")
def test_an_interrupt_while_workers_start_leaves_one_sentence(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "system_models.cli.main", "sweep", "mtm_zddp", *QUICK, "--processes", "2"]
    command += ["--vary", "operation.load=20 N:80 N:4", "--out", str(tmp_path)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while process.poll() is None and len(children.read_text().split()) < 2:  # of them one keeps count of resources
            time.sleep(0.01)
        time.sleep(0.2)  # a worker has begun to import
        os.killpg(process.pid, signal.SIGINT)
        said = process.communicate()[1]
    assert process.returncode == 130
    assert "Traceback" not in said
    assert "the same command goes on from there" in said


def test_a_key_that_is_varied_and_set_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", "mtm_zddp", "--vary", "operation.load=20 N,30 N", "--set", "operation.load=9 N"]) == 2
    assert "operation.load: --vary and --set give it. Keep one of the two." in capsys.readouterr().err
