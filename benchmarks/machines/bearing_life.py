"""Life of ball bearing 209 by ISO 281, by ISO 16281, and by the stress below its smooth, rubbed and rough contacts.

python -m benchmarks.machines.bearing_life
"""

import math
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from benchmarks.pages import Page
from contact_core import ContactState, OperatingPoint, Scene, advance, initial_state, march, solve
from contact_core.kernels.arrays import Array
from contact_core.kernels.stress_measures import von_mises
from contact_core.kernels.subsurface import Subsurface
from contact_core.scene import Case
from contact_core.surfaces.track_means import folded
from system_models.machines import reading
from system_models.machines.ball_bearing import rating
from system_models.machines.ball_bearing import stress_life as life
from system_models.machines.ball_bearing.equilibrium import RingLoads
from system_models.machines.ball_bearing.equilibrium import solve as balance
from system_models.machines.ball_bearing.geometry import BEARING_209, RACES, BallBearingGeometry
from system_models.machines.ball_bearing.lives import RatedRun
from system_models.machines.ball_bearing.record import BearingRun
from system_models.machines.resolve import started
from system_models.master import simulate

CONTACT = "inner_3"  # the most loaded class
KEEP = 16  # columns of material that are followed through the contact
EVERY = 2  # instants of the march of which the stress is taken one: it moves with the material
EDGE = 1.15  # half widths across of the ellipse that count
CASES = 3  # of the contacts below that are those of the run
ROUGHER = (2.0, 4.0)  # times the roughness, under the thin film
SETTLE = 16  # nodes that the film moves on before the first column enters
NEAR = int(np.searchsorted(life.DEPTHS, 0.2))
KELVIN = 273.15
CATALOGUES = {"older catalogues (from memory)": 33.2e3, "SKF today (from memory)": 35.1e3}
FRICTION = (0.02, 0.05, 0.1, 0.15, 0.2, 0.3)
# 6 balls of 11.1 mm on 43.5 mm, C = 23.4 kN, 1 kN radial, published with the program github.com/minzhun/ISO16281:
# diametral clearance [m], life [million revolutions]
PUBLISHED = ((0.0, 12008.9256), (10e-6, 9323.8946))


def passing(
    instants: Iterable[tuple[Array, Array, int]], spacing: float, depths: Array, poisson: float, keep: int
) -> Array:
    """Return the largest von Mises stress [keep, nz, ny] of columns of material that pass under solved instants [Pa].

    Parameters
    ----------
    instants : pressure and shear stress along x on the body [ny, nx], in Pa, and the nodes by which it has moved on
        along +x since the first; no body moves by more than a node from one to the next.
    spacing, depths : of the nodes, and [nz] below the surface, in m.
    keep : columns, from the first on that enters the grid after the first instant. They have all left it when the body
        has moved by `keep` and the grid's columns.

    """
    found, below = np.zeros(0), None
    for pressure, shear, moved in instants:
        if below is None:
            found = np.zeros((keep, depths.size, pressure.shape[0]))
            below = Subsurface((pressure.shape[0], pressure.shape[1]), spacing, depths, poisson, "pyfftw")
        # way of the body when what is at each node now came to the first
        entered = moved - np.arange(pressure.shape[1])
        here = (entered >= 1) & (entered <= keep)
        for k, layer in enumerate(below.layers(pressure, shear)):
            rows = entered[here] - 1
            found[rows, k] = np.maximum(found[rows, k], von_mises(layer)[:, here].T)
    return found


class Stressed(NamedTuple):
    """Largest von Mises stress below a contact, over its own smooth one."""

    name: str
    ratio: float  # lambda, h_c over the undeformed roughness
    friction: float
    pressure: float  # largest of all instants [Pa]
    stress: Array  # [columns, nz, ny], Pa
    smooth: Array  # [nz, ny], of Hertz's contact on the same grid
    depths: Array
    spacing: float
    limit: float  # [Pa]

    @property
    def near(self) -> float:
        """Share of integral s^(31/3) dA above a depth of 0.2 a."""
        by_depth = (self.stress**life.STRESS_POWER).mean(axis=0).sum(axis=-1) * np.gradient(self.depths)
        return float(by_depth[:NEAR].sum() / by_depth.sum())

    def factor(self, limit: float = 0.0, depths: slice = slice(None)) -> float:
        """Life over that of the smooth contact without friction and limit."""
        risks = (
            life.risk(stress[..., depths, :], self.depths[depths], self.spacing, least)
            for stress, least in ((self.stress, limit), (self.smooth, 0.0))
        )
        return life.factor(*risks)


