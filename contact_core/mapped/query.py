"""What a map says of a contact: factors, half widths and the corrected contact, by plain arithmetic.

Numbers and tuples of numbers alone, loops over tuples of fixed length: the C of a native FMU is generated from this
source.
"""

import math
from typing import NamedTuple

from ..amended import amended, kept
from ..regression.contact import MeanContact, Stated
from ..regression.outputs import half_widths
from ..scene import Case
from .map import STEEPEST, Map

Three = tuple[float, float, float]

_SLIP, _OIL, _THIN, _WORN, _NONE = 0.1, 1e-4, 1e-3, 0.01, 1e-9  # least numbers: no logarithm of 0
_MARGIN = 1.0  # of half the range of a coordinate, over which a map fades out beyond it


class Here(NamedTuple):
    """A contact as a map sees it."""

    trust: float  # 1 within the ranges of the map, 0 where the regression level stands as it is
    scaled: list[float]  # 1, and its coordinates from -1 to 1
    terms: list[float]  # of the polynomials


class Told(NamedTuple):
    """What a map says of a contact."""

    friction: float  # factor on friction
    film: float  # factor on h_c
    load_ratio: float  # contact_load_ratio


def coordinates(case: Case, contact: MeanContact) -> tuple[float, ...]:
    """Return where a contact with friction lies, by what the regression level says of it; see `COORDINATES`."""
    op, share = case.op, contact.load_ratio
    first, second = case.sides
    mean = max(0.5 * abs(op.speed_1 + op.speed_2), _NONE)
    oil = abs(contact.fluid) / (max(1.0 - share, _NONE) * op.load)
    new = math.hypot(first.surface.rms, second.surface.rms)
    return (
        math.log(max(contact.gap / contact.sigma, _THIN)),
        math.log(abs(op.speed_1 - op.speed_2) / mean + _SLIP),
        math.log(case.pressed),
        share,
        math.log(oil + _OIL),
        contact.cover,
        math.log(contact.sigma / new),
        math.log(mean),
        op.inlet_temperature,
        contact.tribofilms[0].raised / new,
        contact.tribofilms[1].raised / new,
        math.log(math.hypot(contact.tribofilms[0].solid, contact.tribofilms[1].solid) / new + _WORN),
    )


def trusted(chart: Map, place: list[float], slip: float) -> float:
    """Return how far a map is trusted: 1 within the ranges of its coordinates, 0 well outside and without sliding.

    `slip` is sliding over entrainment speed.
    """
    beyond = 0.0
    for value, centre, half in zip(place, chart.centres, chart.halves, strict=True):
        beyond = max(beyond, abs(value - centre) / half - 1.0)
    return max(1.0 - beyond / _MARGIN, 0.0) * min(slip / chart.least_slip, 1.0)


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
    """Return a contact with friction as a map sees it."""
    op = case.op
    everything = coordinates(case, contact)
    place = [everything[k] for k in chart.picked]
    slip = abs(op.speed_1 - op.speed_2) / max(0.5 * abs(op.speed_1 + op.speed_2), _NONE)
    scaled = scaled_to(chart, place)
    known = op.spin == 0.0 and case.shape.radii == case.scene.shape().radii  # no knot has others
    return Here(trusted(chart, place, slip) if known else 0.0, scaled, terms(chart, scaled))


def told(chart: Map, place: Here, load_ratio: float) -> Told:
    """Return what a map says of a contact of a contact_load_ratio by the regression level."""
    friction = math.exp(place.trust * bounded(total(chart.weights[0], place.terms)))
    film = math.exp(place.trust * bounded(total(chart.weights[1], place.terms)))
    odds = math.exp(place.trust * bounded(total(chart.weights[2], place.terms)))
    return Told(friction, film, odds * load_ratio / (1.0 + (odds - 1.0) * load_ratio))


def bounded(value: float) -> float:
    """Return a polynomial's value within what the logarithm of a factor may be."""
    return min(max(value, -STEEPEST), STEEPEST)


def half_widths_of(chart: Map, place: Here, stated: Three) -> Three:
    """Return the half widths (95 %) of friction and h_c, relative, and of contact_load_ratio.

    `stated` are those of the regression level, which hold as far as the map is not trusted.
    """
    wide = math.sqrt(1.0 + leverage(chart, place.terms))
    return (
        _half_width(chart, 0, place, wide, stated[0]),
        _half_width(chart, 1, place, wide, stated[1]),
        _half_width(chart, 2, place, wide, stated[2]),
    )


def _half_width(chart: Map, output: int, place: Here, wide: float, stated: float) -> float:
    alone = wide * math.exp(total(chart.uneven[output], place.scaled))
    shared = math.exp(total(chart.own[output], place.scaled))
    return place.trust * math.hypot(alone, shared) + (1.0 - place.trust) * stated


def corrected(chart: Map, case: Case, contact: MeanContact) -> MeanContact:
    """Return a contact of the regression level, corrected, with the errors that are left.

    Where that level is exact, or the map says nothing, it stands as it is.
    """
    raw = half_widths(case, contact)
    own = (raw["error_friction"], raw["error_film"], raw["error_load_ratio"])
    if kept(case, contact):
        return contact._replace(stated=Stated(*own, 1.0))
    place = here(chart, case, contact)
    found = told(chart, place, contact.load_ratio)
    better = amended(contact, found.friction, found.film * contact.gap, found.load_ratio, max(case.op.bodies))
    return better._replace(stated=Stated(*half_widths_of(chart, place, own), place.trust))
