"""Accuracy of the co-simulation master: orders, requested and reached tolerances, a stiff contact.

    python -m benchmarks.coupling.accuracy

Writes docs/measured/coupling.md and docs/measured/coupling/accuracy.png. The errors are those against solutions of the coupled
equations as a whole. Orders: the largest error of the positions and speeds at the end, the course before t = 0 being
exact. Tolerances: the root mean square of the errors of positions and speeds, each over the largest value of its own,
at its largest over the run, looked at in 300 rows. The work is the number of calls of doStep, of all FMUs together.
"""

import json
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from benchmarks.models import build, exact
from benchmarks.pages import folder, save
from system_models.master import CouplingError, System, simulate

Solution = Callable[[np.ndarray], np.ndarray]
Settings = dict[str, Any]

STEPS, STOP = (0.04, 0.02, 0.01, 0.005), 2.0  # s
STATES = ("one.x", "two.x", "one.v", "two.v")
REFERENCE = {  # errors at the largest and the smallest step, by an own calculation with exact solvers
    ("f-d", "jacobi", False): ((7.5e-1, 8.2e-2), (4.7e-2, 5.4e-4), (2.4e-2, 4.7e-5)),
    ("f-d", "gauss_seidel", False): ((4.8e-1, 5.6e-2), (3.1e-2, 3.7e-4), (1.9e-2, 3.7e-5)),
    ("d-d", "jacobi", False): ((4.7e-1, 5.4e-2), (4.4e-2, 5.3e-4), (1.4e-2, 2.9e-5)),
    ("d-d", "gauss_seidel", False): ((1.8e-1, 2.3e-2), (2.7e-2, 4.3e-4), (9.9e-3, 1.8e-5)),
}
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
CONTROLLED: dict[str, Settings] = {
    "Jacobi, order 1": {"order": 1},
    "Jacobi, order 2": {"order": 2},
    "Gauss-Seidel, order 2": {"algorithm": "gauss_seidel", "order": 2},
    "quasi-Newton, order 2": {"iterate": "quasi_newton", "order": 2},
}
ROWS = 300
CONTACT = {1e-6: 400, 1e-5: 100, 1e-4: 100}  # s: steps
AT_REST = 1.0795e-6  # m
STIFF: dict[str, Settings] = {
    "Jacobi, order 0": {},
    "Jacobi, order 1": {"order": 1},
    "Jacobi, order 0, derivatives": {},
    "Gauss-Seidel, order 0": {"algorithm": "gauss_seidel"},
    "Gauss-Seidel, order 1": {"algorithm": "gauss_seidel", "order": 1},
    "fixed point, order 0": {"iterate": "fixed_point"},
    "Aitken, order 0": {"iterate": "aitken"},
    "quasi-Newton, order 0": {"iterate": "quasi_newton"},
    "quasi-Newton, order 1": {"iterate": "quasi_newton", "order": 1},
    "quasi-Newton, Gauss-Seidel, order 0": {"iterate": "quasi_newton", "algorithm": "gauss_seidel"},
}


def oscillator(folder: Path, kind: str) -> System:
    if kind == "f-d":
        fmus = {"one": build("mass_1_force", folder), "two": build("mass_2_spring", folder)}
        return System(fmus, [("one.x", "two.x1"), ("one.v", "two.v1"), ("two.F", "one.F")])
    fmus = {"one": build("mass_1_displacement", folder), "two": build("mass_2_displacement", folder)}
    pairs = (("one", "two"), ("two", "one"))
    return System(fmus, [(f"{a}.{name}", f"{b}.{name}_other") for a, b in pairs for name in "xv"])


def quarter_car(folder: Path) -> System:
    fmus = {"wheel": build("wheel_force", folder), "chassis": build("chassis_spring", folder)}
    connections = [("wheel.x", "chassis.x_wheel"), ("wheel.v", "chassis.v_wheel"), ("chassis.F", "wheel.F")]
    return System(fmus, connections, {"wheel.road": 0.1})


def stick_slip(folder: Path) -> System:
    fmus = {"block": build("block", folder), "friction": build("friction", folder)}
    return System(fmus, [("block.u", "friction.u"), ("friction.F", "block.F")])


