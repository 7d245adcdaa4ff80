"""Runs of scenes and machines that are killed, interrupted, cut off from the disk, and gone on with: nothing is lost.

    python -m benchmarks.house.soak [--minutes 60] [--seed 1]

Each job runs once without a fault; then, as long as there is time, every job with every fault, in random order: it is gone
on with by its own command and `--resume` until it is done, and its result is compared, bit by bit, with that of the first run.
A fault may leave a sentence, never a traceback. Writes docs/measured/house/soak.md. Linux alone.
"""

import argparse
import hashlib
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import xarray as xr

from benchmarks.pages import Page

JOBS = {  # short forms of what is shipped, each some ten seconds
    "mtm_zddp": ("run", "mtm_zddp", "--grid", "65", "--hours", "0.1"),
    "mtm_zddp fields": ("run", "mtm_zddp", "--grid", "65", "--hours", "0.05", "--fields", "3"),
    "auto": ("run", "azam_case_a", "--grid", "65", "--hours", "0.2", "--set", "film.model=auto"),
    "pin_on_disc": ("run", "pin_on_disc", "--grid", "65", "--hours", "0.02"),
    "mtm_rig": ("run", "mtm_rig", "--unchecked", "--hours", "0.02"),
    "bearing_209": ("run", "bearing_209", "--unchecked", "--hours", "0.005"),
    "bearing_209_start_stop": ("run", "bearing_209_start_stop", "--unchecked", "--hours", "0.002"),
    "bearing_218": ("run", "bearing_218", "--unchecked", "--hours", "0.002"),
    "gear_fzg_a": ("run", "gear_fzg_a", "--unchecked", "--hours", "0.5"),
    "gear_fzg_c": ("run", "gear_fzg_c", "--unchecked", "--hours", "0.5"),
    "cam_follower": ("run", "cam_follower", "--unchecked", "--hours", "0.002"),
    "sweep": (
        *("sweep", "mtm_zddp", "--set", "film.model=regression", "operation.duration=20 min", "--processes", "2"),
        *("--vary", "operation.load=20 N:80 N:6"),
    ),
}
FAULTS = ("kill", "interrupt", "full disk", "lost worker", "cut checkpoint", "cut result")
LONGEST = 600.0  # s, of one process
TRIES = 6  # of going on


@dataclass
class Trial:
    """A job, a fault, and how it went."""

    job: str
    fault: str
    hit: bool = False  # the fault came before the end
    same: bool = False  # the result has the bits of the run without a fault
    sentences: bool = True  # every process that ended early said why, without a traceback
    memory: list[int] = field(default_factory=list)  # largest of each process [kB]
    said: str = ""


def digest(folder: Path, job: str) -> str:
    """Return a fingerprint of the numbers of a result."""
    file = folder / ("sweep.nc" if job == "sweep" else "result.nc")
    if not file.exists():
        return "no result"
    total = hashlib.sha256()
    with xr.open_dataset(file) as found:
        for name in sorted(map(str, found.variables)):
            values = np.ascontiguousarray(found[name].values)
            total.update(
                name.encode() + (str(values.tolist()).encode() if values.dtype.kind in "OU" else values.tobytes())
            )
    return total.hexdigest()


def limited(size: int) -> Callable[[], None]:
    """Return what makes files of a process no larger than a size [bytes], as a full disk would."""

    def before() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return before


def started(words: tuple[str, ...], log: Path, before: Callable[[], None] | None = None) -> subprocess.Popen[bytes]:
    """Start a command of tribofmu in a process group of its own."""
    command = [sys.executable, "-m", "system_models.cli.main", *words]
    return subprocess.Popen(
        command, stdout=log.open("wb"), stderr=subprocess.STDOUT, preexec_fn=before, start_new_session=True
    )


def ended(process: subprocess.Popen[bytes], seconds: float) -> tuple[int | None, int]:
    """Wait for a process; return its exit code, or None if it still runs, and its largest memory [kB]."""
    end = time.monotonic() + seconds
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid:
            process.returncode = os.waitstatus_to_exitcode(status)
            return process.returncode, usage.ru_maxrss
        if time.monotonic() > end:
            return None, 0
        time.sleep(0.02)


def children(pid: int) -> list[int]:
    """Return the processes that a process has started."""
    found = subprocess.run(["pgrep", "-P", str(pid)], capture_output=True, text=True, check=False).stdout.split()
    return list(map(int, found))


def strike(trial: Trial, process: subprocess.Popen[bytes], seconds: float) -> tuple[int | None, int]:
    """Let a process run for some time, then do what the fault is; return as `ended`."""
    code, memory = ended(process, seconds if trial.fault != "full disk" else LONGEST)
    if code is not None:
        return code, memory
    trial.hit = True
    if trial.fault == "interrupt":
        os.killpg(process.pid, signal.SIGINT)
    elif trial.fault == "lost worker":
        for child in children(process.pid)[-1:]:
            os.kill(child, signal.SIGKILL)
    else:
        os.killpg(process.pid, signal.SIGKILL)
    return ended(process, LONGEST)


