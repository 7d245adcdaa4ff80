"""Smooth contacts over Hamrock's and Dowson's U, G, W, solved on domains of any length."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from contact_core import ContactError, line_contact, point_contact
from contact_core.film.inlet_loss import lost_film
from contact_core.film.lengths import inlet_length
from contact_core.laws.viscosity import Barus
from contact_core.reference import SmoothContact, SmoothLine, film_behind_meniscus
from contact_core.shapes import Line, Point

RADIUS, SPEED = 10e-3, 1.0  # m, m/s
STEEL, RUBBER = 230e9, 10e6  # Pa
_TOLERANCE, _FLOOR = 1e-4, 1e-10
_FEWEST, _ACROSS, _MOST = 12, 3, 128  # nodes across a half width and an inlet, and most across a half width
_HALVED = 16  # intervals are in multiples of it, for multigrid


@dataclass(frozen=True)
class Contact:
    """A smooth contact by dimensionless speed, material and load (of a line per length), and radius_y / radius_x."""

    shape: str
    speed: float
    material: float
    load: float
    ratio: float = 1.0
    modulus: float = STEEL

    @property
    def line(self) -> bool:
        """True for a line."""
        return self.shape == "line"

    @property
    def bodies(self) -> Point | Line:
        """The undeformed bodies; a line is 1 m long."""
        return Line(RADIUS, 1.0) if self.line else Point(RADIUS, self.ratio * RADIUS)

    @property
    def newtons(self) -> float:
        """The load [N]."""
        return self.load * self.modulus * RADIUS * (1.0 if self.line else RADIUS)

    @property
    def viscosity(self) -> float:
        """Viscosity [Pa s]."""
        return self.speed * self.modulus * RADIUS / SPEED

    @property
    def smooth(self) -> SmoothContact | SmoothLine:
        """The contact in the terms of film formulas."""
        oil = Barus(self.viscosity, 300.0, self.material / self.modulus, 0.0)
        return self.bodies.smooth(self.newtons, SPEED, oil, 300.0, self.modulus)

    @property
    def half_widths(self) -> tuple[float, float]:
        """Half widths [m] of Hertz's contact along x and y."""
        hertz = self.bodies.hertz(self.newtons, self.modulus)
        return hertz.a, hertz.b

    @property
    def inlet(self) -> float:
        """Length [m] of the inlet."""
        return inlet_length(self.half_widths[0], self.bodies, self.smooth.film)

    @property
    def beside(self) -> float:
        """Extent [m] to either side that leaves room for inlets there."""
        b = self.half_widths[1]
        if self.line:
            return b
        return b + 5.0 * inlet_length(b, Point(self.ratio * RADIUS, RADIUS), self.smooth.film)

    @property
    def step(self) -> float:
        """Distance [m] of the nodes."""
        a = self.half_widths[0]
        return max(min(a / _FEWEST, self.inlet / _ACROSS), a / _MOST)

    def stated(self, before: float) -> float:
        """Return the loss over the film that is found, as `inlet_loss` states it for a domain before the centre [m]."""
        return lost_film(before, self.half_widths[0], self.bodies, self.smooth)

    def starved(self, before: float) -> float:
        """Return the loss over the flooded film by Hamrock and Dowson, for an inlet full from there on."""
        film = self.smooth.film
        return 1.0 - film_behind_meniscus(film, before, self.half_widths[0], RADIUS) / film

    def film(self, before: float, behind: float, beside: float) -> float:
        """Return the central film [m] on a domain of these extents [m] about the centre, nan without a solution."""
        step = self.step
        left, side = round(before / step), _HALVED // 2 * int(np.ceil(beside / step / (_HALVED // 2)))
        right = _HALVED * int(np.ceil((left + behind / step) / _HALVED)) - left
        along = -left * step, right * step
        given: dict[str, Any] = {
            "load": self.newtons, "reduced_modulus": self.modulus, "speed_1": SPEED, "speed_2": SPEED,
            "viscosity": self.viscosity, "pressure_viscosity": self.material / self.modulus, "floor": _FLOOR,
            "tolerance": _TOLERANCE,
        }  # fmt: skip
        try:
            if self.line:
                found: Any = line_contact(**given, radius=RADIUS, domain=along, grid=left + right + 1)
            else:
                radii = {"radius_x": RADIUS, "radius_y": self.ratio * RADIUS}
                domain, grid = (*along, -side * step, side * step), (2 * side + 1, left + right + 1)
                found = point_contact(**given, **radii, domain=domain, grid=grid)
        except ContactError:
            return float("nan")
        return found.h_central if found.converged else float("nan")

    def __str__(self) -> str:
        """Return what it is, for tables."""
        name = f"{self.shape} 1:{self.ratio:g}" if self.shape == "ellipse" else self.shape
        return f"{name}, U {self.speed:.0e}, G {self.material:g}, W {self.load:.0e}"


def contacts() -> Iterator[Contact]:
    """All contacts."""
    circles = ((1e-12, 1e-7), (1e-12, 1e-6), (1e-12, 1e-5), (1e-11, 1e-6), (1e-11, 1e-5), (1e-10, 1e-6), (1e-10, 1e-5))
    for speed, load in circles:
        yield Contact("circle", speed, 4600.0, load)
    yield Contact("circle", 1e-11, 9000.0, 1e-5)
    yield Contact("circle", 1e-10, 1000.0, 1e-6)
    for speed, load in ((1e-8, 1e-3), (1e-7, 1e-3), (1e-7, 1e-2)):
        yield Contact("circle", speed, 0.2, load, modulus=RUBBER)
    for ratio in (0.3, 5.0):
        for speed, load in ((1e-11, 1e-6), (1e-11, 1e-5), (1e-10, 1e-5)):
            yield Contact("ellipse", speed, 4600.0, load, ratio)
    yield Contact("ellipse", 1e-11, 4600.0, 1e-5, 20.0)
    for speed, load in ((1e-12, 1e-5), (1e-12, 1e-4), (1e-12, 1e-3), (1e-11, 1e-5), (1e-11, 1e-4), (1e-10, 1e-4)):
        yield Contact("line", speed, 4600.0, load)
    for speed, load in ((1e-8, 1e-3), (1e-8, 1e-2), (1e-7, 1e-2)):
        yield Contact("line", speed, 0.2, load, modulus=RUBBER)
