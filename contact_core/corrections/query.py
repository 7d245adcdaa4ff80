"""What a map says of a contact: factors, half widths and the corrected contact, by plain arithmetic.

Numbers and tuples of numbers alone, loops over tuples of fixed length: the C of a native FMU is generated from this
source.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

from ..regression.contact import MeanContact, Stated, evaluate
from ..regression.surfaces import Tribofilms
from ..scene import Case
from .correction import Deviation, Three, corrected, exact
from .map import STEEPEST, Map
from .places import NONE, SLIP, Guards, place_of

Four = tuple[float, float, float, float]

_GUARDS, _WORN = Guards(0.02), 0.01  # no logarithm of 0
_MARGIN = 1.0  # of half the range of a coordinate, over which a map fades out beyond it
_STEP, _KELVIN = 1e-5, 1e-3  # of differences of the factor on friction, relative and in temperature


class Here(NamedTuple):
    """A contact as a map sees it."""

    trust: float  # 1 within the ranges of the map, 0 where the regression level stands as it is
    slides: float  # part of it that friction has: 1 from the least sliding of the knots on, 0 without sliding
    scaled: list[float]  # 1, and its coordinates from -1 to 1
    terms: list[float]  # of the polynomials


def coordinates(case: Case, contact: MeanContact) -> tuple[float, ...]:
    """Return where a loaded contact lies, by what the regression level says of it; see `COORDINATES`."""
    op = case.op
    first, second = case.sides
    mean = max(0.5 * abs(op.speed_1 + op.speed_2), NONE)
    along = 0.5 * (op.speed_1 + op.speed_2)
    faster = (op.speed_2 - op.speed_1 if case.scene.rougher else op.speed_1 - op.speed_2) / math.copysign(mean, along)
    new = math.hypot(first.surface.rms, second.surface.rms)
    slide, oil, clearance = abs(op.speed_1 - op.speed_2), abs(contact.fluid), contact.gap / contact.sigma
    return (
        *place_of(_GUARDS, clearance, mean, slide, case.pressed, contact.load_ratio, oil, op.load),
        contact.cover,
        math.log(contact.sigma / new),
        math.log(mean),
        op.inlet_temperature,
        contact.tribofilms[0].raised / new,
        contact.tribofilms[1].raised / new,
        math.log(contact.tribofilms[0].solid / max(first.surface.rms, NONE) + _WORN),
        math.log(contact.tribofilms[1].solid / max(second.surface.rms, NONE) + _WORN),
        faster / (abs(faster) + SLIP),
        math.log(case.unit_hertz.a * case.growth[0] / case.sides[case.scene.rougher].surface.length),
    )


def trusted(chart: Map, place: list[float]) -> float:
    """Return how far a map is trusted: 1 within the ranges of its coordinates, 0 well outside."""
    beyond = 0.0
    for value, centre, half in zip(place, chart.centres, chart.halves, strict=True):
        beyond = max(beyond, abs(value - centre) / half - 1.0)
    return max(1.0 - beyond / _MARGIN, 0.0)


def scaled_to(chart: Map, place: list[float]) -> list[float]:
    """Return 1 and the coordinates from -1 to 1; outside the ranges those of the nearest point on their border."""
    found = [1.0]
    for value, centre, half in zip(place, chart.centres, chart.halves, strict=True):
        found.append(min(max((value - centre) / half, -1.0), 1.0))
    return found


def terms(chart: Map, scaled: list[float]) -> list[float]:
    """Return the terms of the polynomials from 1 and the scaled coordinates."""
    found = [1.0]
    for term, coordinate in zip(chart.term, chart.coordinate, strict=True):
        found.append(found[term] * scaled[1 + coordinate])
    return found


def total(weights: tuple[float, ...], found: list[float]) -> float:
    """Return the sum of terms with weights."""
    value = 0.0
    for weight, term in zip(weights, found, strict=True):
        value += weight * term
    return value


def leverage(chart: Map, found: list[float]) -> float:
    """Return the variance of a fitted value over that of a solution."""
    value = 0.0
    for row in chart.spread:
        part = 0.0
        for weight, term in zip(row, found, strict=False):  # rows of a triangle
            part += weight * term
        value += part * part
    return value


def here(chart: Map, case: Case, contact: MeanContact) -> Here:
    """Return a loaded contact as a map sees it."""
    op = case.op
    everything = coordinates(case, contact)
    place = [everything[k] for k in chart.picked]
    slip = abs(op.speed_1 - op.speed_2) / max(0.5 * abs(op.speed_1 + op.speed_2), NONE)
    scaled = scaled_to(chart, place)
    least, most = chart.radii
    radius, ellipse = case.shape.radius_x, case.shape.radii[1:] == case.scene.shape().radii[1:]
    known = op.spin == 0.0 and ellipse and least <= radius and radius <= most
    trust = trusted(chart, place) if known else 0.0  # no knot has others
    return Here(trust, min(slip / chart.least_slip, 1.0), scaled, terms(chart, scaled))


def told(chart: Map, place: Here, load_ratio: float) -> Deviation:
    """Return what a map says of a contact of a contact_load_ratio by the regression level."""
    film = math.exp(place.trust * bounded(total(chart.weights[1], place.terms)))
    odds = math.exp(place.trust * bounded(total(chart.weights[2], place.terms)))
    return Deviation(friction_factor(chart, place), film, odds * load_ratio / (1.0 + (odds - 1.0) * load_ratio))


def friction_factor(chart: Map, place: Here) -> float:
    """Return the factor on the friction of the regression level."""
    return math.exp(place.trust * place.slides * bounded(total(chart.weights[0], place.terms)))


def bounded(value: float) -> float:
    """Return a polynomial's value within what the logarithm of a factor may be."""
    return min(max(value, -STEEPEST), STEEPEST)


