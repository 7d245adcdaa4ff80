"""Hard cases: random operating points and the rows of a list, each held against the equations written once more.

    python -m benchmarks.film.hard_cases random [--shape circle|ellipse|line] [--from N] [--to N] [--part K/N] [--nodes N]
    python -m benchmarks.film.hard_cases rows [--nodes N]
    python -m benchmarks.film.hard_cases report

`random` solves 2000 points of `random_points.py` with `point_contact` on 129x129 nodes at a tolerance of 3e-3 and adds
a line for each to results/hard_cases/random_K_of_N.csv; what stands there already is not solved again. Of ellipses,
whose radii are in a ratio of 0.1 to 10, the nodes are those along the shorter side. Lines have the same radius and
largest pressure, and rows that repeat themselves; their answers are not checked. `rows` solves the listed cases on
three grids. `report` writes docs/measured/film/hard_cases.md and docs/measured/film/hard_cases.png from those files.
"""

import argparse
import csv
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field, fields, replace
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.signal import fftconvolve

from benchmarks.film.random_points import CORRELATION, MODULUS, ROWS, Point, draw
from benchmarks.folders import MEASURED, RESULTS
from contact_core import ContactError, ContactFields, OperatingPoint, Scene, Transient, initial_state, solve
from contact_core.film.instant import Grid
from contact_core.line_contact import line_contact
from contact_core.point_contact import PointContact, point_contact
from contact_core.reference import SmoothContact, hertz_point, nijenbanning_venner_moes

KEPT, DOCS = RESULTS / "hard_cases", MEASURED / "film"
SEED, POINTS, NODES, TOLERANCE = 1, 2000, 129, 3e-3
FLOOR = 1e-9
# what an answer called converged must be within
LIMITS = {"force": 2e-3, "imbalance": 0.1, "complementarity": 0.3, "cavity": 0.01, "gap": 0.01, "bounds": 1e-9}

SAID = ("iterations", "pressure_change", "load_error", "h_c", "h_min", "contact_load_ratio", "contact_area_ratio")

Array = np.ndarray


@dataclass(frozen=True)
class Answer:
    """What a solver says about a contact, in SI, entrained along +x. Arrays [ny, nx]."""

    x: Array
    y: Array
    pressure: Array
    fluid: Array
    solid: Array  # in contact
    film: Array  # gap, at least the floor
    rigid: float
    heights: Array
    load: float
    radius: float  # along x
    radius_y: float
    modulus: float
    speed: float
    hardness: float | Array
    size: float  # half width of what carries the load
    viscosity: Callable[[Array], Array]
    before: Array | None = None  # density ratio times film, one time step ago
    step: float = np.inf

    def mirrored(self) -> "Answer":
        """Seen from the other side."""
        names = ("pressure", "fluid", "solid", "film", "heights", "before")
        turned = {name: values[:, ::-1] for name in names if (values := getattr(self, name)) is not None}
        return replace(self, x=-self.x[::-1], speed=-self.speed, **turned)


def limit(name: str, beyond: float) -> float:
    """The most that a number may be. The solver's formula for what lies beyond the grid is good to 5 %."""
    return LIMITS[name] + (0.05 * abs(beyond) if name == "force" else 0.0)


@dataclass(frozen=True)
class Judgement:
    """How far an answer is from solving the equations: 0 for the exact one."""

    force: float  # force on the grid and beyond it, relative
    beyond: float  # share of it beyond the grid
    imbalance: float  # mass gained or lost in l / u by the film, relative, weighted by pressure
    cavity: float  # load that nodes without pressure would carry if their inflow were dammed up, relative
    complementarity: float  # |gap - floor| of contacts, overlap of others, mean by pressure, in floors
    beneath: float  # as imbalance, of the fluid under the contacts
    gap: float  # between the film reported and that of the pressure, in floors
    bounds: float  # 0 <= fluid <= total <= hardness, fluid = total off contact; in Hertz pressures

    @property
    def failures(self) -> list[str]:
        """Which limits it is not within."""
        return [name for name in LIMITS if not abs(getattr(self, name)) < limit(name, self.beyond)]


