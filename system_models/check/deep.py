"""Rules that run the FMU. Every stage has a process of its own, watched: a crash or a hang is a verdict."""

import json
import math
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from enum import Enum, auto
from pathlib import Path
from time import monotonic

from . import static
from .instance import call_in, progress_in
from .package import Package
from .start import asked, cheapest, sentence
from .variables import Start
from .verdict import Answer, Finding, Verdict, failed, not_applicable, noted

# stages of a rule, each in a new process: names of functions that `stages.STAGES` lists
RULES: dict[str, tuple[str, ...]] = {
    "run": ("run",),
    "guid": ("guid",),
    "interface": ("interface",),
    "resources": ("resources",),
    "finite": ("finite",),
    "replay": ("replay",),
    "rollback": ("rollback",),
    "serialise": ("save", "resume"),
    "step splitting": ("splitting",),
    "stop time": ("stop_time",),
    "communication point": ("communication_point",),
    "order of calls": ("order",),
    "input range": ("sweep",),
    "unusable input": ("unusable",),
    "text": ("long_text", "foreign_text"),
    "feedthrough": ("feedthrough",),
    "derivatives": ("derivatives",),
    "reset": ("reset",),
    "two instances": ("interleaved",),
    "reloading": ("reloading",),
    "memory": ("memory",),
    "home": ("home",),
    "children": ("children",),
    "fork": ("fork",),
    "reference results": ("reference",),
}
# stages, not rules. FMI does not ask for it: whatever goes wrong there is worth a note
_NOT_ASKED = {"resources", "communication_point", "order", "foreign_text", "reloading", "home", "children", "fork"}

UNFINISHED = "Not finished"  # begins the evidence of a rule whose time was used up
_START = 60.0  # s until the first call at most
_PATIENT = {"TRIBOFMU_START_TIMEOUT": "1000000"}  # our own FMUs leave it to the watch here when a start takes too long
_POLL = 0.1  # s between two looks at a process
_LONGEST = 300  # characters of the output of a process


def findings(
    package: Package, limit: float, budget: float, settings: Iterable[tuple[str, str]] = ()
) -> Iterator[Finding]:
    """Run every rule, at the FMU's lowest level where `settings` of start values do not say otherwise.

    A rule of which a call takes longer than `limit` [s], or which takes longer than `budget` [s], is left with a note:
    no clock distinguishes a call that hangs from one on a busy machine. But `run` may take as long as its calls.
    """
    reason = _reason_not_to_run(package)
    start: Start = {}
    if package.description is not None and not reason:
        wanted = asked(package.description, settings)
        start = {**cheapest(package.description), **wanted}
        if said := sentence(package.description, start, wanted):
            yield Finding("start values", *noted(said))
    with tempfile.TemporaryDirectory(prefix="tribofmu-check-", ignore_cleanup_errors=True) as folder:
        unpacked, notebook = Path(folder) / "fmu", Path(folder) / "notebook"
        notebook.mkdir()
        if not reason:
            package.archive.unpack(unpacked)
        for rule, stages in RULES.items():
            if reason:
                yield Finding(rule, *not_applicable(reason))
                continue
            watch = _Watch(limit, math.inf if rule == "run" else budget)
            answer = _answer(unpacked, stages, notebook, start, watch)
            yield Finding(rule, *answer)
            if rule == "run" and answer.verdict is Verdict.FAIL:
                reason = "The FMU does not run."
            elif rule == "run" and answer.evidence.startswith(UNFINISHED):
                reason = "The FMU has not been seen to run."


def _reason_not_to_run(package: Package) -> str:
    if static.archive(package).verdict is Verdict.FAIL:
        return "The archive is not fit to be unpacked."
    if package.description is None or package.description.coSimulation is None or not package.runs:
        return "Only co-simulation of FMI 2.0 and 3.0 is run."
    if package.platform not in package.binaries:
        return f"There is no binary for this machine, {package.platform}."
    return ""


def _answer(folder: Path, stages: tuple[str, ...], notebook: Path, start: Start, watch: "_Watch") -> Answer:
    for stage in stages:
        answer = _stage(folder, stage, notebook, start, watch)
        if answer is not None:
            beyond = answer.verdict is Verdict.FAIL and stage in _NOT_ASKED
            return noted(answer.evidence) if beyond else answer
    raise AssertionError(f"the last stage of {stages} gives no answer")


def _stage(folder: Path, stage: str, notebook: Path, start: Start, watch: "_Watch") -> Answer | None:
    """Return the answer of a stage; None if the next one gives it."""
    command = [sys.executable, "-m", f"{__package__}.stages", str(folder), stage, str(notebook), json.dumps(start)]
    trace, words = notebook / "call", notebook / "printed.txt"
    trace.unlink(missing_ok=True)
    with words.open("wb") as printed:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=printed,
            stderr=subprocess.STDOUT,
            env=_environment(),
            start_new_session=True,
        )
        try:
            end = watch.until_end(process, trace)
        finally:
            _kill(process)
    said = trace.read_bytes() if trace.exists() else b""
    call = call_in(said) or "the start of the process"
    if end is _End.LATE:
        return noted(f"{UNFINISHED}: {call} had not returned after {watch.limit:g} s (--limit).")
    if end is _End.OVER:
        known = progress_in(said)
        return noted(f"{UNFINISHED} in {watch.budget:g} s (--budget): {f'{known}; ' if known else ''}it was in {call}.")
    if process.returncode:
        return failed(f"The process ended with {_how(process.returncode)} during {call}{_last_line(words)}.")
    file = notebook / f"{stage}.json"
    if not file.exists():
        return None
    verdict, evidence = json.loads(file.read_text())
    return Answer(Verdict(verdict), evidence)


def _environment() -> dict[str, str]:
    """Return the environment in which the new process finds the packages where this one found them."""
    root = str(Path(__file__).parents[2])
    paths = os.pathsep.join(filter(None, [root, os.environ.get("PYTHONPATH", "")]))
    return _PATIENT | os.environ | {"PYTHONPATH": paths}


class _End(Enum):
    """End of the time of a process."""

    BY_ITSELF = auto()
    LATE = auto()
    OVER = auto()


class _Watch:
    """Waits for the processes of one rule; `limit` [s] is that of a call, `budget` [s] that of all."""

    def __init__(self, limit: float, budget: float):
        self.limit, self.budget = limit, budget
        self._begun = monotonic()

    def until_end(self, process: "subprocess.Popen[bytes]", trace: Path) -> _End:
        """Wait until it ends, or has written no new call into `trace` for too long, or the budget is used up."""
        last, since = b"", monotonic()
        while True:
            try:
                process.wait(_POLL)
                return _End.BY_ITSELF
            except subprocess.TimeoutExpired:
                call = trace.read_bytes() if trace.exists() else b""
            now = monotonic()
            if call != last:
                last, since = call, now
            elif now - since > (self.limit if call else max(self.limit, _START)):
                return _End.LATE
            if now - self._begun > self.budget:
                return _End.OVER


def _kill(process: "subprocess.Popen[bytes]") -> None:
    """End a process that still runs, and its children."""
    if process.poll() is not None:
        return
    if os.name == "posix":
        os.killpg(process.pid, signal.SIGKILL)
    else:
        process.kill()
    process.wait()


def _last_line(printed: Path) -> str:
    """Return the last line that the process printed, if any."""
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
