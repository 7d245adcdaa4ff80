"""Stress and damage at the regression level: the curves against passes that were solved, and against others held back.

    python -m benchmarks.stress.curves         # fits and compares; solves what is not yet in results/stress: 5 min

Writes docs/measured/stress/curves.md.
"""

import time
from collections.abc import Sequence
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from benchmarks.pages import Page
from benchmarks.stress.fit import Known, fitted, largest_off, pressure_off, quantiles_off
from benchmarks.stress.points import (
    COUNTS,
    EXPONENTS,
    INSTANTS,
    LAMBDAS,
    LENGTH,
    NODES,
    PROBABILITIES,
    ROUGHNESS,
    Seen,
    solved,
)
from contact_core import Scene, advance, initial_state
from contact_core.laws.stress import HalfSpace
from contact_core.regression.contact import evaluate
from contact_core.regression.near_surface import CURVES, HALF_WIDTH, NearSurface
from contact_core.regression.smooth_cycles import smooth_cycles
from contact_core.regression.stress import stressed
from contact_core.regression.surfaces import tribofilms_of
from contact_core.scene import Case
from contact_core.state.classes import WEIGHTS
from contact_core.surfaces.track_means import means_of

Array = np.ndarray

SHARE = 0.95  # of the points that a half width holds
STEPS = 300  # of the regression level that are timed
MINUTES = 20
LATER = {  # scenes that are followed over time
    "film.points": "65",
    "stress.model": "half_space",
    "stress.instants": "16",
    "fatigue.model": "basquin",
    "fatigue.reference_stress": "2500 MPa",
    "fatigue.life_exponent": "10",
    "control.longest": "60 s",
}
LATER_LENGTH = {"fzg_flank": "25 um", "mtm_zddp": "16 um"}
BASQUIN = {"fatigue.model": "basquin", "fatigue.reference_stress": "900 MPa", "fatigue.life_exponent": "10"}


class Fast(NamedTuple):
    """What the regression level says of a point. Stresses are over Hertz's largest pressure."""

    load_ratio: float
    equivalent: Array  # as of `Seen`
    von_mises: float
    dang_van_ratio: float
    near_surface_share: float


def fast(seen: Seen) -> Fast:
    """Ask the regression level, which knows the scene and the operating point alone."""
    scene = seen.point.build().at_level("regression")
    case = Case.bind(scene, seen.point.operating_point)
    contact = evaluate(case, tribofilms_of(means_of(scene, initial_state(scene))))
    found, largest = stressed(case, contact), case.hertz.pressure_max
    worst = [part.max(axis=1) / largest for part in (found.cycles.shear, found.cycles.dang_van)]  # [2, rows, classes]
    equivalent = [
        [[((part[i] ** m) @ WEIGHTS).mean() ** (1.0 / m) for m in EXPONENTS] for part in worst] for i in (0, 1)
    ]
    out = found.outputs
    return Fast(
        contact.load_ratio,
        np.array(equivalent),
        out["von_mises_max"] / largest,
        out["dang_van_ratio"],
        out["near_surface_share"],
    )


def held(values: Array) -> float:
    """Half width that holds 95 % of the values."""
    return float(np.quantile(np.abs(values), SHARE))


def of_level(seen: Sequence[Seen]) -> dict[str, Array]:
    """Logarithms of the regression level's stresses over those solved, and differences of shares."""
    told = [fast(each) for each in seen]
    off = np.array([np.log(a.equivalent / b.equivalent) for a, b in zip(told, seen, strict=True)])
    return {
        "von_mises_max": np.array([np.log(a.von_mises / b.von_mises.max()) for a, b in zip(told, seen, strict=True)]),
        **{f"shear that damages, m = {m:g}": off[:, :, 0, k].ravel() for k, m in enumerate(EXPONENTS)},
        **{f"Dang Van's that damages, m = {m:g}": off[:, :, 1, k].ravel() for k, m in enumerate(EXPONENTS)},
        "dang_van_ratio": np.array(
            [np.log(a.dang_van_ratio / b.dang_van_ratio) for a, b in zip(told, seen, strict=True)]
        ),
        "near_surface_share": np.array(
            [a.near_surface_share - b.near_surface_share for a, b in zip(told, seen, strict=True)]
        ),
    }


def tables() -> dict[str, float]:
    """Make the tables of smooth cycles; return the processor time of each [s]."""
    found = {}
    for name in COUNTS:
        scene, start = Scene.from_toml(name), time.process_time()
        hertz = scene.unit_hertz
        smooth_cycles(None if scene.shape().along_face else hertz.b / hertz.a, HalfSpace().dang_van_slope, 0.0)
        found[name] = time.process_time() - start
    return found


