"""A run that was killed, interrupted or failed goes on to the result of one that was not, bit for bit."""

import logging
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fmpy.fmi1 import FMICallException

import fmu_src.runtime.slave
from contact_core import ContactError, OperatingPoint, Scene, StateError, advance
from fmu_src.package.build import build
from system_models.charts import files
from system_models.cli.main import main
from system_models.fmu.fmi2 import Fmi2Instance
from system_models.run.contact import run
from system_models.run.duty import Duty
from system_models.run.origin import identity
from system_models.store import results
from system_models.store.checkpoint import Checkpoint

QUICK = ["--set", "film.model=regression"]
BEFORE, BETWEEN = "before the checkpoint is replaced", "between two steps"  # of KILLED
NAMES = ["result.csv", "result.nc"]  # without a picture


@pytest.fixture(scope="module")
def faltering(scene: Scene) -> Duty:
    """A duty with a step of the load and one point that cannot be used."""
    low, impossible = (OperatingPoint(load, 0.1025, 0.0975, 353.15) for load in (40.0, -1.0))
    return Duty((0.0, 90.0, 120.0, 150.0), (scene.operation.point, low, impossible, low))


@pytest.fixture
def no_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spare the time of drawing."""
    monkeypatch.setattr(files, "save", lambda sheet, path, dpi=150: path)


def bits(dataset: xr.Dataset) -> dict[Any, tuple[str, bytes]]:
    return {name: (str(values.dtype), values.values.tobytes()) for name, values in dataset.variables.items()}


def test_a_run_goes_on_from_its_rows_bit_for_bit(
    fmu: Path, scene: Scene, faltering: Duty, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: Any
) -> None:
    who, folder = identity(scene, faltering), tmp_path / "run"
    folder.mkdir()
    saved: list[Path] = []
    save = Checkpoint.save

    def save_and_copy(self: Checkpoint, *arguments: Any) -> None:
        save(self, *arguments)
        saved.append(Path(shutil.copytree(folder, tmp_path / f"killed at {len(saved)}")))

    whole = run(fmu, faltering, 200.0, 50.0)
    with monkeypatch.context() as patch:
        patch.setattr(Checkpoint, "save", save_and_copy)
        patch.setattr(Checkpoint, "due", lambda self: True)
        assert bits(run(fmu, faltering, 200.0, 50.0, None, Checkpoint(folder, who))) == bits(whole)
    assert len(saved) == whole.sizes["time"] == 7
    assert np.ptp(whole["tribofilm_1"].values) > 5e-9
    assert whole["wear_volume_2"].values[-1] > whole["wear_volume_2"].values[-2] > 0.0
    assert len(set(whole["iterations"].values)) > 2
    assert (~whole["valid"].values).sum() == 1
    told: list[float] = []
    for count in (1, 4, 6, 7):  # after the first row, without a change, after a refused one, at the end
        told.clear()
        caplog.clear()
        checkpoint = Checkpoint.resume(saved[count - 1], who)
        assert checkpoint.count == count
        assert bits(run(fmu, faltering, 200.0, 50.0, told.append, checkpoint)) == bits(whole)
        assert told == whole["time"].values[count:].tolist(), "only what is left is computed"
        warned = [r.getMessage() for r in caplog.records if r.levelno == logging.WARNING]
        assert warned[-1].startswith("1 of 7 rows are invalid, the first at 150 s")


def test_the_first_and_the_last_row_are_stored_however_short_the_run(
    fmu: Path, scene: Scene, duty: Duty, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    counts: list[int] = []
    save = Checkpoint.save

    def note(self: Checkpoint, *arguments: Any) -> None:
        save(self, *arguments)
        counts.append(self.count)

    monkeypatch.setattr(Checkpoint, "save", note)
    monkeypatch.setattr(Checkpoint, "due", lambda self: False)
    run(fmu, duty, 72.0, 30.0, None, Checkpoint(tmp_path, identity(scene, duty)))
    assert counts == [1, 5]


def test_the_state_of_another_fmu_is_not_gone_on_from(fmu: Path, scene: Scene, duty: Duty, tmp_path: Path) -> None:
    other = Scene.from_dict(scene.to_dict() | {"wear": {"model": "none"}})
    run(build(other, tmp_path / "other.fmu", "embedded"), duty, 30.0, 30.0, None, Checkpoint(tmp_path, {}))
    with pytest.raises(StateError, match="does not take the state of the checkpoint at t = 30 s"):
        run(fmu, duty, 60.0, 30.0, None, Checkpoint.resume(tmp_path, {}))


def test_rows_before_a_failure_are_kept(
    fmu: Path, scene: Scene, duty: Duty, dataset: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = Fmi2Instance._do_step

    def fail(self: Fmi2Instance, time: float, size: float) -> float:
        if time == 40.0:
            raise FMICallException(function="fmi2DoStep", status=3)
        return step(self, time, size)

    who = identity(scene, duty)
    with monkeypatch.context() as patch:
        patch.setattr(Fmi2Instance, "_do_step", fail)
        patch.setattr(Checkpoint, "due", lambda self: True)
        with pytest.raises(ContactError, match="failed in the step from 40 s to 60 s"):
            run(fmu, duty, 72.0, 30.0, None, Checkpoint(tmp_path, who))
    assert Checkpoint.resume(tmp_path, who).count == 3
    assert bits(run(fmu, duty, 72.0, 30.0, None, Checkpoint.resume(tmp_path, who))) == bits(dataset)


# what a killed process runs: its own end is at a write that can be told, whatever the machine's speed
KILLED = """
import os, signal, sys
from pathlib import Path
from system_models.store.checkpoint import Checkpoint
from system_models.cli.main import main

