"""Two hours of rubbing: cost, errors and their causes.

    python -m benchmarks.surfaces.evolution                run what is not yet in results/surfaces/evolution, then write the page
    python -m benchmarks.surfaces.evolution grid driver    these parts only
    python -m benchmarks.surfaces.evolution --again        run everything anew, after a change of the core

Parts: control, order, grid, sensitivity, driver, memory. Writes docs/measured/surfaces.md and docs/measured/surfaces/evolution.png. One thread; a
run is found again by the fingerprint of its scene.
"""

import argparse
import hashlib
import json
import time
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.claims import kept
from benchmarks.pages import folder, save
from benchmarks.timing import work_unit
from contact_core import OperatingPoint, Scene, advance, initial_state, solve, uncertainty
from contact_core.deterministic.accumulator import Accumulator
from contact_core.deterministic.sampling import sample_dry, sample_mixed
from contact_core.scene import Case
from contact_core.surfaces.patches import track_rows

SECTION = "surfaces/evolution"
CASE, HOURS, INTERVAL = "azam_case_a", 2.0, 60.0
TIMES = np.array([5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 119])  # minutes at which runs are compared
WINDOW = 2.0  # minutes to either side over which the finer run is averaged: its rows scatter, too
NAMES = {
    "friction_coefficient": "mu",
    "h_c": "h_c",
    "lambda_ratio": "lambda",
    "contact_load_ratio": "W_c",
    "contact_area_ratio": "A_c",
    "pressure_max": "p_max",
    "tribofilm_1": "film 1",
    "tribofilm_2": "film 2",
    "wear_depth_1": "wear 1",
    "wear_depth_2": "wear 2",
    "roughness_1": "Rq 1",
    "roughness_2": "Rq 2",
}
SCATTERED = tuple(NAMES)[:6]  # outputs of the contact; films, wear and roughness run smoothly
SCALE = {"h_c": 1e9, "tribofilm": 1e9, "wear_depth": 1e9, "roughness": 1e9, "pressure_max": 1e-9}
BARE = {"tribofilm.model": "none"}
FINE = {"control.change": "0.3 nm", "control.longest": "12 s"}  # a tenth of the shipped blocks
again = False


def scene_of(changes: dict[str, str], case: str = CASE) -> Scene:
    return Scene.from_toml(case, changes)


def run(changes: dict[str, str], case: str = CASE) -> dict[str, np.ndarray]:
    """Rows of two hours: outputs, their half widths (`time_...`, `sampling_...`), blocks, seconds and work units."""
    scene = scene_of(changes, case)
    text = json.dumps([scene.to_dict(), HOURS, INTERVAL], sort_keys=True)
    file = kept(SECTION) / f"{case}-{hashlib.sha256(text.encode()).hexdigest()[:12]}.npz"
    if again or not file.exists():
        compute(scene, file)
    with np.load(file) as stored:
        return dict(stored)


def compute(scene: Scene, file: Path) -> None:
    op: OperatingPoint = scene.operation.point
    solve(scene, op, initial_state(scene), dry=True)  # compiled and planned
    solve(scene, op, initial_state(scene))
    start, rows, widths = time.process_time(), [], []
    state, out = advance(scene, op, initial_state(scene), 0.0)
    for k in range(round(HOURS * 3600.0 / INTERVAL) + 1):
        if k:
            state, out = advance(scene, op, state, INTERVAL)
        rows.append(asdict(out))
        widths.append(uncertainty(scene, state))
    seconds = time.process_time() - start
    found = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    for k, kind in enumerate(("time", "sampling")):
        found |= {f"{kind}_{name}": np.array([width[name][k] for width in widths]) for name in widths[0]}
    found["minutes"] = np.arange(len(rows)) * INTERVAL / 60.0
    found["seconds"], found["units"] = np.array(seconds), np.array(seconds / work_unit(scene.film.points))
    found["blocks"] = found["blocks_dry"] + found["blocks_mixed"] + found["blocks_fallback"]
    np.savez_compressed(file, **found)
    print(f"{file.name}: {seconds:.0f} s, {found['blocks'][-1]:.0f} blocks", flush=True)


