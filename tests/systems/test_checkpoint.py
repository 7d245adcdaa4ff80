"""The files of a checkpoint, with a run that only counts: what lies on the disk at any moment can be gone on from."""

import errno
import logging
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest

from contact_core import Scene, StateError
from system_models.run.duty import Duty
from system_models.run.origin import identity
from system_models.store import checkpoint as module
from system_models.store.checkpoint import Checkpoint

RUN = {"version": "1", "film": {"points": 33, "model": "some"}, "steps": [1.0, 0.1]}
RECORD = np.dtype([("third", "<f8"), ("number", "<i4"), ("odd", "?")])
LAST = 5


def rows(first: int, end: int) -> Any:
    return np.array([(n / 3.0, n, n % 2 == 1) for n in range(first, end)], RECORD)


def state(number: int) -> bytes:
    return bytes(range(256)) * 100 + f"{number:03d}".encode()


def count(checkpoint: Checkpoint, last: int = LAST) -> list[Any]:
    """Store a point for every number that is not stored yet, and return all numbers as they were stored and made."""
    found = [] if checkpoint.saved is None else checkpoint.saved.rows.tolist()
    if checkpoint.saved:
        assert checkpoint.saved.state == state(len(found))
        assert checkpoint.saved.time == len(found) / 10.0
    for number in range(len(found) + 1, last + 1):
        found += rows(number - 1, number).tolist()
        checkpoint.save(number / 10.0, state(number), rows(checkpoint.count, number))
    return found


ALL = rows(0, LAST).tolist()


