"""One instant of a film and its solution, in SI. Arrays [ny, nx], x along entrainment."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ..kernels.arrays import Array, Mask
from ..kernels.convergence import Convergence
from ..kernels.surface_give import SurfaceGive
from ..laws.asperity_layer import AsperityLayer
from ..shapes import Shape


@dataclass(frozen=True)
class Grid:
    """Nodes of the contact on a square lattice. The bodies touch at zero."""

    x: Array  # [nx] [m]
    y: Array  # [ny] [m]
    periodic: bool = False  # along y: the row after the last is the first
    repeats: float = 1.0  # number of times the grid lies in the contact, side by side along y

    @staticmethod
    def centred(ny: int, nx: int, spacing: float, *, periodic: bool = False, repeats: float = 1.0) -> "Grid":
        """Return a grid about the contact."""
        x, y = ((np.arange(n, dtype=np.float64) - 0.5 * (n - 1)) * spacing for n in (nx, ny))
        return Grid(x, y, periodic, repeats)

    @property
    def spacing(self) -> float:
        """Distance between neighbours [m]."""
        return float(self.x[-1] - self.x[0]) / (self.x.size - 1)

    @property
    def cell(self) -> float:
        """Area [m2] of the contact that a node stands for."""
        return self.spacing**2 * self.repeats

    @property
    def shape(self) -> tuple[int, int]:
        """Nodes along y and along x."""
        return self.y.size, self.x.size

    @property
    def radius_2(self) -> Array:
        """Square of the distance from the centre of the contact [m2], [ny, nx]."""
        distance_2: Array = self.x[None, :] ** 2 + self.y[:, None] ** 2
        return distance_2

    def shifted(self, way: float) -> "Grid":
        """Return the grid moved on along +x [m]."""
        return replace(self, x=self.x + way) if way else self

    def mirrored(self) -> "Grid":
        """Return the grid mirrored along x: x becomes -x."""
        return replace(self, x=-self.x[::-1])


@dataclass(frozen=True)
class Instant:
    """One instant of a contact."""

    load: float  # of the whole contact
    entrainment_speed: float  # of either sign
    temperature: float
    shape: Shape
    reduced_modulus: float
    viscosity: Callable[[Array, float], Array]  # [Pa s] at pressures and a temperature
    density: Callable[[Array], Array]  # ratio to that at p = 0, at pressures
    heights: Array  # of both bodies together, positive into the gap
    limit: Array  # largest pressure
    hardness: float  # no limit is above it
    dry: bool = False  # without a film
    solid_share: float = 1.0  # of the load of a dry contact; oil carries the rest, spread as in Hertz's contact
    ease: Array | None = None  # `viscosity` over that at a node's temperature
    thinned: Array | None = None  # fluidity [1/(Pa s)] that shear adds to that at a node
    conserving: bool = False  # cavities hold the oil that flows into them; else they count as full
    supply: float | None = None  # oil film [m] on both surfaces together before the contact; None: flooded
    microroughness: AsperityLayer | None = None  # of both bodies together, too short for the grid
    give: SurfaceGive | None = None  # by which surfaces give way node by node, besides the half space
    meniscus: float | None = None  # distance [m] of the inlet meniscus before the centre; None: beyond the grid

    def touching(self, solid: Array) -> Array:
        """Return the touching share of a node's area under the solids' pressure [Pa]; 0 or 1 without microroughness."""
        if self.microroughness is None:
            return (solid > 0.0).astype(np.float64)
        return self.microroughness.area(solid, self.reduced_modulus, self.hardness)

    def mirrored(self) -> "Instant":
        """Return the instant mirrored along x: entrained the other way."""
        back = self.mapped(lambda field: np.ascontiguousarray(field[:, ::-1]))
        return replace(back, entrainment_speed=-self.entrainment_speed)

    def mapped(self, change: Callable[[Array], Array]) -> "Instant":
        """Return the instant with every field of its nodes changed alike, such as mirrored or restricted."""
        ease, thinned = (None if field is None else change(field) for field in (self.ease, self.thinned))
        surfaces = replace(self, heights=change(self.heights), limit=change(self.limit))
        return replace(surfaces, ease=ease, thinned=thinned, give=self.give and self.give.mapped(change))


@dataclass(frozen=True)
class Step:
    """Time step from the film solution at which an instant starts."""

    dt: float  # time since then [s]
    moved: int = 0  # nodes by which the rough surfaces have moved along +x on the grid since then
    order: int = 1  # of the squeeze term in time: 1, backward Euler; 2, backward differences over two steps
    thorough: bool = False  # True: every algorithm is tried; False: the residual carries over to the next instant
    shifted: float = 0.0  # nodes by which the grid itself has moved along +x since then
    rolled: int = 0  # and those by which the oil moved along on the grid; both 0: the grid stands still under the oil
    passing: float = 1.0  # part of the gap's change in which oil flows through the gaps between; the rest is at once

    def mirrored(self) -> "Step":
        """Return the step mirrored along x."""
        return replace(self, moved=-self.moved, shifted=-self.shifted, rolled=-self.rolled)


@dataclass(frozen=True)
class Settings:
    """Settings of a solution."""

    floor: float  # gap at which solids touch [m]
    tolerance: float  # pressure change at which a solution counts as converged
    iterations: int
    fft: str  # library: "pyfftw" or "scipy"
    lumped: bool = False  # the thesis's criterion: total pressure in Reynolds' equation, solids included
    fitted: bool = False  # flow through faces exact for a constant flow in each cell; else second order upstream
    patient: bool = False  # a steady film that no algorithm of its row finds is sought by a far slower one


@dataclass(frozen=True)
class FilmState:
    """A film solution from which the next one may start."""

    pressure: Array
    fluid: Array
    solid: Mask
    mass: Array  # density ratio times film thickness
    rigid_gap: float  # gap of the undeformed, smooth bodies at the centre
    ease: Array = field(default_factory=lambda: np.ones((1, 1)))  # `Instant.ease`, [1, 1] if there is none
    thinned: Array = field(default_factory=lambda: np.zeros((1, 1)))  # `Instant.thinned`, as well
    warmth: Array = field(default_factory=lambda: np.zeros((1, 1)))  # of the film above the inlet [K], as well
    mass_before: Array = field(default_factory=lambda: np.zeros((1, 1)))  # of a step of second order, where it began
    dt: float = 0.0  # [s] since then
    gap: Array = field(default_factory=lambda: np.zeros((1, 1)))  # through which the oil flowed, [1, 1] if unknown

    def __post_init__(self) -> None:
        for array in (self.solid, *self._fields):
            array.setflags(write=False)

    @property
    def _fields(self) -> tuple[Array, ...]:
        oil = self.ease, self.thinned, self.warmth
        return self.pressure, self.fluid, self.mass, *oil, self.mass_before, self.gap

    def mirrored(self) -> "FilmState":
        """Return the state mirrored along x."""
        solid = np.ascontiguousarray(self.solid[:, ::-1])
        first = (np.ascontiguousarray(f[:, ::-1]) for f in self._fields)
        pressure, fluid, mass, ease, thinned, warmth, before, gap = first
        return FilmState(pressure, fluid, solid, mass, self.rigid_gap, ease, thinned, warmth, before, self.dt, gap)


@dataclass(frozen=True)
class FilmSolution(Convergence):
    """The film of one instant.

    `gap` is at least the floor; `overlap` is what yields plastically: the shortfall below the floor, and the depth that
    `Instant.give` yields; `touching` is the share of a node's area where solids touch.
    """

    state: FilmState
    gap: Array
    overlap: Array
    touching: Array

    def mirrored(self) -> "FilmSolution":
        """Return the solution mirrored along x."""
        gap, overlap, touching = (np.ascontiguousarray(f[:, ::-1]) for f in (self.gap, self.overlap, self.touching))
        return replace(self, state=self.state.mirrored(), gap=gap, overlap=overlap, touching=touching)
