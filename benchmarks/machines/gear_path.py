"""FZG test gears along their path of contact: load sharing of the teeth, and accuracy by number of stations.

python -m benchmarks.machines.gear_path
"""

import math
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.integrate import quad

from benchmarks.pages import Page
from contact_core import Scene
from contact_core.reference import hertz_line
from system_models.machines.gear_pair.geometry import FZG_A, FZG_C, FZG_STAGES, SpurGearPair
from system_models.machines.gear_pair.path import (
    Array,
    named_points,
    radius,
    slide_to_roll,
    stations_of,
    steps,
    surface_speeds,
)
from system_models.machines.gear_pair.sharing import Sharing, loads, mean_stiffness, pair_stiffness, single_stiffness
from system_models.machines.gear_pair.textbook import (
    iso_14179_1,
    load_intensity,
    loss_factor,
    ohlendorf,
    schlenk,
    sliding_share,
)

PAIRS = {"C": FZG_C, "A": FZG_A}
PINION = 2170.0 * 2.0 * math.pi / 60.0  # rad/s
STAGE = 9
SHARINGS = {
    "rigid": Sharing(),
    "elastic": Sharing("elastic"),
    "elastic, relief 20 um over 3 mm": Sharing("elastic", 20e-6, 20e-6, 3e-3, 3e-3),
}
COUNTS = (4, 8, 12, 16, 21, 30, 42, 60, 84, 120, 168, 240)
FADES = 0.3  # m/s
OIL, WARM = "fzg_flank", 363.15


def force_of(pair: SpurGearPair, stage: int) -> float:
    """Along the line of action [N]."""
    return FZG_STAGES[0.5][stage - 1] / pair.base_radius_1


def pressure(pair: SpurGearPair, load: float, place: float) -> float:
    """Hertz's [Pa]; none without load."""
    if load == 0.0:
        return 0.0
    return hertz_line(load, radius(pair, place), pair.face_width, pair.reduced_modulus).pressure_max


def exact_factor(pair: SpurGearPair, sharing: Sharing, force: float) -> float:
    """Loss factor by adaptive quadrature between the steps of the load."""

    def part(place: float) -> float:
        return float(loads(pair, sharing, force, np.array(place))) / force * sliding_share(pair, place)

    edges = np.unique(np.concatenate([steps(pair), bends(pair, sharing)]))
    return sum(quad(part, *ends, epsrel=1e-10, limit=200)[0] for ends in pairwise(edges)) / pair.base_pitch


def bends(pair: SpurGearPair, sharing: Sharing) -> Array:
    """Positions [m] within the path at which relief begins, on the pair of teeth or on its neighbours."""
    ends = np.array([pair.end - sharing.relief_length_1, pair.start + sharing.relief_length_2])
    found = np.concatenate([ends + step * pair.base_pitch for step in (-1, 0, 1)])
    return found[(found > pair.start) & (found < pair.end)]


def factor(pair: SpurGearPair, sharing: Sharing, force: float, count: int) -> float:
    """Loss factor by stations."""
    places = stations_of(pair, count)
    return loss_factor(pair, places, loads(pair, sharing, force, places.position) / force)


def along(report: Page) -> None:
    report.say(
        f"### Along the path of contact\n\nPinion at {PINION * 30 / math.pi:.0f} 1/min. Position from T1, where the line "
        "of action touches the pinion's base circle. Share of the force under rigid sharing, after the step where there "
        "is one. In type A two pairs carry at the pitch point C, which lies before B."
    )
    report.header("type", "point", "s [mm]", "R [mm]", "SRR", "u1 [m/s]", "u2 [m/s]", "share", "elastic")
    for name, pair in PAIRS.items():
        for point, place in named_points(pair).items():
            after = np.array(place + 1e-9)
            shares = [float(loads(pair, SHARINGS[model], 1.0, after)) for model in ("rigid", "elastic")]
            u1, u2 = surface_speeds(pair, place, PINION, PINION / pair.ratio)
            report.row(name, point, 1e3 * place, 1e3 * radius(pair, place), slide_to_roll(pair, place), u1, u2, *shares)


def stages(report: Page) -> None:
    report.say(
        "### Load stages\n\nLever of 0.5 m. Hertz's pressure under the whole force, as tabulated for type A at C (ISO 14635-1, 1841 MPa at stage 12), where actually two pairs carry it."
    )
    report.header("stage", "T1 [N m]", "C: at B [MPa]", "C: at C [MPa]", "A: at B [MPa]", "A: at C [MPa]")
    for stage, torque in enumerate(FZG_STAGES[0.5], 1):
        found = [
            1e-6 * pressure(pair, force_of(pair, stage), place)
            for pair in PAIRS.values()
            for place in (pair.single_start, pair.pitch_point)
        ]
        report.row(stage, torque, *found)