def main() -> None:
    took = tables()
    fit = {name: solved(name, check=False) for name in COUNTS}
    check = {name: solved(name, check=True) for name in COUNTS}
    both = {name: [*fit[name], *check[name]] for name in COUNTS}
    seconds = sum(each.seconds for part in both.values() for each in part)
    page = Page("stress/curves", "Stress and damage at the regression level")
    known = {name: ([Known.of(s) for s in fit[name]], [Known.of(s) for s in check[name]]) for name in COUNTS}
    ours = fitted([each for part in known.values() for each in part[0]], CURVES)
    page.say(
        f"Passes of fresh surfaces by {INSTANTS} instants at {NODES} nodes, {seconds:.0f} s in all: "
        + ", ".join(f"`{name}` {len(fit[name])} + {len(check[name])}" for name in COUNTS)
        + f" (fit + held back, of which the ball on the ring's are held back altogether). Load .4 to 1.3 of the scene's, lambda {LAMBDAS[0]:g} to {LAMBDAS[1]:g}, slide-roll ratio .3 to 100 % of either sign, "
        f"roughness {ROUGHNESS['fzg_flank']} of the flanks' and {ROUGHNESS['mtm_zddp']} of the discs', correlation length {LENGTH['fzg_flank']} and {LENGTH['mtm_zddp']} of the scene's, boundary friction .05 to .2. "
        "Errors are logarithms of the ratio; stresses are over Hertz's largest pressure."
    )
    _of_curves(page, known)
    off = {name: of_level(check[name]) for name in COUNTS if check[name]}
    _of_the_level(page, off)
    _over_time(page)
    _constants(page, ours)
    _cost(page, took)
    page.picture(_picture(both, check), "curves.png", "Stresses by the regression level against solved ones")
    page.write()


def _of_curves(page: Page, known: dict[str, tuple[list[Known], list[Known]]]) -> None:
    page.say("The curves alone, told what was solved of friction and W_c. Rms on the fit / on points held back:")
    page.header(
        "scene",
        "rms pressure",
        *(f"shear of the first layer, {100 * p:g} %" for p in PROBABILITIES[[2, 4, 6]]),
        "largest von Mises",
    )
    for name, parts in known.items():
        cells = [[], []]
        for cell, part in zip(cells, parts, strict=True):
            if not part:
                cell += ["-"] * 5
                continue
            shear = quantiles_off(part, CURVES, 0)
            first = [np.concatenate([each[:, k, 0, 0].ravel() for each in shear]) for k in (2, 4, 6)]
            values = [pressure_off(part, CURVES.pressures), *first, largest_off(part, CURVES)[0]]
            cell += [f"{np.sqrt(np.mean(value**2)):.3f}" for value in values]
        page.row(f"`{name}`", *(f"{a} / {b}" for a, b in zip(*cells, strict=True)))


def _of_the_level(page: Page, off: dict[str, dict[str, Array]]) -> None:
    page.say(
        "The regression level, which has W_c and friction from its own curves, on the points held back: mean, and half width of 95 %. "
        "The stress that damages is the mean over the track of the m-th power of a point's worst stress, to the power of 1/m; "
        "damage by a line of lives with the exponent m is off by m times that logarithm."
    )
    names = list(next(iter(off.values())))
    page.header("stress", *(f"`{name}`" for name in off), "all", "factor on life")
    pooled = {name: np.concatenate([part[name] for part in off.values()]) for name in names}
    for name in names:
        m = float(name.split("=")[1]) if "=" in name else 0.0
        cells = [f"{part[name].mean():+.3f}, {held(part[name]):.3f}" for part in off.values()]
        page.row(name, *cells, f"{held(pooled[name]):.3f}", f"{np.exp(m * held(pooled[name])):.3g}" if m else "")
    needed = max(np.exp(held(pooled[name])) - 1.0 for name in names if "damages" in name)
    page.verdict(
        f"95 % of the stresses that damage within the stated half width, {HALF_WIDTH:g}",
        f"{needed:.3f}",
        needed <= HALF_WIDTH,
    )
    first = off["fzg_flank"]["von_mises_max"], off["mtm_zddp"]["von_mises_max"]
    page.verdict(
        "largest von Mises stress within 25 % (95 % of the points held back)",
        " / ".join(f"{held(part):.3f}" for part in first),
        max(map(held, first)) <= 0.25,
    )


def _constants(page: Page, ours: NearSurface) -> None:
    page.say("Constants, fitted and shipped:")
    page.header("curve", "constants", "fitted", "shipped")
    for f in fields(ours):
        curve, shipped = getattr(ours, f.name), getattr(CURVES, f.name)
        names = [g.name for g in fields(curve)]
        page.row(f.name, ", ".join(names), *(", ".join(f"{getattr(c, n):g}" for n in names) for c in (curve, shipped)))


