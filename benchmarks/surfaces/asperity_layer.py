"""Constants of the law of asperities below the grid, from dry contacts of periodic random roughness.

    python -m benchmarks.surfaces.asperity_layer            two surfaces a case, half a minute
    python -m benchmarks.surfaces.asperity_layer --full     six surfaces, larger planes, more steps of the nodes: six minutes

Writes docs/measured/surfaces/asperity_layer.md and .png. One thread.
"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from benchmarks.pages import Page
from benchmarks.surfaces import asperity_theory as theory
from benchmarks.surfaces.asperity_text import CONSTANTS, LIMITS, UNITS, WHAT, real_surfaces
from benchmarks.surfaces.periodic_contact import Band, PeriodicPlane, Point, press
from contact_core.kernels.half_space import Array
from contact_core.laws.asperity_layer import AsperityLayer, touching

PRESSURES = (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6)
FITTED = 0.005, 0.2  # pressures of the fit of the exponential, and at most half the hardness
HARDNESSES = (np.inf, 1.0, 0.25)
SPECTRA = ((4, 0.8), (16, 0.8), (16, 0.5), (4, -1.0), (16, -1.0))  # breadth, Hurst exponent
MODULUS = 2.3e11  # E' of steel [Pa]
SOLID = (2e9, 4e9, 6e9)  # hardnesses [Pa]
# longest and shortest wavelength [um], rms height [nm]
CASES = ((16, 4, 30), (16, 1, 30), (4, 1, 12), (16, 4, 60), (8, 0.5, 5), (8, 0.5, 20), (4, 1, 5), (4, 1, 60))
LOADS = (5e6, 50e6, 200e6, 500e6, 1000e6)
UNIT = AsperityLayer(1.0, 2.0 * np.pi)  # q = sigma = 1


@dataclass(frozen=True)
class Plan:
    """How many surfaces and how large."""

    seeds: int
    broad: int  # longest waves along a side of a plane of a broad band
    hardnesses: tuple[float, ...] = HARDNESSES  # of the spectra of the law
    steps: tuple[int, ...] = (4, 8)  # nodes a shortest wave

    def band(self, breadth: int, hurst: float) -> tuple[Band, int]:
        """Return a band and the nodes along a side of its plane."""
        longest, each = (8, 8) if breadth < 8 else (self.broad, 4)
        return Band(breadth, hurst, longest), each * breadth * longest

    def curves(self, breadth: int, hurst: float, pressures: Sequence[float], hardness: float) -> Array:
        """Return contacts [surfaces, pressures, entries of Point]."""
        band, nodes = self.band(breadth, hurst)
        return contacts(band, nodes, self.seeds, tuple(p for p in pressures if p < 0.9 * hardness), hardness)


QUICK = Plan(seeds=2, broad=4)
FULL = Plan(seeds=6, broad=8, hardnesses=(np.inf, 2.0, 1.0, 0.5, 0.25), steps=(4, 8, 16))


@cache
def contacts(band: Band, nodes: int, seeds: int, pressures: tuple[float, ...], hardness: float) -> Array:
    plane = PeriodicPlane(nodes, band.longest)
    return np.array(
        [list(press(plane, band.heights(nodes, seed), pressures, hardness)) for seed in range(1, seeds + 1)]
    )


def column(found: Array, name: str) -> tuple[Array, Array]:
    """Mean over the surfaces, and its standard deviation."""
    values = found[:, :, Point._fields.index(name)]
    return values.mean(0), values.std(0, ddof=1) if len(values) > 1 else np.zeros(values.shape[1])


def fitted(pressures: Array, hardness: float) -> NDArray[np.bool_]:
    """Which pressures the exponential is fitted to."""
    return (pressures >= FITTED[0]) & (pressures <= min(FITTED[1], 0.5 * hardness))


def scales(pressures: Array, gaps: Array, hardness: float) -> tuple[float, float]:
    """p0 and h0 of gap = h0 ln(p0 / p)."""
    use = fitted(pressures, hardness)
    slope, at_one = np.polyfit(np.log(pressures[use]), gaps[use], 1)
    return float(np.exp(-at_one / slope)), float(-slope)


def scattered(found: Array, hardness: float) -> tuple[Array, Array]:
    """p0 and h0 of the mean curve, and their standard errors by leaving out one surface at a time."""
    at, n = found[0, :, 0], len(found)
    whole = np.array(scales(at, column(found, "gap")[0], hardness))
    parts = np.array([scales(at, column(np.delete(found, i, 0), "gap")[0], hardness) for i in range(n)])
    return whole, np.sqrt((n - 1) / n * ((parts - parts.mean(0)) ** 2).sum(0))


def misfit(pressures: Array, gaps: Array, hardness: float) -> float:
    """Largest error of the fitted exponential's gap on the fitted pressures."""
    p0, h0 = scales(pressures, gaps, hardness)
    return float(np.abs(gaps - h0 * np.log(p0 / pressures))[fitted(pressures, hardness)].max())