def losses(report: Page) -> None:
    report.say(
        "### Loss factors\n\nAdaptive quadrature. Ohlendorf's formula is the integral under rigid sharing where a single "
        "pair carries at C; for type A it is not. Relief removes load from the ends of the path, where sliding is fast, and relatively more of a light load. Arana, Larranaga & Ulacia, [doi:10.1177/1350650118778655]"
        "(https://doi.org/10.1177/1350650118778655), have 0.168 for type C with a tip relief."
    )
    report.header("type", "stage", "Ohlendorf", *SHARINGS)
    for name, pair in PAIRS.items():
        for stage in (3, 6, STAGE, 12):
            found = [exact_factor(pair, sharing, force_of(pair, stage)) for sharing in SHARINGS.values()]
            report.row(name, stage, ohlendorf(pair), *found)

    off = exact_factor(FZG_C, SHARINGS["rigid"], 1.0) / ohlendorf(FZG_C) - 1.0
    report.verdict("type C: Ohlendorf's formula is the rigid integral", f"{abs(off):.1g} off", abs(off) < 1e-9)
    worst = abs(ohlendorf(FZG_C) / 0.1948 - 1.0)
    report.verdict("type C: H_V 0.1948 to 0.5 %", f"{ohlendorf(FZG_C):.4f}, {100 * worst:.1g} % off", worst < 5e-3)


def errors_of(pair: SpurGearPair, sharing: Sharing) -> Array:
    """Return the relative error of the loss factor for all numbers of stations."""
    force = force_of(pair, STAGE)
    exact = exact_factor(pair, sharing, force)
    return np.array([abs(factor(pair, sharing, force, count) / exact - 1.0) for count in COUNTS])


def fading(pair: SpurGearPair) -> Array:
    """Errors, relative, of the loss under rigid sharing by a friction that fades where sliding is slow."""
    speed = PINION * pair.base_radius_1

    def lost(place: Array) -> Array:
        sliding = sliding_share(pair, place) * speed
        return loads(pair, SHARINGS["rigid"], 1.0, place) * sliding * np.tanh(sliding / FADES)

    exact = sum(quad(lambda s: float(lost(np.array(s))), *ends, epsrel=1e-10)[0] for ends in pairwise(steps(pair)))
    found = [stations_of(pair, count) for count in COUNTS]
    return np.array([abs((places.stretch * lost(places.position)).sum() / exact - 1.0) for places in found])


def convergence(report: Page) -> None:
    report.say(
        f"### Stations\n\nError of the loss factor, and so of the loss of a constant coefficient of friction, in percent; "
        f"load stage {STAGE}. For rigid sharing any number of stations is exact. Fading: the loss of a coefficient that "
        f"falls as tanh of the sliding speed over {FADES:g} m/s, under rigid sharing."
    )
    report.header("type", "sharing", *COUNTS, "order")
    for name, pair in PAIRS.items():
        for model, sharing in SHARINGS.items():
            errors = errors_of(pair, sharing)
            if model == "rigid":
                report.row(name, model, *[f"{100 * error:.1g}" for error in errors], "exact")
                report.verdict(f"type {name}, rigid: exact", f"{errors.max():.1g}", bool(errors.max() < 1e-9))
                continue
            order = -float(np.polyfit(np.log(COUNTS), np.log(errors), 1)[0])
            report.row(name, model, *[f"{100 * error:.2g}" for error in errors], order)
            least = 1e-3 if "relief" not in model else 1e-2
            error = float(errors[COUNTS.index(21)])
            report.verdict(
                f"type {name}, {model}: 21 stations to {100 * least:g} %", f"{100 * error:.2g} %", bool(error < least)
            )
        errors = fading(pair)
        order = -float(np.polyfit(np.log(COUNTS), np.log(errors), 1)[0])
        report.row(name, "fading", *[f"{100 * error:.2g}" for error in errors], order)
        error = float(errors[COUNTS.index(21)])
        report.verdict(f"type {name}, fading: 21 stations to 1 %", f"{100 * error:.2g} %", bool(error < 1e-2))


def stiffness(report: Page) -> None:
    report.say(
        "### Stiffness\n\nc' and c_gamma of ISO 6336-1; the pairs of teeth share by c' times a parabola that falls to 55 % "
        "at the ends (Cai & Hayashi), whose mean over a mesh cycle is 0.85 c' times the contact ratio."
    )
    report.header("type", "c' [N/(mm um)]", "c_gamma", "mean of the parabolas", "contact ratio")
    for name, pair in PAIRS.items():
        places = stations_of(pair, 1000)
        mean = float((places.stretch * pair_stiffness(pair, places.position)).sum()) / pair.base_pitch
        found = (single_stiffness(pair), mean_stiffness(pair), mean)
        report.row(name, *[1e-9 * value for value in found], pair.contact_ratio)