def at(found: dict[str, np.ndarray], name: str, smooth: bool) -> np.ndarray:
    """Values at `TIMES`; of a straight line through the rows nearby if they are to be smooth."""
    minutes, values = found["minutes"], found[name]
    if not smooth:
        return np.interp(TIMES, minutes, values)
    lines = []
    for t in TIMES:
        near = np.abs(minutes - t) <= WINDOW
        lines.append(np.polyval(np.polyfit(minutes[near] - t, values[near], 1), 0.0))
    return np.array(lines)


def errors(found: dict[str, np.ndarray], control: dict[str, np.ndarray]) -> dict[str, tuple[float, float]]:
    """Rms error over `TIMES`, relative, and the share of the times at which it is within the reported half widths."""
    result = {}
    for name in NAMES:
        mine, true = at(found, name, False), at(control, name, name in SCATTERED)
        parts = [np.interp(TIMES, found["minutes"], found[f"{kind}_{name}"]) for kind in ("time", "sampling")]
        width = np.hypot(*parts)
        rms = float(np.sqrt(np.mean((mine / true - 1.0) ** 2)))
        result[name] = rms, float(np.mean(np.abs(mine - true) <= width))
    return result


def table(head: list[str], rows: list[list[str]]) -> list[str]:
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *("| " + " | ".join(row) + " |" for row in rows)]


def cost(found: dict[str, np.ndarray]) -> list[str]:
    return [f"{found['blocks'][-1]:.0f}", f"{float(found['seconds']):.1f}", f"{float(found['units']):.3g}"]


COST = ["blocks", "s", "WU"]


def control() -> list[str]:
    """The shipped control against one ten times finer in time."""
    lines, rows, bars = [], [], []
    for driver in ("dry", "mixed"):
        reference = run({"control.driver": driver} | FINE)
        found = run({"control.driver": driver})
        rows.append([driver, *cost(found), *(f"{100 * e:.1f} ({c:.2f})" for e, c in errors(found, reference).values())])
        bars += judged(driver, errors(found, reference))
        rows.append([f"{driver}, 10x finer", *cost(reference), *("" for _ in NAMES)])
    lines += [
        "Rms error over 13 times from 5 to 119 min in per cent, and in brackets the share of these times at which the error is",
        "within the reported half widths (time and sampling).",
        "",
        *table(["driver", *COST, *NAMES.values()], rows),
        "",
        *table(["asked", "found", "met"], bars),
        "",
        "Half widths at 60 min, by time steps / by sampling, in per cent of the value:",
        "",
    ]
    rows = []
    for driver in ("dry", "mixed"):
        found = run({"control.driver": driver})
        cells = [
            f"{100 * found[f'time_{n}'][60] / abs(found[n][60]):.1f} / {100 * found[f'sampling_{n}'][60] / abs(found[n][60]):.1f}"
            for n in NAMES
        ]
        rows.append([driver, *cells])
    return lines + table(["driver", *NAMES.values()], rows)


def judged(driver: str, found: dict[str, tuple[float, float]]) -> list[list[str]]:
    """Return the requirement on a run against its control, and whether it is met."""
    most, names = (
        (0.03, list(NAMES))
        if driver == "dry"
        else (0.05, [n for n in NAMES if n[:4] in ("fric", "h_c", "trib", "wear")])
    )
    above = [f"{NAMES[n]} {100 * found[n][0]:.1f} %" for n in names if found[n][0] > most]
    worst = max(found[n][0] for n in names if f"{NAMES[n]} {100 * found[n][0]:.1f} %" not in above)
    told = (
        f"{', '.join(above)} above; the others {100 * worst:.1f} % at most" if above else f"{100 * worst:.1f} % at most"
    )
    kind = "every observable" if driver == "dry" else "mu, h_c, films, wear"
    rows = [[f"{driver}: {kind} within {100 * most:.0f} % rms", told, "**no**" if above else "yes"]]
    names = list(NAMES) if driver == "dry" else ["contact_area_ratio", "contact_load_ratio"]
    outside = [f"{NAMES[n]} at {found[n][1]:.2f} of the times" for n in names if found[n][1] < 0.9]
    kind = "every observable" if driver == "dry" else "A_c, W_c"
    rows.append(
        [
            f"{driver}: {kind} within the half widths (two sigma) at 0.9 of the times",
            ", ".join(outside) or "all",
            "**no**" if outside else "yes",
        ]
    )
    return rows