def cut(folder: Path, name: str) -> bool:
    """Cut a file of a folder in half; return whether there is one."""
    found = sorted(folder.rglob(name))
    for path in found[:1]:
        os.truncate(path, path.stat().st_size // 2)
    return bool(found)


def tried(job: str, fault: str, alone: float, expected: str, draw: random.Random) -> Trial:
    """Run a job with a fault, go on until it is done, and compare. `alone`: how long it takes without one [s]."""
    trial = Trial(job, fault)
    with tempfile.TemporaryDirectory(prefix="soak-") as name:
        folder, log = Path(name) / "out", Path(name) / "log"
        words = (*JOBS[job], "--out", str(folder))
        again = words if job == "sweep" else (*words, "--resume")
        size = draw.choice((10_000, 30_000, 100_000))  # above what is printed: the log is a file, too
        process = started(words, log, limited(size) if fault == "full disk" else None)
        code, memory = strike(trial, process, alone * draw.uniform(0.3, 0.95))
        trial.hit |= fault == "full disk" and code not in (0, 1)
        said = log.read_text("utf-8", "replace")
        if fault.startswith("cut") and cut(folder, "checkpoint.tribofmu" if fault == "cut checkpoint" else "*.n[cp]*"):
            trial.hit, code = True, None  # also of a job that has ended: its result has to be made again
        for _ in range(TRIES):
            trial.memory.append(memory)
            trial.sentences &= "Traceback" not in said and (code in (0, 1, None, -9) or "tribofmu:" in said)
            if code in (0, 1) and "Traceback" not in said:  # an error that nobody caught has code 1, too
                break
            if code == 2 and "checkpoint" in said:  # it is damaged, and the sentence says how to begin anew
                again = words
            code, memory = ended(started(again, log), LONGEST)
            said = log.read_text("utf-8", "replace")
        trial.said = said.strip().splitlines()[-1][:300] if said.strip() else ""
        trial.same = code in (0, 1) and digest(folder, job) == expected
    return trial


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    page = Page("house/soak", "Runs that are killed, interrupted and cut off, and gone on with")
    end, draw = time.monotonic() + 60.0 * given.minutes, random.Random(given.seed)
    alone: dict[str, tuple[float, str, int]] = {}
    for job, words in JOBS.items():
        with tempfile.TemporaryDirectory(prefix="soak-") as name:
            begin, folder = time.monotonic(), Path(name) / "out"
            code, memory = ended(started((*words, "--out", str(folder)), Path(name) / "log"), LONGEST)
            if code not in (0, 1):
                raise RuntimeError(f"{job} failed without a fault:\n{(Path(name) / 'log').read_text()}")
            alone[job] = time.monotonic() - begin, digest(folder, job), memory
            print(f"{job}: {alone[job][0]:.0f} s alone", flush=True)
    pairs = [(job, fault) for job in JOBS for fault in FAULTS if fault != "lost worker" or job == "sweep"]
    trials: list[Trial] = []
    while time.monotonic() < end:
        if len(trials) % len(pairs) == 0:
            draw.shuffle(pairs)
        job, fault = pairs[len(trials) % len(pairs)]
        trials.append(tried(job, fault, *alone[job][:2], draw))
        last = trials[-1]
        print(
            f"{len(trials)}: {job}, {fault}: hit {last.hit}, same {last.same}, in words {last.sentences}. {last.said}",
            flush=True,
        )
    report(page, trials, alone, given.minutes)


def report(page: Page, trials: list[Trial], alone: dict[str, tuple[float, str, int]], minutes: float) -> None:
    """Write the page."""
    hit = [trial for trial in trials if trial.hit]
    lost = [trial for trial in trials if not trial.same]
    mute = [trial for trial in trials if not trial.sentences]
    growth = {
        job: max((max(t.memory) for t in trials if t.job == job), default=memory) / memory
        for job, (_, _, memory) in alone.items()
    }
    page.say(
        f"{minutes:g} minutes of jobs one after the other, {len(trials)} in all, each with one fault at a random time. A full disk is a limit on the "
        "size of files. A cut file is cut in half after a kill."
    )
    page.verdict(
        "every result is that of the run without a fault, bit by bit", f"{len(lost)} of {len(trials)} differ", not lost
    )
    page.verdict("every early end says why, without a traceback", f"{len(mute)} of {len(trials)} do not", not mute)
    page.verdict(
        "memory at most 1.2 times that without a fault", f"{max(growth.values()):.2f}", max(growth.values()) <= 1.2
    )
    page.header("fault", "jobs", "came before the end", "same result", "in words")
    for fault in FAULTS:
        some = [trial for trial in trials if trial.fault == fault]
        page.row(fault, len(some), sum(t.hit for t in some), sum(t.same for t in some), sum(t.sentences for t in some))
    page.say("Jobs:")
    page.header("job", "alone [s]", "memory alone [MB]", "largest memory over that", "faults", "of them hit")
    counts, hits = Counter(t.job for t in trials), Counter(t.job for t in hit)
    for job, (seconds, _, memory) in alone.items():
        page.row(job, f"{seconds:.0f}", f"{memory / 1024:.0f}", growth[job], counts[job], hits[job])
    for trial in [*lost, *mute]:
        page.say(f"- {trial.job}, {trial.fault}: {trial.said}")
    page.write()


if __name__ == "__main__":
    if shutil.which("pgrep") is None:
        raise SystemExit("pgrep is needed.")
    main()
