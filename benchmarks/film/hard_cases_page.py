"""The page of the hard cases: tables and a map of the rows in results/film/hard_cases."""

import sys
from collections import Counter
from dataclasses import fields
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.film.hard_cases_kept import GRIDS, NODES, TOLERANCE, folder, read
from benchmarks.film.independent import LIMITS, Judgement, limit
from benchmarks.film.random_points import ROWS
from benchmarks.pages import folder as pictures_of
from benchmarks.pages import save

Array = np.ndarray


def _numbers(lines: list[dict[str, str]], name: str) -> Array:
    return np.array([float(line[name]) if line[name] else np.nan for line in lines])


def _failures(line: dict[str, str]) -> list[str]:
    """Limits that a line is not within; a time step makes up for what it owes in the next one."""
    if not line["force"]:  # not checked
        return []
    names = [name for name in LIMITS if not ("step" in line["name"] and name == "imbalance")]
    return [name for name in names if not abs(float(line[name])) < limit(name, float(line["beyond"]))]


def _check_table(good: list[dict[str, str]]) -> list[str]:
    text = [
        "",
        "The check of the converged points:",
        "",
        "| | median | 99 % | worst | limit |",
        "|---|---|---|---|---|",
    ]
    for entry in fields(Judgement):
        values = np.abs(_numbers(good, entry.name))
        limit = f"{LIMITS[entry.name]:g}" if entry.name in LIMITS else ""
        found = (np.median(values), np.quantile(values, 0.99), values.max())
        text.append(f"| {entry.name} | {' | '.join(f'{value:.2g}' for value in found)} | {limit} |")
    return text


def _random_tables(lines: list[dict[str, str]]) -> list[str]:
    converged = _numbers(lines, "converged") == 1.0
    checked = any(line["force"] for line in lines)
    wrong = [line for line, good in zip(lines, converged, strict=True) if good and _failures(line)]
    dropped = int(_numbers(lines, "number").max()) - int(_numbers(lines, "case").max())
    share = 100.0 * converged.mean()
    text = [
        f"{len(lines)} points, {dropped} more were dropped. **{int(converged.sum())} ({share:.2f} %) "
        f"have converged{f'; {len(wrong)} of them fail the check' if checked else ''}.**",
        "",
        "| Moes' M | points | converged | median ms | 90 % ms | iterations | found by (points) |",
        "|---|---|---|---|---|---|---|",
    ]
    load, ms, steps = (_numbers(lines, name) for name in ("moes_load", "ms", "iterations"))
    edges = [0.0, 1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e300, np.inf]
    names = ["below 1", *(f"1e{k} to 1e{k + 1}" for k in range(6)), "above 1e6", "no entrainment"]
    for k, name in enumerate(names):
        inside = (load >= edges[k]) & (load < edges[k + 1]) if k < len(names) - 1 else np.isinf(load)
        if inside.any():
            used = Counter(lines[n]["algorithm"] for n in np.flatnonzero(inside))
            found = ", ".join(f"{how} ({count})" for how, count in used.most_common(5))
            text.append(
                f"| {name} | {inside.sum()} | {converged[inside].sum()} | {np.median(ms[inside]):.0f} | "
                f"{np.quantile(ms[inside], 0.9):.0f} | {np.nanmedian(steps[inside]):.0f} | {found} |"
            )
    text += _check_table([line for line, fine in zip(lines, converged, strict=True) if fine]) if checked else []
    text += [
        "",
        "Not converged, or not within a limit:",
        "",
        "| number | M | film / nm | Rq / nm | u / (m/s) | by | why |",
    ]
    text.append("|---|---|---|---|---|---|---|")
    for line in lines:
        why = line["shortfall"] if line["converged"] == "0" else "check: " + ", ".join(_failures(line))
        if why != "check: ":
            film, rq = 1e9 * float(line["formula_film"]), 1e9 * float(line["rq"])
            text.append(
                f"| {line['number']} | {float(line['moes_load']):.2g} | {film:.2g} | {rq:.2g} | "
                f"{float(line['speed']):.2g} | {line['algorithm']} | {why} |"
            )
    return text


def _map(lines: list[dict[str, str]], path: Path) -> None:
    """Plot the points by Moes' M and formula film over Rq, with the algorithms that solved them."""
    lines = [line for line in lines if float(line["speed"]) != 0.0]
    load, rq = _numbers(lines, "moes_load"), _numbers(lines, "rq")
    clearance = np.where(rq > 0.0, _numbers(lines, "formula_film") / np.maximum(rq, 1e-300), 1e5)
    converged = _numbers(lines, "converged") == 1.0
    method = np.array([line["algorithm"].split(": ")[-1].split(" from")[0] for line in lines])
    figure = Figure(figsize=(7.0, 4.4), layout="constrained")
    axes = figure.add_subplot()
    for name in sorted(set(method[converged])):
        chosen = converged & (method == name)
        axes.loglog(load[chosen], clearance[chosen], ".", markersize=4, label=f"{name} ({chosen.sum()})")
    axes.loglog(load[~converged], clearance[~converged], "kx", label=f"not converged ({(~converged).sum()})")
    axes.set_xlabel("Moes' M")
    axes.set_ylabel("film by formula / Rq (smooth: 1e5)")
    axes.legend(fontsize="small")
    figure.savefig(path, dpi=110)