def run() -> RatedRun:
    assembly = reading.assemble(reading.read("bearing_209"))
    with tempfile.TemporaryDirectory() as folder:
        dataset = simulate(assembly.system(Path(folder)), **assembly.settings, outputs=assembly.outputs())
    return RatedRun(BearingRun(assembly, dataset))


def led(found: BearingRun, name: str) -> tuple[Scene, OperatingPoint, ContactState]:
    """Scene, operating point and state of a contact at the end of the run, by its recorded inputs."""
    scene, start = started(found.assembly.contacts[name])
    columns = {key: found.of(f"{name}.{key}") for key in found.assembly.inputs_of(name)}
    state, point = initial_state(scene), start
    for row in range(1, found.time.size):
        point = replace(start, **{key: float(values[row]) for key, values in columns.items()})
        state, _ = advance(scene, point, state, float(found.time[row] - found.time[row - 1]))
    deep = scene.at_level("deterministic")
    return deep, point, folded(deep, state)


def roughened(scene: Scene, times: float) -> Scene:
    """Return the scene with `times` the roughness, on the grid and below it."""
    first, second = (
        replace(one, rq=times * one.rms, microroughness=replace(one.microroughness, rms=times * one.microroughness.rms))
        for one in (scene.surface_1, scene.surface_2)
    )
    return replace(scene, surface_1=first, surface_2=second)


def passed(name: str, scene: Scene, point: OperatingPoint, state: ContactState) -> Stressed:
    """Let material of the ring pass a rough contact; without roughness one instant stands for all."""
    contact = life.SmoothContact(Case.bind(scene, point).hertz, BEARING_209.poisson)
    depths, spacing, smooth = contact.depths, scene.film.spacing, not scene.surface_2.rms
    grid = solve(roughened(scene, 0.0), point, initial_state(scene))
    rows = np.abs(grid.y) < EDGE * contact.hertz.b
    below = Subsurface((int(rows.sum()), grid.x.size), spacing, depths, BEARING_209.poisson, "pyfftw")
    h, y = contact.hertz, grid.y[rows][:, None]
    pressed = h.pressure_max * np.sqrt(np.maximum(1.0 - (grid.x[None, :] / h.a) ** 2 - (y / h.b) ** 2, 0.0))
    own = np.stack([von_mises(layer).max(axis=-1) for layer in below.layers(pressed)])
    seen: dict[str, list[float]] = {"h_c": [], "friction": [], "pressure": []}

    def instants() -> Iterator[tuple[Array, Array, int]]:
        step = spacing / max(point.speed_1, point.speed_2)
        count = SETTLE + KEEP + grid.x.size + 2
        for k, moment in enumerate(march(scene, state, lambda _: point, [0.0, count * step])):
            moved = round(moment.time * point.speed_2 / spacing) - SETTLE
            if k % EVERY or moved < 1:
                continue
            fields = moment.fields
            seen["h_c"].append(moment.outputs["h_c"])
            seen["friction"].append(moment.outputs["friction_coefficient"])
            seen["pressure"].append(float(fields.pressure.max()))
            yield fields.pressure[rows], (fields.fluid_shear + fields.solid_shear)[rows], moved

    if smooth:
        sheared = (grid.fluid_shear + grid.solid_shear)[rows]
        stress = np.stack([von_mises(layer).max(axis=-1) for layer in below.layers(grid.pressure[rows], sheared)])[None]
        force = float((grid.fluid_shear + grid.solid_shear).sum()) * spacing**2
        ratio, friction, pressure = math.inf, abs(force) / point.load, float(grid.pressure.max())
    else:
        stress = passing(instants(), spacing, depths, BEARING_209.poisson, KEEP)
        rough = math.hypot(scene.surface_1.rms, scene.surface_2.rms)
        ratio, friction = (float(np.mean(seen[key])) for key in ("h_c", "friction"))
        ratio, pressure = ratio / rough, max(seen["pressure"])
    return Stressed(name, ratio, friction, pressure, stress, own, depths, spacing, contact.fatigue_limit)