ORDER = ((24, 960), (12, 480), (6, 240), (3, 120))  # control.change [nm] and control.longest [s]


def order() -> list[str]:
    """Dry-driven: error against the length of blocks at fine sampling, and against sampling at short blocks."""
    reference = run(
        {"control.driver": "dry", "control.dry_instants": "16", "control.change": "0.75 nm", "control.longest": "30 s"}
    )
    shown = (
        "wear_depth_1",
        "wear_depth_2",
        "tribofilm_1",
        "tribofilm_2",
        "h_c",
        "contact_area_ratio",
        "roughness_1",
        "roughness_2",
    )
    rows, series = [], []
    for change, longest in ORDER:
        found = run(
            {
                "control.driver": "dry",
                "control.dry_instants": "16",
                "control.change": f"{change} nm",
                "control.longest": f"{longest} s",
            }
        )
        e = errors(found, reference)
        series.append((found["blocks"][-1], e))
        rows.append([f"{change} nm", "16", *cost(found), *(f"{100 * e[n][0]:.2f}" for n in shown)])
    for instants in (1, 2, 4, 8):
        found = run({"control.driver": "dry", "control.dry_instants": f"{instants}"})
        e = errors(found, reference)
        rows.append(["3 nm", str(instants), *cost(found), *(f"{100 * e[n][0]:.2f}" for n in shown)])
    blocks = np.log([n for n, _ in series])
    slopes = [f"{-np.polyfit(blocks, np.log([e[n][0] for _, e in series]), 1)[0]:.1f}" for n in shown]
    rows.append(["order in blocks", "", "", "", "", *slopes])
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.add_subplot()
    for n in shown:
        axes.loglog([b for b, _ in series], [100 * e[n][0] for _, e in series], "o-", label=NAMES[n])
    axes.loglog([20, 200], [10, 1], "k:", label="first order")
    axes.set_xlabel("blocks in two hours")
    axes.set_ylabel("rms error over time [%]")
    axes.legend(fontsize="x-small")
    figure.savefig(folder("surfaces") / "evolution.png", dpi=130)
    return [
        "Dry-driven, rms error over time in per cent against blocks of 0.75 nm with 16 instants each. First the length of the blocks,",
        "then the instants of a block. Euler's steps are of first order; the roughness of the ball is sampling noise: it falls with",
        "the product of blocks and instants.",
        "",
        *table(["control.change", "instants", *COST, *(NAMES[n] for n in shown)], rows),
        "",
        "![error against the number of blocks](evolution.png)",
    ]


def values(found: dict[str, np.ndarray], minute: int) -> list[str]:
    cells = []
    for name in NAMES:
        scale = next((s for key, s in SCALE.items() if name.startswith(key)), 1.0)
        cells.append(f"{found[name][minute] * scale:.3g}")
    return cells


UNITS = "h_c, films, wear and Rq in nm, p_max in GPa"


def grid() -> list[str]:
    """Grids of 65 to 257 nodes, mixed- and dry-driven, with the additive and without."""
    rows = []
    for points in (65, 129, 257):
        for driver, extra, text in (
            ("mixed", {}, "with"),
            ("mixed", BARE, "without"),
            ("dry", {}, "with"),
            ("dry", BARE, "without"),
        ):
            if points == 257 and (driver, text) == ("mixed", "without"):
                continue
            found = run({"film.points": str(points), "control.driver": driver} | extra)
            rows.append(
                [str(points), driver, text, *cost(found), f"{100 * smooth_error(points):.0f}", *values(found, 120)]
            )
    return [
        f"After two hours, at t = 120 min; {UNITS}. `smooth`: error of h_central of smooth bodies on that grid in per cent, against",
        "the value extrapolated from 257 and 513 nodes, the accuracy of a film without roughness on that grid. 257 nodes mixed-driven without the additive are left out, as they take ten minutes.",
        "",
        *table(["nodes", "driver", "additive", *COST, "smooth", *NAMES.values()], rows),
    ]


