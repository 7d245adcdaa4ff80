"""Film that is missing where the domain ends within the inlet: the pressure begins too close to the contact.

Of smooth, flooded contacts the distance from the edge of the domain to Hertz's contact decides, in lengths of the inlet.
The law covers circles, ellipses and lines, of steel and of rubber, up to ten inlets (docs/measured/film/inlet.md,
`python -m benchmarks.film.inlet`). Hamrock's and Dowson's of starved contacts, `reference.film_behind_meniscus`, has no
loss from some three inlets on.
"""

from ..reference import SmoothContact, SmoothLine
from ..shapes import Shape
from .lengths import FAR_FIELD_BELOW, inlet_length

NEGLIGIBLE = 0.1  # of an error by other causes: less changes the error by less than 1 %
_SCALE = 2.0  # inlets
_POINTS, _LINES = 3.6, 2.75  # powers with which the loss falls
_CONTINUED = 9.0  # of light points, whose pressure goes on beyond the edge by `kernels.far_field`


def inlets_before(before: float, a: float, shape: Shape, film: float) -> float:
    """Return the lengths of the inlet between the edge of a domain and Hertz's contact.

    `before`: the edge before the centre [m]; `a`: half width [m]; `film` [m] of smooth bodies, above 0.
    """
    return max(before - a, 0.0) / inlet_length(a, shape, film)


def inlets_for(lost: float, shape: Shape) -> float:
    """Return the lengths of the inlet before Hertz's contact with which at most this part of the film is missing."""
    return _SCALE * (lost ** (-1.0 / _power(shape)) - 1.0)


def lost_film(
    before: float,
    a: float,
    shape: Shape,
    smooth: SmoothContact | SmoothLine,
    layer: float | None = None,
    meniscus: float | None = None,
) -> float:
    """Return the part of the central film that may be missing (95 %), as the domain begins `before` the centre [m].

    The film is too thin by at most that. `smooth`: the contact in the terms of film formulas, of half width a [m];
    `layer` [m] and `meniscus` [m before the centre] as in `Instant`: what a meniscus on the domain takes is meant.
    """
    if smooth.entrainment_speed == 0.0 or (meniscus is not None and meniscus <= before):
        return 0.0
    light = shape.has_far_field and smooth.circular_load < FAR_FIELD_BELOW and layer is None
    inlets = inlets_before(before, a, shape, smooth.film)
    return float((1.0 + inlets / _SCALE) ** -(_CONTINUED if light else _power(shape)))


def _power(shape: Shape) -> float:
    return _POINTS if shape.has_far_field else _LINES
