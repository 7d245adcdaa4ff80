"""Errors of a moving rough contact by the distance of the nodes, as measured against finer grids.

Two lengths decide: the correlation length of the roughness and the inlet in which the film builds up, both in nodes.
The constants cover nine in ten of the differences that `python -m benchmarks.film.grid_error` finds between grids.
"""

import math

# relative half width at one node per correlation length, and the power with which it falls; of others `_OTHER`
_ROUGH: dict[str, tuple[float, float]] = {
    "friction_force": (0.05, 0.3),
    "contact_load_ratio": (0.08, 0.5),
    "wear_depth": (0.08, 0.5),
    "contact_area_ratio": (0.09, 0.8),
    "h_c": (0.15, 1.5),
    "lambda_ratio": (0.15, 1.5),
    "tribofilm": (0.30, 1.0),
    "roughness": (0.05, 1.0),
}
_OTHER = 0.15, 0.5
_SOLIDS = {"contact_load_ratio", "contact_area_ratio", "wear_depth", "tribofilm"}  # what the solids' share decides
# relative error of the film of smooth bodies at one node across the inlet, the power with which it falls, and the least
_INLET, _FALL, _LEAST = 0.08, 3.0, 0.003
_SHARE = 0.82  # d ln(W_c) / d ln(film) over ln(W_c): the exponent C of `laws.load_sharing`
_FEWEST = 0.1  # nodes: with fewer, nothing is known


def grid_error(name: str, rough: float, inlet: float, load_ratio: float) -> float:
    """Return the relative half width (95 %) of an output's error by the distance of the nodes, at most 1.

    Parameters
    ----------
    name : of the output.
    rough : nodes per correlation length of the rougher body; 0 of smooth ones.
    inlet : nodes across the inlet; 0 without entrainment.
    load_ratio : share of the load on the solids.

    """
    kind = name.removesuffix("_1").removesuffix("_2")
    factor, power = _ROUGH.get(kind, _OTHER)
    by_roughness = factor * max(rough, _FEWEST) ** -power if rough > 0.0 else 0.0
    film = film_error(inlet) if inlet > 0.0 else 0.0
    part = 1.0 - load_ratio
    if kind in _SOLIDS:
        part = -_SHARE * math.log(max(load_ratio, 1e-12))
    return min(math.hypot(by_roughness, part * film), 1.0)


def film_error(inlet: float) -> float:
    """Return the relative half width (95 %) of the error of a film of smooth bodies with `inlet` nodes across it."""
    return min(max(_INLET * max(inlet, _FEWEST) ** -_FALL, _LEAST), 1.0)
