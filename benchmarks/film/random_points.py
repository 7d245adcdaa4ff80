"""Random operating points, far beyond those of a machine, and their surfaces.

Not a program: `hard_cases.py` and `error_estimate.py` draw from here.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from contact_core import shapes
from contact_core.film.fitted import Extent, line_extent
from contact_core.film.instant import Grid
from contact_core.reference import SmoothContact, SmoothLine, nijenbanning_venner_moes

MODULUS, ALPHA, HARDNESS, CORRELATION = 230.47e9, 15e-9, 6e9, 20e-6
SLIMMEST = 10.0  # ratio of the radii, either way
LARGEST_HERTZ = 4e9
WAVES = 400
ROWS = 32  # of a line, that repeat


@dataclass(frozen=True)
class Point:
    """A contact and what is asked of it, in SI."""

    number: int
    radius: float  # along x
    load: float
    speed: float  # entrainment, of either sign
    viscosity: float
    rq: float
    ratio: float = 1.0  # radius along y over that along x

    @property
    def shape(self) -> shapes.Point:
        """The undeformed bodies."""
        return shapes.Point(self.radius, self.ratio * self.radius)

    @property
    def contact(self) -> SmoothContact:
        """The contact in the terms of the film formulas."""
        speed = abs(self.speed)
        radii = self.shape.radius_x, self.shape.radius_y
        return SmoothContact(self.load, speed, self.viscosity, ALPHA, *radii, MODULUS)

    @property
    def film(self) -> float:
        """Film [m] of smooth bodies by formula."""
        return nijenbanning_venner_moes(self.contact) if self.speed != 0.0 else 0.0

    def grid(self, nodes: int) -> Grid:
        """The grid that fits the film, `nodes` along its shorter side, entered from the side the oil comes from."""
        extent = Extent.of(self.shape, self.load, MODULUS, self.film)
        ny, nx = (nodes, nodes) if self.ratio == 1.0 else extent.shape(shorter=nodes)
        found = extent.grid(ny, nx)
        return found if self.speed >= 0.0 else found.mirrored()

    def heights(self, grid: Grid, correlation: float) -> np.ndarray:
        """Gaussian heights [ny, nx] as a sum of waves: the same surface on every grid."""
        random = np.random.Generator(np.random.Philox(key=[self.number, 2]))
        kx, ky = random.normal(0.0, np.sqrt(2.0) / correlation, (2, WAVES))
        phase = random.uniform(0.0, 2.0 * np.pi, WAVES)
        along = np.exp(1j * (kx[:, None] * grid.x + phase[:, None]))
        across = np.exp(1j * ky[:, None] * grid.y)
        return self.rq * np.sqrt(2.0 / WAVES) * (across.T @ along).real

    def arguments(self, nodes: int) -> dict:
        """Of `point_contact`. The surface is 20 um long, or two nodes of the 129 grid where those are longer."""
        grid = self.grid(nodes)
        correlation = max(CORRELATION, 2.0 * self.grid(129).spacing)
        return {
            "load": self.load,
            "radius_x": self.radius,
            "radius_y": self.shape.radius_y,
            "reduced_modulus": MODULUS,
            "speed_1": self.speed,
            "speed_2": self.speed,
            "viscosity": self.viscosity,
            "pressure_viscosity": ALPHA,
            "hardness": HARDNESS,
            "heights_2": self.heights(grid, correlation),
            "domain": (grid.x[0], grid.x[-1], grid.y[0], grid.y[-1]),
        }

    @property
    def line(self) -> SmoothLine:
        """The line contact of that radius under the same largest pressure."""
        load = 2.0 * np.pi * self.radius * self.shape.hertz(self.load, MODULUS).pressure_max ** 2 / MODULUS
        return SmoothLine(load, abs(self.speed), self.viscosity, ALPHA, self.radius, MODULUS)

    def line_arguments(self, nodes: int) -> dict:
        """Of `line_contact`. The surface is as in `arguments`, but its waves repeat themselves after ROWS rows."""
        film = self.line.film if self.speed != 0.0 else 0.0
        left, right = line_extent(shapes.Line(self.radius, 1.0), self.line.load, MODULUS, film)
        side = max(left, right)
        spacing = 2.0 * side / (nodes - 1)
        x, depth = np.linspace(-side, side, nodes), ROWS * spacing
        correlation = max(CORRELATION, 4.0 * side / 128)
        random = np.random.Generator(np.random.Philox(key=[self.number, 2]))
        kx, ky = random.normal(0.0, np.sqrt(2.0) / correlation, (2, WAVES))
        ky = 2.0 * np.pi / depth * np.round(ky * depth / (2.0 * np.pi))
        along = np.exp(1j * (kx[:, None] * x + random.uniform(0.0, 2.0 * np.pi, WAVES)[:, None]))
        across = np.exp(1j * ky[:, None] * spacing * np.arange(ROWS))
        return {
            "load": self.line.load,
            "radius": self.radius,
            "reduced_modulus": MODULUS,
            "speed_1": self.speed,
            "speed_2": self.speed,
            "viscosity": self.viscosity,
            "pressure_viscosity": ALPHA,
            "hardness": HARDNESS,
            "heights_2": self.rq * np.sqrt(2.0 / WAVES) * (across.T @ along).real,
            "spacing": spacing,
        }


def draw(seed: int, *, elliptical: bool = False) -> Iterator[Point | None]:
    """Points for ever, the same ones with another radius along y if `elliptical`; None where the film by formula is
    thicker than a hundredth of a radius or p_H above 4 GPa.
    """
    random, ratios = (np.random.Generator(np.random.Philox(key=[seed, stream])) for stream in (1, 4))

    def logarithmic(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    number = 0
    while True:
        number += 1
        radius, load = logarithmic(1e-3, 0.1), logarithmic(0.1, 1e3)
        speed, viscosity = logarithmic(1e-6, 20.0), logarithmic(1e-4, 10.0)
        rq, smooth, standing = logarithmic(1e-9, 1.5e-6), random.uniform() < 0.2, random.uniform() < 0.05
        sign = random.choice([-1.0, 1.0])
        ratio = float(SLIMMEST ** ratios.uniform(-1.0, 1.0)) if elliptical else 1.0
        point = Point(number, radius, load, 0.0 if standing else sign * speed, viscosity, 0.0 if smooth else rq, ratio)
        too_high = point.shape.hertz(load, MODULUS).pressure_max > LARGEST_HERTZ
        yield None if too_high or point.film > 0.01 * radius * min(ratio, 1.0) else point
