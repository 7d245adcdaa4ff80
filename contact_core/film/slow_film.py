"""The film that stands still in a march whose nodes move on with the oil.

What deviates from it, the oil between moving asperities, moves along with the nodes and is never interpolated: between
a contact and a valley it would fall below the floor or fill the contact. What stands still has to be known wherever the
nodes lie. It is the steady film of smooth bodies: Hertz's gap, which is steep at the edge of the contact and known in
closed form, and a smooth rest, by cubic splines.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.ndimage

from ..errors import ConvergenceError
from ..kernels.arrays import Array
from ..shapes import Shape
from .instant import FilmSolution, Grid, Instant, Settings

Solve = Callable[[Instant, Grid, Settings], FilmSolution]

_PER_DOUBLING = 4.0  # loads and speeds, and
_KELVIN = 4.0  # temperatures, whose rests are told apart: a film need not be known exactly to be what stands still
_ITERATIONS = 2000  # of a steady film, at most
# formula film over floor, below which solids carry nearly all of rough contacts: a film so near the floor is hard to
# find, and what stands still there decides nothing
_THIN = 3.0
_DIGITS = 9  # of a node


@dataclass(frozen=True)
class SlowFilm:
    """Mass [m] of the film that stands still, [ny, nx], on the nodes of two instants."""

    before: Array
    now: Array

    def carried(self, mass: Array, rolled: int, supply: float | None = None) -> Array:
        """Return a mass [m] of the instant before on the nodes of now; its deviation moves along by `rolled` nodes.

        supply: mass [m] that enters at most; None: as much as the first column can take.
        """
        deviation = mass - self.before
        if supply is not None:
            deviation[:, 0] = np.minimum(mass[:, 0], supply) - self.before[:, 0]
        if rolled > 0:
            entering = np.repeat(deviation[:, :1], rolled, axis=1)
            deviation = np.concatenate([entering, deviation[:, :-rolled]], axis=1)
        return np.asarray(self.now + deviation)


def slow_film(now: Instant, grid: Grid, shifted: float, settings: Settings, solve: Solve) -> SlowFilm:
    """Return the film that stands still on a grid, and on that `shifted` nodes before; entrained along +x."""
    viscosity, density = now.viscosity, now.density
    part = 0.5 * float(grid.x[0] + grid.x[-1]) / grid.spacing
    smooth = _Smooth(
        shape=now.shape,
        load=now.load,
        near=(_near(now.load), _near(now.entrainment_speed)),
        temperature=_KELVIN * round(now.temperature / _KELVIN),
        viscosity=viscosity,
        density=density,
        reduced_modulus=now.reduced_modulus,
        hardness=now.hardness,
        nodes=grid.shape,
        spacing=grid.spacing,
        repeats=grid.repeats,
        settings=replace(settings, iterations=_ITERATIONS, patient=False),
        meniscus=now.meniscus,
    )
    return SlowFilm(*(_on_nodes(smooth, round(part - back, _DIGITS), solve) for back in (shifted, 0.0)))


def _near(value: float) -> float:
    """Return a value above zero that stands for all those nearby."""
    return float(2.0 ** (round(_PER_DOUBLING * math.log2(value)) / _PER_DOUBLING))


@dataclass(frozen=True)
class _Smooth:
    """Smooth bodies on a grid."""

    shape: Shape
    load: float
    near: tuple[float, float]  # load and entrainment speed of the rest
    temperature: float
    viscosity: Callable[[Array, float], Array]
    density: Callable[[Array], Array]
    reduced_modulus: float
    hardness: float
    nodes: tuple[int, int]
    spacing: float
    repeats: float
    settings: Settings
    meniscus: float | None

    @property
    def grid(self) -> Grid:
        """Nodes about the contact."""
        ny, nx = self.nodes
        return Grid.centred(ny, nx, self.spacing, periodic=self.shape.periodic, repeats=self.repeats)

    def gap(self, load: float, part: float) -> Array:
        """Return Hertz's gap [m] on the nodes, moved on by `part` of one."""
        grid = self.grid.shifted(part * self.spacing)
        return self.shape.hertz(load, self.reduced_modulus).gap(grid.x, grid.y, self.reduced_modulus)


@lru_cache(maxsize=32)
def _on_nodes(smooth: _Smooth, part: float, solve: Solve) -> Array:
    """Return the film [m] on the nodes, moved on by `part` of one."""
    rest = _rest(replace(smooth, load=smooth.near[0]), solve)
    found = smooth.gap(smooth.load, part) + scipy.ndimage.shift(rest, (0.0, -part), mode="nearest")
    found.setflags(write=False)
    return np.asarray(found)


@lru_cache(maxsize=32)
def _rest(smooth: _Smooth, solve: Solve) -> Array:
    """Return the mass of a steady film less Hertz's gap [m]: a constant for thin films, and without a solution."""
    grid, (load, speed) = smooth.grid, smooth.near
    about = smooth.shape.smooth(load, speed, smooth.viscosity, smooth.temperature, smooth.reduced_modulus).film
    if about < _THIN * smooth.settings.floor:
        return np.full(smooth.nodes, max(about, smooth.settings.floor))
    if grid.periodic:  # all rows are alike
        grid = replace(grid, y=np.zeros(1), repeats=grid.repeats * grid.y.size)
    now = Instant(
        load=load,
        entrainment_speed=speed,
        temperature=smooth.temperature,
        shape=smooth.shape,
        reduced_modulus=smooth.reduced_modulus,
        viscosity=smooth.viscosity,
        density=smooth.density,
        heights=np.zeros(grid.shape),
        limit=np.full(grid.shape, smooth.hardness),
        hardness=smooth.hardness,
        meniscus=smooth.meniscus,
    )
    with suppress(ConvergenceError):
        found = solve(now, grid, smooth.settings)
        if found.route == "mixed":
            return np.asarray(found.state.mass - smooth.gap(load, 0.0))
    return np.full(smooth.nodes, about)
