"""Film that is missing where the domain ends within the inlet: the pressure begins too close to the contact.

What decides of smooth, flooded contacts is the distance of the domain's edge from Hertz's, in lengths of the inlet. The
law covers circles, ellipses and lines, of steel and of rubber, up to ten inlets (docs/measured/film.md,
`python -m benchmarks.film.inlet`). Hamrock's and Dowson's of starved contacts, `reference.film_behind_meniscus`, has no
loss from some three inlets on.
"""

from ..reference import SmoothContact, SmoothLine
from ..shapes import Shape
from .lengths import FAR_FIELD_BELOW, inlet_length

NEGLIGIBLE = 0.1  # of an error by other causes: less changes the error by less than 1 %
PEAK = 0.5  # relative change of the largest pressure over that of the film, at most
_SCALE = 2.0  # inlets
_POINTS, _LINES = 3.3, 2.5  # powers with which the loss falls
_MOST = 0.9  # of the film, that a loss may be
_LEAST = {True: 3.0, False: 1.5}  # inlets, of light contacts or others: on less no solution is found of some
_CONTINUED = 9.0  # of light points, whose pressure goes on beyond the edge by `kernels.far_field`


def inlets_before(before: float, a: float, shape: Shape, film: float) -> float:
    """Return the lengths of the inlet between the edge of a domain and Hertz's contact.

    `before`: the edge before the centre [m]; `a`: half width [m]; `film` [m] of smooth bodies, above 0.
    """
    return max(before - a, 0.0) / inlet_length(a, shape, film)


def inlets_for(lost: float, shape: Shape, *, light: bool = False) -> float:
    """Return the lengths of the inlet before Hertz's contact with which at most this part of the film is missing."""
    return max(_SCALE * (lost ** (-1.0 / _power(shape, light=light)) - 1.0), _LEAST[light])


def is_light(shape: Shape, smooth: SmoothContact | SmoothLine, layer: float | None) -> bool:
    """Return True if the pressure goes on beyond the edge of the domain, as in `Scaled`."""
    return shape.has_far_field and smooth.circular_load < FAR_FIELD_BELOW and layer is None


def lost_film(
    before: float,
    a: float,
    shape: Shape,
    smooth: SmoothContact | SmoothLine,
    layer: float | None = None,
    meniscus: float | None = None,
) -> float:
    """Return the film that may be missing (95 %), over the one that is found, as the domain ends within the inlet.

    `before`: the edge of the domain before the centre [m]; `smooth`: the contact in the terms of film formulas, of half
    width a [m]; `layer` [m] and `meniscus` [m before the centre] as in `Instant`. What a meniscus takes is meant.
    """
    if smooth.entrainment_speed == 0.0 or (meniscus is not None and meniscus <= before):
        return 0.0
    power = _power(shape, light=is_light(shape, smooth, layer))
    lost = min((1.0 + inlets_before(before, a, shape, smooth.film) / _SCALE) ** -power, _MOST)
    return float(lost / (1.0 - lost))


def _power(shape: Shape, *, light: bool) -> float:
    if light:
        return _CONTINUED
    return _POINTS if shape.has_far_field else _LINES
