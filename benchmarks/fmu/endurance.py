"""Endurance of the isolated flavour: many instances, long runs, lost processes.

    python -m benchmarks.fmu.endurance

Writes docs/measured/fmu/endurance.md: growth of memory over 5000 instances made and freed and over 100000 steps, in the host, the
supervisor and the worker; how long a start takes, and how long a lost worker and a lost supervisor keep a host from going
on, with the model at its regression level and on the shipped grid. The host is a C program that knows nothing of Python. Needs
Linux and gcc.
"""

import os
import signal
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from benchmarks.fmu.overhead import SCENE, STEP, Flavour, unpacked
from benchmarks.hosts.native_host import ERROR, OK, Instance, NativeHost, compiled, plain_environment
from benchmarks.hosts.processes import alive, children, descriptors, resident, soon
from benchmarks.pages import save
from contact_core import Scene
from fmu_src.package.build import build

CYCLES, STEPS, LOSSES = 5_000, 100_000, 11
SHIPPED = Scene.from_toml("mtm_zddp")


def started(host: NativeHost, folder: Path) -> Instance:
    instance = host.load(folder).instance(logging=False)
    if any((*instance.initialise(), instance.step(STEP))):
        raise RuntimeError(f"The FMU does not run: {instance.log}")
    return instance


def cycles(program: Path, folder: Path) -> Iterator[str]:
    """Instances made and freed."""
    with NativeHost(program, plain_environment()) as host:
        fmu = host.load(folder)
        host.ask("cycles", fmu.number, 100)
        (supervisor,) = host.supervisors()
        before = [(resident(pid), descriptors(pid)) for pid in (host.process.pid, supervisor)]
        start = time.perf_counter()
        if host.ask("cycles", fmu.number, CYCLES).status != OK:
            raise RuntimeError("An instance could not be made.")
        each = (time.perf_counter() - start) / CYCLES
        soon(lambda: not children(supervisor))
        for name, pid, (size, files) in zip(
            ("host", "supervisor"), (host.process.pid, supervisor), before, strict=True
        ):
            grown, more = resident(pid) - size, descriptors(pid) - files
            yield f"| {CYCLES} instances made and freed, {1e3 * each:.1f} ms each | {name} | {grown} kB, {more} files |"


def steps(program: Path, folder: Path) -> Iterator[str]:
    """A long run."""
    with NativeHost(program, plain_environment()) as host:
        instance = started(host, folder)
        (supervisor,) = host.supervisors()
        (worker,) = children(supervisor)
        load, output = (instance.fmu.variables[name].valueReference for name in ("load", "friction_force"))
        duty = (STEP, STEP, load, SCENE.operation.load, 0.9 * SCENE.operation.load, output)
        instance.ask("bench", STEPS // 10, *duty)
        processes = {"host": host.process.pid, "supervisor": supervisor, "worker": worker}
        before = {name: resident(pid) for name, pid in processes.items()}
        instance.ask("bench", STEPS, *duty)
        for name, pid in processes.items():
            yield f"| {STEPS} steps | {name} | {resident(pid) - before[name]} kB |"


def starts(program: Path, folder: Path, model: str) -> Iterator[str]:
    """The first calls of a host."""
    calls = (("instantiate", 0, 0, 0), ("setup", 0, 0.0), ("enter", 0), ("exit", 0), ("step", 0, 0.0, STEP))
    with NativeHost(program, plain_environment()) as host:
        host.load(folder)
        taken = {}
        for call in (*calls, ("step", 0, STEP, STEP)):
            start = time.perf_counter()
            if host.ask(*call).status != OK:
                raise RuntimeError(f"The FMU fails at {call}.")
            taken["again" if call[0] in taken else call[0]] = 1e3 * (time.perf_counter() - start)
        shown = (taken[name] for name in ("instantiate", "exit", "step", "again"))
        yield f"| {model} | {' | '.join(f'{milliseconds:.1f}' for milliseconds in shown)} |"


def losses(program: Path, folder: Path, model: str) -> Iterator[str]:
    """Return the times from a kill to a restored instance that is ready to step."""
    with NativeHost(program, plain_environment()) as host:
        instance = started(host, folder)
        instance.ask("save", 0)

        def supervisor() -> int:
            return host.supervisors()[0]

        def worker() -> int:
            return children(supervisor())[0]

        for name, victim in (("worker", worker), ("supervisor", supervisor)):
            taken = [restored(instance, victim) for _ in range(LOSSES)]
            low, middle, high = 1e3 * np.percentile(taken, [0, 50, 100])
            yield f"| {name} | {model} | {middle:.0f} | {low:.0f} | {high:.0f} |"


def restored(instance: Instance, victim: Callable[[], int]) -> float:
    """Seconds that a restore takes which finds its process killed."""
    pid = victim()
    os.kill(pid, signal.SIGKILL)
    if not soon(lambda: not alive(pid)) or instance.ask("step", 0.0, STEP).status != ERROR:
        raise RuntimeError("The host did not notice that its process was killed.")
    start = time.perf_counter()
    if instance.ask("restore", 0).status != OK:
        raise RuntimeError(f"The instance could not be restored: {instance.log}")
    return time.perf_counter() - start


def main() -> None:
    lines = [
        "# Endurance of the isolated FMU",
        "",
        "Written by `python -m benchmarks.fmu.endurance`, which describes the measurement.",
        "",
        "| what | process | growth |",
        "|---|---|---|",
    ]

    def add(rows: Iterator[str]) -> None:
        for line in rows:
            print(line, flush=True)
            lines.append(line)

    with tempfile.TemporaryDirectory() as name:
        folder, program = Path(name), compiled(Path(name))
        quick = Flavour("isolated", plain_environment).contact(folder)
        shipped = unpacked(build(SHIPPED, folder / "shipped.fmu"))
        models = ((quick, "regression level"), (shipped, "129 x 129 nodes"))
        add(cycles(program, quick))
        add(steps(program, quick))
        lines += [
            "",
            "| model | instantiate [ms] | initialise [ms] | first step [ms] | second step [ms] |",
            "|---|---|---|---|---|",
        ]
        for model in models:
            add(starts(program, *model))
        lines += ["", "| lost process | model | restored after, median [ms] | least | most |", "|---|---|---|---|---|"]
        for model in models:
            add(losses(program, *model))
    save("fmu/endurance", "\n".join(lines))


if __name__ == "__main__":
    main()