def name(breadth: int, hurst: float) -> str:
    return f"{breadth}, {'white' if hurst < 0.0 else f'H {hurst:g}'}"


def check_solver(page: Page) -> None:
    page.say("## The solver against closed forms")
    page.say(
        "One wave on 256 nodes. cos x: Westergaard's solution; cos x cos y: Hertz's contact at the crests, and full contact from 0.7071 on."
    )
    page.header("wave", "pressure", "area", "closed form", "gap", "closed form")
    nodes = 256
    wave = np.cos(2.0 * np.pi * np.arange(nodes) / nodes)
    plane = PeriodicPlane(nodes, 1)
    worst = [0.0, 0.0]
    for point in press(plane, np.tile(wave, (nodes, 1)), (0.02, 0.1, 0.25, 0.4)):
        area, gap = theory.westergaard(point.pressure)
        page.row("cos x", point.pressure, point.area, area, point.gap, gap)
        worst = [max(worst[0], abs(point.area - area)), max(worst[1], abs(point.gap - gap))]
    for point in press(plane, wave[:, None] * wave, (0.001, 0.002, 0.7, 0.71)):
        light = point.pressure < 0.1
        area = theory.light_eggbox(point.pressure) if light else 1.0 if point.pressure > 0.7071 else "< 1"
        page.row("cos x cos y", point.pressure, point.area, area, point.gap, "" if light else 0.0)
    page.verdict("gap of Westergaard's wave, error below 0.001 amplitudes", f"{worst[1]:.1g}", worst[1] < 1e-3)
    page.verdict("its area, error below 0.01 (two nodes of 256 are 0.008)", f"{worst[0]:.1g}", worst[0] < 1e-2)


def check_nodes(page: Page, plan: Plan) -> None:
    page.say("## Nodes and size of the plane")
    page.say(
        "One surface, the same on every grid; breadth 4, H 0.8, 8 longest waves along a side. Areas are corrected for the width of the nodes by their number of edges "
        "(Yastrebov, Anciaux & Molinari, arXiv:1701.02727); where that falls below pressure over hardness, the least that can touch, this is taken."
    )
    page.header(
        "hardness", "nodes a shortest wave", *(f"{what} at {p:g}" for p in (0.01, 0.1, 0.4) for what in ("gap", "area"))
    )
    for hardness in (np.inf, 0.5):
        last: Array | None = None
        for each in plan.steps:
            found = contacts(Band(4, 0.8), each * 32, 1, (0.01, 0.1, 0.4), hardness)
            gap, area = column(found, "gap")[0], column(found, "area")[0]
            page.row(hardness, each, *np.stack((gap, area), 1).ravel())
            if last is not None and each == plan.steps[-1]:
                worst = float(np.abs(area / last - 1.0).max())
                page.verdict(
                    f"area at hardness {hardness:g} within 3 % between the last two steps of the nodes",
                    f"{100 * worst:.1f} %",
                    worst < 0.03,
                )
            last = area
    page.say("The size of the plane: mean over the surfaces, standard deviation.")
    page.header("breadth, spectrum", "longest waves along a side", *(f"gap at {p:g}" for p in (0.005, 0.05, 0.2)))
    for longest in (4, 8) if plan is QUICK else (4, 8, 16):
        found = contacts(Band(4, 0.8, longest), 4 * 4 * longest, plan.seeds, (0.005, 0.05, 0.2), np.inf)
        mean, scatter = column(found, "gap")
        page.row(name(4, 0.8), longest, *(f"{m:.3f}, {s:.3f}" for m, s in zip(mean, scatter, strict=True)))