COLUMNS = (
    *("case", "name", "nodes", *(entry.name for entry in fields(Point)), "moes_load", "formula_film", "ms"),
    *("converged", "shortfall", "algorithm", *SAID, *(entry.name for entry in fields(Judgement))),
)


@lru_cache(maxsize=4)
def _love(ny: int, nx: int) -> Array:
    """Integrals of 1/r over a unit cell at every distance on the grid."""
    x, y = np.arange(1 - nx, nx)[None, :], np.arange(1 - ny, ny)[:, None]

    def corner(u: Array, v: Array) -> Array:
        return u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / np.abs(v))

    return sum(s * t * corner(x + 0.5 * s, y + 0.5 * t) for s in (-1, 1) for t in (-1, 1))


def deformation(pressure: Array, spacing: float, modulus: float) -> Array:
    """Settlement [m] of both bodies."""
    return 2.0 * spacing / (np.pi * modulus) * fftconvolve(pressure, _love(*pressure.shape), mode="same")


def roelands(viscosity: float, alpha: float) -> Callable[[Array], Array]:
    """Viscosity over pressure."""
    span = np.log(viscosity) + 9.67
    return lambda p: viscosity * np.exp(np.minimum(span * ((1.0 + 5.1e-9 * p) ** (alpha / 5.1e-9 / span) - 1.0), 500.0))


def load_beyond(at: Answer, gap: Array) -> float:
    """Force [N] beyond the inlet edges: p goes on like -x / h^2 under rigid parabolas, ray by ray from the contact."""
    dx, total = at.x[1] - at.x[0], 0.0
    nodes, weights = np.polynomial.legendre.leggauss(60)
    t, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    xx, yy = np.meshgrid(at.x, at.y)
    for edge, normal in ((np.s_[1:-1, 0], xx), (np.s_[0, :], yy), (np.s_[-1, :], yy)):
        x, p, h = xx[edge], at.pressure[edge], gap[edge]
        radius, distance = np.hypot(x, yy[edge]), np.abs(normal[edge])
        begin = radius * (1.0 + 0.5 * dx / distance)  # the cells of the edge reach half a spacing beyond their nodes
        r = begin[:, None] / t
        curvature = ((x / radius) ** 2 / at.radius + (yy[edge] / radius) ** 2 / at.radius_y)[:, None]
        film = h[:, None] + 0.5 * curvature * (r**2 - radius[:, None] ** 2)
        decay = r / radius[:, None] * (h[:, None] / film) ** 2
        ray = (decay * r * begin[:, None] / t**2) @ weights
        total += float((p * ray * dx * distance / radius**2)[x < 0.0].sum())
    return total


def net_inflow(at: Answer, film: Array) -> tuple[Array, Array]:
    """Mass per density and area that comes into each node [m/s], zero on the edge; and rho h^3 / 12 eta about it."""
    dx, f = at.x[1] - at.x[0], at.fluid
    mass = (5.9e8 + 1.34 * f) / (5.9e8 + f) * film
    ease = mass * film**2 / (12.0 * at.viscosity(f))
    along = 0.5 * (ease[:, 1:] + ease[:, :-1]) * np.diff(f, axis=1) / dx
    across = 0.5 * (ease[1:] + ease[:-1]) * np.diff(f, axis=0) / dx
    faces = np.concatenate([0.5 * (mass[:, :1] + mass[:, 1:2]), 1.5 * mass[:, 1:] - 0.5 * mass[:, :-1]], axis=1)
    net, around = np.zeros_like(f), np.ones_like(f)
    inner = np.s_[1:-1, 1:-1]
    net[inner] = (np.diff(along, axis=1)[1:-1] + np.diff(across, axis=0)[:, 1:-1]) / dx
    net[inner] -= at.speed * np.diff(faces, axis=1)[1:-1, :-1] / dx
    if at.before is not None:
        net[inner] -= ((mass - at.before) / at.step)[inner]
    around[inner] = 0.5 * ease[inner] + 0.125 * (ease[:-2, 1:-1] + ease[2:, 1:-1] + ease[1:-1, :-2] + ease[1:-1, 2:])
    return net, around