def course() -> dict[str, Callable[[float], float]]:
    """The oscillator's coupled outputs at any time."""
    found: dict[str, Callable[[float], float]] = {
        name: lambda time, n=n: exact.two_mass(time)[0, n] for n, name in enumerate(STATES)
    }

    def force(time: float) -> float:
        x1, x2, v1, v2 = exact.two_mass(time)[0]
        return 10.0 * (x2 - x1) + 0.1 * (v2 - v1)

    return found | {"two.F": force}


class Order(NamedTuple):
    """Errors of a scheme at all steps."""

    kind: str
    algorithm: str
    iterated: bool
    order: int
    errors: list[float]

    @property
    def found(self) -> float:
        """The order of convergence."""
        return float(np.log2(self.errors[-2] / self.errors[-1]))

    @property
    def reference(self) -> tuple[float, float] | None:
        """The errors that are known, at the largest and the smallest step."""
        known = REFERENCE.get((self.kind, self.algorithm, self.iterated))
        return known[self.order] if known else None


def orders(folder: Path) -> Iterator[Order]:
    history, end = course(), exact.two_mass(STOP)[0]
    for kind in ("f-d", "d-d"):
        system = oscillator(folder, kind)
        for iterate in (None, "fixed_point"):
            for algorithm in ("jacobi", "gauss_seidel"):
                for order in (0, 1, 2):
                    errors = []
                    for step in STEPS:
                        data = simulate(
                            system, STOP, step, algorithm=algorithm, order=order, iterate=iterate,
                            iteration_tolerance=1e-11 if iterate else None, history=history, outputs=STATES,
                        )  # fmt: skip
                        errors.append(max(abs(data[name].values[-1] - end[n]) for n, name in enumerate(STATES)))
                    yield Order(kind, algorithm, bool(iterate), order, errors)


class Case(NamedTuple):
    """A system, how long it runs and after which time [s] its errors have died out or no longer matter."""

    name: str
    make: Callable[[Path], System]
    states: tuple[str, ...]
    solution: Solution
    stop: float
    horizon: float


CASES = (
    Case("oscillator", lambda folder: oscillator(folder, "f-d"), STATES, exact.two_mass, 5.0, 2.0),
    Case("quarter car", quarter_car, ("wheel.x", "chassis.x", "wheel.v", "chassis.v"), exact.quarter_car, 2.0, 0.5),
    Case("stick-slip", stick_slip, ("block.x", "block.v"), exact.stick_slip, 3.0, 1.0),
)


class Run(NamedTuple):
    """A run: requested tolerance and reached error."""

    case: str
    scheme: str
    horizon: float
    tolerance: float
    error: float
    attributes: dict[str, Any]

    @property
    def calls(self) -> int:
        """Calls of doStep."""
        return called(self.attributes)


def called(attributes: dict[str, Any]) -> int:
    return sum(cost["steps"] for cost in json.loads(attributes["cost"]).values())


def runs(folder: Path) -> Iterator[Run]:
    for case in CASES:
        system = case.make(folder)
        found = []
        for horizon in (case.stop, case.horizon):
            for scheme, settings in CONTROLLED.items():
                for tolerance in TOLERANCES:
                    data = simulate(
                        system, case.stop, 1e-3, tolerance=tolerance, horizon=horizon, outputs=case.states, **settings
                    )
                    rows = np.unique(np.linspace(0, data.sizes["time"] - 1, ROWS).astype(int))
                    found.append((scheme, horizon, tolerance, data.isel(time=rows)))
        times, back = np.unique(np.concatenate([data.time.values for *_, data in found]), return_inverse=True)
        solution = case.solution(times)
        truths = np.split(solution[back], np.cumsum([data.sizes["time"] for *_, data in found])[:-1])
        for (scheme, horizon, tolerance, data), truth in zip(found, truths, strict=True):
            errors = (np.stack([data[name].values for name in case.states], 1) - truth) / abs(solution).max(0)
            error = float(np.sqrt((errors**2).mean(1)).max())
            yield Run(case.name, scheme, horizon, tolerance, error, data.attrs)


class Contact(NamedTuple):
    """Position of the pressed mass at the end, or the reason why the run failed."""

    step: float
    scheme: str
    place: float  # over that at rest
    passes: float
    missed: int
    reason: str = ""

    @property
    def rests(self) -> bool:
        """Whether the mass is at rest and every step has converged."""
        return abs(self.place - 1.0) < 0.01 and not self.missed


