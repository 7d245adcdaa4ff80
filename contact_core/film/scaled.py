"""An instant of the film in SI, and in the Hertz units that the kernels work in."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import ConvergenceError
from ..kernels.dry import solve_dry
from ..kernels.half_space import HalfSpace
from ..kernels.mixed import Iterate, Problem, Solution
from ..reference import SmoothContact, hertz_point, nijenbanning_venner_moes

if TYPE_CHECKING:
    from .deterministic import Deterministic

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_TABLE = 16385  # entries over 0 <= p <= hardness: relative error of the viscosity below 1e-5
_DRY_TOLERANCE = 1e-4
_DRY_ITERATIONS = 1000


@dataclass(frozen=True)
class Instant:
    """What the film has to be solved for, in SI. Arrays [ny, nx]."""

    load: float
    entrainment_speed: float  # of either sign
    temperature: float
    radius_x: float
    radius_y: float
    reduced_modulus: float
    viscosity: Callable[[Array, float], Array]  # [Pa s] at pressures and a temperature
    density: Callable[[Array], Array]  # ratio to that at p = 0, at pressures
    heights: Array  # of both bodies together, positive into the gap
    limit: Array  # largest pressure
    hardness: float  # no limit is above it
    dry: bool = False  # leave the fluid out


@dataclass(frozen=True)
class FilmState:
    """A film solution in SI, from which the next may start. Arrays [ny, nx]."""

    pressure: Array
    fluid: Array
    solid: Mask
    mass: Array  # density ratio times film thickness
    rigid_gap: float  # gap of the undeformed, smooth bodies at the centre

    def __post_init__(self) -> None:
        for array in (self.pressure, self.fluid, self.solid, self.mass):
            array.setflags(write=False)


@dataclass(frozen=True)
class FilmSolution:
    """The film of one instant. `gap` is at least the floor; `overlap` is what is missing to it and yields
    plastically.
    """

    state: FilmState
    gap: Array
    overlap: Array
    converged: bool
    route: str  # "mixed", "dry" (asked for, or no entrainment) or "fallback"
    iterations: int
    change: float
    load_error: float
    inlet_nodes: float  # grid nodes across the inlet zone of the film; below 3 the film is a number of the grid


class Scaled:
    """An instant in Hertz units of the circular contact of radius_x: lengths a, pressures p_H, gaps a^2 / radius_x."""

    def __init__(self, film: "Deterministic", now: Instant) -> None:
        hertz = hertz_point(now.load, now.radius_x, now.radius_x, now.reduced_modulus)
        self.film, self.now = film, now
        self.a, self.p_h, self.length = hertz.a, hertz.pressure_max, hertz.a**2 / now.radius_x
        self.dx, self.floor = film.spacing / self.a, film.floor / self.length
        self.load = 2.0 * np.pi / 3.0 / self.dx**2
        self.half_space = _half_space(film.points, 2.0 / np.pi**2 * self.dx, film.fft)
        self.cap = now.limit / self.p_h
        if self.cap.sum() <= 1.01 * self.load:
            raise ConvergenceError(
                f"{now.load:g} N are more than the grid of {film.domain:g} m can carry at the hardness. "
                "Lower the load or enlarge film.domain."
            )
        x = film.axis / self.a
        self.smooth = np.sqrt(np.maximum(1.0 - x[None, :] ** 2 - now.radius_x / now.radius_y * x[:, None] ** 2, 0.0))
        shape = 0.5 * (x[None, :] ** 2 + now.radius_x / now.radius_y * x[:, None] ** 2)
        self.undeformed = shape - now.heights / self.length

    def per_dt(self, step: float) -> float:
        """1 / time step in Hertz units."""
        return self.a / (self.now.entrainment_speed * step)

    def problem(self, mass: Array | None, per_dt: float) -> Problem:
        """What the kernels solve; `mass` [ny, nx] is that of the instant before, None for a steady film."""
        now = self.now
        fluidity, density, viscosity = _tables(now.viscosity, now.density, now.temperature, now.hardness)
        mobility = self.a**3 * self.p_h / (12.0 * viscosity * now.entrainment_speed * now.radius_x**2)
        return Problem(
            self.undeformed,
            self.cap,
            self.floor,
            self.dx,
            self.load,
            mobility,
            per_dt,
            np.zeros_like(self.cap) if mass is None else mass,
            fluidity,
            density,
            now.hardness / self.p_h / (_TABLE - 1),
            1.0,
            np.zeros_like(self.cap),
            np.ones_like(self.cap),
        )

    def iterate(self, state: FilmState) -> Iterate:
        """A film state in Hertz units, scaled to carry the load."""
        total = state.pressure.sum() / self.p_h
        scale = self.load / total / self.p_h if total > 0.0 else 1.0 / self.p_h
        pressure = np.minimum(state.pressure * scale, self.cap)
        return Iterate(
            pressure, np.minimum(state.fluid * scale, pressure), state.solid.copy(), state.rigid_gap / self.length
        )

    @cached_property
    def smooth_film(self) -> float:
        """Film [m] that smooth bodies would have, by formula."""
        now = self.now
        eta = now.viscosity(np.array([0.0, 1e6]), now.temperature)
        rise = float(np.log(eta[1] / eta[0])) * 1e-6
        return nijenbanning_venner_moes(
            SmoothContact(
                load=now.load,
                entrainment_speed=now.entrainment_speed,
                viscosity=float(eta[0]),
                pressure_coefficient=rise,
                radius_x=now.radius_x,
                radius_y=now.radius_y,
                reduced_modulus=now.reduced_modulus,
            )
        )

    @property
    def full_film(self) -> bool:
        """Whether the smooth film clears the roughness."""
        return self.smooth_film > 3.0 * float(self.now.heights.std())

    def fresh_starts(self) -> list[Callable[[], Iterate]]:
        """Where to begin from nothing, the likelier first: the dry contact, Hertz's pressure under the smooth film."""

        def dry() -> Iterate:
            pressure, rigid, _, _ = self.dry_pressure()
            return Iterate(pressure, np.zeros_like(pressure), pressure > 0.0, rigid + self.floor)

        def lifted() -> Iterate:
            pressure = np.minimum(self.smooth * (self.load / max(float(self.smooth.sum()), 1e-300)), self.cap)
            rigid = -1.0 + (self.smooth_film + 0.5 * max(float(self.now.heights.max()), 0.0)) / self.length
            return Iterate(pressure, pressure.copy(), np.zeros(pressure.shape, np.bool_), rigid)

        return [lifted, dry] if self.full_film else [dry, lifted]

    def dry_pressure(self) -> tuple[Array, float, bool, int]:
        """Pressure and rigid gap without a fluid, and whether and when that converged."""
        start = np.where(self.smooth > 0.0, self.smooth, 0.0)
        return solve_dry(self.half_space, self.undeformed, self.cap, self.load, start, _DRY_TOLERANCE, _DRY_ITERATIONS)

    def dry(self, route: str) -> FilmSolution:
        """The contact without fluid pressure: its gap is the floor where solids touch."""
        pressure, rigid, converged, iterations = self.dry_pressure()
        rigid += self.floor
        gap = rigid + self.undeformed + self.half_space.deform(pressure)
        mass = np.maximum(gap, self.floor)
        iterate = Iterate(pressure, np.zeros_like(pressure), pressure > 0.0, rigid)
        load_error = float(pressure.sum()) / self.load - 1.0
        found = Solution(iterate, gap, mass, converged, iterations, _DRY_TOLERANCE, load_error, 0.0, 0.0)
        return replace(self.solution(found, iterations), route=route)

    def solution(self, found: Solution, iterations: int) -> FilmSolution:
        """A solution in SI."""
        it = found.iterate
        state = FilmState(
            it.pressure * self.p_h, it.fluid * self.p_h, it.solid, found.mass * self.length, it.rigid * self.length
        )
        capped = it.solid & (it.pressure >= self.cap)
        overlap = np.where(capped, np.maximum(self.floor - found.gap, 0.0), 0.0) * self.length
        gap = np.maximum(found.gap, self.floor) * self.length
        x = self.film.axis / self.a
        centre = (x[None, :] ** 2 + x[:, None] ** 2) < max(2.0 / 3.0, 0.71 * self.dx) ** 2  # at least the nearest nodes
        film = float(gap[centre].mean())
        if self.now.entrainment_speed > 0.0:  # roughness holds the gap open, yet it is the oil's own film that comes in
            film = min(film, self.smooth_film)
        # the inlet zone ends where the Hertz gap, (4 sqrt2/3pi) d^1.5 at a distance d before the contact, is the film
        inlet = (film / self.length / 0.6) ** (2.0 / 3.0) / self.dx
        return FilmSolution(
            state, gap, overlap, found.converged, "mixed", iterations, found.change, found.load_error, inlet
        )


_LOCAL = threading.local()  # plans and scratch may not be shared between threads


def _half_space(points: int, scale: float, library: str) -> HalfSpace:
    store: dict[tuple[int, float, str], HalfSpace] = _LOCAL.__dict__.setdefault("half_spaces", {})
    key = (points, scale, library)
    if key not in store:
        if len(store) >= 4:
            store.pop(next(iter(store)))
        store[key] = HalfSpace(points, points, scale, library)
    return store[key]


@lru_cache(maxsize=8)
def _tables(
    viscosity: Callable[[Array, float], Array], density: Callable[[Array], Array], temperature: float, top: float
) -> tuple[Array, Array, float]:
    """1 / viscosity relative to that at p = 0, density ratio, and the viscosity at p = 0."""
    pressure = np.linspace(0.0, top, _TABLE)
    values = viscosity(pressure, temperature)
    return values[0] / values, density(pressure), float(values[0])