def _over_time(page: Page) -> None:
    page.say(
        f"Damage of both bodies over {MINUTES} minutes by both levels, {LATER['control.longest']} a step, lives so long that nothing breaks out: deterministic / regression level. "
        "The first block of the deterministic level knows a few instants of a pass and moves them on as they are, so that its first minutes do several times the damage of a whole pass; the last column is without them. "
        "Pits load what is beside them; the regression level leaves that out, and from then on falls behind."
    )
    page.header(
        "scene",
        "min",
        "W_c",
        "damage 1",
        "damage 2",
        "ratio",
        "1 + error_damage",
        "CPU s",
        "ratio of the rates since the row before",
    )
    worst = 0.0
    for name in ("fzg_flank", "mtm_zddp"):
        deep = Scene.from_toml(name, LATER | {f"surface_{i}.correlation_length": LATER_LENGTH[name] for i in (1, 2)})
        runs = [[scene, initial_state(scene), 0.0] for scene in (deep, deep.at_level("regression"))]
        was = np.zeros((2, 2))
        for minute in range(1, MINUTES + 1):
            outs = []
            for each in runs:
                start = time.process_time()
                each[1], out = advance(each[0], deep.operation.point, each[1], 60.0)
                each[2] += time.process_time() - start
                outs.append(out)
            one, two = outs
            if minute in (1, MINUTES // 2, MINUTES):
                now = np.array([[out.damage_1, out.damage_2] for out in outs])
                (slow, quick), was = now - was, now
                ratios = two.damage_1 / one.damage_1, two.damage_2 / one.damage_2
                worst = max(worst, *(max(r, 1.0 / r) / (1.0 + two.error_damage) for r in ratios))
                page.row(
                    f"`{name}`",
                    minute,
                    f"{one.contact_load_ratio:.2f} / {two.contact_load_ratio:.2f}",
                    f"{one.damage_1:.2e} / {two.damage_1:.2e}",
                    f"{one.damage_2:.2e} / {two.damage_2:.2e}",
                    f"{ratios[0]:.2f}, {ratios[1]:.2f}",
                    1.0 + two.error_damage,
                    f"{runs[0][2]:.1f} / {runs[1][2]:.1f}",
                    f"{quick[0] / slow[0]:.2f}, {quick[1] / slow[1]:.2f}",
                )
    page.verdict("damage over time within the stated error", f"{worst:.2f} of it", worst <= 1.0)


def _cost(page: Page, took: dict[str, float]) -> None:
    page.say(
        f"Time of a step of 10 ms at the regression level [us], the least of {STEPS}, and processor time of the first one's table:"
    )
    page.header("scene", "without stress", 'stress.model = "half_space"', "and damage", "table of smooth cycles [s]")
    for name in COUNTS:
        cells = []
        for changes in ({}, {"stress.model": "half_space"}, {"stress.model": "half_space"} | BASQUIN):
            scene = Scene.from_toml(name, changes).at_level("regression")
            state, _ = advance(scene, scene.operation.point, initial_state(scene), 1.0)
            steps = []
            for _ in range(STEPS):
                start = time.perf_counter()
                state, _ = advance(scene, scene.operation.point, state, 0.01)
                steps.append(time.perf_counter() - start)
            cells.append(f"{1e6 * min(steps):.0f}")
        page.row(f"`{name}`", *cells, f"{took[name]:.2f}")


def _picture(both: dict[str, list[Seen]], check: dict[str, list[Seen]]) -> Figure:
    figure = Figure(figsize=(11.0, 3.8), layout="constrained")
    axes = figure.subplots(1, 3)
    colours = dict(zip(both, ("#2471a3", "#e59866", "#27ae60", "#8e44ad"), strict=True))
    for name, seen in check.items():
        told = [fast(each) for each in seen]
        style = {"color": colours[name], "ls": "none", "marker": "o", "ms": 4, "label": name}
        axes[0].plot([a.von_mises for a in told], [b.von_mises.max() for b in seen], **style)
        for panel, which in ((axes[1], 0), (axes[2], 1)):
            panel.plot(
                [a.equivalent[i, which, 1] for a in told for i in (0, 1)],
                [b.equivalent[i, which, 1] for b in seen for i in (0, 1)],
                **style,
            )
    for panel, text in zip(
        axes, ("largest von Mises / p_H", "shear that damages / p_H", "Dang Van's / p_H"), strict=True
    ):
        low, high = panel.get_xlim()
        panel.plot([low, high], [low, high], "k-", lw=1)
        panel.set(xlabel=f"{text}, regression level", ylabel="solved")
        panel.spines[["top", "right"]].set_visible(False)
        panel.grid(color="0.93")
    axes[0].legend(frameon=False, fontsize="small")
    return figure


if __name__ == "__main__":
    main()