@cache
def smooth_film(points: int) -> float:
    smooth = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "film.tolerance": "1e-4"}
    scene = scene_of({"film.points": str(points)} | smooth | BARE)
    return float(solve(scene, scene.operation.point, initial_state(scene)).gap[points // 2, points // 2])


def smooth_error(points: int) -> float:
    fine, finer = smooth_film(257), smooth_film(513)
    return smooth_film(points) / (finer + (finer - fine) / 3.0) - 1.0


def sensitivity() -> list[str]:
    """Inputs that the thesis does not give."""
    rows = []
    for length in (4, 8, 16, 32):
        lengths = {f"surface_{i}.correlation_length": f"{length} um" for i in (1, 2)}
        found = run(lengths | {"control.driver": "mixed"})
        rows += [[f"correlation length {length} um", f"{m} min", *values(found, m)] for m in (0, 20, 120)]
    for floor in (0.5, 2.0, 4.0):
        found = run({"film.floor": f"{floor} nm", "control.driver": "mixed"})
        rows += [[f"floor {floor} nm", f"{m} min", *values(found, m)] for m in (0, 20, 120)]
    for name, changes in {
        "dose: contact_length": {"tribofilm.dose": "contact_length"},
        "hardness: total indentation": {"plasticity.indentation": "total"},
        "change 3 nm, floor 1 nm, 8 um (shipped)": {},
    }.items():
        found = run(changes | {"control.driver": "mixed"})
        rows += [[name, f"{m} min", *values(found, m)] for m in (0, 20, 120)]
    return [f"Mixed-driven, 129 nodes; {UNITS}.", "", *table(["input", "t", *NAMES.values()], rows)]


def driver() -> list[str]:
    """At the same surfaces: mixed lubrication and dry contact."""
    rows = []
    for case in (CASE, "mtm_zddp"):
        scene = scene_of(
            {"control.driver": "mixed", "control.mixed_instants": "128", "control.dry_instants": "32"}, case
        )
        shipped, op = scene_of({"control.driver": "mixed"}, case), scene.operation.point
        state = initial_state(scene)
        for minutes in (1, 4, 5, 10, 20, 20):
            state, _ = advance(shipped, op, state, 60.0 * minutes)
            mixed = Accumulator.before(state)
            sample_mixed(Case(scene, op), state, mixed, True)
            dry = Accumulator.before(state)
            sample_dry(Case(scene, op), state, dry, True)
            for name, sweep in (("mixed", mixed), ("dry", dry)):
                m = sweep.means()
                rows.append(
                    [case, f"{state.time / 60:.0f}", name, f"{m['contact_load_ratio']:.3f}", f"{m['contact_area_ratio']:.3f}",
                     f"{abs(m['friction_force']) / op.load:.4f}", f"{m['h_c'] * 1e9:.1f}", f"{m['lambda_ratio']:.3f}", f"{m['pressure_max'] * 1e-9:.2f}"]
                )  # fmt: skip
    lines = table(["case", "min", "contact", "W_c", "A_c", "mu", "h_c [nm]", "lambda", "p_max [GPa]"], rows)
    two_hours = []
    for case in (CASE, "mtm_zddp"):
        mixed = run({"control.driver": "mixed"}, case)
        found = run({"control.driver": "dry"}, case)
        blocks = f"{found['blocks_dry'][-1]:.0f}"
        two_hours.append(
            [case, "dry", *cost(found), blocks, *(f"{100 * e:.1f}" for e, _ in errors(found, mixed).values())]
        )
    return [
        "The same surfaces, solved two ways: a mixed march over one pass, and 32 dry instants.",
        "",
        *lines,
        "",
        "Two hours driven dry, against the mixed-driven run, rms over time in per cent:",
        "",
        *table(["case", "driver", *COST, "dry blocks", *NAMES.values()], two_hours),
    ]


def memory() -> list[str]:
    """The Reynolds time scale in a block: steady snapshots against the march."""
    rows = []
    for case in (CASE, "mtm_zddp"):
        for changes in ({}, {f"surface_{i}.correlation_length": "16 um" for i in (1, 2)}):
            scene = scene_of({"control.driver": "mixed", "control.mixed_instants": "128"} | changes, case)
            shipped, op = scene_of({"control.driver": "mixed"} | changes, case), scene.operation.point
            state, _ = advance(shipped, op, initial_state(scene), 0.0)
            for minutes in (0, 20):
                state, _ = advance(shipped, op, state, 60.0 * minutes)
                march, steady = Accumulator.before(state), Accumulator.before(state)
                sample_mixed(Case(scene, op), state, march, True)
                for k in range(8):
                    offsets = [
                        (body.offset + (k + 1) * g * scene.film.domain) % scene.film.domain
                        for body, g in zip(state.bodies, (0.7549, 0.5698), strict=True)
                    ]
                    first, second = (replace(body, offset=o) for body, o in zip(state.bodies, offsets, strict=True))
                    moved = replace(state, bodies=(first, second))
                    steady.add(scene, op, moved, solve(scene, op, moved))
                still = Accumulator.before(state)
                sample_mixed(Case(scene, op), state, still, True, jumping=False)
                for name, sweep in (("march", march), ("march without jumps", still), ("steady", steady)):
                    m = sweep.means()
                    rows.append([case, f"{scene.surface_2.correlation_length * 1e6:.0f} um", f"{minutes}", name, f"{sweep.unconverged} of {sweep.count}",
                                 *(f"{m[n]:.3f}" for n in ("contact_load_ratio", "contact_area_ratio")), f"{m['h_c'] * 1e9:.1f}", f"{abs(m['friction_force']) / op.load:.4f}", *(f"{touched(scene, sweep, i):.2f}" for i in (0, 1))])  # fmt: skip
    return [
        "One block, the same surfaces: a march of the moving roughness over one pass, and 8 steady films at offsets of low discrepancy.",
        "In near rolling the pattern of the film moves with the roughness, which a steady film does not represent. Without jumps the same points of the two bodies stay in contact over the whole pass. `touched`: share of the track |y| < a that any instant of the pass",
        "touched; with jumps a pass represents the many real passes of a block, in which the ball keeps meeting new asperities.",
        "",
        *table(
            [
                "case",
                "correlation length",
                "min",
                "film",
                "not converged",
                "W_c",
                "A_c",
                "h_c [nm]",
                "mu",
                "touched, ball",
                "touched, disc",
            ],
            rows,
        ),
    ]


def touched(scene: Scene, sweep: Accumulator, i: int) -> float:
    rows = track_rows(scene, sweep.since[i].shape[0])
    return float((sweep.exposures[i][rows] > 0.0).mean())


PARTS = {part.__name__: part for part in (control, order, grid, sensitivity, driver, memory)}


def main() -> None:
    global again
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"of {', '.join(PARTS)} (all)")
    parser.add_argument("--again", action="store_true", help="run anew what is stored")
    args = parser.parse_args()
    unknown = set(args.parts) - set(PARTS)
    if unknown:
        raise SystemExit(f"{', '.join(unknown)}: no such part. There are {', '.join(PARTS)}.")
    again = args.again
    for name in args.parts or PARTS:
        (kept(SECTION) / f"{name}.md").write_text("\n".join(PARTS[name]()) + "\n")
    page = [
        f"# Two hours of rubbing: cost, error and its causes ({CASE})",
        "",
        "Written by `python -m benchmarks.surfaces.evolution`. One thread; CPU seconds on a shared machine; one work unit (WU) is a",
        "deformation convolution on the same grid. Outputs are explained in `contact_core/quantities.py`.",
    ]
    for name, part in PARTS.items():
        text = kept(SECTION) / f"{name}.md"
        if text.exists():
            page += [
                "",
                f"## {part.__doc__.splitlines()[0].rstrip('.')} (`{name}`)",
                "",
                *text.read_text().splitlines(),
            ]
    save(SECTION, "\n".join(page))


if __name__ == "__main__":
    main()
