"""Rules on effects of an FMU on the process and the machine of its host. FMI says nothing on most of them.

Each changes the process that it runs in: never ask them in one that is still needed.
"""

import gc
import math
import os
import re
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

from .answers import FirstRun, disturbed
from .confine import confine
from .instance import Fmu, Instance
from .rows import STEPS, rows_alone
from .verdict import Answer, not_applicable, noted, passed

_SETTLED, _CYCLES = 5, 20  # instances: until caches are full, and then
_LEAK = 10.0  # kB per instance that are worth a note
_FORKS = 200
_NOWHERE = "/dev/null/home"  # a home folder that cannot be made


def memory(fmu: Fmu, notebook: Path) -> Answer:
    """Check that instances that are made, run for some steps and freed leave little behind."""
    single = fmu.capabilities.canBeInstantiatedOnlyOncePerProcess
    with nullcontext() if single else fmu.instance():  # which keeps loaded what they share
        before = _memory_after(fmu, _SETTLED)
        growth = (_memory_after(fmu, _CYCLES) - before) / _CYCLES
    evidence = f"{_SETTLED + _CYCLES} instances made, run for {STEPS} steps and freed"
    if math.isnan(growth):
        return passed(f"{evidence}; memory is measured on Linux only.")
    evidence += f"; memory grows by {max(growth, 0.0):.0f} kB per instance."
    return noted(evidence) if growth > _LEAK else passed(evidence)


def _memory_after(fmu: Fmu, count: int) -> float:
    """Return the memory [kB] of this process after so many runs; NaN where the system does not tell it."""
    for _ in range(count):
        rows_alone(fmu)
        gc.collect(1)  # what fmpy leaves
    try:
        text = Path("/proc/self/smaps_rollup").read_text()
    except OSError:
        return math.nan
    # not what is resident: the system takes pages of files away, and brings back what it has swapped
    return sum(float(kb) for kb in re.findall(r"^(?:Anonymous|Swap):\s*(\d+) kB", text, re.MULTILINE))


def reloading(fmu: Fmu, notebook: Path) -> Answer:
    """Check that the library may be unloaded and loaded again while an instance lives."""
    if fmu.capabilities.canBeInstantiatedOnlyOncePerProcess:
        return not_applicable("canBeInstantiatedOnlyOncePerProcess is true.")
    if wrong := disturbed(fmu, reload=True):
        return noted(f"{wrong[0].upper()}{wrong[1:]}{fmu.where}: so do hosts like ecos for each instance.")
    return passed("Two instances, the library loaded again before the second, give the bits of each alone.")


def home(fmu: Fmu, notebook: Path) -> Answer:
    """Check that the FMU runs for a user without a home who can write temporary files only."""
    if sys.platform != "linux":
        return not_applicable("It is asked on Linux only.")
    os.environ["HOME"] = _NOWHERE
    for name in [name for name in os.environ if name.startswith("XDG_")]:
        del os.environ[name]
    os.chdir("/proc")  # where nobody can write
    temporary = tempfile.gettempdir()
    walled = confine([temporary, str(notebook), "/dev"])
    fmu.where = f" without a home folder, {f'where only {temporary} can be written' if walled else 'in /proc'}"
    with fmu.started() as instance:
        instance.step()
    return passed(f"It runs{fmu.where}.")


def children(fmu: Fmu, notebook: Path) -> Answer:
    """Check that in the run the host had no child process that it did not start itself."""
    has_child = FirstRun.read(notebook).has_child
    if has_child is None:
        return not_applicable("It is asked on Linux only.")
    if has_child:
        return noted(
            "While it runs, the host has a child process that it did not start itself: one that waits for all its "
            "children, while (wait(NULL) > 0), hangs."
        )
    return passed("While it runs, the host has no child process that it did not start itself.")


def fork(fmu: Fmu, notebook: Path) -> Answer:
    """Check that a host may fork while its other threads make instances, free them and call them."""
    if sys.platform != "linux":
        return not_applicable("It is asked on Linux only.")
    if fmu.capabilities.canBeInstantiatedOnlyOncePerProcess:
        return not_applicable("canBeInstantiatedOnlyOncePerProcess is true.")
    over = threading.Event()

    def busy(call: Callable[[], object]) -> None:
        while not over.is_set():
            call()

    with fmu.instance() as instance, fmu.instance() as other:
        threads = [
            threading.Thread(target=busy, args=(call,)) for call in (instance.come_and_go, other.be_quiet_unwritten)
        ]
        for thread in threads:
            thread.start()
        try:
            for number in range(_FORKS):
                fmu.progress = f"{number} of {_FORKS} children forked while other threads worked with it have survived"
                time.sleep(1e-3 * (number % 3))  # here and there in the life of the other instance
                if ending := _ending_of_child(fmu, instance):
                    return noted(f"A child forked while other threads made, freed and called instances {ending}.")
        finally:
            over.set()
            for thread in threads:
                thread.join()
    return passed(f"{_FORKS} children forked while other threads made, freed and called instances: all survive.")


def _ending_of_child(fmu: Fmu, instance: Instance) -> str:
    """Return how a forked child that calls the FMU ends; an empty text if it returns."""
    fmu.note("fork")
    child = os.fork()
    if not child:
        try:
            instance.be_quiet()
            instance.free()
        finally:
            os._exit(0)
    _, status = os.waitpid(child, 0)  # one that hangs is left to the rule's budget
    if os.WIFSIGNALED(status):
        return f"ends with {signal.Signals(os.WTERMSIG(status)).name} in {fmu.last_call()}"
    return ""
