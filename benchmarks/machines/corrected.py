"""Machines corrected by the states solved again, and at the level auto: stated against true errors, cost.

    python -m benchmarks.machines.corrected solve [MACHINE ...]  # runs, and COUNT states of each: some minutes each
    python -m benchmarks.machines.corrected auto [MACHINE ...]   # the same runs at the level auto
    python -m benchmarks.machines.corrected page                 # docs/measured/machines/corrected.md, of what is kept

Every second state conditions, the others judge, and the other way round. What is solved stays in
results/machines/corrected.
"""

import argparse
import json
from dataclasses import asdict
from typing import Any

import numpy as np
import xarray as xr

from benchmarks.dependencies import kept
from benchmarks.pages import Page
from contact_core import Outputs
from contact_core.corrections.blocks import ACCURACY
from contact_core.corrections.kriging import Conditioned, Place, conditioned
from system_models.machines import reading
from system_models.machines.assembly import Assembly
from system_models.machines.corrected import corrected, deviation, knots_of, with_corrected
from system_models.machines.report import loss_error
from system_models.machines.resolve import COMPARED, Resolved, resolve
from system_models.master import simulate
from system_models.store import results

NAME = "machines/corrected"
KEPT = kept(NAME)
MACHINES = ("mtm_rig", "bearing_209", "cam_follower", "gear_fzg_c")
COUNT = 12  # states of each
SHORT = {"friction_coefficient": "friction", "h_c": "h_c"}


def assembled(machine: str, level: str) -> Assembly:
    """The machine with its contacts at a level."""
    return reading.assemble(reading.read(machine, {"contact.film.model": level}))


def run(machine: str, level: str) -> tuple[Assembly, xr.Dataset]:
    """The run at a level: as it is kept, or simulated."""
    assembly, folder = assembled(machine, level), KEPT / machine / level
    if (folder / "result.nc").exists():
        return assembly, xr.load_dataset(folder / "result.nc")
    folder.mkdir(parents=True, exist_ok=True)
    system = assembly.system(folder / "fmus")
    dataset = simulate(system, **{**assembly.settings, "outputs": assembly.outputs()})
    results.write(dataset, folder)
    return assembly, dataset


def solve(machine: str) -> None:
    """Run, and solve states again."""
    assembly, dataset = run(machine, "regression")
    file = KEPT / machine / "states.json"
    if not file.exists():
        states = resolve(assembly, dataset, lambda done: print(machine, done, flush=True), COUNT)
        file.write_text(json.dumps([asdict(state) for state in states], default=float))


def states_of(machine: str) -> list[Resolved]:
    """Return the states that can judge."""
    file = KEPT / machine / "states.json"
    rows = json.loads(file.read_text()) if file.exists() else []
    found = [
        Resolved(**row | {
            "fast": Outputs(**row["fast"]),
            "deep": Outputs(**row["deep"]) if row["deep"] else None,
            "place": Place(*row["place"]),
        })
        for row in rows
    ]  # fmt: skip
    return [state for state in found if state.solved]


def judged(states: list[Resolved]) -> list[tuple[Resolved, dict[str, Any]]]:
    """Return each state with what the half that it is not in makes of it."""
    found = []
    for half in (0, 1):
        given, rest = knots_of(states[half::2]), states[1 - half :: 2]
        here = knots_of(rest)
        told = conditioned(given, here.pairs, here.places)
        found += [
            (s, Conditioned(told.mean[k], told.left[k]).of(vars(s.fast))) for k, s in enumerate(rest)
        ]  # fmt: skip
    return found


