"""Central films on domains that cut the inlet off, against longer ones with the same distance of the nodes.

    python -m benchmarks.film.inlet [--report]

Smooth bodies over Hamrock's and Dowson's U, G, W: circles, ellipses and lines, of steel and of rubber. Writes
docs/measured/film/inlet.md in some ten minutes; `--report` from what results/film/inlet.json holds.
"""

import argparse
import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.film.inlet_page import write
from benchmarks.folders import RESULTS
from contact_core import ContactError, line_contact, point_contact
from contact_core.film.lengths import inlet_length
from contact_core.shapes import Line, Point

KEPT = RESULTS / "film" / "inlet.json"
RADIUS, SPEED = 10e-3, 1.0  # m, m/s
STEEL, RUBBER = 230e9, 10e6  # Pa
CHOSEN = 1.44  # half widths before the centre: half of 2.88
INLETS = (0.4, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0)  # before Hertz's contact
LONG = {"point": 14.0, "line": 60.0}  # inlets that stand for all
_TOLERANCE, _FLOOR = 1e-4, 1e-10
_FEWEST, _ACROSS = 12, 3  # nodes across a half width and an inlet
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
    def bodies(self) -> Point | Line:
        """The undeformed bodies; a line is 1 m long."""
        return Line(RADIUS, 1.0) if self.shape == "line" else Point(RADIUS, self.ratio * RADIUS)

    @property
    def newtons(self) -> float:
        """The load [N]."""
        return self.load * self.modulus * RADIUS * (1.0 if self.shape == "line" else RADIUS)

    @property
    def moes(self) -> float:
        """Moes' M as film formulas of circles and lines have it."""
        return self.load / (2.0 * self.speed) ** (0.5 if self.shape == "line" else 0.75)

    @property
    def viscosity(self) -> float:
        """Viscosity [Pa s]."""
        return self.speed * self.modulus * RADIUS / SPEED

    @property
    def formula(self) -> float:
        """Film [m] by formula."""
        coefficient = self.material / self.modulus
        return self.bodies.film(self.newtons, SPEED, self.viscosity, coefficient, self.modulus)

    @property
    def half_widths(self) -> tuple[float, float]:
        """Half widths [m] of Hertz's contact along x and y."""
        hertz = self.bodies.hertz(self.newtons, self.modulus)
        return hertz.a, hertz.b

    @property
    def inlet(self) -> float:
        """Length [m] of the inlet."""
        return inlet_length(self.half_widths[0], self.bodies, self.formula)

    @property
    def arguments(self) -> dict[str, Any]:
        """Arguments of a call, without grid and domain."""
        own: dict[str, Any] = {"radius_x": RADIUS, "radius_y": self.ratio * RADIUS, "load": self.newtons}
        if self.shape == "line":
            own = {"radius": RADIUS, "load": self.newtons}
        return own | {
            "reduced_modulus": self.modulus, "speed_1": SPEED, "speed_2": SPEED, "viscosity": self.viscosity,
            "pressure_viscosity": self.material / self.modulus, "floor": _FLOOR,
        }  # fmt: skip

    def film(self, before: float, behind: float, beside: float) -> float:
        """Return the central film [m] on a domain of these extents [m] about the centre, nan without a solution."""
        a, step = self.half_widths[0], min(self.half_widths[0] / _FEWEST, self.inlet / _ACROSS)
        step = max(step, a / 128)
        left, side = round(before / step), _HALVED // 2 * int(np.ceil(beside / step / (_HALVED // 2)))
        right = _HALVED * int(np.ceil((left + behind / step) / _HALVED)) - left
        along = -left * step, right * step
        try:
            if self.shape == "line":
                found: Any = line_contact(**self.arguments, domain=along, grid=left + right + 1, tolerance=_TOLERANCE)
            else:
                domain, grid = (*along, -side * step, side * step), (2 * side + 1, left + right + 1)
                found = point_contact(**self.arguments, domain=domain, grid=grid, tolerance=_TOLERANCE)
        except ContactError:
            return float("nan")
        return found.h_central if found.converged else float("nan")


def contacts() -> Iterator[Contact]:
    """All contacts."""
    for speed, load in ((1e-12, 1e-7), (1e-12, 1e-6), (1e-11, 1e-6), (1e-11, 1e-5), (1e-10, 1e-6), (1e-10, 1e-5)):
        yield Contact("circle", speed, 4600.0, load)
    for speed, load in ((1e-8, 1e-3), (1e-7, 1e-3), (1e-7, 1e-2)):
        yield Contact("circle", speed, 0.2, load, modulus=RUBBER)
    for ratio in (0.3, 5.0):
        for speed, load in ((1e-11, 1e-6), (1e-11, 1e-5), (1e-10, 1e-5)):
            yield Contact("ellipse", speed, 4600.0, load, ratio)
    yield Contact("ellipse", 1e-11, 4600.0, 1e-5, 20.0)
    for speed, load in ((1e-12, 1e-5), (1e-11, 1e-5), (1e-11, 1e-4), (1e-10, 1e-5), (1e-10, 1e-4)):
        yield Contact("line", speed, 4600.0, load)
    for speed, load in ((1e-8, 1e-3), (1e-8, 1e-2), (1e-7, 1e-2)):
        yield Contact("line", speed, 0.2, load, modulus=RUBBER)


def measured(contact: Contact) -> dict[str, Any]:
    """Return the films of a contact on domains of all lengths, over that on the longest: a record."""
    a, b = contact.half_widths
    inlet, line = contact.inlet, contact.shape == "line"
    beside = b
    if not line:
        turned = Point(contact.ratio * RADIUS, RADIUS)
        beside = max(CHOSEN * b, b + 5.0 * inlet_length(b, turned, contact.formula))
    behind = max(CHOSEN * a, 1.3 * a + inlet)
    whole = contact.film(a + LONG["line" if line else "point"] * inlet, behind, beside)
    step = min(a / _FEWEST, inlet / _ACROSS)

    def lost(before: float, behind: float, beside: float) -> float:
        return 1.0 - contact.film(before, behind, beside) / whole

    cut = {}
    for inlets in INLETS:
        before = max(round((a + inlets * inlet) / step), round(a / step) + 1) * step
        cut[(before - a) / inlet] = lost(before, behind, beside)
    return {
        "shape": contact.shape, "speed": contact.speed, "material": contact.material, "load": contact.load,
        "ratio": contact.ratio, "soft": contact.modulus == RUBBER, "moes": contact.moes, "film": whole,
        "formula": contact.formula, "half_width": a, "inlet": inlet,
        "resistance": contact.bodies.side_resistance,
        "chosen": [lost(k * CHOSEN * a, CHOSEN * a, CHOSEN * b) for k in (1, 2, 4)],
        "cut": sorted(cut.items()),
    }  # fmt: skip


def main() -> None:
    """Measure, unless told otherwise, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--report", action="store_true", help="write the page from what is kept")
    if not parser.parse_args().report:
        KEPT.parent.mkdir(parents=True, exist_ok=True)
        records: list[dict[str, Any]] = []
        for contact in contacts():
            records.append(measured(contact))
            print(json.dumps(records[-1]), flush=True)
            KEPT.write_text(json.dumps(records))
    write(json.loads(KEPT.read_text()))


if __name__ == "__main__":
    main()
