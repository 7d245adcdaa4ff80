"""The master beside other masters on the same FMUs: error against the number of calls of fmi2DoStep.

    pip install -e ".[importers]" && python -m benchmarks.coupling.masters [--python RIVAL=INTERPRETER ...]

Writes docs/measured/coupling/masters.md and docs/measured/coupling/masters.png. A rival runs in a process of its own, under the interpreter given for it
(CoFmuPy wants one: it pins another fmpy); what is not installed is named and left out. Needs gcc.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks.coupling.masters_cases import CASES, Case
from benchmarks.coupling.masters_rivals import MODULES, UNUSABLE
from benchmarks.folders import MEASURED
from benchmarks.models import build
from benchmarks.pages import save
from system_models.master import CouplingError, System, simulate

DOCS = MEASURED / "coupling"
OURS = "tribofmu"
CALLS = (300, 3_000, 10_000)
PASSES = 4  # that an iterated step is thought to take
HASH_SEED = "3"  # by it CoFmuPy orders the FMUs of a loop; with this one the better way on the oscillator
OUR_COLOURS = ("C0", "C1", "C8", "C2", "C9", "C3", "C4")
RIVAL_COLOURS = ("0.2", "0.6", "tab:brown", "peru", "navy", "slateblue")
MOST = 30_000  # calls of our own runs
TOLERANCES = 10.0 ** np.arange(-1.0, -7.0, -1.0)
FIXED: dict[str, dict[str, Any]] = {
    "Jacobi, order 0": {},
    "Jacobi, order 2": {"order": 2},
    "Gauss-Seidel, order 2": {"order": 2, "algorithm": "gauss_seidel"},
    "quasi-Newton, order 0": {"iterate": "quasi_newton"},
    "quasi-Newton, order 1": {"iterate": "quasi_newton", "order": 1},
}
CONTROLLED: dict[str, dict[str, Any]] = {
    "Jacobi, order 2, error-controlled": {"order": 2},
    "quasi-Newton, order 2, error-controlled": {"order": 2, "iterate": "quasi_newton"},
}


@dataclass
class Curve:
    """Runs of one algorithm of one master: calls of fmi2DoStep of all FMUs together, and errors."""

    master: str
    algorithm: str
    calls: list[int] = field(default_factory=list)
    errors: list[float] = field(default_factory=list)

    @property
    def name(self) -> str:
        return f"{self.master}, {self.algorithm}"

    def add(self, calls: int, error: float) -> None:
        if math.isfinite(error):
            self.calls.append(calls)
            self.errors.append(error)

    def front(self) -> tuple[np.ndarray, np.ndarray]:
        """Logarithms of the calls, rising, and of the smallest error with so many."""
        order = np.argsort(self.calls)
        return np.log(np.array(self.calls)[order]), np.minimum.accumulate(np.log(np.array(self.errors)[order]))

    def calls_for(self, error: float) -> float:
        """Calls that an error takes, infinite if no run is as good."""
        if not self.calls or min(self.errors) > error:
            return math.inf
        calls, errors = self.front()
        n = int(np.argmax(errors <= math.log(error)))
        if n == 0:
            return math.exp(calls[0])
        share = (errors[n - 1] - math.log(error)) / (errors[n - 1] - errors[n])
        return math.exp(calls[n - 1] + share * (calls[n] - calls[n - 1]))

    def error_after(self, calls: int) -> float:
        """Error that so many calls give, infinite if all runs take more."""
        if not self.calls or not min(self.calls) <= calls <= max(self.calls):
            return math.inf
        return math.exp(np.interp(math.log(calls), *self.front()))


def halved(case: Case, settings: dict[str, Any], calls: int, passes: int = 1) -> list[dict[str, Any]]:
    """Fixed steps, halved until a run takes more than so many calls."""
    most = math.log2(calls / (passes * len(case.fmus) * case.coarsest))
    return [{**settings, "step": case.stop / (case.coarsest * 2**n)} for n in range(int(most) + 1)]


def rival_runs(case: Case) -> dict[str, dict[str, list[dict[str, Any]]]]:
    """Settings of each rival, by algorithm."""
    ecco = {"algorithm": "ecco", "step": case.stop / 50_000.0}  # its shortest step, and its first
    iterated = {"algorithm": "iterated", "tolerance": 1e-4, "iterations": 50}
    return {
        "libcosimpy": {
            "fixed step": halved(case, {"algorithm": "jacobi"}, 200_000),
            "ECCO": [{**ecco, "tolerance": tolerance} for tolerance in 10.0 ** np.arange(0.0, -9.0, -1.0)],
        },
        "PyCosimLibrary": {
            "Jacobi": halved(case, {"algorithm": "jacobi"}, 60_000),
            "iterated Jacobi": halved(case, iterated, 20_000, PASSES),
        },
        "CoFmuPy": {
            "Gauss-Seidel": halved(case, {"algorithm": "gauss_seidel"}, 15_000),
            "iterated Gauss-Seidel": halved(case, {"algorithm": "iterated_gauss_seidel"}, 15_000, PASSES),
        },
    }


def ours(case: Case, fmus: dict[str, str]) -> Iterator[Curve]:
    for name, settings in FIXED.items():
        yield _curve(case, fmus, name, halved(case, settings, MOST, PASSES if "iterate" in settings else 1))
    for name, settings in CONTROLLED.items():
        first = {**settings, "step": case.stop / case.coarsest / 4.0, "min_step": case.stop / 1e5}
        yield _curve(case, fmus, name, [{**first, "tolerance": tolerance} for tolerance in TOLERANCES])


def _curve(case: Case, fmus: dict[str, str], name: str, runs: list[dict[str, Any]]) -> Curve:
    curve, system = Curve(OURS, name), System(fmus, case.connections)
    for run in runs:
        step = run.pop("step")
        try:
            found = simulate(system, case.stop, step, outputs=list(case.signals), **run)
        except CouplingError:  # it has diverged
            continue
        rows = np.transpose([found[name].values[1:] for name in case.signals])
        calls = sum(cost["steps"] for cost in json.loads(found.attrs["cost"]).values())
        curve.add(calls, case.error(found["time"].values[1:], rows))
        if calls > MOST:
            break
    return curve


def theirs(rival: str, python: str, case: Case, fmus: dict[str, str], folder: Path) -> list[Curve]:
    """Curves of a rival; none if it is not installed."""
    algorithms = rival_runs(case)[rival]
    request = {
        "fmus": fmus,
        "connections": case.connections,
        "inputs": case.inputs,
        "bond": case.bond,
        "energy": case.energy,
        "outputs": list(case.signals),
        "stop": case.stop,
        "runs": [run for runs in algorithms.values() for run in runs],
    }
    asked, answered = folder / "request.json", folder / "answer.npz"
    asked.write_text(json.dumps(request))
    script = str(Path(__file__).with_name("masters_rivals.py"))
    command = [python, script, rival, str(asked), str(answered)]
    process = subprocess.run(command, env={**os.environ, "PYTHONHASHSEED": HASH_SEED})
    if process.returncode == UNUSABLE:
        return []
    process.check_returncode()
    answer, curves, k = np.load(answered), [], 0
    for name, runs in algorithms.items():
        curve = Curve(f"{rival} {answer['version']}", name)
        for _ in runs:
            curve.add(int(answer[f"calls_{k}"]), case.error(answer[f"times_{k}"], answer[f"rows_{k}"]))
            k += 1
        curves.append(curve)
    return curves


def shown(value: float, form: str) -> str:
    return format(value, form) if math.isfinite(value) else "-"


def table(case: Case, curves: list[Curve]) -> list[str]:
    heads = [f"calls for {error:g}" for error in case.errors] + [f"error after {calls}" for calls in CALLS]
    lines = ["| master | algorithm | " + " | ".join(heads) + " |", "|---" * (len(heads) + 2) + "|"]
    for curve in curves:
        calls = [shown(curve.calls_for(error), ".0f") for error in case.errors]
        errors = [error if error < 1.0 else math.inf for error in map(curve.error_after, CALLS)]
        cells = [curve.master, curve.algorithm, *calls, *(shown(error, ".0e") for error in errors)]
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def comparison(case: Case, curves: list[Curve]) -> Iterator[str]:
    """Rows that put our best beside the best rival."""
    for error in case.errors:
        cells, calls = [case.name, f"{error:g}"], []
        for own in (True, False):
            able = [c for c in curves if (c.master == OURS) == own and c.calls_for(error) < math.inf]
            best = min(able, key=lambda curve: curve.calls_for(error), default=None)
            calls.append(best.calls_for(error) if best else math.inf)
            cells += [best.name if best else "none", shown(calls[-1], ".0f")]
        yield f"| {' | '.join(cells)} | {shown(calls[1] / calls[0], '.1f')} |"


def plot(results: dict[str, list[Curve]]) -> None:
    figure = Figure(figsize=(11.0, 9.8), layout="constrained")
    panels = figure.subplots(2, 2).flatten()
    for axes, case in zip(panels, CASES, strict=True):
        colours = {True: iter(OUR_COLOURS), False: iter(RIVAL_COLOURS)}
        for curve in results[case.name]:
            own = curve.master == OURS
            style = {"marker": "o", "ms": 4} if own else {"marker": "x", "ls": "--", "lw": 1.2}
            axes.loglog(curve.calls, curve.errors, color=next(colours[own]), label=curve.name, **style)
        axes.set_ylim(1e-8, 3.0)
        axes.set_title(case.name)
        axes.set_xlabel("calls of fmi2DoStep, both FMUs together")
        axes.set_ylabel("error")
        axes.grid(alpha=0.3)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    figure.savefig(DOCS / "masters.png", dpi=110)


HEAD = """# The co-simulation master beside others

