"""Errors of a moving rough contact by the distance of the nodes, as measured against finer grids.

Two lengths decide: the correlation length of the rougher body and the inlet in which the film builds up, both in nodes.
A contact of smooth bodies has 0 nodes per correlation length, one without entrainment 0 across its inlet. `film` is the
relative error of the film of smooth bodies, such as `inlet_error`: what it does to the other outputs. The constants
cover nine in ten of the differences between grids in `python -m benchmarks.film.grid_error`.
"""

import math

_SOLIDS, _SHARE = 0.11, 0.3  # absolute error of W_c at one node per correlation length, times this power of W_c
_AREA = 0.09  # relative error of A_c beside that of W_c
_GAP, _PEAK = 0.23, 0.25  # relative errors of h_c and of the largest pressure
_TRIBOFILM, _ON_SMOOTHER = 0.35, 0.1  # relative errors of the mean tribofilm of the rougher body and of the other
_WORN = 1.2  # error of a wear depth over that of W_c, over hours: `python -m benchmarks.film.two_hours`
# powers with which these fall as the nodes come closer
_SOLIDS_FALL, _AREA_FALL, _GAP_FALL, _PEAK_FALL, _TRIBOFILM_FALL = 0.5, 1.0, 1.25, 1.0, 1.0
# relative error of the film of smooth bodies at one node across the inlet, the power with which it falls, and the least
_INLET, _INLET_FALL, _INLET_LEAST = 0.08, 3.0, 0.003
_SENSITIVE = 0.82  # d ln(W_c) / d ln(film) over ln(W_c), with which the other constants were found
_FEWEST = 0.1  # nodes: with fewer, nothing is known


def _fall(factor: float, nodes: float, power: float) -> float:
    return factor * max(nodes, _FEWEST) ** -power if nodes > 0.0 else 0.0


def inlet_error(inlet: float) -> float:
    """Return the relative half width (95 %) of the error of a film of smooth bodies with `inlet` nodes across it."""
    return min(max(_fall(_INLET, inlet, _INLET_FALL), _INLET_LEAST * (inlet > 0.0)), 1.0)


def load_ratio_error(load_ratio: float, rough: float, film: float) -> float:
    """Return the half width (95 %) of the error of contact_load_ratio, absolute."""
    if load_ratio <= 0.0:
        return 0.0
    asperities = _fall(_SOLIDS, rough, _SOLIDS_FALL) * load_ratio**_SHARE
    shifted = _SENSITIVE * load_ratio * abs(math.log(min(load_ratio, 1.0))) * film
    return min(math.hypot(asperities, shifted), 1.0)


def film_error(load_ratio: float, rough: float, film: float) -> float:
    """Return the half width (95 %) of the error of h_c, relative."""
    return min(math.hypot(_fall(_GAP, rough, _GAP_FALL), (1.0 - load_ratio) * film), 1.0)


def area_error(load_ratio: float, rough: float, film: float) -> float:
    """Return the half width (95 %) of the error of contact_area_ratio, relative."""
    return math.hypot(_fall(_AREA, rough, _AREA_FALL), solids_error(load_ratio, rough, film))


def solids_error(load_ratio: float, rough: float, film: float) -> float:
    """Return the half width (95 %) of the error of what is in proportion to the load on the solids, relative."""
    return min(load_ratio_error(load_ratio, rough, film) / load_ratio, 1.0) if load_ratio > 0.0 else 0.0


def wear_error(load_ratio: float, rough: float, film: float) -> float:
    """Return the half width (95 %) of the error of a wear depth, relative."""
    return _WORN * solids_error(load_ratio, rough, film)


def tribofilm_error(load_ratio: float, rough: float, film: float, *, smoother: bool = False) -> float:
    """Return the half width (95 %) of the error of the mean tribofilm of the rougher or the smoother body, relative."""
    own = _ON_SMOOTHER if smoother else _TRIBOFILM
    return math.hypot(_fall(own, rough, _TRIBOFILM_FALL), wear_error(load_ratio, rough, film))


def other_error(load_ratio: float, rough: float, film: float) -> float:
    """Return the half width (95 %) of the error of any other output, relative: as of the largest pressure."""
    return math.hypot(_fall(_PEAK, rough, _PEAK_FALL), film)


def friction_error(load_ratio: float, solid: float, fluid: float, rough: float, film: float) -> float:
    """Return the half width (95 %) of the error of the friction force [N].

    `solid` and `fluid` are its parts [N], in either direction. Load taken from the solids rubs as oil does, and the
    oil's friction falls as its film grows.
    """
    solid, fluid = abs(solid), abs(fluid)
    of_solids = solid / load_ratio if load_ratio > 0.0 else 0.0
    of_oil = fluid / (1.0 - load_ratio) if load_ratio < 1.0 else 0.0
    shifted = abs(of_solids - of_oil) * load_ratio_error(load_ratio, rough, film)
    return math.hypot(shifted, fluid * film_error(load_ratio, rough, film))
