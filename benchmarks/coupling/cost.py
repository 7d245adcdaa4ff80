"""Cost of the co-simulation master beyond the calls of the FMUs.

    python -m benchmarks.coupling.cost

Writes docs/measured/coupling/cost.md and docs/measured/coupling/cost.png. Every simulation is recorded once as the sequence of its calls through
fmpy, with their arguments. Then it runs again, and a bare loop repeats the calls on instances of its own, in turns in
one process: the difference, in CPU time, is what the master adds. Chains are of gains, all feedthrough, and pairs are
two-mass oscillators. The memory is the resident set during one long simulation of a pair.
"""

import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from ctypes import Array, byref
from functools import partial
from itertools import pairwise
from os import sysconf
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np
from matplotlib.figure import Figure

from benchmarks.folders import MEASURED
from benchmarks.models import build
from benchmarks.pages import save
from system_models.master import System, simulate
from system_models.master.coupled import Coupled
from system_models.master.recorder import STATISTICS, Recorder
from system_models.master.settings import Settings

DOCS = MEASURED / "coupling"
STEP, REPEATS, CALLS = 1e-3, 5, 4_000  # s, -, FMU steps of one timed simulation
COUNTS = {"chain": (2, 5, 20), "pairs": (2, 6, 20)}
LONG = (20_000, 100_000, 200_000)  # steps
ROW = 2 + len(STATISTICS)  # numbers of a row: the time, one output, and how the step went
LIMIT = 30.0  # us per step and FMU
SCHEMES: dict[str, dict[str, Any]] = {
    "Jacobi, order 0": {},
    "Jacobi, order 1": {"order": 1},
    "Jacobi, order 2": {"order": 2},
    "Gauss-Seidel, order 0": {"algorithm": "gauss_seidel"},
    "Gauss-Seidel, order 1": {"algorithm": "gauss_seidel", "order": 1},
    "Gauss-Seidel, order 2": {"algorithm": "gauss_seidel", "order": 2},
    "fixed point": {"iterate": "fixed_point"},
    "quasi-Newton, order 1": {"iterate": "quasi_newton", "order": 1},
    "Jacobi, order 1, controlled": {"order": 1, "tolerance": 1e-3},
}


FIXED = [scheme for scheme, settings in SCHEMES.items() if settings.keys() <= {"order"}]


class Call(NamedTuple):
    """One call of an FMU."""

    instance: str
    function: str
    arguments: tuple[Any, ...]


class Trace:
    """The calls of a simulation; `begin` are those before its second step."""

    def __init__(self, system: System, settings: Mapping[str, Any], steps: int) -> None:
        self.calls: list[Call] = []
        self.begin = 0
        trace = self

        class Traced(Coupled):
            def initialise(self) -> None:
                super().initialise()
                for instance in self.instances.values():
                    trace.watch(instance)

        def mark(_: float) -> None:
            self.begin = self.begin or len(self.calls)
            self.end = len(self.calls)

        with patch.object(sys.modules["system_models.master.simulate"], "Coupled", Traced):
            data = simulate(system, steps * STEP, STEP, progress=mark, **settings)
        self.steps = int(data.attrs["steps"]) - 1
        self.made = sum(call.function == "fmi2DoStep" for call in self.calls[self.begin : self.end])
        del self.calls[self.end :]

    def watch(self, instance: Any) -> None:
        """Keep all calls of an instance from now on."""
        for name in dir(instance._fmu):
            if name.startswith("fmi2"):
                setattr(instance._fmu, name, self._kept(instance.name, name, getattr(instance._fmu, name)))

    def _kept(self, instance: str, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any) -> Any:
            self.calls.append(Call(instance, name, arguments))
            return function(*arguments)

        return call

    def bound(self, coupled: Coupled) -> list[tuple[Callable[..., Any], tuple[Any, ...]]]:
        """The calls on other instances: what the trace's were and their states are replaced."""
        places: dict[int, Any] = {}

        def moved(argument: Any, component: Any) -> Any:
            if isinstance(argument, (float, int, Array)):
                return argument
            target = getattr(argument, "_obj", argument)  # behind a pointer
            if id(target) not in places:
                places[id(target)] = type(target)()
            return byref(places[id(target)]) if target is not argument else places[id(target)]

        result = []
        for name, function, (_, *rest) in self.calls:
            instance = coupled.instances[name]
            arguments = (instance._component, *(moved(argument, instance) for argument in rest))
            result.append((getattr(instance._fmu, function), arguments))
        return result