def check_gap(page: Page, plan: Plan, figure: Figure) -> None:
    page.say("## Mean gap of elastic contact")
    page.say(
        "gap: mean of the surfaces, and their standard deviation; law: that of `contact_core/laws/asperity_layer.py` for the same rms "
        "height and longest wavelength; fit: the exponential with constants of its own; Persson: his theory with the energy factor 0.45; "
        "Greenwood-Tripp: by the moments of the spectrum, distance of the mean planes."
    )
    page.header("breadth, spectrum", "pressure", "gap", "deviation", "law", "fit", "Persson", "Greenwood-Tripp")
    axis = figure.subplots(1, 2)
    for breadth, hurst in SPECTRA:
        found = plan.curves(breadth, hurst, PRESSURES, np.inf)
        band = plan.band(breadth, hurst)[0]
        (p0, h0), _ = scattered(found, np.inf)
        mean, scatter = column(found, "gap")
        law = UNIT.gap(np.array(PRESSURES), 2.0, np.inf)
        for i, p in enumerate(PRESSURES):
            others = theory.persson_gap(band, p), theory.greenwood_tripp_gap(band, p)
            page.row(name(breadth, hurst), p, mean[i], scatter[i], law[i], max(h0 * np.log(p0 / p), 0.0), *others)
        axis[0].semilogy(mean, PRESSURES, "o-", ms=3, lw=1, label=name(breadth, hurst))
        axis[1].loglog(PRESSURES, column(found, "area")[0], "o-", ms=3, lw=1)
    axis[0].semilogy(law, PRESSURES, "k--", lw=1, label="law")
    axis[1].loglog(PRESSURES, UNIT.area(np.array(PRESSURES), 2.0, np.inf), "k--", lw=1)
    axis[0].set(xlabel="gap / rms height", ylabel="pressure / (q sigma E'/2)", xlim=(0.0, 3.2))
    axis[1].set(xlabel="pressure / (q sigma E'/2)", ylabel="touching share of the area")
    axis[0].legend(frameon=False, fontsize="small")


def check_constants(page: Page, plan: Plan) -> None:
    page.say("## Constants of the exponential")
    page.say(
        f"p = p0 exp(-gap / h0) fitted to pressures from {FITTED[0]:g} to {FITTED[1]:g}, and at most half the hardness; standard errors by leaving out one "
        "surface at a time. Misfit: largest error of the gap on the fitted pressures; the second is that of the distance of the mean planes before yielding."
    )
    page.header(
        "breadth, spectrum",
        "rms slope",
        "hardness",
        "p0",
        "+-",
        "h0",
        "+-",
        "misfit",
        "misfit, planes before yielding",
        "p0 over slope",
        "p0 of the law",
        "h0 of the law",
        "error of the law's gap",
    )
    worst = 0.0
    for breadth, hurst in SPECTRA:
        for hardness in plan.hardnesses if hurst == 0.8 else HARDNESSES:
            found = plan.curves(breadth, hurst, PRESSURES, hardness)
            (p0, h0), (dp, dh) = scattered(found, hardness)
            at, gap = found[0, :, 0], column(found, "gap")[0]
            misfits = misfit(at, gap, hardness), misfit(at, column(found, "planes")[0], hardness)
            error = float(np.abs(gap - UNIT.gap(at, 2.0, hardness))[fitted(at, hardness)].max())
            slope = plan.band(breadth, hurst)[0].slope
            law = float(UNIT.pressure_scale(2.0, hardness)), float(UNIT.height_scale(2.0, hardness))
            page.row(name(breadth, hurst), slope, hardness, p0, dp, h0, dh, *misfits, p0 / slope, *law, error)
            if hurst == 0.8:
                worst = max(worst, error)
    page.say(CONSTANTS)
    page.verdict("gap of the law within 0.15 rms heights on the fitted pressures, H 0.8", f"{worst:.2f}", worst < 0.15)