@contextmanager
def copied_at_every_line(folder: Path, copies: Path) -> Iterator[None]:
    """Copy the folder whenever a line of checkpoint.py is about to run: just what a kill there would leave."""
    made = 0

    def trace(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal made
        if frame.f_code.co_filename != module.__file__:
            return None
        if event == "line":
            shutil.copytree(folder, copies / str(made))
            made += 1
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        yield
    finally:
        sys.settrace(before)


def distinct(folder: Path) -> dict[tuple[tuple[str, bytes], ...], Path]:
    """One folder of each content."""
    return {tuple(sorted((p.name, p.read_bytes()) for p in each.iterdir())): each for each in folder.iterdir()}


@pytest.mark.parametrize("leftover", ["nothing", "another run", "an earlier start of this run"])
def test_what_a_kill_leaves_at_any_line_can_be_gone_on_from(tmp_path: Path, leftover: str) -> None:
    folder, copies = tmp_path / "run", tmp_path / "copies"
    folder.mkdir()
    if leftover != "nothing":
        count(Checkpoint(folder, RUN if "this" in leftover else {"version": "0"}), 2)
    with copied_at_every_line(folder, copies):
        assert count(Checkpoint(folder, RUN), 3) == ALL[:3]
    others, points = 0, set()
    for found in distinct(copies).values():
        try:
            checkpoint = Checkpoint.resume(found, RUN)
        except StateError as refusal:
            assert "belongs to another run" in str(refusal)
            others += 1
            continue
        points.add(checkpoint.count)
        assert count(checkpoint) == ALL
        assert count(Checkpoint.resume(found, RUN)) == ALL
    assert points == {0, 1, 2, 3}
    assert (others > 0) == (leftover == "another run")


def test_a_write_that_a_kill_cuts_short_leaves_the_checkpoint_before(tmp_path: Path) -> None:
    count(Checkpoint(tmp_path, RUN), 3)
    with (tmp_path / "checkpoint.rows").open("ab") as file:
        file.write(b"half a row")
    (tmp_path / "checkpoint.new").write_bytes((tmp_path / "checkpoint.tribofmu").read_bytes()[:1000])
    checkpoint = Checkpoint.resume(tmp_path, RUN)
    assert checkpoint.count == 3
    assert count(checkpoint) == ALL
    assert count(Checkpoint.resume(tmp_path, RUN)) == ALL
    assert sorted(path.name for path in tmp_path.iterdir()) == ["checkpoint.rows", "checkpoint.tribofmu"]


def test_records_of_the_caller_are_those_of_the_point_at_any_line(tmp_path: Path) -> None:
    folder, copies = tmp_path / "run", tmp_path / "copies"
    folder.mkdir()
    count(Checkpoint(folder, RUN), 1)  # an earlier start, without records
    (folder / "checkpoint.kept").write_bytes(b"of yet another run")
    records = [b"", state(1), b"x" * 10]
    with copied_at_every_line(folder, copies):
        checkpoint = Checkpoint(folder, RUN)
        for number, new in enumerate(([], records[:2], [], records[2:]), 1):
            checkpoint.kept += new
            checkpoint.save(number / 10.0, state(number), rows(number - 1, number))
    found = set()
    for copy in distinct(copies).values():
        resumed = Checkpoint.resume(copy, RUN)
        assert resumed.kept == records[: (0, 0, 2, 2, 3)[resumed.count]]
        found.add(resumed.count)
        resumed.kept += records[len(resumed.kept) :]
        resumed.save(0.9, b"", rows(0, 1))
        assert Checkpoint.resume(copy, RUN).kept == records
    assert found >= {1, 2, 3, 4}
    (folder / "checkpoint.kept").write_bytes(b"")
    with pytest.raises(StateError, match=r"its records '.*checkpoint.kept' were cut or changed"):
        Checkpoint.resume(folder, RUN)
    checkpoint.remove()
    assert list(folder.iterdir()) == []


def test_rows_are_written_once(tmp_path: Path) -> None:
    checkpoint = Checkpoint(tmp_path, RUN)
    checkpoint.save(0.1, b"", rows(0, 2))
    assert (tmp_path / "checkpoint.rows").read_bytes() == rows(0, 2).tobytes()
    checkpoint.save(0.2, b"", rows(2, 5))
    assert (tmp_path / "checkpoint.rows").read_bytes() == rows(0, 5).tobytes()


def test_removing_leaves_nothing_to_go_on_from(tmp_path: Path) -> None:
    checkpoint = Checkpoint(tmp_path, RUN)
    count(checkpoint)
    checkpoint.remove()
    assert list(tmp_path.iterdir()) == []
    assert Checkpoint.resume(tmp_path, RUN).saved is None
    checkpoint.remove()


def test_a_kill_while_removing_leaves_a_checkpoint_or_none(tmp_path: Path) -> None:
    folder, copies = tmp_path / "run", tmp_path / "copies"
    folder.mkdir()
    checkpoint = Checkpoint(folder, RUN)
    count(checkpoint)
    with copied_at_every_line(folder, copies):
        checkpoint.remove()
    assert {Checkpoint.resume(found, RUN).count for found in distinct(copies).values()} == {0, LAST}


def test_numbers_that_json_rounds_or_lacks_are_kept(tmp_path: Path) -> None:
    odd = np.array([(0.1 + 0.2, -(2**31), True), (np.nan, 2**31 - 1, False), (5e-324, 0, True)], RECORD)
    Checkpoint(tmp_path, RUN).save(0.1 + 0.2, b"\0\xff", odd)
    saved = Checkpoint.resume(tmp_path, RUN).saved
    assert saved is not None
    assert (saved.time, saved.state) == (0.1 + 0.2, b"\0\xff")
    assert saved.rows.tobytes() == odd.tobytes()
    assert saved.rows.dtype == RECORD


@pytest.mark.parametrize("name", ["checkpoint.tribofmu", "checkpoint.rows"])
@pytest.mark.parametrize("damage", ["cut", "emptied", "changed", "removed", "replaced"])
def test_a_damaged_checkpoint_is_refused(tmp_path: Path, name: str, damage: str) -> None:
    count(Checkpoint(tmp_path, RUN))
    path = tmp_path / name
    data = path.read_bytes()
    middle = len(data) // 2
    damaged = {
        "cut": data[:-1],
        "emptied": b"",
        "changed": data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :],
        "replaced": b"something else " * 50,
    }
    path.unlink() if damage == "removed" else path.write_bytes(damaged[damage])
    if (name, damage) == ("checkpoint.tribofmu", "removed"):
        assert Checkpoint.resume(tmp_path, RUN).saved is None
        return
    with pytest.raises(StateError, match=r"checkpoint\.tribofmu' cannot be used: .* without --resume, which replaces"):
        Checkpoint.resume(tmp_path, RUN)
    assert count(Checkpoint(tmp_path, RUN)) == ALL, "a run from the beginning replaces it"
    assert Checkpoint.resume(tmp_path, RUN).count == LAST


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"version": "2"}, "version = '1' there, '2' here"),
        ({"film": {"points": 65, "model": "some"}}, "film.points = 33 there, 65 here"),
        ({"film": {"points": 33}}, "film.model = 'some' there, 'nothing' here"),
        ({"wear": {"model": "none"}}, "wear.model = 'nothing' there, 'none' here"),
        ({"steps": [1.0, 0.2]}, "steps = [1.0, 0.1] there, [1.0, 0.2] here"),
        ({"version": "2", "steps": [], "a": 1, "b": 2, "c": 3}, "a = 'nothing' there, 1 here and 2 more. Give"),
    ],
)
def test_another_run_is_refused_and_what_differs_is_named(tmp_path: Path, change: dict[str, Any], said: str) -> None:
    count(Checkpoint(tmp_path, RUN))
    with pytest.raises(StateError) as refusal:
        Checkpoint.resume(tmp_path, RUN | change)
    assert said in str(refusal.value)
    assert "without --resume" in str(refusal.value)