def judge(at: Answer) -> Judgement:
    """Hold an answer against the equations."""
    if at.speed < 0.0:
        at = at.mirrored()
    dx, p, f, solid = at.x[1] - at.x[0], at.pressure, at.fluid, at.solid
    hertz = hertz_point(at.load, at.radius, at.radius_y, at.modulus)
    gap = at.rigid + at.x[None, :] ** 2 / (2.0 * at.radius) + at.y[:, None] ** 2 / (2.0 * at.radius_y) - at.heights
    gap = gap + deformation(p, dx, at.modulus)
    below, total = p < at.hardness * (1.0 - 1e-12), p.sum()
    beyond = load_beyond(at, gap + at.heights) / at.load if at.speed != 0.0 else 0.0
    # a contact is at the floor or, at the hardness, below it; nothing else overlaps unless it yields
    away = np.where(solid & below, np.abs(gap - FLOOR), np.where(solid, np.maximum(gap - FLOOR, 0.0), 0.0))
    away = np.where(~solid & below, np.maximum(FLOOR - gap, 0.0), away)
    imbalance = cavity = beneath = 0.0
    if at.speed != 0.0:
        film = np.where(solid, FLOOR, np.maximum(gap, FLOOR))
        net, ease = net_inflow(at, film)
        oil = ~solid & (p > 0.0)
        # a film that loses mass sinks to the floor at most; solids at the hardness yield to one that gains
        loss = np.minimum(np.maximum(-net, 0.0), at.speed * film * (film / FLOOR - 1.0) / dx)
        wrong = loss + np.where(below, np.maximum(net, 0.0), 0.0)
        per_mass = at.size / at.speed / max(float((film * p)[oil].sum()), 1e-300)
        imbalance = float((wrong * p)[oil].sum() * per_mass * p[oil].sum() / total)
        dammed = np.where(~solid & (p <= 0.0), np.maximum(net, 0.0), 0.0) * dx**2 / (4.0 * ease)
        cavity = float(np.minimum(dammed, hertz.pressure_max).sum() / total)
        under = np.where(f > 0.0, np.abs(net), np.maximum(net, 0.0)) * np.where(solid, f, 0.0)
        beneath = float(under.sum() * at.size / at.speed / FLOOR / total)
    violated = [-f.min(), (f - p).max(), (p - at.hardness).max(), np.abs(p - f)[~solid].max(initial=0.0)]
    return Judgement(
        force=float(total * dx**2 / at.load + beyond - 1.0),
        beyond=beyond,
        imbalance=imbalance,
        cavity=cavity,
        complementarity=float((away * p).sum() / total / FLOOR),
        beneath=beneath,
        gap=float(np.abs(np.maximum(gap, FLOOR) - at.film).max() / FLOOR),
        bounds=float(max(violated) / hertz.pressure_max),
    )


def film_of(given: dict[str, Any]) -> tuple[float, float]:
    """Moes' M and the film [m] of smooth bodies by formula, of the arguments of `point_contact`."""
    speed = 0.5 * abs(given["speed_1"] + given["speed_2"])
    if speed == 0.0:
        return np.inf, 0.0
    names = ("viscosity", "pressure_viscosity", "radius_x", "radius_y", "reduced_modulus")
    contact = SmoothContact(given["load"], speed, *(given[name] for name in names))
    return contact.moes_parameters[0], nijenbanning_venner_moes(contact)