where, last, *arguments = sys.argv[1:]
calls = 0

def deadly(function):
    def call(self, *given):
        global calls
        calls += 1
        if calls == int(last):
            os.kill(os.getpid(), signal.SIGKILL)
        return function(self, *given)
    return call

Checkpoint.due = lambda self: True
if where == "before the checkpoint is replaced":
    Path.replace = deadly(Path.replace)
else:
    Checkpoint.due = deadly(Checkpoint.due)
main(arguments)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
@pytest.mark.parametrize(
    ("level", "kills", "minutes"),
    [
        ("regression", {BEFORE: 4}, 0.4),
        pytest.param("deterministic", {BEFORE: 3, BETWEEN: 4}, 0.8, marks=pytest.mark.long),
    ],
)
def test_a_run_that_is_killed_again_and_again_writes_the_same_files(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    coarse: list[str],
    no_picture: None,
    level: str,
    kills: dict[str, int],
    minutes: float,
) -> None:
    """Each kill leaves one row less than calls."""
    command = ["run", "mtm_zddp", *coarse, "--set", f"film.model={level}", "operation.interval=12 s", "--resume"]
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    assert main([*command, "--out", str(whole)]) == 0
    assert "There is no checkpoint" in capsys.readouterr().err
    for where, last in kills.items():
        child = subprocess.run(
            [sys.executable, "-c", KILLED, where, str(last), *command, "--out", str(killed)],
            capture_output=True,
            text=True,
        )
        assert child.returncode == -signal.SIGKILL, child.stderr
        assert (killed / "checkpoint.new").exists() == (where == BEFORE)
        assert {path.name for path in killed.iterdir()} >= {"checkpoint.tribofmu", "checkpoint.rows"}
    assert main([*command, "--out", str(killed)]) == 0
    assert f"Continuing from '{killed / 'checkpoint.tribofmu'}' at {minutes} min" in capsys.readouterr().err
    for folder in (whole, killed):
        assert sorted(path.name for path in folder.iterdir()) == NAMES
    for name in NAMES:
        assert (whole / name).read_bytes() == (killed / name).read_bytes(), name
    dataset = results.read(whole / "result.nc")
    assert dataset.sizes["time"] == 7
    assert dataset["tribofilm_1"].values[-1] > dataset["tribofilm_1"].values[5] > 0.0