def contacts(folder: Path) -> Iterator[Contact]:
    fmus = {"contact": build("contact_point", folder), "mass": build("point_mass", folder)}
    wires = [("mass.x", "contact.x"), ("mass.v", "contact.v"), ("contact.F", "mass.F")]
    slopes = {("contact.F", f"contact.{by}"): f"contact.dF_d{by}" for by in "xv"}
    for step, steps in CONTACT.items():
        for scheme, settings in STIFF.items():
            system = System(fmus, wires, derivatives=slopes if "derivatives" in scheme else None)
            try:
                data = simulate(system, steps * step, step, outputs=["mass.x"], **settings)
            except CouplingError as error:
                yield Contact(step, scheme, np.nan, np.nan, 0, str(error).partition(". ")[0])
                continue
            last, made = data["mass.x"].values[-1] / AT_REST, data.attrs["iterations"] / data.attrs["steps"]
            yield Contact(step, scheme, last, made, data.attrs["unconverged"])


def contact_rows(found: list[Contact]) -> Iterator[str]:
    for c in found:
        cells = c.reason + " | |" if c.reason else f"{c.place:.6g} | {c.passes:.2f} | {c.missed} of {CONTACT[c.step]}"
        yield f"| {c.step:g} | {c.scheme} | {cells} |"


def order_rows(found: list[Order]) -> Iterator[str]:
    for o in found:
        errors = " | ".join(f"{error:.2e}" for error in o.errors)
        known = " ... ".join(f"{error:.1e}" for error in o.reference) if o.reference else ""
        scheme = f"{o.kind} {o.algorithm.replace('_', '-')}{' iterated' if o.iterated else ''}"
        yield f"| {scheme} | {o.order} | {errors} | {o.found:.2f} | {known} |"


def exponent(runs: list[Run]) -> float:
    """Return the exponent of the work over the tolerance, between the last two tolerances."""
    return float(-np.log(runs[-1].calls / runs[-2].calls) / np.log(runs[-1].tolerance / runs[-2].tolerance))


def grouped(found: list[Run]) -> dict[tuple[str, float, str], list[Run]]:
    groups: dict[tuple[str, float, str], list[Run]] = {}
    for run in found:
        groups.setdefault((run.case, run.horizon, run.scheme), []).append(run)
    return groups


def tolerance_rows(found: list[Run]) -> Iterator[str]:
    for (case, horizon, scheme), group in grouped(found).items():
        cells = " | ".join(f"{run.error / run.tolerance:.2f} ({run.calls})" for run in group)
        missed = sum(run.attributes["below_min_step"] for run in group)
        expected = 1.0 / (CONTROLLED[scheme]["order"] + 1)
        yield f"| {case} | {horizon:g} | {scheme} | {cells} | {exponent(group):.2f} ({expected:.2f}) | {missed} |"


def plot(rates: list[Order], found: list[Run]) -> None:
    figure = Figure(figsize=(13, 4.4), layout="constrained")
    by_step, by_tolerance, by_calls = figure.subplots(1, 3)
    for o in rates:
        if o.kind == "f-d" and o.algorithm == "jacobi":
            style = {"marker": "s", "ls": "--"} if o.iterated else {"marker": "o"}
            label = f"{'iterated' if o.iterated else 'Jacobi'}, order {o.order}"
            by_step.loglog(STEPS, o.errors, color=f"C{o.order}", label=label, **style)
    by_step.set(xlabel="step [s]", ylabel="error at 2 s", title="two-mass oscillator, f-d, fixed steps")
    by_step.set_xticks(STEPS, [f"{step:g}" for step in STEPS])
    by_step.minorticks_off()
    shown = [case.horizon for case in CASES]
    for (case, horizon, scheme), group in grouped(found).items():
        place = [c.name for c in CASES].index(case)
        if horizon != shown[place]:
            continue
        number = list(CONTROLLED).index(scheme)
        style = {"color": f"C{number}", "marker": "osD"[place], "ls": ("-", "--", ":")[place], "ms": 5}
        label = f"{case}, {scheme}"
        by_tolerance.loglog(TOLERANCES, [run.error for run in group], label=label, **style)
        by_calls.loglog([run.calls for run in group], [run.error for run in group], **style)
    by_tolerance.fill_between(
        TOLERANCES, np.array(TOLERANCES) * 3, np.array(TOLERANCES) / 3, color="0.9", label="within 3"
    )
    by_tolerance.set(xlabel="tolerance", ylabel="largest error", title="error control, the shorter horizon")
    by_calls.set(xlabel="calls of doStep", ylabel="largest error", title="the same by work")
    by_step.legend(fontsize=7)
    figure.legend(*by_tolerance.get_legend_handles_labels(), loc="outside right center", fontsize=7)
    figure.savefig(folder("coupling") / "accuracy.png", dpi=120)


