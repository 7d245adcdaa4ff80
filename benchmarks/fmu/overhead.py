"""Cost of an FMU over a direct call: a step, and many instances at once.

    python -m benchmarks.fmu.overhead

Writes docs/measured/fmu.md. All of it in one run, for each flavour: the median and the 90 % range of the time of one
round trip (set one input, step, get five outputs) of an empty slave and of mtm_zddp at the regression level, called directly,
through fmpy, and from a host in C that knows nothing of Python, all on one CPU; the same in C with the state saved before
each step, and restored and freed after it ("taken back"), and with processes that may change their CPU; of three passes
that with the smallest median. "direct call, other process between" times the direct call only, each after a byte went
to another process and back: the change of processes makes the model itself slower, whose caches and predictions the
CPU has lost meanwhile. Then how long it takes until the instances in the host in C have made their first step, and the
memory of all processes by then (PSS: a page that n processes share counts 1/n in each). Last, the contact's state
(ContactState) after a step at the regression level, of fresh surfaces and of such as the deterministic level has left: its size,
and the medians of the times to make its parts, which a saved state is, and to make a state of its bytes. Needs gcc, and a
shared library of Python for the embedded flavour in C.
"""

import os
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Literal

import fmpy
import numpy as np
from fmpy.simulation import instantiate_fmu

from benchmarks.hosts.empty_slave import Empty, pack
from benchmarks.hosts.native_host import Instance, NativeHost, compiled, embedding_environment, plain_environment
from benchmarks.hosts.processes import children
from benchmarks.pages import save
from benchmarks.regression.cost import unit
from contact_core import ContactState, Scene, advance, initial_state
from fmu_src.package.build import build

ROUNDS, PASSES, STEP, FIRST = 5_000, 3, 1e-3, 60.0  # -, -, s, s
READ = ("friction_force", "friction_coefficient", "power_loss", "heat_flow_1", "heat_flow_2")
CROWDS, STATES = (1, 20, 50), 200
SCENE = Scene.from_toml("mtm_zddp").at_level("regression")


@dataclass(frozen=True)
class Flavour:
    """Recipe to build an FMU and to run it in the host in C."""

    name: Literal["embedded", "isolated"]
    environment: Callable[[], dict[str, str] | None]

    def contact(self, folder: Path) -> Path:
        return unpacked(build(SCENE, folder / f"{self.name}_contact.fmu", self.name))

    def empty(self, folder: Path) -> Path:
        """An empty slave with all of the contact's files but its own: its description and its script."""
        own = ("modelDescription.xml", "resources/slavemodule.txt", "resources/guid.txt")
        with zipfile.ZipFile(build(SCENE, folder / "parts.fmu", self.name)) as archive:
            parts = {name: archive.read(name) for name in archive.namelist() if name not in own}
        return unpacked(pack(folder / f"{self.name}_empty.fmu", parts))


FLAVOURS = (Flavour("embedded", embedding_environment), Flavour("isolated", plain_environment))
os.environ["TRIBOFMU_PYTHON"] = sys.executable


@dataclass(frozen=True)
class Duty:
    """Variables that a round trip sets, in turn, and gets."""

    input: str
    values: tuple[float, float]
    outputs: tuple[str, ...]


CONTACT = Duty("load", (SCENE.operation.load, 0.9 * SCENE.operation.load), READ)
EMPTY = Duty("u", (1.0, 2.0), ("y",))


def unpacked(fmu: Path) -> Path:
    folder = fmu.with_suffix("")
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    return folder


def timed(rounds: Iterator[None]) -> list[float]:
    """Microseconds between one item and the next."""
    found, start = [], time.perf_counter_ns()
    for _ in rounds:
        end = time.perf_counter_ns()
        found.append((end - start) / 1e3)
        start = time.perf_counter_ns()
    return found


