"""An instant of the film in the dimensionless units that the kernels work in."""

import math
import threading
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from ..errors import ConvergenceError
from ..kernels.dry import solve_dry
from ..kernels.far_field import far_field
from ..kernels.half_space import HalfSpace
from ..kernels.mixed import Iterate, Problem, Solution
from ..reference import SmoothContact, hertz_point, nijenbanning_venner_moes
from .instant import FilmSolution, FilmState, Grid, Instant, Settings, Step

Array = NDArray[np.float64]

_TABLE = 16385  # entries over 0 <= p <= hardness: relative error of the viscosity below 1e-4
_TABLE_TOP = 2e10  # Pa: no oil flows above
_DRY_TOLERANCE = 1e-6
_DRY_ITERATIONS = 1000
_START_TOLERANCE = 1e-2
_SOLID_SHARE = 0.85  # of the load in `shared_start`: the best of 0.03 to 0.95 from light contact to nearly dry
_LEAST_EASE = 1e-6  # what flows less does not flow
_FAR_FIELD_BELOW = 30.0  # Moes' M: above, what lies beyond a film-sized grid changes the film by less than 1 %
_SLOWEST = 0.25  # unit of speeds, in nodes per time step: entrained more slowly, a film is a matter of squeezing
_FASTEST_CHANGE = 2.0  # of a film in a step, up to which it is of second order


