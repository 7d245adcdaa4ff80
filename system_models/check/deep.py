"""Rules that run the FMU. Every stage has a process of its own, watched: a crash or a hang is a verdict."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from . import static
from .package import Package
from .verdict import Answer, Finding, Verdict, failed, not_applicable

# stages of a rule, each in a new process (check.stages)
RULES: dict[str, tuple[str, ...]] = {
    "run": ("run",),
    "guid": ("guid",),
    "finite": ("finite",),
    "replay": ("record", "replay"),
    "rollback": ("rollback",),
    "serialise": ("save", "resume"),
    "step splitting": ("splitting",),
    "input range": ("sweep",),
    "unusable input": ("unusable",),
    "feedthrough": ("feedthrough",),
    "reset": ("reset",),
    "memory": ("cycles",),
    "two instances": ("interleaved",),
    "reference results": ("reference",),
}

_START = 60.0  # s until the first call at most
_POLL = 0.1  # s between two looks at a process
_LONGEST = 300  # characters of what a process has printed


def findings(package: Package, limit: float) -> Iterator[Finding]:
    """Run every rule; a call of the FMU that takes longer than `limit` [s] has hung."""
    reason = _reason_not_to_run(package)
    with tempfile.TemporaryDirectory(prefix="tribofmu-check-", ignore_cleanup_errors=True) as folder:
        unpacked = Path(folder) / "fmu"
        if not reason:
            package.archive.extractall(unpacked)
        for number, (rule, stages) in enumerate(RULES.items()):
            if reason:
                yield Finding(rule, *not_applicable(reason))
                continue
            notebook = Path(folder) / str(number)
            notebook.mkdir()
            answer = _answer(unpacked, stages, notebook, limit)
            yield Finding(rule, *answer)
            if rule == "run" and answer.verdict is Verdict.FAIL:
                reason = "The FMU does not run."


def _reason_not_to_run(package: Package) -> str:
    if static.archive(package).verdict is Verdict.FAIL:
        return "The archive is not fit to be unpacked."
    if package.description is None or package.version != "2.0" or package.description.coSimulation is None:
        return "Only FMI 2.0 co-simulation is run."
    if package.platform not in package.binaries:
        return f"There is no binary for this machine, {package.platform}."
    return ""


def _answer(folder: Path, stages: tuple[str, ...], notebook: Path, limit: float) -> Answer:
    for stage in stages:
        answer = _stage(folder, stage, notebook, limit)
        if answer is not None:
            return answer
    raise AssertionError(f"the last stage of {stages} gives no answer")


def _stage(folder: Path, stage: str, notebook: Path, limit: float) -> Answer | None:
    """The answer of a stage; None if the next one gives it."""
    command = [sys.executable, "-m", f"{__package__}.stages", str(folder), stage, str(notebook)]
    with (notebook / f"{stage}.txt").open("wb") as printed:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=printed,
            stderr=subprocess.STDOUT,
            env=_environment(),
            start_new_session=True,
        )
        try:
            ended = _watch(process, notebook / "call", limit)
        finally:
            _kill(process)
    if not ended:
        return failed(f"Hung in {_last_call(notebook)}: it had not returned after {limit:g} s.")
    if process.returncode:
        ending = f"The process ended with {_how(process.returncode)} during {_last_call(notebook)}"
        return failed(f"{ending}{_last_line(notebook / f'{stage}.txt')}.")
    file = notebook / "answer.json"
    if not file.exists():
        return None
    verdict, evidence = json.loads(file.read_text())
    return Answer(Verdict(verdict), evidence)


def _environment() -> dict[str, str]:
    """The new process finds the packages where this one found them."""
    root = str(Path(__file__).parents[2])
    return os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, [root, os.environ.get("PYTHONPATH", "")]))}


def _watch(process: "subprocess.Popen[bytes]", trace: Path, limit: float) -> bool:
    """True when the process ends; False when it has written no new call for `limit` seconds."""
    last, since = b"", time.monotonic()
    while True:
        try:
            process.wait(_POLL)
            return True
        except subprocess.TimeoutExpired:
            call = trace.read_bytes() if trace.exists() else b""
        if call != last:
            last, since = call, time.monotonic()
        elif time.monotonic() - since > (limit if call else _START):
            return False


def _kill(process: "subprocess.Popen[bytes]") -> None:
    """End a process that still runs, and what it has started."""
    if process.poll() is not None:
        return
    if os.name == "posix":
        os.killpg(process.pid, signal.SIGKILL)
    else:
        process.kill()
    process.wait()


def _last_call(notebook: Path) -> str:
    """The call that was made last: what the FMU was doing."""
    trace = notebook / "call"
    _, _, call = (trace.read_text("utf-8", "replace") if trace.exists() else "").partition(" ")
    return call or "the start of the process"


def _last_line(printed: Path) -> str:
    """What the process printed last, if anything."""
    lines = printed.read_text("utf-8", "replace").split("\n")
    said = [line.strip() for line in lines if line.strip()]
    return f"; it printed: {said[-1][:_LONGEST]}" if said else ""


def _how(code: int) -> str:
    if code > 0:
        return f"exit code {code if code < 256 else hex(code)}"
    try:
        return signal.Signals(-code).name
    except ValueError:
        return f"signal {-code}"