def orthogonal(contact: life.SmoothContact, friction: float) -> Array:
    """Largest half range of the shear stress along x on planes parallel to the surface: Lundberg and Palmgren's [Pa]."""
    h, step = contact.hertz, contact.spacing
    across = int(h.b / step) + 2
    x, y = np.arange(-18, 19) * step, np.arange(-across, across + 1) * step
    pressure = np.sqrt(np.maximum(1.0 - (x[None, :] / h.a) ** 2 - (y[:, None] / h.b) ** 2, 0.0))
    below = Subsurface(pressure.shape, step, contact.depths, contact.poisson, "scipy")
    shear = (layer[4] for layer in below.layers(h.pressure_max * pressure, friction * h.pressure_max * pressure))
    return np.stack([0.5 * (each.max(axis=-1) - each.min(axis=-1)) for each in shear])


def ratings(report: Page) -> None:
    geometry = BEARING_209
    own = rating.dynamic_rating(geometry)
    report.say(
        f"### Ratings\n\nC_r by ISO 281 from the dimensions of the 209 (9 balls of 12.7 mm on 65 mm, grooves 0.52): {1e-3 * own:.1f} kN. Lives go with its cube."
    )
    report.header("C_r of 6209 by", "kN", "life over that by the dimensions")
    for name, value in CATALOGUES.items():
        report.row(name, 1e-3 * value, (value / own) ** 3)
    report.say(
        f"Fatigue load limit C_u: {rating.fatigue_load_limit(geometry):.0f} N by Hertz's pressure of 1500 MPa, {rating.simple_fatigue_load_limit(geometry):.0f} N by C_0 / 22."
    )
    report.say(
        "Reference life by ISO 16281 with our load distribution beside examples published with another program (6 balls of 11.1 mm on 43.5 mm, C = 23.4 kN, 1 kN radial):"
    )
    report.header("clearance [um]", "published [10^6 revolutions]", "here", "apart [%]")
    most = 0.0
    for clearance, published in PUBLISHED:
        other = BallBearingGeometry(
            balls=6, ball_diameter=11.1e-3, pitch_diameter=43.5e-3, conformity_inner=0.52, conformity_outer=0.53,
            clearance=clearance,
        )  # fmt: skip
        rest = balance(other, RingLoads(0.0, 1000.0), 0.0)
        found = 1e-6 * float(rating.reference_life(other, 23.4e3, rest.load_inner, rest.load_outer))
        most = max(most, abs(found / published - 1.0))
        report.row(1e6 * clearance, published, found, 100.0 * (found / published - 1.0))
    report.verdict("published reference lives within 1 %", f"{100.0 * most:.2g} %", most < 0.01)
    constants = []
    for race, sign in zip(RACES, (1.0, -1.0), strict=True):
        load = rating.contact_rating(geometry, own, race)
        passes = 0.5e6 * geometry.balls * (1.0 + sign * geometry.ratio)
        contact = life.SmoothContact(geometry.race(race).ellipse(load), geometry.poisson)
        constants.append(passes**rating.WEIBULL * 2.0 * math.pi * geometry.race(race).track * contact.risk())
    apart = (constants[0] / constants[1]) ** (1.0 / rating.WEIBULL)
    report.verdict(
        "one constant of the stress integral gives the ISO lives of both races within 20 %",
        f"that of the inner race: {100.0 * (apart - 1.0):+.0f} % for the outer one",
        abs(apart - 1.0) < 0.2,
    )


def clearances(report: Page) -> None:
    report.say(
        "### Load distribution\n\nISO 281 has the rating of a bearing half of whose balls carry; ISO 16281 the loads of the balls as they are. 2 kN at rest; mean over places of the cage, and the largest and least of them."
    )
    report.header("clearance [um]", "P_ref / F_r", "L10r / L10", "least", "largest")
    own = rating.dynamic_rating(BEARING_209)
    for clearance in (0.0, 5e-6, 15e-6, 30e-6, 45e-6):
        geometry = replace(BEARING_209, clearance=clearance)
        found = []
        for shift in np.arange(12) / 12.0 * 2.0 * math.pi / geometry.balls:
            rest = balance(geometry, RingLoads(0.0, 2000.0), 0.0, first_ball=float(shift))
            found.append(float(rating.reference_life(geometry, own, rest.load_inner, rest.load_outer)))
        over = np.array(found) / rating.rating_life(own, 2000.0)
        mean = 1.0 / float(np.mean(1.0 / over))
        report.row(1e6 * clearance, mean ** (-1.0 / 3.0), mean, float(over.min()), float(over.max()))