def answer(given: dict[str, Any], found: PointContact) -> Answer:
    """What `point_contact` found of its arguments."""
    load, radius, radius_y, modulus = (given[name] for name in ("load", "radius_x", "radius_y", "reduced_modulus"))
    size = np.sqrt(hertz_point(load, radius, radius_y, modulus).a ** 2 + 1.4 * radius * film_of(given)[1])
    return Answer(
        x=found.x,
        y=found.y,
        pressure=found.pressure,
        fluid=found.fluid_pressure,
        solid=found.solid_pressure > 0.0,
        film=found.film,
        rigid=-found.approach,
        heights=given["heights_2"],
        load=load,
        radius=radius,
        radius_y=radius_y,
        modulus=modulus,
        speed=0.5 * (given["speed_1"] + given["speed_2"]),
        hardness=given["hardness"],
        size=float(size),
        viscosity=roelands(given["viscosity"], given["pressure_viscosity"]),
    )


def solved(given: dict[str, Any]) -> dict[str, Any]:
    """Solve and judge one contact: a row."""
    moes, film = film_of(given)
    row: dict[str, Any] = {"moes_load": moes, "formula_film": film}
    start, found, why = time.process_time(), None, ""
    try:
        found = point_contact(**given, tolerance=TOLERANCE, floor=FLOOR)
    except ContactError as error:
        why = f"{type(error).__name__}: {error}"
    row["ms"] = 1e3 * (time.process_time() - start)
    if found is None:
        return row | {"converged": 0, "shortfall": why, "algorithm": "none"}
    numbers = {name: getattr(found, name) for name in ("shortfall", "algorithm", *SAID)}
    return row | {"converged": int(found.converged)} | numbers | asdict(judge(answer(given, found)))


def solved_line(point: Point, nodes: int) -> dict[str, Any]:
    """Solve a line contact: a row, without a check."""
    line = point.line
    moes, film = (line.circular_load, line.film) if point.speed != 0.0 else (np.inf, 0.0)
    row: dict[str, Any] = {"moes_load": moes, "formula_film": film}
    start = time.process_time()
    try:
        found = line_contact(**point.line_arguments(nodes), tolerance=TOLERANCE, floor=FLOOR)
    except ContactError as error:
        why = f"{type(error).__name__}: {error}"
        return row | {"ms": 1e3 * (time.process_time() - start), "converged": 0, "shortfall": why, "algorithm": "none"}
    row["ms"] = 1e3 * (time.process_time() - start)
    return (
        row
        | {"converged": int(found.converged)}
        | {name: getattr(found, name) for name in ("shortfall", "algorithm", *SAID)}
    )


def random(shape: str, first: int, last: int, part: int, parts: int, nodes: int) -> None:
    """Solve points `first` to `last` of those drawn, every `parts`-th, and add them to a file."""
    path = KEPT / f"{'random' if shape == 'circle' else shape}_{part}_of_{parts}.csv"
    done = {int(row["case"]) for row in _read(path)}
    for case, point in enumerate(islice(_kept(elliptical=shape == "ellipse"), last), 1):
        if case < first or case % parts != part % parts or case in done:
            continue
        drawn = {"case": case, "nodes": nodes} | asdict(point)
        _add(path, drawn | (solved_line(point, nodes) if shape == "line" else solved(point.arguments(nodes))))


def _kept(*, elliptical: bool) -> Iterator[Point]:
    return (point for point in draw(SEED, elliptical=elliptical) if point is not None)


def _read(path: Path) -> list[dict[str, str]]:
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def _add(path: Path, row: dict[str, Any]) -> None:
    """Add a line to a file of comma-separated values; the columns are the same in all of them."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = not path.exists()
    with path.open("a", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="")
        if new:
            writer.writeheader()
        writer.writerow(row)
    print(*(f"{value:.3g}" if isinstance(value, float) else value for value in row.values()), flush=True)


@dataclass(frozen=True)
class Steady:
    """A row of numerics.md, section 5: steady, by `point_contact`, about the thesis's case A."""

    name: str
    change: dict[str, Any]  # of CASE_A
    also: dict[str, Any] = field(default_factory=dict)  # of the arguments
    starved: float = 0.0  # where the inlet is cut, in Hertz's half widths; 0: nowhere

    def arguments(self, nodes: int) -> dict[str, Any]:
        """Of `point_contact`."""
        point = replace(CASE_A, **self.change)
        given = point.arguments(nodes)
        if self.starved:
            side = self.starved * hertz_point(point.load, point.radius, point.radius, MODULUS).a
            axis = np.linspace(-side, side, nodes)
            given |= {"heights_2": point.heights(Grid(axis, axis), CORRELATION), "domain": (-side, side, -side, side)}
        return given | self.also