def interrupted(call: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Ctrl-C, pressed twice, reach the contact in its advance number `call`."""
    calls = 0

    def advance_or_stop(*arguments: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls == call:
            signal.raise_signal(signal.SIGINT)  # waits for the end of the step
            signal.raise_signal(signal.SIGINT)  # acts at once
        return advance(*arguments)

    monkeypatch.setattr(fmu_src.runtime.slave, "advance", advance_or_stop)


def test_after_ctrl_c_the_command_says_how_to_go_on_and_does(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    coarse: list[str],
    no_picture: None,
) -> None:
    command = ["run", "mtm_zddp", *coarse, *QUICK, "--set", "operation.interval=20 s", "--resume", "--out"]
    assert main([*command, str(tmp_path / "whole")]) == 0
    monkeypatch.setattr(Checkpoint, "due", lambda self: True)
    for call, count in ((1, 0), (4, 3)):  # the first is at initialisation
        folder = tmp_path / str(call)
        with monkeypatch.context() as patch:
            interrupted(call, patch)
            capsys.readouterr()
            assert main([*command, str(folder)]) == 130
        out, err = capsys.readouterr()
        assert out.startswith("Azam's case B")  # what the contact is like, and no result
        assert "friction" not in out
        kept = f" What was computed is kept in '{folder / 'checkpoint.tribofmu'}': the same command with --resume"
        assert err.splitlines()[-1].startswith(f"tribofmu: Interrupted.{kept if count else ''}")
        assert len(list(folder.glob("checkpoint.tribofmu"))) == (count > 0)
        assert main([*command, str(folder)]) == 0
        told = "Continuing from" if count else "There is no checkpoint"
        assert told in capsys.readouterr().err
        assert (folder / "result.nc").read_bytes() == (tmp_path / "whole" / "result.nc").read_bytes()


def test_a_run_that_continues_from_its_end_says_the_same_of_its_errors(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, no_picture: None
) -> None:
    settings = ["--set", "film.model=regression", "operation.duration=2 min"]
    command = ["run", "mtm_zddp", *settings, "--resume", "--out", str(tmp_path / "run")]
    assert main(command) == 0
    whole = capsys.readouterr().out
    assert "(the fitted curves)" in whole.split("Verdict")[1]
    shutil.rmtree(tmp_path / "run")

    def stopped(*arguments: Any) -> Any:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("system_models.runs.contact._Job.report", stopped)  # all rows are there, the result is not
        assert main(command) == 130
    capsys.readouterr()
    assert main(command) == 0
    again = capsys.readouterr().out
    assert again == whole[whole.index("time") :], "word for word, but for what is told before a run"


def test_a_failure_says_how_to_go_on(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse: list[str]
) -> None:
    def fail(self: Fmi2Instance, time: float, size: float) -> float:
        raise FMICallException(function="fmi2DoStep", status=3)

    monkeypatch.setattr(Fmi2Instance, "_do_step", fail)
    assert main(["run", "mtm_zddp", *coarse, *QUICK, "--out", str(tmp_path)]) == 2
    last = capsys.readouterr().err.splitlines()[-1]
    assert "tribofmu: The FMU 'contact' failed in the step from 0 s" in last
    assert "the same command with --resume continues from there." in last


def test_a_finished_run_is_not_computed_again(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    coarse: list[str],
    no_picture: None,
) -> None:
    command = ["run", "mtm_zddp", *coarse, *QUICK, "--out", str(tmp_path), "--resume"]
    assert main(command) == 0
    capsys.readouterr()
    with monkeypatch.context() as patch:
        patch.setattr("system_models.runs.contact._Job.simulate", None)
        assert main(command) == 0
    assert "This run is finished" in capsys.readouterr().err
    assert main([*command, "--hours", "0.005"]) == 0
    assert "There is no checkpoint" in capsys.readouterr().err, "another run's result is none of this one"
    (tmp_path / "result.nc").write_bytes((tmp_path / "result.nc").read_bytes()[:3000])
    assert main([*command, "--hours", "0.005"]) == 0
    assert "There is no checkpoint" in capsys.readouterr().err


def test_other_settings_and_damage_are_refused_and_a_run_without_resume_starts_over(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    coarse: list[str],
    no_picture: None,
) -> None:
    command = ["run", "mtm_zddp", *coarse, *QUICK, "wear.model=none", "--out", str(tmp_path)]
    with monkeypatch.context() as patch:
        interrupted(2, patch)
        assert main(command) == 130
    duty = tmp_path / "duty.csv"
    duty.write_text("time [s],load [N]\n0,30\n")
    capsys.readouterr()
    for more, said in (
        (["--hours", "1"], "operation.duration = '72.0 s' there, '3600.0 s' here"),
        (["--set", "operation.interval=5 s"], "operation.interval = '30.0 s' there, '5.0 s' here"),
        (["--set", "wear.model=archard"], "wear.model = 'none' there, 'archard' here"),
        (["--duty", str(duty)], "duty = '1 rows, fingerprint "),
    ):
        assert main([*command, *more, "--resume"]) == 2
        assert said in capsys.readouterr().err.splitlines()[-1]
    (tmp_path / "checkpoint.rows").write_bytes(b"")
    assert main([*command, "--resume"]) == 2
    assert "were cut or changed. Start from the beginning without --resume" in capsys.readouterr().err
    assert main(command) == 0
    assert "checkpoint.tribofmu' of an unfinished run will be replaced" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["duty.csv", *NAMES]