def shown(rows: Iterator[str]) -> list[str]:
    found = []
    for line in rows:
        print(line, flush=True)
        found.append(line)
    return found


def findings(rates: list[Order], found: list[Run]) -> Iterator[str]:
    """Yield the findings of the tables."""
    off = max(abs(o.found - o.order - 1) for o in rates if not o.iterated)
    ratios = [
        error / known
        for o in rates
        if o.reference
        for error, known in zip(o.errors[:: len(STEPS) - 1], o.reference, strict=True)
    ]
    yield f"Orders: order of hold + 1 within {off:.2f} for all explicit schemes; errors {min(ratios):.2f} to {max(ratios):.2f} of the reference."
    for case in CASES:
        for horizon in (case.stop, case.horizon):
            own = [run for run in found if (run.case, run.horizon) == (case.name, horizon)]
            over = [run for run in own if run.error > 3.0 * run.tolerance]
            factors = [run.error / run.tolerance for run in own]
            yield (
                f"- {case.name}, horizon {horizon:g} s: {min(factors):.2g} to {max(factors):.2g} of the tolerance, "
                f"{len(over)} of {len(own)} runs above three times it"
                + (": " + "; ".join(f"{r.scheme} at {r.tolerance:g}" for r in over) if over else "")
                + f"; {sum(r.error < r.tolerance / 3.0 for r in own)} below a third."
            )


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rates = list(orders(folder))
        order_lines = shown(order_rows(rates))
        found = list(runs(folder))
        tolerance_lines = shown(tolerance_rows(found))
        pressed = list(contacts(folder))
        contact_lines = shown(contact_rows(pressed))
    rests = [
        f"{step:g} s: {', '.join(c.scheme for c in pressed if c.step == step and c.rests) or 'none'}"
        for step in CONTACT
    ]
    plot(rates, found)
    lines = [
        "# Accuracy of the co-simulation master",
        "",
        "Written by `python -m benchmarks.coupling.accuracy`, which describes the measurement.",
        "",
        "![Accuracy](accuracy.png)",
        "",
        *shown(findings(rates, found)),
        "",
        "## Orders",
        "",
        f"Two-mass oscillator, errors at {STOP:g} s by step [s]. An iterated scheme interpolates; with order 0 it holds the",
        "value at the end. The last column has the errors at the largest and the smallest step by an independent calculation",
        "with exact solvers; iterated schemes have none, because it stops after one pass.",
        "",
        f"| scheme | order of hold | {' | '.join(f'{step:g}' for step in STEPS)} | order | reference |",
        "|---|" + "---|" * (len(STEPS) + 3),
        *order_lines,
        "",
        "## Tolerances",
        "",
        "Largest error over the requested tolerance, with calls of doStep in parentheses. The horizon [s] is the time over which errors may add up to the tolerance: first the whole run, as by default, then a shorter one. The work should grow",
        "by the exponent in parentheses. The last column counts steps at min_step whose error is larger than allowed.",
        "",
        f"| system | horizon | scheme | {' | '.join(f'{tolerance:g}' for tolerance in TOLERANCES)} | exponent | below min_step |",
        "|---|---|---|" + "---|" * (len(TOLERANCES) + 2),
        *tolerance_lines,
        "",
        "## Stiff contact",
        "",
        "1 g pressed into a contact by 300 N, at rest at x / x_eq = 1. "
        + ", ".join(f"{n} steps of {h:g} s" for h, n in CONTACT.items())
        + ".",
        "",
        "| step [s] | scheme | x / x_eq at the end | passes per step | not converged |",
        "|---|---|---|---|---|",
        *contact_lines,
        "",
        "At rest to 1 %, and converged in every step: " + "; ".join(rests) + ".",
        "A negative x is a mass that has left the contact.",
    ]
    save("coupling/accuracy", "\n".join(lines))


if __name__ == "__main__":
    main()