class Cost(NamedTuple):
    """Microseconds per FMU and pass: one doStep."""

    passes: float  # per macro step
    calls: float
    simulation: float
    beyond: float


def simulated(system: System, settings: Mapping[str, Any], steps: int) -> float:
    """CPU seconds of all steps but the first."""
    times: list[float] = []

    def clock(_: float) -> None:
        times[len(times[:1]) :] = [time.process_time()]

    simulate(system, steps * STEP, STEP, progress=clock, **settings)
    return times[1] - times[0]


def repeated(system: System, settings: Mapping[str, Any], trace: Trace) -> float:
    """CPU seconds of the same calls alone."""
    ports = system.outputs(settings.get("outputs"))
    with ExitStack() as exits:
        coupled = Coupled(system, ports, Settings(1.0, STEP, tolerance=settings.get("tolerance")), exits)
        coupled.initialise()
        calls = trace.bound(coupled)
        for function, arguments in calls[: trace.begin]:
            function(*arguments)
        timed = calls[trace.begin :]
        start = time.process_time()
        for function, arguments in timed:
            function(*arguments)
        return time.process_time() - start


def cost(system: System, settings: Mapping[str, Any]) -> Cost:
    """Cost of a scheme, the median of pairs of runs."""
    settings = {"outputs": []} | settings
    steps = max(20, CALLS // len(system.models))
    trace = Trace(system, settings, steps)
    pairs = [(simulated(system, settings, steps), repeated(system, settings, trace)) for _ in range(REPEATS)]
    whole, bare = 1e6 / trace.made * np.array(pairs).T
    return Cost(
        trace.made / trace.steps / len(system.models),
        float(np.median(bare)),
        float(np.median(whole)),
        float(np.median(whole - bare)),
    )


def chain(folder: Path, count: int) -> System:
    """Gains, each set by the one before."""
    names = [f"g{n:02}" for n in range(count)]
    connections = [(f"{a}.y", f"{b}.u") for a, b in pairwise(names)]
    return System(dict.fromkeys(names, build("gain", folder)), connections, {"g00.u": 1.0})


def pairs(folder: Path, count: int) -> System:
    """Two-mass oscillators, coupled by displacements."""
    fmus, connections = {}, []
    for n in range(count // 2):
        one, other = f"one{n:02}", f"other{n:02}"
        fmus |= {one: build("mass_1_displacement", folder), other: build("mass_2_displacement", folder)}
        for a, b in ((one, other), (other, one)):
            connections += [(f"{a}.x", f"{b}.x_other"), (f"{a}.v", f"{b}.v_other")]
    return System(fmus, connections)


SYSTEMS = {"chain": chain, "pairs": pairs}


def costs(folder: Path) -> Iterator[tuple[str, int, str, Cost]]:
    """Yield the costs of all systems and schemes; a chain has no loop and nothing to iterate."""
    for kind, counts in COUNTS.items():
        for count in counts:
            system = SYSTEMS[kind](folder, count)
            for scheme, settings in SCHEMES.items():
                if kind == "pairs" or not settings.keys() & {"iterate", "tolerance"}:
                    yield kind, count, scheme, cost(system, settings)


def recording(folder: Path) -> Iterator[str]:
    """Rows of the table of what a recorded value costs."""
    reals, echo = pairs(folder, 20), System({"echo": build("echo", folder)})
    for system, names in ((reals, [port.name for port in reals.outputs(None)]), (echo, ["echo.integer_out"])):
        steps = CALLS // len(system.models)
        runs = [[simulated(system, {"outputs": which}, steps) for which in ([], names)] for _ in range(REPEATS)]
        more = float(np.median(np.diff(runs))) / (steps - 1) * 1e6
        yield f"| {len(names)} {system.port(names[0]).kind} | {more:.1f} | {more / len(names):.2f} |"


def resident() -> float:
    """Resident set of this process in MB."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * sysconf("SC_PAGE_SIZE") / 1e6


def memory(folder: Path) -> Iterator[str]:
    """Rows of the table of memory: first a simulation whose rows are dropped, then one that keeps them."""
    for scheme in ("Jacobi, order 0", "fixed point"):
        dropped, kept = (_grown(pairs(folder, 2), SCHEMES[scheme], keep) for keep in (False, True))
        for made in LONG:
            rows = 8e-6 * ROW * (made - LONG[0])
            yield f"| {scheme} | {made} | {dropped[made]:.2f} | {kept[made]:.2f} | {rows:.2f} |"


def _grown(system: System, settings: Mapping[str, Any], keep: bool) -> dict[int, float]:
    """Return the growth of the resident set since the first recorded step [MB]."""
    found: dict[int, float] = {}
    add = Recorder.add if keep else (lambda *_: None)
    with patch.object(Recorder, "add", add):
        sample = partial(_sampled, found)
        simulate(system, LONG[-1] * STEP, STEP, progress=sample, outputs=["one00.x"], **settings)
    return {made: size - found[LONG[0]] for made, size in found.items()}


def _sampled(found: dict[int, float], time: float) -> None:
    if (made := round(time / STEP)) in LONG:
        found[made] = resident()


def shown(rows: Iterator[str]) -> list[str]:
    found = []
    for line in rows:
        print(line, flush=True)
        found.append(line)
    return found


def plot(found: list[tuple[str, int, str, Cost]]) -> None:
    figure = Figure(figsize=(9, 3.8), layout="constrained")
    for axes, kind in zip(figure.subplots(1, 2, sharey=True), COUNTS, strict=True):
        for n, scheme in enumerate(SCHEMES):
            own = [(count, c.beyond) for system, count, name, c in found if (system, name) == (kind, scheme)]
            if own:
                axes.plot(*zip(*own, strict=True), marker="osv^D<>Px"[n], color=f"C{n}", label=scheme)
        axes.axhline(LIMIT, color="k", ls=":", lw=1)
        axes.set(title=kind, xlabel="FMUs", xscale="log", xticks=COUNTS[kind], xticklabels=COUNTS[kind], yscale="log")
        axes.minorticks_off()
    figure.axes[0].set_ylabel("beyond the calls [us per FMU and pass]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside right center", fontsize=8)
    figure.savefig(DOCS / "cost.png", dpi=130)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        cost(chain(folder, 2), {})  # warm up
        found = []
        table = []
        for kind, count, scheme, c in costs(folder):
            found.append((kind, count, scheme, c))
            table.append(
                f"| {kind} | {count} | {scheme} | {c.passes:.2f} | {c.calls:.1f} | {c.simulation:.1f} | {c.beyond:.1f} |"
            )
            print(table[-1], flush=True)
        columns = shown(recording(folder))
        kept = shown(memory(folder))
    plot(found)
    fixed = [(c.beyond, kind, count) for kind, count, scheme, c in found if scheme in FIXED]
    above = [f"{scheme}, {kind} of {count}: {c.beyond:.1f}" for kind, count, scheme, c in found if c.beyond > LIMIT]
    lines = [
        "# Cost of the co-simulation master",
        "",
        "Written by `python -m benchmarks.coupling.cost`, which describes the measurement. Microseconds of CPU time per FMU and",
        f"pass (one doStep), median of {REPEATS} pairs of runs. Asked for: less than {LIMIT:.0f} us beyond the calls with fixed steps;",
        "the most that Jacobi needs is {:.1f} us ({} of {}).".format(*max(fixed)),
        "",
        "![Cost](cost.png)",
        "",
        "| system | FMUs | scheme | passes per step | calls alone | simulation | beyond |",
        "|---|---|---|---|---|---|---|",
        *table,
        "",
        f"Above {LIMIT:.0f} us: {'; '.join(above) or 'none'}.",
        "",
        "A controlled step has two rows, and is made once as a whole and once in halves: 1.5 passes per row, and more where it is repeated. Other programs on the machine change single figures by several microseconds.",
        "",
        "Cost of recording outputs, with Jacobi and order 0; a coupled Real is read in any case:",
        "",
        "| recorded | us per step | us per value |",
        "|---|---|---|",
        *columns,
        "",
        f"Growth of the resident memory since step {LONG[0]} [MB], with the rows of the result dropped and kept, and the",
        "size of these rows:",
        "",
        "| scheme | steps | rows dropped | rows kept | size of the rows |",
        "|---|---|---|---|---|",
        *kept,
    ]
    save("coupling/cost", "\n".join(lines))


if __name__ == "__main__":
    main()