class Scaled:
    """An instant in units of l (lengths), l^2 / radius_x (gaps) and p_H a^2 / l^2 (pressures).

    l^2 = a^2 + 1.4 radius_x h is the size of what carries the load: a of Hertz's circular contact of radius_x, or the
    extent of a film of smooth bodies h that is thicker than that contact is deep. Both keep the solution of order one.
    The unit of speeds is that of entrainment; in a time `step` from a film `start` it is at least a quarter of a node
    per step, so that the film of slow bodies and of bodies at rest is of order one, too. `closing`: speed [m/s] at
    which the bodies come closer, for what lies beyond the grid.
    """

    def __init__(
        self,
        now: Instant,
        grid: Grid,
        settings: Settings,
        start: FilmState | None = None,
        step: Step | None = None,
        closing: float = 0.0,
    ) -> None:
        self.now, self.grid, self.settings = now, grid, settings
        self.closing = closing
        self.step = step if start else None
        self.start = start if step else None
        hertz = hertz_point(now.load, now.radius_x, now.radius_x, now.reduced_modulus)
        self.a = hertz.a
        self.size = film_size(hertz.a, now.radius_x, self.film)
        self.p_unit = hertz.pressure_max * (self.a / self.size) ** 2
        self.h_unit = self.size**2 / now.radius_x
        self.dx, self.floor = grid.spacing / self.size, settings.floor / self.h_unit
        self.load = 2.0 * np.pi / 3.0 / self.dx**2
        self.compliance = (self.a / self.size) ** 3
        self.half_space = half_space(grid.shape, self.compliance * 2.0 / np.pi**2 * self.dx, settings.fft)
        self.cap = now.limit / self.p_unit
        if self.cap.sum() <= 1.01 * self.load:
            raise ConvergenceError(
                f"{now.load:g} N are more than a grid of {grid.shape[1] * grid.spacing:g} m by "
                f"{grid.shape[0] * grid.spacing:g} m can carry at the hardness. Lower the load or enlarge film.domain."
            )
        self.x, self.y = grid.x / self.size, grid.y / self.size
        radius_2 = self.x[None, :] ** 2 + now.radius_x / now.radius_y * self.y[:, None] ** 2
        self.smooth = np.sqrt(np.maximum(1.0 - radius_2, 0.0))
        self.undeformed = 0.5 * radius_2 - now.heights / self.h_unit

    @cached_property
    def contact(self) -> SmoothContact:
        """The smooth contact in the terms of film formulas."""
        now = self.now
        oil = (now.viscosity, now.temperature)
        smooth = SmoothContact.of(
            now.load, now.entrainment_speed, *oil, now.radius_x, now.radius_y, now.reduced_modulus
        )
        if now.ease is None and now.thinned is None:
            return smooth
        before = self.a + inlet_length(self.a, now.radius_x, nijenbanning_venner_moes(smooth))
        at = np.abs(self.grid.y).argmin(), np.abs(self.grid.x + before).argmin()  # where the film builds up
        ease, thinned = self._oil(smooth.viscosity)
        return replace(smooth, viscosity=smooth.viscosity / float(ease[at] * (1.0 + thinned[at])))

    def _oil(self, viscosity: float) -> tuple[Array, Array]:
        """Ease of every node, at least a little, and what shear adds to the fluidity, relative to the eased one at p =
        0, whose viscosity [Pa s] is given.
        """
        ease, thinned = self.now.ease, self.now.thinned
        ease = np.ones(self.grid.shape) if ease is None else np.maximum(ease, _LEAST_EASE)
        return ease, np.zeros(self.grid.shape) if thinned is None else thinned * viscosity / ease

    @cached_property
    def smooth_film(self) -> float:
        """Film [m] that smooth bodies would have, by formula; zero if there is none."""
        now = self.now
        return 0.0 if now.dry or now.entrainment_speed == 0.0 else nijenbanning_venner_moes(self.contact)

    @cached_property
    def film(self) -> float:
        """Film [m] of smooth bodies: by formula, or that of a start from which they have not come so close yet."""
        return max(self.smooth_film, self.start.rigid_gap) if self.start else self.smooth_film

    @cached_property
    def moes_load(self) -> float:
        """Moes' parameter of load; infinite at rest."""
        return self.contact.moes_parameters[0] if self.now.entrainment_speed > 0.0 else math.inf

    @property
    def is_light(self) -> bool:
        """Whether the film is so thick that what lies beyond the grid matters."""
        return self.moes_load < _FAR_FIELD_BELOW or (self.start is not None and self.start.rigid_gap > 0.0)

    @cached_property
    def speed(self) -> float:
        """Unit of speeds [m/s]."""
        return max(self.now.entrainment_speed, _SLOWEST * self.grid.spacing / self.step.dt if self.step else 0.0)

    @cached_property
    def roughness(self) -> float:
        """Rms height [m] of both bodies together where they meet."""
        inside = self.grid.radius_2 < (1.5 * self.size) ** 2
        return float(self.now.heights[inside].std()) if inside.any() else 0.0

    def _history(self) -> tuple[float, Array]:
        """1 / time step, and the mass [m] from which the film has come in it, [ny, nx].

        A second-order step replaces both by those of the backward difference over this step and the one before
        (Hairer & Wanner, Solving Ordinary Differential Equations II, 1996, doi:10.1007/978-3-642-05221-7, V.1).
        """
        if self.step is None or self.start is None:
            return 0.0, np.zeros_like(self.cap)
        per_dt, mass = self.size / (self.speed * self.step.dt), self.start.mass
        if self.step.order == 1 or self.start.dt == 0.0:
            return per_dt, mass
        ratio = self.step.dt / self.start.dt
        own = (1.0 + 2.0 * ratio) / (1.0 + ratio)
        old = ((1.0 + ratio) * mass - ratio**2 / (1.0 + ratio) * self.start.mass_before) / own
        return own * per_dt, np.clip(old, mass / _FASTEST_CHANGE, mass * _FASTEST_CHANGE)

    def problem(self) -> Problem:
        """What the kernels solve."""
        now, (per_dt, mass) = self.now, self._history()
        top = min(now.hardness, _TABLE_TOP)
        fluidity, density, viscosity = _tables(now.viscosity, now.density, now.temperature, top)
        mobility = self.size**3 * self.p_unit / (12.0 * viscosity * self.speed * now.radius_x**2)
        edge, weight = self._beyond
        ease, thinned = self._oil(viscosity)
        return Problem(
            undeformed=self.undeformed,
            cap=self.cap,
            floor=self.floor,
            spacing=self.dx,
            load=self.load,
            mobility=mobility * ease,
            thinned=thinned,
            per_dt=per_dt,
            wedge=now.entrainment_speed / self.speed,
            mass_old=mass / self.h_unit,
            fluidity=fluidity,
            density=density,
            step=top / self.p_unit / (_TABLE - 1),
            compliance=self.compliance,
            edge=edge,
            weight=weight,
            lumped=self.settings.lumped,
        )

    @cached_property
    def _beyond(self) -> tuple[Array, Array]:
        if self.is_light:
            closing = 1.25 * self.closing * self.now.radius_x / (self.speed * self.size)
            wedge = self.now.entrainment_speed / self.speed
            return far_field(self.x, self.y, self.film / self.h_unit, wedge, closing)
        return np.zeros_like(self.cap), np.ones_like(self.cap)

    def iterate(self, state: FilmState) -> Iterate:
        """A film state in these units, scaled to carry the load. Bodies that have carried none are taken to begin as
        rigid ones that sink through oil do.
        """
        begun = state.pressure if state.pressure.any() else self.p_unit * (state.mass.min() / state.mass) ** 2
        total = begun.sum() / self.p_unit
        scale = self.load / total / self.p_unit
        pressure = np.minimum(begun * scale, self.cap)
        fluid = np.minimum(state.fluid * scale, pressure) if begun is state.pressure else pressure.copy()
        return Iterate(pressure, fluid, state.solid.copy(), state.rigid_gap / self.h_unit)

    def dry_start(self) -> Iterate:
        """The dry contact, its fluid still to come."""
        return self._shared(1.0, _DRY_TOLERANCE)[0]

    def lifted_start(self) -> Iterate:
        """A Hertz-like pressure under the film of smooth bodies and the highest asperities."""
        pressure = np.minimum(self.smooth * (self.load / max(float(self.smooth.sum()), 1e-300)), self.cap)
        lift = self.smooth_film + 0.5 * max(float(self.now.heights.max()), 0.0)
        rigid = lift / self.h_unit - self.compliance  # what that pressure deforms the centre by
        return Iterate(pressure, pressure.copy(), np.zeros(pressure.shape, np.bool_), rigid)

    def shared_start(self) -> Iterate:
        """Solids that carry most of the load, above oil that carries the rest.

        Filled valleys drain faster than dry ones fill: from a dry contact, the oil has to break every seal. The
        contact then settles to a share of its own, which is far lower.
        """
        return self._shared(_SOLID_SHARE, _START_TOLERANCE)[0]

    def _shared(self, share: float, tolerance: float) -> tuple[Iterate, bool, int]:
        """Solids that carry `share` of the load in dry contact, above oil that carries the rest like smooth bodies;
        whether they converged, and iterations.
        """
        fluid, gap = np.zeros_like(self.cap), self.undeformed
        if share < 1.0:
            fluid = np.minimum(self.smooth * ((1.0 - share) * self.load / self.smooth.sum()), 0.5 * self.cap)
            gap = gap + self.half_space.deform(fluid)
        left = self.load - float(fluid.sum())
        room = self.cap - fluid
        solid, rigid, converged, iterations = solve_dry(
            self.half_space, gap, room, left, self.smooth, tolerance, _DRY_ITERATIONS
        )
        return Iterate(solid + fluid, fluid, solid > 0.0, rigid + self.floor), converged, iterations

    def dry(self, route: str, share: float = 1.0) -> FilmSolution:
        """The contact without a film: its gap is the floor where solids touch. They carry `share` of the load, oil
        under a pressure like Hertz's the rest.
        """
        tolerance = 0.1 * self.settings.tolerance  # conjugate gradients are cheap, and nothing corrects them
        iterate, converged, iterations = self._shared(share, tolerance)
        gap = iterate.rigid + self.undeformed + self.half_space.deform(iterate.pressure)
        load_error = float(iterate.pressure.sum()) / self.load - 1.0
        mass = np.maximum(gap, self.floor)
        why = "" if converged else f"dry contact short of {tolerance:g} after {iterations} iterations"
        found = Solution(iterate, gap, mass, converged, iterations, tolerance, load_error, 0.0, 0.0, why)
        return self.solution(found, route, "conjugate gradients")

    def solution(self, found: Solution, route: str, algorithm: str) -> FilmSolution:
        """A solution in SI."""
        it = found.iterate
        state = FilmState(
            it.pressure * self.p_unit,
            it.fluid * self.p_unit,
            it.solid,
            found.mass * self.h_unit,
            it.rigid * self.h_unit,
            np.ones((1, 1)) if self.now.ease is None else self.now.ease,
            np.zeros((1, 1)) if self.now.thinned is None else self.now.thinned,
        )
        if self.start and self.step and self.step.order == 2:
            state = replace(state, mass_before=self.start.mass, dt=self.step.dt)
        capped = it.solid & (it.pressure >= self.cap)
        overlap = np.where(capped, np.maximum(self.floor - found.gap, 0.0), 0.0) * self.h_unit
        gap = np.maximum(found.gap, self.floor) * self.h_unit
        return FilmSolution(
            state=state,
            gap=gap,
            overlap=overlap,
            converged=found.converged,
            shortfall=found.shortfall,
            route=route,
            algorithm=algorithm,
            iterations=found.iterations,
            change=found.change,
            load_error=found.load_error,
            load_beyond=1.0 + found.load_error - float(it.pressure.sum()) / self.load,
            complementarity=found.intrusion,
            imbalance=found.imbalance,
            inlet_nodes=self._inlet_nodes(gap),
        )

    def _inlet_nodes(self, gap: Array) -> float:
        """Nodes across the zone before the contact in which the film builds up."""
        radius_2 = self.grid.radius_2
        centre = radius_2 < max(4.0 / 9.0 * self.a**2, 1.01 * float(radius_2.min()))  # at least the nearest nodes
        film = float(gap[centre].mean())
        if self.now.entrainment_speed > 0.0:  # roughness holds the gap open, yet it is the oil's own film that comes in
            film = min(film, self.smooth_film)
        return inlet_length(self.a, self.now.radius_x, film) / self.grid.spacing