def contact_directly() -> Iterator[None]:
    radius_x, radius_y = SCENE.radii(SCENE.operation.point)
    oil = SCENE.operation.temperature
    rest = {"body_temperature_1": oil, "body_temperature_2": oil, "radius_x": radius_x, "radius_y": radius_y}
    point = replace(SCENE.operation.point, **rest)  # all inputs, as an FMU has them
    state, _ = advance(SCENE, point, initial_state(SCENE), FIRST)
    for i in range(ROUNDS):
        state, outputs = advance(SCENE, replace(point, load=CONTACT.values[i % 2]), state, STEP)
        [getattr(outputs, name) for name in READ]
        yield


def contact_between_processes() -> list[float]:
    """Microseconds of direct calls, before each of which another process of this CPU had its turn."""
    rounds = contact_directly()
    found = []
    with subprocess.Popen(["cat"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0) as other:
        for _ in range(ROUNDS):
            other.stdin.write(b".")
            other.stdout.read(1)
            start = time.perf_counter_ns()
            next(rounds)
            found.append((time.perf_counter_ns() - start) / 1e3)
    return found


def empty_directly() -> Iterator[None]:
    slave = Empty(instance_name="", resources="")
    for i in range(ROUNDS):
        slave.set_real([0], [EMPTY.values[i % 2]])
        slave.do_step(i * STEP, STEP)
        slave.get_real([1])
        yield


def in_fmpy(folder: Path, duty: Duty) -> Iterator[None]:
    description = fmpy.read_model_description(str(folder), validate=False)
    references = {v.name: v.valueReference for v in description.modelVariables}
    put, got = [references[duty.input]], [references[name] for name in duty.outputs]
    fmu = instantiate_fmu(str(folder), description)
    fmu.setupExperiment()
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    fmu.doStep(0.0, FIRST)
    for i in range(ROUNDS):
        fmu.setReal(put, [duty.values[i % 2]])
        fmu.doStep(FIRST + i * STEP, STEP)
        fmu.getReal(got)
        yield
    fmu.freeInstance()


def ready(host: NativeHost, folder: Path, count: int) -> list[Instance]:
    """Instances after their first step."""
    fmu = host.load(folder)
    instances = [fmu.instance(k, logging=False) for k in range(count)]
    for instance in instances:
        if any((*instance.initialise(), instance.step(FIRST))):
            raise RuntimeError(f"The FMU does not run in the host in C: {instance.log}")
    return instances


def in_c(program: Path, environment: dict[str, str], folder: Path, duty: Duty, command: str = "bench") -> list[float]:
    """Microseconds of each round trip; `retry`: of each that is taken back by the state saved before."""
    host = NativeHost(program, environment)
    (instance,) = ready(host, folder, 1)
    references = [instance.fmu.variables[name].valueReference for name in (duty.input, *duty.outputs)]
    answer = instance.ask(command, ROUNDS, FIRST, STEP, references[0], *duty.values, *references[1:])
    host.close()
    return [float(value) / 1e3 for value in answer.values]


def family(pid: int) -> list[int]:
    """A process and all that descend from it."""
    return [pid, *(member for child in children(pid) for member in family(child))]


def proportional_set_size(pid: int) -> float:
    """PSS of a process in MB."""
    lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024.0


def crowd(program: Path, environment: dict[str, str], folder: Path, count: int) -> tuple[float, float, int]:
    """Seconds until all instances are ready, their memory in MB, and the number of processes."""
    start = time.perf_counter()
    host = NativeHost(program, environment)
    ready(host, folder, count)
    taken = time.perf_counter() - start
    members = [member for pid in (host.process.pid, *host.supervisors()) for member in family(pid)]
    memory = sum(proportional_set_size(pid) for pid in members)
    host.close()
    return taken, memory, len(members)


@dataclass(frozen=True)
class Way:
    """One way to call a slave, and how to time its round trips in microseconds."""

    slave: str
    name: str
    times: Callable[[], list[float]]
    pinned: bool = True


def ways(program: Path, folder: Path) -> Iterator[Way]:
    """All that are compared; the direct call of each slave comes first."""
    for slave, duty, directly in (("empty", EMPTY, empty_directly), ("mtm_zddp", CONTACT, contact_directly)):
        yield Way(slave, "direct call", lambda directly=directly: timed(directly()))
        if slave == "mtm_zddp":
            yield Way(slave, "direct call, other process between", contact_between_processes)
        for flavour in FLAVOURS:
            fmu = flavour.empty(folder) if slave == "empty" else flavour.contact(folder)
            yield Way(slave, f"{flavour.name}, fmpy", partial(_timed_in_fmpy, fmu, duty))
            environment = flavour.environment()
            if environment is not None:
                run = partial(in_c, program, environment, fmu, duty)
                yield Way(slave, f"{flavour.name}, host in C", run)
                yield Way(slave, f"{flavour.name}, host in C, taken back", partial(run, "retry"))
                yield Way(slave, f"{flavour.name}, host in C, any CPU", run, pinned=False)


def _timed_in_fmpy(fmu: Path, duty: Duty) -> list[float]:
    return timed(in_fmpy(fmu, duty))


def steps(program: Path, folder: Path) -> Iterator[str]:
    """Rows of the table of round trips."""
    compared = list(ways(program, folder))
    cpus = os.sched_getaffinity(0)
    passes = []
    for _ in range(PASSES):
        passes.append([])
        for way in compared:
            os.sched_setaffinity(0, {max(cpus)} if way.pinned else cpus)
            passes[-1].append(np.percentile(way.times(), [5, 50, 95]))
    os.sched_setaffinity(0, cpus)
    direct = 0.0
    for way, found in zip(compared, zip(*passes, strict=True), strict=True):
        low, middle, high = min(found, key=lambda percentiles: percentiles[1])
        direct = middle if way.name == "direct call" else direct
        yield f"| {way.slave} | {way.name} | {middle:.1f} | {low:.1f} | {high:.1f} | {middle - direct:.1f} |"


def crowds(program: Path, folder: Path) -> Iterator[str]:
    """Rows of the table of many instances."""
    for flavour in FLAVOURS:
        environment = flavour.environment()
        for count in CROWDS if environment is not None else ():
            taken, memory, processes = crowd(program, environment, flavour.contact(folder), count)
            yield f"| {flavour.name} | {count} | {taken:.2f} | {memory:.0f} | {processes} |"


def states() -> Iterator[str]:
    """Rows of the table of states."""
    point, fresh = SCENE.operation.point, initial_state(SCENE)
    solved, _ = advance(SCENE.at_level("deterministic"), point, fresh, STEP)
    for name, state in (("fresh", fresh), ("from the deterministic level", solved)):
        made, read = [], []
        for _ in range(STATES):
            state, _ = advance(SCENE, point, state, STEP)
            start = time.perf_counter_ns()
            state.parts()
            made.append(time.perf_counter_ns() - start)
            data = state.to_bytes()
            start = time.perf_counter_ns()
            ContactState.from_bytes(data, SCENE)
            read.append(time.perf_counter_ns() - start)
        yield f"| {name} | {len(data) / 1e3:.1f} | {np.median(made) / 1e3:.1f} | {np.median(read) / 1e3:.0f} |"


def shown(rows: Iterator[str]) -> list[str]:
    found = []
    for line in rows:
        print(line, flush=True)
        found.append(line)
    return found


def main() -> None:
    lines = [
        "# Cost of an FMU step over a direct call",
        "",
        "Written by `python -m benchmarks.fmu.overhead`, which describes the measurement.",
        "",
        "| slave | called by | median [us] | 5 % [us] | 95 % [us] | over the direct call [us] |",
        "|---|---|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program = compiled(folder)
        lines += shown(steps(program, folder))
        lines += ["", f"np.exp of nine numbers took {unit():.2f} us in the same run.", ""]
        lines += ["| flavour | instances | ready after [s] | memory [MB] | processes |", "|---|---|---|---|---|"]
        lines += shown(crowds(program, folder))
    lines += ["", "| surfaces | state [kB] | made in [us] | read in [us] |", "|---|---|---|---|", *shown(states())]
    save("fmu/overhead", "\n".join(lines))


if __name__ == "__main__":
    main()
