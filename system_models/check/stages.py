"""A process in which an FMU is run: python -m system_models.check.stages FOLDER STAGE NOTEBOOK START.

A stage writes its answer to NOTEBOOK/STAGE.json, or leaves files there for the next, in a new process.
"""

import ctypes
import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

from fmpy.fmi1 import FMICallException

from . import answers, calls, derivatives, hosts, reference
from .instance import Fmu
from .variables import Start
from .verdict import Answer, failed

Stage = Callable[[Fmu, Path], Answer | None]

# by their names, by which the rules of `deep` point to them
STAGES: dict[str, Stage] = {
    stage.__name__: stage
    for stage in (
        answers.run, answers.finite, answers.replay, answers.rollback, answers.save, answers.resume, answers.splitting,
        answers.sweep, answers.unusable, answers.feedthrough, answers.reset, answers.interleaved,
        calls.guid, calls.interface, calls.resources, calls.stop_time, calls.communication_point, calls.order,
        calls.long_text, calls.foreign_text,
        hosts.memory, hosts.reloading, hosts.home, hosts.children, hosts.fork,
        derivatives.derivatives, reference.reference,
    )
}  # fmt: skip


def answer(folder: Path, stage: str, notebook: Path, start: Start) -> Answer | None:
    """Answer one stage, of an FMU that starts with these values; an exception is an answer, too."""
    with (notebook / "call").open("wb", buffering=0) as trace:
        fmu = Fmu(folder, trace, start)
        try:
            return STAGES[stage](fmu, notebook)
        except FMICallException:
            return failed(f"{fmu.fault}.")
        except Exception as error:  # fmpy's own, when an FMU cannot be loaded or instantiated, and unreadable data
            sentences = filter(None, (" ".join(str(error).split()), fmu.complaint()))
            return failed(" ".join(sentence.rstrip(".") + "." for sentence in sentences))


_PR_SET_PDEATHSIG = 1


def main(folder: str, stage: str, notebook: str, start: str) -> None:
    """Write the answer of one stage, if it gives one. It ends with the checker, also when that is killed."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    found = answer(Path(folder), stage, Path(notebook), json.loads(start))
    if found is not None:
        (Path(notebook) / f"{stage}.json").write_text(json.dumps(found))
    sys.stdout.flush()
    os._exit(0)  # the answer is given: pythonfmu's binary now and then aborts a host that ends in the usual way


if __name__ == "__main__":
    main(*sys.argv[1:])