def film_size(a: float, radius: float, film: float) -> float:
    """Half width [m] of what carries the load under a film [m] of smooth bodies; a [m] of Hertz's contact if thin."""
    return float(np.sqrt(a**2 + 1.4 * radius * film))


def inlet_length(a: float, radius: float, film: float) -> float:
    """Distance [m] before Hertz's contact at which its gap, (4 sqrt2 / 3 pi) (d/a)^1.5 a^2 / R, is the film [m]."""
    return float(a * (film * radius / a**2 / 0.6) ** (2.0 / 3.0))


_LOCAL = threading.local()  # plans and scratch may not be shared between threads


def half_space(shape: tuple[int, int], scale: float, library: str) -> HalfSpace:
    """The half space of a grid, with plans kept from before."""
    store: dict[tuple[tuple[int, int], float, str], HalfSpace] = _LOCAL.__dict__.setdefault("half_spaces", {})
    key = (shape, scale, library)
    if key not in store:
        if len(store) >= 8:
            store.pop(next(iter(store)))
        store[key] = HalfSpace(*shape, scale, library)
    return store[key]


@lru_cache(maxsize=8)
def _tables(
    viscosity: Callable[[Array, float], Array], density: Callable[[Array], Array], temperature: float, top: float
) -> tuple[Array, Array, float]:
    """1 / viscosity relative to that at p = 0, density ratio, and the viscosity at p = 0."""
    pressure = np.linspace(0.0, top, _TABLE)
    values = viscosity(pressure, temperature)
    return values[0] / values, density(pressure), float(values[0])