def _load(hertz_pressure: float) -> float:
    """Load [N] that gives case A another Hertz pressure [Pa]."""
    return float(CASE_A.load * (hertz_pressure / 1.26e9) ** 3)


CASE_A = Point(number=1, radius=0.01, load=77.85, speed=0.25, viscosity=0.004, rq=127e-9)
SMOOTH = {"rq": 0.0}
STEADY = (
    *(Steady(f"u = {speed:g} m/s", {"speed": speed}) for speed in (0.25, 1e-3, 1e-6, 1e-9, 0.0, -0.25)),
    Steady("p_H 3 GPa", {"load": _load(3e9)}),
    Steady("p_H 0.3 GPa", {"load": _load(0.3e9)}),
    Steady("p_H 0.05 GPa, u = 0.5", {"load": _load(0.05e9), "speed": 0.5}),
    Steady("p_H 0.005 GPa, u = 1e-4", {"load": _load(0.005e9), "speed": 1e-4}),
    Steady("p_H 0.05 GPa, u = 0.5, smooth", {"load": _load(0.05e9), "speed": 0.5} | SMOOTH),
    Steady("p_H 0.005 GPa, u = 1e-4, smooth", {"load": _load(0.005e9), "speed": 1e-4} | SMOOTH),
    Steady("p_H 0.3 GPa, smooth (M = 51)", {"load": _load(0.3e9)} | SMOOTH),
    Steady("starved: domain of 1.1 a", {}, starved=1.1),
    Steady("oil of 1 mPa s", {"viscosity": 1e-3}),
    Steady("oil of 1 mPa s, smooth", {"viscosity": 1e-3} | SMOOTH),
    Steady("smooth (M = 3757)", SMOOTH),
    Steady("p_H 3 GPa, smooth", {"load": _load(3e9)} | SMOOTH),
    Steady("u = 1e-3, smooth", {"speed": 1e-3} | SMOOTH),
    Steady("Rq 500 nm, cap 6 GPa", {"rq": 500e-9}),
    Steady("Rq 1500 nm, cap 6 GPa", {"rq": 1500e-9}),
    Steady("Rq 500 nm, cap 3 GPa", {"rq": 500e-9}, {"hardness": 3e9}),
    Steady("no piezoviscosity", {}, {"pressure_viscosity": 1e-10}),
    Steady("thick film: u = 20", {"speed": 20.0}),
)


@dataclass(frozen=True)
class Moving:
    """A row of the same: instants one after the other by `contact_core.solve`, from the steady film of the first."""

    name: str
    begin: tuple[float, float]  # load [N] and entrainment speed [m/s]
    then: tuple[float, float]
    steps: int
    dt: float  # s


MOVING = (
    Moving("stop: u 0.25 to 1e-6", (77.85, 0.25), (77.85, 1e-6), 5, 2e-4),
    Moving("reversal in one step", (77.85, 0.25), (77.85, -0.25), 7, 2e-5),
    Moving("u 0.25 to 4 in one step", (77.85, 0.25), (77.85, 4.0), 3, 2e-5),
    Moving("u 4 to 0.01 in one step", (77.85, 4.0), (77.85, 0.01), 3, 2e-5),
    Moving("load x10 in one step", (7.785, 0.25), (77.85, 0.25), 3, 2e-5),
    Moving("load /10 in one step", (77.85, 0.25), (7.785, 0.25), 3, 2e-5),
    Moving("load x10 and reversal in one step", (7.785, 0.25), (77.85, -0.25), 3, 2e-5),
)
GRIDS = (65, 129, 257)