def test_an_identity_is_of_scene_duty_and_version(scene: Scene, duty: Duty) -> None:
    same = identity(Scene.from_dict(scene.to_dict()), Duty(duty.times, duty.points))
    assert same == identity(scene, duty)
    later = Duty((*duty.times[:-1], np.nextafter(duty.times[-1], 1e9)), duty.points)
    assert {key for key, value in identity(scene, later).items() if value != same[key]} == {"duty"}
    assert same["operation"]["duration"] == "72.0 s"
    assert "version" in same


def test_a_checkpoint_is_due_again_after_its_pause(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(module, "monotonic", lambda: now)
    checkpoint = Checkpoint(tmp_path, RUN)
    assert checkpoint.due()
    count(checkpoint, 1)
    assert not checkpoint.due()
    now = 101.9
    assert not checkpoint.due()
    now = 102.0
    assert checkpoint.due()


def test_a_slow_disk_gets_fewer_checkpoints(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0

    def slow(file: object) -> None:
        nonlocal now
        now += 1.0

    monkeypatch.setattr(module, "monotonic", lambda: now)
    monkeypatch.setattr(module, "_flush", slow)
    checkpoint = Checkpoint(tmp_path, RUN)
    count(checkpoint, 1)
    now += 10.0
    assert not checkpoint.due()


def test_a_disk_that_refuses_is_warned_about_once_and_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def full(file: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    checkpoint = Checkpoint(tmp_path, RUN)
    count(checkpoint, 1)
    with monkeypatch.context() as disk:
        disk.setattr(module, "_flush", full)
        for number in (2, 3):
            checkpoint.save(number / 10.0, state(number), rows(checkpoint.count, number))
    (warning,) = [record.getMessage() for record in caplog.records if record.levelno == logging.WARNING]
    assert "cannot be written: No space left on device. The run continues" in warning
    assert Checkpoint.resume(tmp_path, RUN).count == 1
    checkpoint.save(0.4, state(4), rows(checkpoint.count, 4))
    assert count(Checkpoint.resume(tmp_path, RUN)) == ALL


@pytest.mark.skipif(sys.platform == "win32", reason="no locks of folders")
def test_a_folder_serves_one_run_at_a_time(tmp_path: Path) -> None:
    with module.alone(tmp_path), pytest.raises(StateError, match="Another run is at work"), module.alone(tmp_path):
        pass
    with module.alone(tmp_path):
        assert list(tmp_path.iterdir()) == []