def corrected_page(page: Page, machines: list[str]) -> None:
    """Stated and true errors of states that are no knots."""
    page.header(
        "machine", "states", "output", "true before", "stated before", "covered before", "true", "stated", "covered",
        "error of the loss before", "with 6 states",
    )  # fmt: skip
    stated_all, covered_all = list[float](), list[bool]()
    for machine in machines:
        states = states_of(machine)
        found = judged(states)
        assembly, dataset = run(machine, "regression")
        better = with_corrected(dataset, corrected(assembly, dataset, states[::2]))
        losses = [f"{loss_error(assembly, each):.0%}" for each in (dataset, better)]
        for name, error in COMPARED.items():
            before = np.array([(s.deviation(name), s.allowed(name)) for s, _ in found])
            after = np.array([(deviation(s, v, name), v[error]) for s, v in found])
            cells = [
                cell
                for pairs in (before, after)
                for cell in (*(f"{x:.1%}" for x in np.median(pairs, 0)), f"{np.mean(pairs[:, 0] <= pairs[:, 1]):.0%}")
            ]
            page.row(machine, len(found), SHORT[name], *cells, *losses)
            if name == "friction_coefficient":
                stated_all += after[:, 1].tolist()
                covered_all += (after[:, 0] <= after[:, 1]).tolist()
    median, covered = float(np.median(stated_all)), float(np.mean(covered_all))
    page.verdict("friction of states that are no knots: covered in at least 90 %", f"{covered:.0%}", covered >= 0.9)
    page.verdict("friction errors stated: at most 25 % in the median", f"{median:.1%}", median <= 0.25)


def contact_seconds(assembly: Assembly, dataset: xr.Dataset) -> float:
    """CPU of all contacts [s]."""
    cost = json.loads(dataset.attrs["cost"])
    return sum(float(cost[name]["seconds"]) for name in assembly.contacts)


def auto_page(page: Page, machines: list[str]) -> None:
    """Cost and errors of the level auto."""
    page.header(
        "machine",
        "contacts",
        "s, regression",
        "s, auto",
        "ratio",
        "rows within 10 %, regression",
        "rows within 10 %, auto",
        "median stated",
    )
    for machine in machines:
        runs = [run(machine, level) for level in ("regression", "auto")]
        seconds = [contact_seconds(*each) for each in runs]
        errors = [
            np.concatenate(
                [d[f"{n}.error_friction"].values[d[f"{n}.friction_coefficient"].values > 0.0] for n in a.contacts]
            )
            for a, d in runs
        ]
        within = [f"{np.mean(each <= ACCURACY):.0%}" for each in errors]
        ratio = seconds[1] / seconds[0]
        page.row(
            machine,
            len(runs[0][0].contacts),
            *(f"{s:.1f}" for s in seconds),
            f"{ratio:.1f}",
            *within,
            f"{np.median(errors[1]):.1%}",
        )
        page.verdict(
            f"{machine}: auto at 10 % costs at most 20 times the regression level", f"{ratio:.1f}", ratio <= 20.0
        )


def page() -> None:
    """Write what is kept."""
    text = Page(NAME, "Machines corrected by states solved again, and the level auto", options="page")
    done = [machine for machine in MACHINES if states_of(machine)]
    left = ", ".join(sorted({*MACHINES} - {*done})) or "none"
    text.say(
        f"Up to {COUNT} states of each run are solved again; every second one conditions, the others judge, and the other "
        "way round. True: deviation of the deterministic solution, relative; stated: half width; both in the median. Error "
        f"of the loss: as if all contacts were off the same way. Machines that have not been run: {left}."
    )
    corrected_page(text, done)
    autos = [machine for machine in done if (KEPT / machine / "auto" / "result.nc").exists()]
    if autos:
        text.say(
            "## The level auto\n\nCPU seconds of all contacts, with those of steps tried or repeated; rows by stated error of friction."
        )
        auto_page(text, autos)
    text.write()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=("solve", "auto", "page"))
    parser.add_argument("machines", nargs="*", default=MACHINES)
    given = parser.parse_args()
    if given.part == "page":
        page()
        return
    for machine in given.machines:
        solve(machine) if given.part == "solve" else run(machine, "auto")


if __name__ == "__main__":
    main()