def frictions(report: Page, load: float) -> None:
    contact = life.SmoothContact(BEARING_209.inner.ellipse(load), BEARING_209.poisson)
    report.say(
        f"### Friction on smooth contacts\n\nLife over that without friction, shear stress in proportion to Hertz's pressure, inner race. By the largest von Mises stress, which the report takes, and by Lundberg and Palmgren's half range of the orthogonal shear stress, with the same exponents. Without a limit, at any load; with ISO 281's of 1500 MPa, {contact.fatigue_limit * 1e-6:.0f} MPa von Mises, at {load:.0f} N ({1e-9 * contact.hertz.pressure_max:.2f} GPa), over the life without friction and with the limit."
    )
    report.header("friction", "von Mises", "orthogonal shear", "von Mises above the limit")
    plain, sheared = (
        contact.risk(),
        life.risk(orthogonal(contact, 0.0), contact.depths, contact.spacing),
    )
    limited = contact.risk(0.0, contact.fatigue_limit)
    for mu in FRICTION:
        report.row(
            mu,
            life.factor(contact.risk(mu), plain),
            life.factor(life.risk(orthogonal(contact, mu), contact.depths, contact.spacing), sheared),
            life.factor(contact.risk(mu, contact.fatigue_limit), limited),
        )


def contacts(found: BearingRun) -> tuple[list[Stressed], float]:
    """Return the contacts of the most loaded class with our pressures and shear stresses, and its load [N]."""
    scene, point, worn = led(found, CONTACT)
    new = initial_state(scene)
    hot = replace(
        point, temperature=KELVIN + 100.0, body_temperature_1=KELVIN + 100.0, body_temperature_2=KELVIN + 100.0
    )
    thin = replace(hot, speed_1=0.1 * point.speed_1, speed_2=0.1 * point.speed_2)
    cases = [
        passed("smooth, with its film", roughened(scene, 0.0), point, initial_state(roughened(scene, 0.0))),
        passed("rough, new", scene, point, new),
        passed("rough, after 3 h", scene, point, worn),
        passed("new, 100 degC, a tenth of the speed", scene, thin, new),
    ]
    for times in ROUGHER:
        rougher = roughened(scene, times)
        cases.append(passed(f"the same, {times:g} times as rough", rougher, thin, initial_state(rougher)))
    return cases, point.load


def roughs(report: Page, cases: list[Stressed], load: float) -> None:
    columns, _, rows = cases[1].stress.shape
    report.say(
        f"### Rough contacts under a film\n\nContact {CONTACT} at the end of the run, under {load:.0f} N: Hertz's pressure {1e-9 * BEARING_209.inner.ellipse(load).pressure_max:.2f} GPa. {columns} cross sections of the ring, a node apart, are followed from the inlet through the contact in a march of the deterministic level, {rows} nodes across; each place has the largest von Mises stress that it has seen. Life: over that of Hertz's contact without friction, on the same grid. Above the limit: with ISO 281's fatigue limit for both; a_ISO: ISO 281's for kappa = lambda^1.3, e_C = 1 and P = {2000.0:.0f} N, over that for kappa = 4."
    )
    report.header(
        "contact", "lambda", "friction", "largest pressure [GPa]", "largest stress, smooth = 1",
        "share of the risk above 0.2 a", "life", "life below 0.2 a alone", "life above the limit", "a_ISO over that of 4",
    )  # fmt: skip
    limit_ratio = rating.fatigue_load_limit(BEARING_209) / 2000.0
    best = float(rating.life_factor(np.array(4.0), np.array(limit_ratio)))
    for each in cases:
        smooth = life.risk(each.smooth, each.depths, each.spacing, each.limit)
        rough = life.risk(each.stress, each.depths, each.spacing, each.limit)
        kappa = rating.kappa_of_lambda(np.array(min(each.ratio, 100.0)))
        report.row(
            each.name, f"{each.ratio:.2g}" if math.isfinite(each.ratio) else "-", each.friction, 1e-9 * each.pressure,
            float(each.stress.max() / each.smooth.max()), each.near,
            each.factor(), each.factor(depths=slice(NEAR, None)), life.factor(rough, smooth),
            float(rating.life_factor(kappa, np.array(limit_ratio))) / best,
        )  # fmt: skip