def marched(row: Moving, nodes: int) -> Iterator[dict[str, Any]]:
    """Solve and judge a row, step by step."""
    scene = Scene.from_toml("azam_case_a", {"film.points": str(nodes), "film.iterations": "500"})
    state = initial_state(scene)

    def point(load: float, speed: float) -> OperatingPoint:
        return OperatingPoint(load, speed, speed, scene.operation.temperature)

    state = replace(state, film=solve(scene, point(*row.begin), state).film)
    op = point(*row.then)
    for k in range(1, row.steps + 1):
        start = time.process_time()
        found = solve(scene, op, state, Transient(row.dt, 0, 500))
        ms = 1e3 * (time.process_time() - start)
        judgement = judge(_answer_of(scene, op, found, state.film.mass, row.dt))
        state = replace(state, film=found.film)
        yield {
            "name": f"{row.name}, step {k}",
            "ms": ms,
            "converged": int(found.converged),
            "shortfall": found.shortfall,
            "algorithm": found.algorithm,
            "iterations": found.iterations,
            "pressure_change": found.pressure_change,
            "load_error": found.load_error,
            "h_c": float(
                found.gap[np.hypot(found.x[None, :], found.y[:, None]) < 2.0 / 3.0 * scene.hertz(op.load).a].mean()
            ),
            "h_min": float(found.gap.min()),
            "contact_load_ratio": float(found.solid_pressure.sum() / found.pressure.sum()),
            "contact_area_ratio": float(
                (found.solid_pressure > 0.0).sum() * scene.film.spacing**2 / scene.hertz(op.load).area
            ),
        } | asdict(judgement)


def _answer_of(scene: Scene, op: OperatingPoint, found: ContactFields, before: Array, dt: float) -> Answer:
    """One instant of `contact_core.solve`."""
    return Answer(
        x=found.x,
        y=found.y,
        pressure=found.pressure,
        fluid=found.fluid_pressure,
        solid=found.film.solid,
        film=found.gap,
        rigid=found.film.rigid_gap,
        heights=found.heights,
        load=op.load,
        radius=scene.geometry.radius_x,
        radius_y=scene.geometry.radius_y,
        modulus=scene.solids.reduced_modulus,
        speed=op.entrainment_speed,
        hardness=scene.plasticity.limit(found.cover_1, found.cover_2, 0.0, 1.0),
        size=scene.hertz(op.load).a,
        viscosity=lambda p: scene.lubricant.viscosity(p, op.temperature),
        before=before,
        step=dt,
    )


