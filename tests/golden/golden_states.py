"""What one tree has stored, the other goes on from: states of a contact, checkpoints of a run and of a machine.

Both write their own; only those of REV are tried again, by the working tree. It may refuse them with a sentence.
"""

import base64
import signal
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from golden_command import COMMAND, ORIGIN, put_results, settings
from golden_laws import LINE, SMALL
from golden_record import NOTE, Record, text_of

from contact_core import ContactState, Scene, StateError, advance, initial_state

SCENES = {"mtm_zddp": SMALL, "fzg_flank": LINE}
LEVELS = ("deterministic", "regression")
RUN = [
    "run",
    "mtm_zddp",
    "--hours",
    "0.2",
    *settings(_=SMALL | {"operation.interval": "2 s", "control.longest": "2 s"}),
]
MACHINE = [
    "run", "mtm_rig", "--unchecked", *settings(_={"simulate.stop_time": "600 s", "simulate.max_step": "0.1 s"}),
    *settings(contact={"film.points": "17"} | {f"surface_{i}.correlation_length": "32 um" for i in (1, 2)})[1:],
]  # fmt: skip
COMMANDS = {"run": RUN, "machine": MACHINE}
LONGEST = 120.0  # s until there is a checkpoint
RIPE = 1.0  # s that a run goes on after its first checkpoint
FILE = "file: "  # begins the name of what is stored
Stored = Mapping[str, Mapping[str, Mapping[str, Any]]]


def runs(before: Stored) -> Iterator[tuple[str, Callable[[Record], None]]]:
    """Return the names and functions of all runs; `before` is what the other tree has recorded of them."""
    for scene in SCENES:
        for level in LEVELS:
            name = f"state of {scene}, {level}"
            yield name, partial(_state, scene, level, before.get(name, {}))
    for kind in COMMANDS:
        name = f"checkpoint of a {kind}"
        yield name, partial(_checkpoint, kind, before.get(name, {}))


def _keep(record: Record, name: str, data: bytes) -> None:
    """Keep a file for the other tree; it is not compared."""
    record.put(f"{NOTE}{FILE}{name}", base64.b64encode(data).decode())


def _kept(before: Mapping[str, Mapping[str, Any]]) -> dict[str, bytes]:
    """Return the files of the other tree."""
    start = f"{NOTE}{FILE}"
    return {
        key.removeprefix(start): base64.b64decode(text_of(value))
        for key, value in before.items()
        if key.startswith(start)
    }


def _state(name: str, level: str, before: Mapping[str, Any], record: Record) -> None:
    scene = Scene.from_toml(name, SCENES[name]).at_level(level)
    op, files = scene.operation.point, _kept(before)
    state = initial_state(scene)
    for dt in (0.0, 30.0, 5.0):
        state, _ = advance(scene, op, state, dt)
    if files:
        try:
            state = ContactState.from_bytes(files["state"], scene)
        except StateError as error:
            record.put(f"{NOTE}the state of REV is refused", str(error))
        else:
            record.put(f"{NOTE}the state of REV", "taken")
    else:
        _keep(record, "state", state.to_bytes())
    for i, dt in enumerate((0.0, 1.0, 40.0)):
        state, outputs = advance(scene, op, state, dt)
        record.put(f"step {i}", outputs)
        record.put(f"step {i}: state", state.to_bytes())


def _checkpoint(kind: str, before: Mapping[str, Any], record: Record) -> None:
    files = _kept(before)
    whole, killed = Path(f"{kind}_whole"), Path(f"{kind}_killed")
    if not files:
        _ended(kind, whole)
        put_results(record, whole)
        for name, data in _killed(kind, killed).items():
            _keep(record, name, data)
        return
    killed.mkdir()
    for name, data in files.items():
        (killed / name).write_bytes(data)
    done = _ended(kind, killed, fine=(0, 1, 2))
    told = done.stderr.replace(str(Path.cwd()), "").strip().splitlines()
    if done.returncode != 2:
        if not any("Continuing from" in line for line in told):
            raise RuntimeError(f"The checkpoint was not gone on from: {told}")
        record.put(f"{NOTE}the checkpoint of REV", "taken")
        put_results(record, killed)
        return
    if len(told) == 0 or not told[-1].startswith(ORIGIN):
        raise RuntimeError(f"The checkpoint was refused without a sentence: {done.stderr[-2000:]}")
    record.put(f"{NOTE}the checkpoint of REV is refused", told[-1].removeprefix(ORIGIN))
    _ended(kind, whole)
    put_results(record, whole)


def _ended(kind: str, folder: Path, fine: tuple[int, ...] = (0, 1)) -> subprocess.CompletedProcess[str]:
    """The run to its end, from the checkpoint in the folder if there is one."""
    words = [*COMMAND, *COMMANDS[kind], "--out", str(folder), "--resume"]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode not in fine:
        raise RuntimeError(f"{' '.join(words)} ended with {done.returncode}: {done.stderr[-2000:]}")
    return done


def _killed(kind: str, folder: Path) -> dict[str, bytes]:
    """What a run leaves that is killed after its first checkpoint."""
    words = [*COMMAND, *COMMANDS[kind], "--out", str(folder)]
    with Path(f"{kind}.txt").open("w") as told:
        process = subprocess.Popen(words, stdout=told, stderr=told)
        end = time.monotonic() + LONGEST
        while not (folder / "checkpoint.tribofmu").exists() and time.monotonic() < end and process.poll() is None:
            time.sleep(0.02)
        time.sleep(RIPE)
        process.send_signal(signal.SIGKILL)
        process.wait()
    files = {path.name: path.read_bytes() for path in folder.glob("checkpoint*")}
    if "checkpoint.tribofmu" not in files:
        raise RuntimeError(f"The {kind} left no checkpoint: {Path(told.name).read_text()[-1000:]}")
    return files