def check_area(page: Page, plan: Plan) -> None:
    page.say("## Real area of contact")
    page.say(
        "formula: that of the law, with the rms slope of the spectrum; law: with the law's own slope; Persson: elastic."
    )
    page.header(
        "breadth, spectrum",
        "hardness",
        "pressure",
        "area",
        "deviation",
        "formula",
        "law",
        "Persson",
        "pressure / hardness",
        "at the hardness",
    )
    worst = dict.fromkeys(("elastic, self-affine", "elastic, white", "plastic, self-affine", "plastic, white"), 0.0)
    for breadth, hurst in SPECTRA:
        band = plan.band(breadth, hurst)[0]
        for hardness in plan.hardnesses if hurst == 0.8 else HARDNESSES:
            found = plan.curves(breadth, hurst, PRESSURES, hardness)
            at, (area, scatter) = found[0, :, 0], column(found, "area")
            formula, own = touching(at, band.slope, hardness), UNIT.area(at, 2.0, hardness)
            held = column(found, "plastic")[0]
            for i in range(0, len(at), 2):
                page.row(
                    name(breadth, hurst),
                    hardness,
                    at[i],
                    area[i],
                    scatter[i],
                    formula[i],
                    own[i],
                    theory.persson_area(band, at[i]),
                    at[i] / hardness,
                    held[i],
                )
            kind = f"{'elastic' if np.isinf(hardness) else 'plastic'}, {'white' if hurst < 0.0 else 'self-affine'}"
            worst[kind] = max(worst[kind], float(np.abs(formula / area - 1.0)[fitted(at, hardness)].max()))
    for kind, error in worst.items():
        page.verdict(
            f"formula of the area, with the rms slope known, within 10 % on the fitted pressures: {kind}",
            f"{100 * error:.0f} %",
            error < 0.1,
        )


def check_metres(page: Page, plan: Plan) -> None:
    page.say("## In metres and pascals")
    page.say(
        f"E' = {MODULUS / 1e9:g} GPa, H 0.8, 4 longest waves along a side of a plane of breadth 16. Area, and gap over rms height: contacts / law of the rms height and the longest wavelength."
    )
    page.header(
        "wavelengths um",
        "rms nm",
        "hardness GPa",
        "q sigma E'/2 GPa",
        *(f"{p / 1e6:g} MPa: area" for p in LOADS),
        *(f"{p / 1e6:g} MPa: gap" for p in LOADS),
    )
    worst, small = [0.0, 0.0, 0.0], replace(plan, broad=QUICK.broad)
    for longest, shortest, rms in CASES:
        layer = AsperityLayer(rms * 1e-9, longest * 1e-6)
        unit = np.pi * MODULUS * layer.rms / layer.longest
        for solid in SOLID if plan is FULL else SOLID[1:2]:
            found = small.curves(round(longest / shortest), 0.8, tuple(p / unit for p in LOADS), solid / unit)
            area, gap = column(found, "area")[0], column(found, "gap")[0]
            law_area, law_gap = (
                layer.area(np.array(LOADS), MODULUS, solid),
                layer.gap(np.array(LOADS), MODULUS, solid) / layer.rms,
            )
            pairs = [f"{a:.3f} / {b:.3f}" for a, b in zip(area, law_area, strict=True)] + [
                f"{a:.2f} / {b:.2f}" for a, b in zip(gap, law_gap, strict=True)
            ]
            page.row(f"{longest:g} to {shortest:g}", rms, solid / 1e9, unit / 1e9, *pairs)
            wrong = np.abs(law_gap - gap)
            worst = [
                max(pair)
                for pair in zip(
                    worst,
                    (float(np.abs(law_area / area - 1.0).max()), float(wrong[1:].max()), float(wrong[0])),
                    strict=True,
                )
            ]
    page.verdict(
        "area of the law, which does not know the shortest wave, within 30 %, H 0.8, 5 MPa to 1 GPa",
        f"{100 * worst[0]:.0f} %",
        worst[0] < 0.3,
    )
    page.verdict("gap of the law within 0.15 rms heights, H 0.8, 50 MPa to 1 GPa", f"{worst[1]:.2f}", worst[1] < 0.15)
    page.verdict("the same at 5 MPa", f"{worst[2]:.2f}", worst[2] < 0.15)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--full", action="store_true", help="more surfaces, larger planes")
    plan = FULL if parser.parse_args().full else QUICK
    page = Page(
        "surfaces/asperity_layer",
        "Asperities below the grid: pressure, gap and area",
        options="--full" if plan is FULL else "",
    )
    page.say(WHAT)
    page.say(UNITS)
    page.say(f"{plan.seeds} surfaces a case; {plan.broad} longest waves along a side of a plane of breadth 16, else 8.")
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    check_solver(page)
    check_nodes(page, plan)
    check_gap(page, plan, figure)
    page.picture(figure, "asperity_layer.png", "pressure against gap, and area against pressure, of elastic contacts")
    check_constants(page, plan)
    check_area(page, plan)
    check_metres(page, plan)
    page.say(LIMITS)
    real_surfaces(page)
    page.write()


if __name__ == "__main__":
    main()
