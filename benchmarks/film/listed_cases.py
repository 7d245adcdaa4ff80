"""Listed hard cases about the thesis's case A: steady ones, and marches through sudden changes."""

import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from benchmarks.film.independent import answer_in_time, judge
from benchmarks.film.random_points import CORRELATION, MODULUS, Point
from contact_core import OperatingPoint, Scene, Transient, initial_state, solve
from contact_core.film.instant import Grid
from contact_core.reference import hertz_point


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


CHECKED = {  # what `answer_in_time` has the equations of
    "film.flux": "upwind",
    "surface_1.microroughness.rms": "0 m",
    "surface_2.microroughness.rms": "0 m",
}


def marched(row: Moving, nodes: int) -> Iterator[dict[str, Any]]:
    """Solve and judge a row, step by step."""
    scene = Scene.from_toml("azam_case_a", {"film.points": str(nodes), "film.iterations": "500"} | CHECKED)
    state = initial_state(scene)

    def point(load: float, speed: float) -> OperatingPoint:
        return OperatingPoint(load, speed, speed, scene.operation.temperature)

    state = replace(state, film=solve(scene, point(*row.begin), state).film)
    op = point(*row.then)
    for k in range(1, row.steps + 1):
        start = time.process_time()
        found = solve(scene, op, state, Transient(row.dt, 0, 500))
        ms = 1e3 * (time.process_time() - start)
        judgement = judge(answer_in_time(scene, op, found, state.film.mass, row.dt))
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