def table(report: Page, rated: RatedRun, cases: list[Stressed]) -> dict[str, float]:
    row = rated.run.last
    lives = {
        "ISO 281, L10": rated.basic,
        "ISO 16281, L10r: with the loads of the balls": rated.reference,
        "ISO 16281, L10mr, kappa by viscosity": rated.modified(rated.kappa_of_viscosity),
        "ISO 16281, L10mr, kappa = lambda^1.3 by our film": rated.modified(rated.kappa_of_film),
        "stress integral, smooth, no friction (L10r by its constant)": rated.reference,
        "stress integral, smooth, our friction": rated.stressed,
    }
    hours = {name: rated.hours(values, row) for name, values in lives.items()}
    duty = {name: rated.hours_of_duty(values) for name, values in lives.items()}
    for each in cases[:CASES]:
        name = f"stress integral, {each.name}"
        hours[name], duty[name] = hours["ISO 16281, L10r: with the loads of the balls"] * each.factor(), math.nan
    report.say(
        f"### Lives\n\n{rated.run.speed[row] * 30.0 / math.pi:.0f} rpm, 2 kN radial, oil at {rated.run.of('housing.temperature_oil')[row] - KELVIN:.0f} degC at the end of the run; hours at which 90 % survive, there and if the run (a cold start and 3 h) is repeated. C_r = {1e-3 * rated.dynamic_rating:.1f} kN, e_C = {rated.given.contamination:g}, kappa = {rated.kappa_of_viscosity[row]:.2f} by viscosity, {rated.kappa_of_film[row]:.1f} by our film (lambda = {rated.film_ratio[row]:.1f}). Rough contacts: the factor of the most loaded inner class, below, for all contacts."
    )
    report.header("life", "at the end [h]", "duty repeated [h]", "over L10 of ISO 281")
    for name, value in hours.items():
        report.row(name, value, duty[name] if math.isfinite(duty[name]) else "-", value / hours["ISO 281, L10"])
    return hours


def reasons(report: Page, rated: RatedRun, cases: list[Stressed], load: float) -> None:
    film, new, worn, thin, twice, most = (each.factor() for each in cases)
    row = rated.run.last
    contact = life.SmoothContact(BEARING_209.inner.ellipse(load), BEARING_209.poisson)
    ratio = rated.given.contamination * rated.fatigue_load_limit / rated.reference_load[row]
    uncapped = 0.1 * (1.0 - (2.5671 - 1.9987 / 4.0**0.071739) ** 0.83 * ratio ** (1.0 / 3.0)) ** -9.3
    endless = life.factor(contact.risk(0.0, contact.fatigue_limit), contact.risk())
    report.say(
        "### Why they disagree\n\n"
        f"- *ISO 281 and ISO 16281.* With 15 um of clearance three balls carry: P_ref is {rated.reference_load[row]:.0f} N. Without clearance both agree (table below).\n"
        f"- *a_ISO.* Both kappa count as 4, and P_ref is {rated.reference_load[row] / rated.fatigue_load_limit:.1f} C_u: the factor is at its cap of 50. The stress integral without a limit stands beside L10r. With ISO 281's limit of 1500 MPa the most loaded contact would live {endless:.1g} times as long, since stress above the limit counts by the power 31/3; the standard's formula is milder, {uncapped:.0f} without its cap.\n"
        f"- *Friction* of the oil in a full film, {cases[0].friction:.3f}, costs less than a percent. Lundberg and Palmgren's shear stress hardly knows friction, which shifts its range without widening it.\n"
        f"- *Film.* Its pressure reaches into the inlet and has a slightly lower stress at depth than Hertz's: life times {film:.2f}.\n"
        f"- *Roughness.* Asperities that roll along under a film of {cases[1].ratio:.1f} times the roughness press with {1e-9 * cases[1].pressure:.1f} GPa, but their stress ends within a tenth of a, where {100.0 * cases[1].near:.1g} % of the risk is: life times {new:.3f}, and {worn:.3f} with the tribofilm of the run, which has worn nothing.\n"
        f"- *Thin film.* At lambda = {cases[3].ratio:.2g} ours is times {thin:.2g}, where a_ISO has fallen to a fiftieth: the integral has little volume near the surface, and the stress there is still below that at depth. With {ROUGHER[0]:g} and {ROUGHER[1]:g} times the roughness it is {twice:.2g} and {most:.2g}: there {100.0 * cases[4].near:.2g} and {100.0 * cases[5].near:.2g} % of the risk is above 0.2 a, where the largest stress is up to {cases[5].stress.max() / cases[5].smooth.max():.1f} times that of the smooth contact. That is elastic stress of new asperities, which would yield and run in within a few passes. The standard's factor is lower at first and falls less: its kappa stands for all that thin films do, damage that begins at the surface, wear and run-in included.\n"
        "- *Not in ours:* particles and their dents, residual stress, cracks that begin at the surface, mild wear that removes tired material, spin and the sign of the sliding across the ellipse."
    )