def half_widths_of(chart: Map, place: Here, stated: Three) -> Three:
    """Return the half widths (95 %) of friction and h_c, relative, and of contact_load_ratio.

    `stated` are those of the regression level, which hold as far as the map is not trusted.
    """
    wide = math.sqrt(1.0 + leverage(chart, place.terms))
    return (
        _half_width(chart, 0, place, wide, place.trust * place.slides, stated[0]),
        _half_width(chart, 1, place, wide, place.trust, stated[1]),
        _half_width(chart, 2, place, wide, place.trust, stated[2]),
    )


def _half_width(chart: Map, output: int, place: Here, wide: float, trust: float, stated: float) -> float:
    alone = wide * math.exp(total(chart.uneven[output], place.scaled))
    shared = math.exp(total(chart.own[output], place.scaled))
    return trust * math.hypot(alone, shared) + (1.0 - trust) * stated


@dataclass(frozen=True)
class ByMap:
    """The correction by a map. The derivatives of friction are those of `slopes`."""

    chart: Map

    def at(self, case: Case, contact: MeanContact, stated: Three) -> tuple[Deviation, Stated]:
        """Return what a contact deviates by, and the errors that are left."""
        place = here(self.chart, case, contact)
        left = half_widths_of(self.chart, place, stated)
        return told(self.chart, place, contact.load_ratio), Stated(*left, place.trust * place.slides)

    def contact(self, case: Case, tribofilms: Tribofilms) -> MeanContact:
        """Return the contact of a case under tribofilms, corrected."""
        return corrected(self, case, evaluate(case, tribofilms, derivatives=False))


def slopes(chart: Map, case: Case, tribofilms: Tribofilms) -> Four:
    """Return the derivatives of the corrected friction on body 1 by speed_1, speed_2, load and temperature.

    How the factor on friction changes is a difference, as those of the regression level are.
    """
    contact, op = evaluate(case, tribofilms), case.op
    if exact(case, contact):
        return contact.derivatives
    force, factor = contact.solid + contact.fluid, friction_factor(chart, here(chart, case, contact))
    faster = math.copysign(_STEP * max(abs(op.speed_1), abs(op.speed_2), NONE), op.speed_1 - op.speed_2)
    warm_1, warm_2 = op.body_temperature_1, op.body_temperature_2
    beside = (
        (faster, replace(op, speed_1=op.speed_1 + faster)),
        (-faster, replace(op, speed_2=op.speed_2 - faster)),
        (_STEP * op.load, replace(op, load=op.load * (1.0 + _STEP))),
        (
            _KELVIN,
            replace(
                op,
                temperature=op.temperature + _KELVIN,
                body_temperature_1=None if warm_1 is None else warm_1 + _KELVIN,
                body_temperature_2=None if warm_2 is None else warm_2 + _KELVIN,
            ),
        ),
    )
    first, second, third, fourth = (
        factor * by + force * (_factor(chart, Case(case.scene, point), tribofilms) - factor) / step
        for by, (step, point) in zip(contact.derivatives, beside, strict=True)
    )
    return first, second, third, fourth


def _factor(chart: Map, case: Case, tribofilms: Tribofilms) -> float:
    """Return the factor on friction."""
    return friction_factor(chart, here(chart, case, evaluate(case, tribofilms, derivatives=False)))
