"""An instant of the film in the dimensionless units that the kernels work in."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ConvergenceError
from ..kernels.arrays import Array, Mask
from ..kernels.far_field import far_field
from ..kernels.giving_half_space import giving
from ..kernels.half_space import HalfSpace
from ..kernels.mixed.problem import Iterate, Problem, Solution
from ..reference import SmoothContact, SmoothLine
from ..reference.starvation import film_behind_meniscus, supplied_film
from .instant import FilmState, Grid, Instant, Settings, Step
from .lengths import FAR_FIELD_BELOW, film_size, inlet_length
from .shared import ENTRIES, half_space, tables
from .slow_film import SlowFilm

_TABLE_TOP = 2e10  # Pa: no oil flows above
_LEAST_EASE = 1e-6  # below it, oil does not flow
_SLOWEST = 0.25  # unit of speeds, in nodes per time step: below it, squeezing dominates
_FASTEST_CHANGE = 2.0  # of a film in a step, up to which it is of second order


@dataclass(frozen=True)
class Images:
    """Rows as the kernels see them: a periodic grid's with images of the last before the first and the first after."""

    periodic: bool

    def of(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return a field on the rows of the kernels."""
        return np.concatenate([field[-1:], field, field[:1]]) if self.periodic else field

    def iterate(self, start: Iterate) -> Iterate:
        """Return an iterate on them."""
        return Iterate(self.of(start.pressure), self.of(start.fluid), self.of(start.solid), start.rigid)

    def removed(self, found: Solution) -> Solution:
        """Return a solution of the kernels on the rows of the grid."""
        if not self.periodic:
            return found
        it, own = found.iterate, np.s_[1:-1]
        iterate = Iterate(it.pressure[own].copy(), it.fluid[own].copy(), it.solid[own].copy(), it.rigid)
        return replace(found, iterate=iterate, gap=found.gap[own].copy(), mass=found.mass[own].copy())


class Scaled:
    """An instant in units of l (lengths), l^2 / radius_x (gaps) and p_H (a / l)^n (pressures; n = 2, for lines 1).

    l^2 = a^2 + 1.4 radius_x h is the size of the loaded zone: a of Hertz's contact along x, or the extent of a
    film of smooth bodies h that is thicker than that contact is deep. Both keep the solution of order one.
    The unit of speeds is that of entrainment; in a time `step` from a film `start` it is at least a quarter of a node
    per step, so that the film of slow bodies and of bodies at rest is of order one, too. For the film beyond the grid:
    `closing`, the speed [m/s] at which the bodies approach, and `apart`, their film [m]; None: that of smooth ones.
    `slow`: the film that stands still where grid and oil move on together.
    """

    def __init__(
        self,
        now: Instant,
        grid: Grid,
        settings: Settings,
        start: FilmState | None = None,
        step: Step | None = None,
        closing: float = 0.0,
        apart: float | None = None,
        slow: SlowFilm | None = None,
    ) -> None:
        self.now, self.grid, self.settings, self.slow = now, grid, settings, slow
        self.images = Images(grid.periodic)
        self.closing, self.apart = closing, apart
        self.step = step if start else None
        self.start = start if step else None
        shape = now.shape
        self.hertz = hertz = shape.hertz(now.load, now.reduced_modulus)
        self.a = hertz.a
        self.size = film_size(hertz.a, shape.radius_x, self.film)
        thin = self.a / self.size
        self.p_unit = hertz.pressure_max * thin**shape.order
        self.h_unit = self.size**2 / shape.radius_x
        self.dx, self.floor = grid.spacing / self.size, settings.floor / self.h_unit
        self.load = shape.carried(hertz, self.size, grid.shape[0] * grid.spacing) / self.dx**2
        self.compliance = shape.softness(hertz, now.reduced_modulus) * thin ** (shape.order + 1)
        scale = self.compliance * 2.0 / np.pi**2 * self.dx
        self.half_space = half_space(grid.shape, scale, settings.fft)
        if grid.periodic:  # displacements are relative to those a grid's length away: the same on coarser grids
            self.half_space = half_space(grid.shape, scale, settings.fft, float(grid.shape[1] - 1))
        self.give = now.give and now.give.scaled(self.p_unit, self.h_unit)
        self.cap = now.limit / self.p_unit
        if self.cap.sum() <= 1.01 * self.load:
            raise ConvergenceError(
                f"{now.load:g} N are more than a grid of {grid.shape[1] * grid.spacing:g} m by "
                f"{grid.shape[0] * grid.spacing:g} m can carry at the hardness. Lower the load or enlarge film.domain."
            )
        asperities, modulus = now.microroughness, now.reduced_modulus
        self.stress = self.fade = 0.0  # of asperities below the grid: pressure at the floor, gap over which it fades
        if asperities is not None and asperities.rms > 0.0:
            self.stress = float(asperities.pressure_scale(modulus, now.hardness)) / self.p_unit
            self.fade = float(asperities.height_scale(modulus, now.hardness)) / self.h_unit
        self.depth = self.compliance ** (2.0 / 3.0) if shape.circular else hertz.approach / self.h_unit
        self.x, self.y = grid.x / self.size, grid.y / self.size
        gap = shape.gap(self.x, self.y, self.size)
        reach = 2.0 * gap
        radius_y = shape.ellipse_radius
        if radius_y is not None:  # Hertz's ellipse is slimmer than a line of equal gap
            slim = self.size / film_size(hertz.b, radius_y, self.smooth_film)
            reach = self.x[None, :] ** 2 + (slim * self.y[:, None]) ** 2
        self.smooth = np.sqrt(np.maximum(1.0 - reach, 0.0))
        self.undeformed = gap - now.heights / self.h_unit

    @cached_property
    def contact(self) -> SmoothContact | SmoothLine:
        """Smooth contact in the terms of film formulas."""
        now, shape = self.now, self.now.shape
        smooth = shape.smooth(now.load, now.entrainment_speed, now.viscosity, now.temperature, now.reduced_modulus)
        if (now.ease is None and now.thinned is None) or now.entrainment_speed == 0.0:
            return smooth
        before = self.a + inlet_length(self.a, shape, smooth.film)
        at = np.abs(self.grid.y).argmin(), np.abs(self.grid.x + before).argmin()  # where the film builds up
        ease, thinned = self._oil(smooth.viscosity)
        return replace(smooth, viscosity=smooth.viscosity / float(ease[at] * (1.0 + thinned[at])))

    def _oil(self, viscosity: float) -> tuple[Array, Array]:
        """Return the ease of every node, and the fluidity that shear adds to it.

        The latter is relative to the eased fluidity at p = 0, whose viscosity [Pa s] is given.
        """
        ease, thinned = self.now.ease, self.now.thinned
        ease = np.ones(self.grid.shape) if ease is None else np.maximum(ease, _LEAST_EASE)
        return ease, np.zeros(self.grid.shape) if thinned is None else thinned * viscosity / ease

    @cached_property
    def smooth_film(self) -> float:
        """Central film thickness [m] of smooth bodies by formula; zero without entrainment."""
        now = self.now
        if now.dry or now.entrainment_speed == 0.0:
            return 0.0
        film = self.contact.film
        if now.meniscus is not None:
            film = film_behind_meniscus(film, now.meniscus, self.a, now.shape.radius_x)
        return film if now.supply is None else supplied_film(film, now.supply, resistance=now.shape.side_resistance)

    @property
    def moes_load(self) -> float:
        """Moes' M; for ellipses and lines that of the circular contact which is as close to rigid. Infinite at rest."""
        return self.contact.circular_load if self.now.entrainment_speed > 0.0 else math.inf

    @property
    def curvature(self) -> float:
        """Curvature of the undeformed gap along y over that along x."""
        return self.now.shape.curvature_ratio

    @cached_property
    def film(self) -> float:
        """Film [m] of smooth bodies: by formula, or the thicker one of a start that is still further apart."""
        return max(self.smooth_film, self._gap_before)

    @property
    def _gap_before(self) -> float:
        """Gap [m] of undeformed bodies at the start of a thorough step, 0 without one or if they overlap."""
        return max(self.start.rigid_gap, 0.0) if self.start and self.step and self.step.thorough else 0.0

    @property
    def is_light(self) -> bool:
        """True if the film is so thick that the pressure beyond the grid matters."""
        return self.moes_load < FAR_FIELD_BELOW or self._gap_before > 0.0

    @cached_property
    def speed(self) -> float:
        """Unit of speeds [m/s]."""
        return max(self.now.entrainment_speed, _SLOWEST * self.grid.spacing / self.step.dt if self.step else 0.0)

    @cached_property
    def roughness(self) -> float:
        """Rms height [m] of both bodies together in the contact."""
        inside = self.hertz.inside(self.grid.x, self.grid.y, 1.5 * self.size / self.a)
        return float(self.now.heights[inside].std()) if inside.any() else 0.0

    def _history(self) -> tuple[float, Array]:
        """Return 1 / time step, and the mass [m] at its start, [ny, nx].

        A second-order step replaces both by those of the backward difference over this step and the one before
        (Hairer & Wanner, Solving Ordinary Differential Equations II, 1996, doi:10.1007/978-3-642-05221-7, V.1).
        """
        if self.step is None or self.start is None:
            return 0.0, np.zeros_like(self.cap)
        per_dt, mass = self.size / (self.speed * self.step.dt), self.start.mass
        if self.slow is not None:
            return per_dt, self.slow.carried(mass, self.step.rolled, self.now.supply)
        if self.step.order == 1 or self.start.dt == 0.0:
            return per_dt, mass
        ratio = self.step.dt / self.start.dt
        own = (1.0 + 2.0 * ratio) / (1.0 + ratio)
        old = ((1.0 + ratio) * mass - ratio**2 / (1.0 + ratio) * self.start.mass_before) / own
        return own * per_dt, np.clip(old, mass / _FASTEST_CHANGE, mass * _FASTEST_CHANGE)

    @cached_property
    def surfaces(self) -> HalfSpace:
        """The half space as the kernels see it, under surfaces that give way where they do."""
        return giving(self.half_space, self.give and self.give.mapped(self.images.of))

    def problem(self) -> Problem:
        """Return the problem that the kernels solve."""
        now, (per_dt, mass) = self.now, self._history()
        top = min(now.hardness, _TABLE_TOP)
        fluidity, density, viscosity = tables(now.viscosity, now.density, now.temperature, top)
        mobility = self.size**3 * self.p_unit / (12.0 * viscosity * self.speed * now.shape.radius_x**2)
        edge, weight = self.beyond
        ease, thinned = self._oil(viscosity)
        images = self.images.of
        weight = images(weight)
        conserving = now.conserving and self.slow is None  # what moves along conserves it anyway
        if self.grid.periodic:
            weight[[0, -1]] = 0.0
        return Problem(
            undeformed=images(self.undeformed),
            cap=images(self.cap),
            floor=self.floor,
            spacing=self.dx,
            load=self.load,
            mobility=mobility * images(ease),
            thinned=images(thinned),
            per_dt=per_dt,
            wedge=now.entrainment_speed / self.speed,
            mass_old=images(mass / self.h_unit),
            fluidity=fluidity,
            density=density,
            step=top / self.p_unit / (ENTRIES - 1),
            compliance=self.compliance,
            edge=images(edge),
            weight=weight,
            lumped=self.settings.lumped,
            conserving=conserving,
            supply=None if now.supply is None else now.supply / self.h_unit,
            first=self.first,
            wrapped=self.grid.periodic,
            fitted=self.settings.fitted,
            slow_mass=None if self.slow is None else images(self.slow.now / self.h_unit),
            empty=None if self.slow is None or self.start is None else images(self._empty(self.start)),
            gap_before=self._flowed_before(),
            passing=self.step.passing if self.step else 1.0,
            stress=self.stress,
            depth=self.fade,
        )

    def _empty(self, start: FilmState) -> Mask:
        """Return the nodes whose oil had no pressure before; a flooded edge and all before a meniscus are full."""
        empty = start.fluid <= 0.0
        empty[:, : max(self.first, 1)] = self.now.supply is not None
        return empty

    def _flowed_before(self) -> Array | None:
        """Return the gap at the start of a step in which the nodes move with the oil, None without one."""
        if self.slow is None or self.start is None or self.start.gap.shape != self.grid.shape:
            return None
        gap = self.slow.carried(self.start.gap, self.step.rolled if self.step else 0) / self.h_unit
        return self.images.of(np.maximum(gap, self.floor))

    @cached_property
    def first(self) -> int:
        """First column in which oil has pressure: the one after the node nearest to the inlet meniscus."""
        meniscus = self.now.meniscus
        if meniscus is None or self.grid.x[0] > -meniscus:
            return 0
        return min(int(np.abs(self.grid.x + meniscus).argmin()) + 1, self.grid.x.size - 1)

    @cached_property
    def beyond(self) -> tuple[Array, Array]:
        """`far_field` of the film, or of bodies `apart`."""
        return self.far_field(self.film if self.apart is None else self.apart)

    def far_field(self, film: float) -> tuple[Array, Array]:
        """Return `far_field` for bodies with that film [m]; zeros and ones if the field does not matter."""
        starved = self.first > 0 or self.now.supply is not None
        if self.is_light and self.now.shape.has_far_field and not starved:
            by_wedge = (3.0 + 2.0 * self.curvature) / (2.0 + 2.0 * self.curvature)  # see `far_field`
            closing = by_wedge * self.closing * self.now.shape.radius_x / (self.speed * self.size)
            wedge = self.now.entrainment_speed / self.speed
            return far_field(self.x, self.y, film / self.h_unit, self.curvature, wedge, closing)
        return np.zeros_like(self.cap), np.ones_like(self.cap)

    def iterate(self, state: FilmState) -> Iterate:
        """Return a film state in these units, scaled to carry the load.

        Bodies that have carried none start like rigid ones that sink through oil.
        """
        begun = state.pressure if state.pressure.any() else self.p_unit * (state.mass.min() / state.mass) ** 2
        total = begun.sum() / self.p_unit
        scale = self.load / total / self.p_unit
        pressure = np.minimum(begun * scale, self.cap)
        fluid = np.minimum(state.fluid * scale, pressure) if begun is state.pressure else pressure.copy()
        return Iterate(pressure, fluid, state.solid.copy(), state.rigid_gap / self.h_unit)