def _row_table(lines: list[dict[str, str]]) -> list[str]:
    text = [
        "| row | "
        + " | ".join(f"{n}: W_c, h_c / nm, ms" for n in GRIDS)
        + " | found by, finest | imbalance | floors |",
        "|" + "---|" * (4 + len(GRIDS)),
    ]
    for name in dict.fromkeys(line["name"].split(", step")[0] for line in lines):
        own = [line for line in lines if line["name"].split(", step")[0] == name]
        cells = []
        for nodes in GRIDS:
            here = [line for line in own if line["nodes"] == str(nodes)]
            bad = sum(line["converged"] == "0" for line in here)
            wrong = sum(line["converged"] == "1" and bool(_failures(line)) for line in here)
            note = f" **{bad} of {len(here)} not converged**" if bad else ""
            note += f" **{wrong} fail the check**" if wrong else ""
            if here and here[-1]["h_c"]:
                share, film = float(here[-1]["contact_load_ratio"]), 1e9 * float(here[-1]["h_c"])
                cells.append(f"{share:.3f}, {film:.3g}, {_numbers(here, 'ms').mean():.0f}{note}")
            else:
                cells.append(note)
        worst = [np.nanmax(_numbers(own, key)) for key in ("imbalance", "complementarity")]
        text.append(f"| {name} | {' | '.join(cells)} | {own[-1]['algorithm']} | {worst[0]:.2g} | {worst[1]:.2g} |")
    return text


def report() -> None:
    """Write the tables and the map from what has been solved."""
    found = {int(line["case"]): line for path in sorted(folder().glob("random_*.csv")) for line in read(path)}
    drawn = [found[case] for case in sorted(found)]
    ellipses = [line for path in sorted(folder().glob("ellipse_*.csv")) for line in read(path)]
    lines = [line for path in sorted(folder().glob("line_*.csv")) for line in read(path)]
    listed = [line for nodes in GRIDS for line in read(folder() / f"rows_{nodes}.csv")]
    text = [
        "# Hard cases",
        "",
        "Written by `python -m benchmarks.film.hard_cases report` from the results of its other two commands.",
        "",
    ]
    if drawn:
        text += [
            "## Random operating points",
            "",
            RANDOM_NOTE,
            "",
            *_random_tables(drawn),
            "",
            "![map](hard_cases.png)",
            "",
        ]
        _map(drawn, pictures_of("film") / "hard_cases.png")
    if ellipses:
        nodes = ", ".join(sorted({line["nodes"] for line in ellipses}))
        ellipses.sort(key=lambda line: int(line["case"]))
        text += ["## Random ellipses", "", ELLIPSE_NOTE.format(nodes=nodes), "", *_random_tables(ellipses), ""]
    if lines:
        lines.sort(key=lambda line: int(line["case"]))
        text += ["## Random lines", "", LINE_NOTE, "", *_random_tables(lines), ""]
    if listed:
        text += ["## Rows", ROWS_NOTE, "", *_row_table(listed), ""]
    save("film/hard_cases", "\n".join(text))
    wrong = sum("0 of them fail" not in line for line in text if "of them fail" in line)
    sys.exit(f"{wrong} groups of points have answers that are called converged and fail the check" if wrong else 0)


RANDOM_NOTE = f"""
`point_contact` on {NODES}x{NODES} nodes, tolerance {TOLERANCE:g}. Log-uniform: R 1-100 mm, load 0.1-1000 N,
speed 1e-6-20 m/s of either sign (5 % stand still), viscosity 1e-4-10 Pa s, Rq 1 nm-1.5 um (20 % smooth); correlation
length 20 um or two nodes, 15 GPa^-1, cap 6 GPa. Dropped: p_H above 4 GPa, or a formula film above R / 100. Times are of
one thread and include both grids of the error estimate.

The check solves nothing. It computes deformation, mass balance and load of the solution a second time, in SI, by
independent code, and tests bounds. force: on the grid and beyond it (limit: plus 5 % of the part beyond). imbalance:
mass gained or lost in l / u by the film, weighted by pressure. cavity: load that nodes without pressure would carry
if their inflow were dammed up. complementarity: distance of contacts from the floor, overlap of others, in floors.
beneath: as imbalance, of the fluid under contacts, per floor. gap: between the film reported and that of the
pressure, in floors. bounds: 0 <= fluid <= total <= hardness, fluid = total off contact, in Hertz pressures."""
ELLIPSE_NOTE = """
The same points with the radius along y in a ratio of 0.1 to 10, log-uniform, to the one along x, on grids of {nodes}
nodes along the shorter side. M is that of R_x."""
LINE_NOTE = f"""
The same points as line contacts without ends, of the same radius and largest pressure, by `line_contact` on {ROWS} rows
of {NODES} nodes that repeat across. M is that of the equivalent circular contact. These solutions are not checked."""
ROWS_NOTE = """
Case A of the thesis (77.85 N, R 10 mm, 4 mPa s, 15 GPa^-1, 0.25 m/s, Rq 127 nm, cap 6 GPa) unless the row says
otherwise; steady rows by `point_contact`, those in time by `solve` with `Transient` (the scene azam_case_a; W_c and
h_c of the last step, ms the mean of the steps). imbalance and floors (complementarity) are the worst of all grids and
steps by the check; a time step may have a larger imbalance, because the residual carries over to the next step."""