def friction(report: Page) -> None:
    oil = Scene.from_toml(OIL).lubricant
    viscosity = float(oil.viscosity(np.zeros(1), WARM)[0])
    kinematic = viscosity / 863.0  # FVA 3 at 90 degC
    report.say(
        f"### Mean friction by formula\n\nFVA 3 at 90 degC ({1e3 * viscosity:.3g} mPa s), Ra 0.4 um, X_L = 1, type C at "
        f"{PINION * 30 / math.pi:.0f} 1/min. Schlenk's formula, which ISO/TR 14179-2 has, rises with load; that of ISO/TR "
        "14179-1 falls with it, and is meant for load intensities K from 1.4 to 14 N/mm2."
    )
    report.header("stage", "Schlenk", "ISO/TR 14179-1", "K [N/mm2]")
    for stage in range(3, 13):
        torque = FZG_STAGES[0.5][stage - 1]
        report.row(
            stage,
            schlenk(FZG_C, force_of(FZG_C, stage), PINION, viscosity, 0.4e-6),
            iso_14179_1(FZG_C, torque, PINION, kinematic),
            1e-6 * load_intensity(FZG_C, torque),
        )


def marked(axes: Axes, pair: SpurGearPair, places: Array) -> None:
    """Names of the points above, stations below."""
    for point, place in named_points(pair).items():
        axes.axvline(1e3 * place, color="0.85", lw=0.8, zorder=0)
        axes.text(1e3 * place, 1.01, point, transform=axes.get_xaxis_transform(), ha="center", fontsize=7)
    axes.plot(1e3 * places, np.full(len(places), 0.02), "|", color="0.4", ms=5, transform=axes.get_xaxis_transform())
    axes.spines[["top", "right"]].set_visible(False)


def picture(report: Page) -> None:
    figure = Figure(figsize=(9.0, 11.0), layout="constrained")
    grid = figure.subplots(5, 2, sharex=False)
    for column, (name, pair) in zip(grid.T, PAIRS.items(), strict=True):
        edges = np.sort(np.concatenate([points + shift for points in [steps(pair)] for shift in (-1e-9, 1e-9)]))
        s = np.unique(np.concatenate([np.linspace(pair.start, pair.end, 400)[1:-1], edges[1:-1]]))
        places, mm = stations_of(pair, 21).position, 1e3 * s
        curved, speeds, loaded, pressed, last = column
        curved.plot(mm, 1e3 * radius(pair, s))
        curved.set(ylabel="radius R [mm]", ylim=(0.0, None))
        curved.set_title(f"FZG type {name}, {1e3 * pair.face_width:.0f} mm wide", fontsize=10, pad=14)
        for values, label in zip(
            surface_speeds(pair, s, PINION, PINION / pair.ratio), ("pinion", "wheel"), strict=True
        ):
            speeds.plot(mm, values, label=f"speed of the {label}")
        speeds.plot(mm, slide_to_roll(pair, s), "k--", lw=1.0, label="slide-to-roll ratio")
        speeds.set(ylabel="speed [m/s], SRR")
        force = force_of(pair, STAGE)
        for model, sharing in SHARINGS.items():
            carried = loads(pair, sharing, force, s)
            loaded.plot(mm, 1e-3 * carried, label=model)
            pressed.plot(mm, [1e-9 * pressure(pair, w, at) for w, at in zip(carried, s, strict=True)], label=model)
        loaded.set(ylabel=f"load [kN], stage {STAGE}", ylim=(0.0, None))
        pressed.set(
            ylabel="Hertz's pressure [GPa]", ylim=(0.0, None), xlabel="position from T1 [mm]; ticks: 21 stations"
        )
        for axes in column[:4]:
            marked(axes, pair, places)
        for model, sharing in list(SHARINGS.items())[1:]:
            colour = f"C{list(SHARINGS).index(model)}"
            last.loglog(COUNTS, 100.0 * errors_of(pair, sharing), "o-", ms=3, color=colour, label=model)
        last.loglog(COUNTS, 30.0 / np.array(COUNTS) ** 2, "k:", lw=1.0, label="second order")
        last.axvline(21, color="0.85", lw=0.8, zorder=0)
        last.set(xlabel="stations", ylabel="error of the loss factor [%]")
        last.spines[["top", "right"]].set_visible(False)
    for axes, place in ((grid[1, 0], "upper center"), (grid[2, 0], "lower center"), (grid[4, 0], "upper right")):
        axes.legend(frameon=False, fontsize=7, loc=place)
    report.picture(figure, "gear_path.png", "radius, speeds, load and pressure along the path; error over stations")


def main() -> None:
    report = Page("machines/gear_path", "Gears along the path of contact")
    for part in (picture, along, stages, losses, convergence, stiffness, friction):
        part(report)
    report.write()


if __name__ == "__main__":
    main()
