"""Machines with native FMUs beside those with FMUs in Python: in this master, and exported, in other ones.

    python -m benchmarks.machines.native

Writes docs/measured/machines/native.md. The master runs the beginning of each duty with embedded and with native FMUs.
The exported files, isolated and native, run in libcosimpy and ecospy (`pip install ".[importers]"`), in fixed steps.
Seconds of a step: those of a long run less those of a short one, over the steps between, so that starting all FMUs does
not count. FMUS_HOST names the interpreter that has the importers, if it is not this one.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.coupling.ssp_importers import BEARING, GEARS, RUNNER
from benchmarks.hosts.ssp_runner import UNUSABLE
from benchmarks.pages import Page
from system_models.machines import reading
from system_models.machines.assembly import Assembly
from system_models.machines.export import with_timetable
from system_models.master import export_ssp, simulate

IMPORTERS = ("libcosimpy", "ecospy")
STEP, SHORT, LONG, LONGEST = 0.125, 20, 180, 4180  # s, and steps; native FMUs go on to the longest
FASTER = 20.0  # asked for
SAME = 1e-7  # of the largest value at any time; of the value, in another master
LEAST = 1e-3  # of the nominal value: what vanishes by symmetry is rounding
ROUNDING = ".residual"  # what an iteration leaves over
HOST = os.environ.get("FMUS_HOST", sys.executable)


class Case(NamedTuple):
    """A machine, the hours that the master runs, and the values that are compared in other masters."""

    machine: str
    hours: float
    names: tuple[str, ...]


CASES = (Case("gear_fzg_c", 10.0, GEARS), Case("bearing_209", 0.5, BEARING))


def in_master(assembly: Assembly, folder: Path, report: Page, case: Case) -> None:
    """Run embedded and native FMUs in the master."""
    found, seconds, built = [], [], []
    for flavour in ("embedded", "native"):
        begin = time.perf_counter()
        system = assembly.system(folder / flavour, flavour, here=True)
        built.append(time.perf_counter() - begin)
        begin = time.perf_counter()
        found.append(simulate(system, **assembly.settings, outputs=assembly.outputs()))
        seconds.append(time.perf_counter() - begin)
    slow, fast = found
    worst, nominals = 0.0, assembly.nominals()
    if slow.sizes["time"] == fast.sizes["time"]:
        for name in slow.data_vars:
            one, other = (np.asarray(run[name].values, float) for run in found)
            if name in nominals and not str(name).endswith(ROUNDING):
                worst = max(worst, float(np.abs(one - other).max() / max(np.abs(one).max(), LEAST * nominals[name])))
    costs = [json.loads(run.attrs["cost"]) for run in found]
    contacts, parts = (
        [1e3 * sum(cost[n]["seconds"] for n in names) for cost in costs]
        for names in (assembly.contacts, assembly.parts)
    )
    report.row(
        case.machine, f"{case.hours:g} h", slow.attrs["steps"], *seconds, seconds[0] / seconds[1], contacts[0] / contacts[1],
        parts[0] / parts[1], f"{worst:.1e}", built[1],
    )  # fmt: skip
    report.verdict(f"{case.machine}: the same answers in the master", f"to {worst:.1e}", 0.0 < worst < SAME)


def run_in(importer: str, file: Path, steps: int, names: tuple[str, ...]) -> tuple[list[float], float] | None:
    """The values at the end in another master, and the seconds that it took; None if it is not installed."""
    call = [HOST, str(RUNNER), importer, str(file), repr(STEP), str(steps), *names]
    begin = time.perf_counter()
    run = subprocess.run(call, capture_output=True, text=True)
    if run.returncode == UNUSABLE:
        return None
    if run.returncode:
        raise RuntimeError(f"{importer} and {file.stem}: {run.stderr[-2000:]}")
    return json.loads(run.stdout.splitlines()[-1])[-1], time.perf_counter() - begin


def in_others(assembly: Assembly, folder: Path, report: Page, case: Case) -> None:
    """Run the exported files in other masters."""
    timed, end = with_timetable(assembly), LONGEST * STEP
    files = {
        flavour: export_ssp(
            timed.system(folder / f"of_{flavour}", flavour, here=True), folder / f"{flavour}.ssp", end, STEP
        )
        for flavour in ("isolated", "native")
    }
    values = {}
    for importer in IMPORTERS:
        each = {}
        for flavour, file in files.items():
            other = SHORT if flavour == "isolated" else LONGEST
            runs = [run_in(importer, file, steps, case.names) for steps in (LONG, other)]
            if runs[0] is None or runs[1] is None:
                report.say(f"{importer} is not installed.")
                return
            (last, whole), (_, seconds) = runs
            each[flavour] = (seconds - whole) / (other - LONG), whole, last
        (slow, slow_whole, python), (fast, fast_whole, native) = each.values()
        apart = max(abs(x - y) / abs(x) for x, y in zip(python, native, strict=True) if x)
        report.row(case.machine, importer, 1e3 * slow, 1e3 * fast, slow / fast, slow_whole, fast_whole, f"{apart:.1e}")
        report.verdict(
            f"{case.machine} in {importer}: {FASTER:g} times as fast a step",
            f"{slow / fast:.0f}",
            slow / fast >= FASTER,
        )
        report.verdict(f"{case.machine} in {importer}: the same answers", f"to {apart:.1e}", apart < SAME)
        values[importer] = native
    one, other = values.values()
    between = max(abs(x - y) / abs(x) for x, y in zip(one, other, strict=True) if x)
    report.say(
        f"{case.machine}: the two masters differ by {between:.1e} at most, as they read outputs at different moments of a step."
    )


def main() -> None:
    """Run all and write the page."""
    report = Page("machines/native", "Machines with native FMUs")
    assemblies = {
        case: reading.assemble(reading.read(case.machine, {"simulate.stop_time": f"{case.hours!r} h"}))
        for case in CASES
    }
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        report.say("### In this master")
        report.say(
            "Seconds of the simulation, without those in which FMUs are built. Faster: all of it, contacts and components "
            "alone. Apart: largest difference of an output at any time, over its largest value, at least a thousandth of the nominal one; residuals are left out."
        )
        report.header(
            "machine", "duty", "steps", "Python s", "native s", "faster", "contacts", "components", "apart", "built s"
        )
        for case, assembly in assemblies.items():
            in_master(assembly, folder / case.machine, report, case)
        for case, assembly in assemblies.items():
            report.say(f"### {case.machine}, exported")
            report.say(
                f"{len(assembly.contacts)} contacts, {len(assembly.parts)} components, all native in the second file: no Python is inside. {LONG} steps of {STEP:g} s."
            )
            report.header(
                "machine", "master", "isolated, ms a step", "native", "faster", "isolated, s in all", "native", "apart"
            )
            in_others(assembly, folder / case.machine, report, case)
    report.write()


if __name__ == "__main__":
    os.environ.setdefault("TRIBOFMU_PYTHON", sys.executable)
    main()