Written by `python -m benchmarks.coupling.masters --python CoFmuPy=INTERPRETER`; libcosimpy and PyCosimLibrary come with
`pip install -e ".[importers]"`, CoFmuPy, which requires other versions, with `pip install CoFmuPy` into a separate environment.{missing}

The same FMUs (`benchmarks/models`, C, FMI 2.0, exact for the inputs they are given) under different masters. The
error is the largest one at any communication point, of any of the compared signals, over that signal's largest value,
against a solution of the whole system by DOP853 with a relative tolerance of 1e-12. The work is the number of calls
of fmi2DoStep of both FMUs together, including iterated and rejected steps. From run to run, fixed steps were halved
and tolerances divided by ten. Between two runs the tables interpolate in the logarithms; "-" means that no run
reached the error. Runs of this master end near 30 000 calls, with tolerances from 1e-1 to 1e-6; all other settings
are defaults.

| rival | version | what it can do |
|---|---|---|
| libcosimpy | {libcosimpy} | Jacobi with inputs held; ECCO takes the next step's size from the power bond's residual and never goes back |
| PyCosimLibrary | {PyCosimLibrary} | Jacobi, Gauss-Seidel and iterated Jacobi with rollback, inputs held; iterated here to 1e-4 |
| CoFmuPy | {CoFmuPy} | Jacobi, Gauss-Seidel, and both iterated with rollback, inputs held, to 1e-3 or ten passes |

