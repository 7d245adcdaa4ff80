"""What a map says of a contact: factors, half widths and the corrected contact, by plain arithmetic.

Numbers and tuples of numbers alone, loops over tuples of fixed length: the C of a native FMU is generated from this
source.
"""

import math
from typing import NamedTuple

from ..amended import amended, kept
from ..regression.contact import MeanContact
from ..scene import Case
from .map import STEEPEST, Map

_SLIP, _OIL, _THIN, _NONE = 0.1, 1e-4, 1e-3, 1e-9  # least numbers: no logarithm of 0
_MARGIN = 1.0  # of half the range of a coordinate, over which a map fades out: films still grow with the speed there


class Told(NamedTuple):
    """What a map says of a contact."""

    friction: float  # factor on friction
    film: float  # factor on h_c
    load_ratio: float  # contact_load_ratio
    trust: float  # 1 within the ranges of the map, 0 where the regression level stands as it is
    error_friction: float  # half widths (95 %): relative
    error_film: float  # relative
    error_load_ratio: float  # absolute


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
    )


def trusted(chart: Map, place: tuple[float, ...], slip: float) -> float:
    """Return how far a map is trusted: 1 within the ranges of its coordinates, 0 well outside and without sliding.

    `slip` is sliding over entrainment speed.
    """
    beyond = 0.0
    for value, centre, half in zip(place, chart.centres, chart.halves, strict=True):
        beyond = max(beyond, abs(value - centre) / half - 1.0)
    return max(1.0 - beyond / _MARGIN, 0.0) * min(slip / chart.least_slip, 1.0)


def scaled_to(chart: Map, place: tuple[float, ...]) -> list[float]:
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


def told(chart: Map, case: Case, contact: MeanContact, stated: tuple[float, float, float]) -> Told:
    """Return what a map says of a contact with friction.

    `stated` are the half widths of the regression level: of friction and h_c, relative, of contact_load_ratio.
    """
    everything = coordinates(case, contact)
    place = tuple(everything[k] for k in chart.picked)
    slip = abs(case.op.speed_1 - case.op.speed_2) / max(0.5 * abs(case.op.speed_1 + case.op.speed_2), _NONE)
    trust = trusted(chart, place, slip)
    scaled = scaled_to(chart, place)
    found = terms(chart, scaled)
    wide = math.sqrt(1.0 + leverage(chart, found))
    friction = trust * bounded(total(chart.weights[0], found))
    film = trust * bounded(total(chart.weights[1], found))
    odds = math.exp(trust * bounded(total(chart.weights[2], found)))
    load = odds * contact.load_ratio / (1.0 + (odds - 1.0) * contact.load_ratio)
    half = []
    for uneven, own, regression in zip(chart.uneven, chart.own, stated, strict=True):
        known = math.hypot(wide * math.exp(total(uneven, scaled)), math.exp(total(own, scaled)))
        half.append(trust * known + (1.0 - trust) * regression)
    return Told(math.exp(friction), math.exp(film), load, trust, half[0], half[1], half[2])


def bounded(value: float) -> float:
    """Return a polynomial's value within what the logarithm of a factor may be."""
    return min(max(value, -STEEPEST), STEEPEST)


def corrected(chart: Map, case: Case, contact: MeanContact) -> MeanContact:
    """Return a contact of the regression level, corrected; the same one where that is exact or the map says nothing."""
    if kept(case, contact):
        return contact
    found = told(chart, case, contact, (0.0, 0.0, 0.0))
    if found.trust == 0.0:
        return contact
    return amended(contact, found.friction, found.film * contact.gap, found.load_ratio, max(case.op.bodies))