def picture(report: Page, cases: list[Stressed], hours: dict[str, float]) -> None:
    figure = Figure(figsize=(12.0, 8.5), layout="constrained")
    (bars, depth), (section, risks) = figure.subplots(2, 2)
    names = list(hours)[::-1]
    colours = ["#0072B2" if name.startswith("ISO") else "#D55E00" for name in names]
    bars.scatter([hours[name] for name in names], range(len(names)), c=colours)
    bars.grid(axis="x", alpha=0.3)
    bars.set_yticks(
        range(len(names)), [name.replace(": with the loads of the balls", "") for name in names], fontsize=7
    )
    bars.set(xscale="log", xlabel="hours, 90 % survive", title="life at 2 kN, 3000 rpm")
    styles = ("#009E73", "#E69F00", "#D55E00", "#CC79A7", "#56B4E9", "0.5")
    first = cases[0]
    a = first.depths[0] / life.DEPTHS[0]
    depth.plot(1e-9 * first.smooth.max(axis=-1), first.depths / a, "k--", label="Hertz, no friction")
    for each, colour in zip(cases, styles, strict=True):
        middle = np.abs(np.arange(each.smooth.shape[1]) - each.smooth.shape[1] // 2) < each.smooth.shape[1] // 8
        typical = each.stress[..., middle]
        depth.plot(1e-9 * typical.mean(axis=(0, 2)), each.depths / a, color=colour, label=each.name)
        depth.plot(1e-9 * typical.max(axis=(0, 2)), each.depths / a, ":", color=colour)
        share = (each.stress**life.STRESS_POWER).mean(axis=0).sum(axis=-1)
        whole = (first.smooth**life.STRESS_POWER).sum(axis=-1).max()
        risks.plot(share / whole, each.depths / a, color=colour, label=each.name)
    risks.plot((first.smooth**life.STRESS_POWER).sum(axis=-1) / whole, first.depths / a, "k--", label="Hertz")
    for axes in (depth, risks):
        axes.set(yscale="log", ylabel="depth / a")
        axes.invert_yaxis()
        axes.spines[["top", "right"]].set_visible(False)
    depth.set(xlabel="largest von Mises stress [GPa]", title="stress: mean, largest (dotted)")
    depth.legend(frameon=False, fontsize=8, loc="lower right")
    risks.set(
        xscale="log",
        xlim=(1e-3, None),
        xlabel="stress^(31/3) at a depth over Hertz's largest",
        title="where the risk is",
    )
    shown, half = cases[1], cases[1].smooth.shape[1] // 2
    wide = slice(half - 70, half + 71)
    y = 1e6 * (np.arange(141) - 70) * shown.spacing
    mesh = section.pcolormesh(y, 1e6 * shown.depths, 1e-9 * shown.stress[0][:, wide], shading="gouraud", cmap="magma")
    section.set(
        xlabel="y across the track [um]",
        ylabel="depth [um]",
        ylim=(1e6 * 1.2 * a, 0.0),
        title="cross section, rough, new [GPa]",
    )
    figure.colorbar(mesh, ax=section)
    report.picture(
        figure, "bearing_life.png", "lives, stress over depth, a stressed cross section and where the risk is"
    )


def main() -> None:
    report = Page("machines/bearing_life", "Life of ball bearing 209")
    rated = run()
    write(report, rated, *contacts(rated.run))


def write(report: Page, rated: RatedRun, cases: list[Stressed], load: float) -> None:
    """Write all that follows from the run and its solved contacts."""
    hours = table(report, rated, cases)
    picture(report, cases, hours)
    roughs(report, cases, load)
    reasons(report, rated, cases, load)
    frictions(report, load)
    clearances(report)
    ratings(report)
    report.write()


if __name__ == "__main__":
    main()