![Error against calls](masters.png)

The best run of this master beside the best of the others. Ratio: calls of the other master over those of this one.

| case | error | ours | calls | rival | calls | ratio |
|---|---|---|---|---|---|---|
"""

FOUND = """
**Findings.** With inputs held over the step and no iteration, this master and PyCosimLibrary have the same error for
the same work. libcosim needs two to three times that work: a force that depends directly on the position reaches the
other FMU one step late. (This master and PyCosimLibrary read such outputs again after setting the inputs. FMI 2.0.5,
section 4.2.4, does not provide for that without a step in between; these FMUs answer.) The other masters that iterate
stay at order 1, because they hold the inputs while they iterate: iteration improves only stability. On smooth systems
polynomials of order 1 and 2 decide; their first steps, which have no history, are repeated instead. Where the
coupling is stiff, iteration decides: the quasi-Newton method reaches the equilibrium of the contact with steps longer
than the period of its oscillation, 10 us, where fixed-point iterations and all explicit schemes fail, and passes from
sticking to slipping with steps that are far too long for explicit schemes. Inputs held to order 0 damp motions that
the steps do not resolve: order 0 suits an equilibrium, order 1 or 2 the course. Error control is expensive where it
resolves irrelevant motions: the oscillation of the first 0.2 ms of the contact, and every change between sticking and
slipping, where it needs less work than fixed steps for small errors only. Gauss-Seidel steps the FMUs in the order of
their names, which may be the worse order: at order 0 the opposite order, in CoFmuPy, takes fewer calls on the
oscillator.

Notes on the other masters. libcosim counts time in whole nanoseconds and may end one step late; with the default of
`EccoParams.max_change_rate`, 0.2, a step can only shrink (here it is 1.5), and ECCO fails in its second step if the
inputs of a bond are not observed. PyCosimLibrary expects a return value that fmpy no longer gives. CoFmuPy starts
inputs at 0 by default, labels the values after a step with the time at which the step began, takes the FMUs of a loop
in an order that changes from process to process unless PYTHONHASHSEED is set, and reads every output of an FMU of FMI
2.0 as a Real: the contact has a Boolean one, so it does not run there.
"""


def page(results: dict[str, list[Curve]], missing: list[str]) -> str:
    found = dict(curve.master.split(" ") for curves in results.values() for curve in curves if curve.master != OURS)
    versions = {rival: found.get(rival, "not installed") for rival in MODULES}
    absent = f" Not installed, so not in the tables: {', '.join(missing)}." if missing else ""
    text = HEAD.format(missing=absent, **versions)
    text += "\n".join(row for case in CASES for row in comparison(case, results[case.name])) + "\n" + FOUND
    for case in CASES:
        text += f"\n## {case.name.capitalize()}\n\n{case.text}\n\n" + "\n".join(table(case, results[case.name])) + "\n"
    return text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", metavar="RIVAL=INTERPRETER", action="append", default=[])
    pythons = dict.fromkeys(MODULES, sys.executable) | dict(a.split("=", 1) for a in parser.parse_args().python)
    results: dict[str, list[Curve]] = {}
    missing = set()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for case in CASES:
            fmus = {n: str(build(model, folder, start=start)) for n, (model, start) in case.fmus.items()}
            curves = list(ours(case, fmus))
            for rival, python in pythons.items():
                found = theirs(rival, python, case, fmus, folder)
                curves += found
                if not found:
                    missing.add(rival)
            results[case.name] = curves
            print("\n".join([*table(case, curves), *comparison(case, curves)]), flush=True)
    save("coupling/masters", page(results, sorted(missing)))
    plot(results)


if __name__ == "__main__":
    main()