def rows(grids: tuple[int, ...]) -> None:
    """Solve the list on grids, each from its beginning."""
    for nodes in grids:
        path = KEPT / f"rows_{nodes}.csv"
        path.unlink(missing_ok=True)
        for row in STEADY:
            _add(path, {"name": row.name, "nodes": nodes} | solved(row.arguments(nodes)))
        for moving in MOVING:
            for line in marched(moving, nodes):
                _add(path, {"nodes": nodes} | line)


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
        "The check, of those that are called converged:",
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
        f"meet the stopping rule{f'; {len(wrong)} of them fail the check' if checked else ''}.**",
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
    """Where the points lie, by Moes' M and formula film over Rq, and what found them."""
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
    found = {int(line["case"]): line for path in sorted(KEPT.glob("random_*.csv")) for line in _read(path)}
    drawn = [found[case] for case in sorted(found)]
    ellipses = [line for path in sorted(KEPT.glob("ellipse_*.csv")) for line in _read(path)]
    lines = [line for path in sorted(KEPT.glob("line_*.csv")) for line in _read(path)]
    listed = [line for nodes in GRIDS for line in _read(KEPT / f"rows_{nodes}.csv")]
    text = [
        "# Hard cases",
        "",
        "Written by `python -m benchmarks.film.hard_cases report` from what its other two commands found.",
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
        _map(drawn, DOCS / "hard_cases.png")
    if ellipses:
        nodes = ", ".join(sorted({line["nodes"] for line in ellipses}))
        ellipses.sort(key=lambda line: int(line["case"]))
        text += ["## Random ellipses", "", ELLIPSE_NOTE.format(nodes=nodes), "", *_random_tables(ellipses), ""]
    if lines:
        lines.sort(key=lambda line: int(line["case"]))
        text += ["## Random lines", "", LINE_NOTE, "", *_random_tables(lines), ""]
    if listed:
        text += ["## Rows", ROWS_NOTE, "", *_row_table(listed), ""]
    (DOCS / "hard_cases.md").write_text("\n".join(text))
    wrong = sum("0 of them fail" not in line for line in text if "of them fail" in line)
    sys.exit(f"{wrong} groups of points have answers that are called converged and fail the check" if wrong else 0)


RANDOM_NOTE = f"""
`point_contact` on {NODES}x{NODES} nodes, tolerance {TOLERANCE:g}. Log-uniform: R 1-100 mm, load 0.1-1000 N,
speed 1e-6-20 m/s of either sign (5 % stand still), viscosity 1e-4-10 Pa s, Rq 1 nm-1.5 um (20 % smooth); correlation
length 20 um or two nodes, 15 GPa^-1, cap 6 GPa. Dropped: p_H above 4 GPa, or a formula film above R / 100. Times are of
one thread and hold both grids of the error estimate.

The check solves nothing: it computes deformation, mass balance and load of the answer a second time, in SI, by other
code, and looks at bounds. force: on the grid and beyond it (limit: and 5 % of what lies beyond). imbalance: mass
gained or lost in l / u by the film, weighted by pressure. cavity: load that nodes without pressure would carry if
their inflow were dammed up. complementarity: distance of contacts from the floor, overlap of others, in floors.
beneath: as imbalance, of the fluid under contacts, per floor. gap: between the film reported and that of the pressure,
in floors. bounds: 0 <= fluid <= total <= hardness, fluid = total off contact, in Hertz pressures."""
ELLIPSE_NOTE = """
The same points with the radius along y in a ratio of 0.1 to 10, log-uniform, to the one along x, on grids of {nodes}
nodes along the shorter side. M is that of R_x."""
LINE_NOTE = f"""
The same points as line contacts without ends, of the same radius and largest pressure, by `line_contact` on {ROWS} rows
of {NODES} nodes that repeat themselves across. M is that of the circular contact as near to rigid. Nothing checks the
answers here."""
ROWS_NOTE = """
Case A of the thesis (77.85 N, R 10 mm, 4 mPa s, 15 GPa^-1, 0.25 m/s, Rq 127 nm, cap 6 GPa) unless the row says
otherwise; steady rows by `point_contact`, those in time by `solve` with `Transient` (the scene azam_case_a; W_c and h_c
of the last step, ms the mean of the steps). imbalance and floors (complementarity) are the worst of all grids and steps
by the check; a time step may owe more, because the next one makes up for it."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("random", "rows", "report"))
    parser.add_argument("--from", dest="first", type=int, default=1)
    parser.add_argument("--to", dest="last", type=int, default=POINTS)
    parser.add_argument("--part", default="1/1", help="k/n: every n-th point, from the k-th")
    parser.add_argument("--nodes", type=int, choices=GRIDS, help="of the random points; only this grid of the rows")
    parser.add_argument("--shape", choices=("circle", "ellipse", "line"), default="circle", help="of the random points")
    args = parser.parse_args()
    if args.what == "random":
        part, parts = map(int, args.part.split("/"))
        random(args.shape, args.first, args.last, part, parts, args.nodes or NODES)
    elif args.what == "rows":
        rows((args.nodes,) if args.nodes else GRIDS)
    else:
        report()


if __name__ == "__main__":
    main()
