"""Deterministic mixed lubrication: fluid and solid pressure node by node, from full film to dry contact."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..errors import ConvergenceError
from ..kernels.dry import solve_dry
from ..kernels.half_space import HalfSpace
from ..kernels.mixed import Iterate, Problem, Solution, advected, solve_mixed
from ..quantities import parameter
from ..reference import SmoothContact, hertz_point, nijenbanning_venner_moes

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_TABLE = 16385  # entries over 0 <= p <= hardness: relative error of the viscosity below 1e-5
_DRY_TOLERANCE = 1e-4
_DRY_ITERATIONS = 1000
_DIRECT = 60  # iterations a steady film gets before it is marched in time
_MARCH_NODES = 3.0  # nodes by which the oil moves in such a time step
_MARCH_ITERATIONS = 10
_MARCH_IMBALANCE = 0.02  # share of its mass that a steady film may still gain or lose in a / u_e
_MARCH_CALM = 3  # time steps that must agree
# a mixed solution short of its tolerance is still better than the dry one within these
_LOAD_ACCEPTED = 1e-3
_CHANGE_ACCEPTED = 0.1
_INTRUSION_ACCEPTED = 20.0


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


@dataclass(frozen=True)
class Deterministic:
    """Reynolds' equation for the fluid on every node, solids where the gap is at its floor, 0 <= p <= hardness.

    The half space deforms under the sum of both pressures. The boundary pressure is zero at the edge of the grid.
    """

    name: ClassVar[str] = "deterministic"
    source: ClassVar[str] = (
        "Azam et al. 2019, doi:10.1016/j.triboint.2018.11.011; the split of fluid and solid pressure is ours"
    )

    points: int = parameter("", "grid nodes along x and along y", least=17, most=4097, shapes_arrays=True)
    domain: float = parameter(
        "m", "side of the square grid, centred on the contact", above=0.0, most=1.0, shapes_arrays=True
    )
    floor: float = parameter(
        "m", "gap at which solids touch: thickness of the adsorbed boundary layer", above=1e-11, most=1e-7
    )
    tolerance: float = parameter(
        "", "pressure change at which a solution counts as converged, relative", above=0.0, most=0.1
    )
    iterations: int = parameter("", "most iterations of one solution", least=1, most=100_000)
    fft: str = parameter("", "library of the Fourier transforms", choices=("pyfftw", "scipy"), default="pyfftw")

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""
        return self.domain / (self.points - 1)

    @property
    def axis(self) -> Array:
        """Coordinates of the nodes along x, and along y [m]; zero is the centre of the contact."""
        nodes: Array = np.arange(self.points, dtype=np.float64)
        return (nodes - 0.5 * (self.points - 1)) * self.spacing

    def solve(
        self, now: Instant, start: FilmState | None, step: float | None, moved: int, iterations: int | None = None
    ) -> FilmSolution:
        """Solve one instant.

        start: a solution nearby, or None to start dry. step: time [s] since `start`, or None for a steady film.
        moved: nodes by
        which the rough surfaces have moved along +x since `start`. iterations: fewer than the scene allows. Raises
        ConvergenceError if even the dry contact has no solution. Entrainment along -x is solved in the mirror.
        """
        if now.entrainment_speed < 0.0:
            mirrored = replace(
                now, entrainment_speed=-now.entrainment_speed, heights=now.heights[:, ::-1], limit=now.limit[:, ::-1]
            )
            return _mirror(self.solve(mirrored, start and _mirror_state(start), step, -moved, iterations))
        scaled = _Scaled(self, now)
        if now.dry or now.entrainment_speed == 0.0:
            return scaled.dry("dry")
        begins = scaled.fresh_starts()
        if start is not None:
            begins.insert(0, lambda: advected(scaled.iterate(start), scaled.smooth, moved))
        budget, spent = min(iterations or self.iterations, self.iterations), 0
        for begin in begins:
            if start is None or step is None:
                found = _steady(scaled, begin(), self.tolerance, budget)
            else:
                problem = scaled.problem(start.mass / scaled.length, scaled.per_dt(step))
                found = solve_mixed(scaled.half_space, problem, begin(), self.tolerance, budget)
            spent += found.iterations
            if _usable(found):
                return scaled.solution(found, spent)
        return replace(scaled.dry("fallback"), converged=False, iterations=spent)


def _steady(scaled: "_Scaled", begin: Iterate, tolerance: float, iterations: int) -> Solution:
    """A steady film: at once where that works; else by time steps over standing surfaces until nothing moves.

    Time lets the oil in step by step and keeps the mass; without it a rough film from a dry start takes thousands of
    iterations, of which each looks converged.
    """
    found = solve_mixed(scaled.half_space, scaled.problem(None, 0.0), begin, tolerance, min(iterations, _DIRECT))
    spent, calm = found.iterations, 0
    if found.converged:
        return found
    per_dt = 1.0 / (_MARCH_NODES * scaled.dx)
    while spent < iterations:
        before = found
        problem = scaled.problem(before.mass, per_dt)
        found = solve_mixed(scaled.half_space, problem, before.iterate, 0.0, min(_MARCH_ITERATIONS, iterations - spent))
        spent += found.iterations
        weight = found.iterate.pressure
        imbalance = float((np.abs(found.mass - before.mass) * weight).sum() * per_dt / (found.mass * weight).sum())
        moved = float(np.abs(found.iterate.pressure - before.iterate.pressure).sum()) / scaled.load
        found = replace(found, iterations=spent, imbalance=imbalance, change=moved)
        calm = calm + 1 if moved < 0.25 * tolerance and imbalance < _MARCH_IMBALANCE else 0
        if calm == _MARCH_CALM:
            return replace(found, converged=True)
    return found


def _usable(solution: Solution) -> bool:
    finite = np.isfinite(solution.change) and np.isfinite(solution.iterate.rigid)
    settled = solution.change < _CHANGE_ACCEPTED and solution.intrusion < _INTRUSION_ACCEPTED
    return bool(finite and settled and abs(solution.load_error) < _LOAD_ACCEPTED)


class _Scaled:
    """An instant in Hertz units of the circular contact of radius_x: lengths a, pressures p_H, gaps a^2 / radius_x."""

    def __init__(self, film: Deterministic, now: Instant) -> None:
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
        )

    def iterate(self, state: FilmState) -> Iterate:
        total = state.pressure.sum() / self.p_h
        scale = self.load / total / self.p_h if total > 0.0 else 1.0 / self.p_h
        pressure = np.minimum(state.pressure * scale, self.cap)
        return Iterate(
            pressure, np.minimum(state.fluid * scale, pressure), state.solid.copy(), state.rigid_gap / self.length
        )

    def fresh_starts(self) -> list[Callable[[], Iterate]]:
        """Where to begin from nothing: the dry contact, or Hertz's pressure under the smooth film if that clears
        the roughness.
        """
        now = self.now
        eta = now.viscosity(np.array([0.0, 1e6]), now.temperature)
        contact = SmoothContact(
            now.load,
            now.entrainment_speed,
            float(eta[0]),
            float(np.log(eta[1] / eta[0])) * 1e-6,
            now.radius_x,
            now.radius_y,
            now.reduced_modulus,
        )
        film = nijenbanning_venner_moes(contact)

        def dry() -> Iterate:
            pressure, rigid, _, _ = self.dry_pressure()
            return Iterate(pressure, np.zeros_like(pressure), pressure > 0.0, rigid + self.floor)

        def lifted() -> Iterate:
            pressure = np.minimum(self.smooth * (self.load / self.smooth.sum()), self.cap)
            rigid = -1.0 + (film + 0.5 * max(float(now.heights.max()), 0.0)) / self.length
            return Iterate(pressure, pressure.copy(), np.zeros(pressure.shape, np.bool_), rigid)

        return [lifted, dry] if film > 3.0 * float(now.heights.std()) else [dry, lifted]

    def dry_pressure(self) -> tuple[Array, float, bool, int]:
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
        it = found.iterate
        state = FilmState(
            it.pressure * self.p_h, it.fluid * self.p_h, it.solid, found.mass * self.length, it.rigid * self.length
        )
        capped = it.solid & (it.pressure >= self.cap)
        overlap = np.where(capped, np.maximum(self.floor - found.gap, 0.0), 0.0) * self.length
        gap = np.maximum(found.gap, self.floor) * self.length
        x = self.film.axis / self.a
        centre = (x[None, :] ** 2 + x[:, None] ** 2) < max(2.0 / 3.0, 0.71 * self.dx) ** 2  # at least the nearest nodes
        film = float(gap[centre].mean()) / self.length
        # the inlet zone ends where the Hertz gap, (4 sqrt2/3pi) d^1.5 at a distance d before the contact, is the film
        inlet = (film / 0.6) ** (2.0 / 3.0) / self.dx
        return FilmSolution(
            state, gap, overlap, found.converged, "mixed", iterations, found.change, found.load_error, inlet
        )


def _mirror_state(state: FilmState) -> FilmState:
    pressure, fluid, mass = (np.ascontiguousarray(f[:, ::-1]) for f in (state.pressure, state.fluid, state.mass))
    return FilmState(pressure, fluid, np.ascontiguousarray(state.solid[:, ::-1]), mass, state.rigid_gap)


def _mirror(solution: FilmSolution) -> FilmSolution:
    return replace(
        solution,
        state=_mirror_state(solution.state),
        gap=np.ascontiguousarray(solution.gap[:, ::-1]),
        overlap=np.ascontiguousarray(solution.overlap[:, ::-1]),
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
