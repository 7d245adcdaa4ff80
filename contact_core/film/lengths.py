"""Lengths of a lubricated contact: of its loaded zone, and of the inlet in which the film builds up."""

import numpy as np

from ..shapes import Shape

FAR_FIELD_BELOW = 30.0  # Moes' M: above it, the pressure beyond a film-sized grid changes the film by less than 1 %
_NODES = {True: 1.0, False: 3.0}  # across the inlet that flow needs which is fitted to cells, or upwind


def film_size(a: float, radius: float, film: float) -> float:
    """Return the half width [m] of the loaded zone under a film [m] of smooth bodies; Hertz's a [m] if thin."""
    return float(np.sqrt(a**2 + 1.4 * radius * film))


def inlet_length(a: float, shape: Shape, film: float) -> float:
    """Return the distance d [m] before Hertz's contact at which its gap, (d/a)^1.5 a^2 / R opening, is the film [m]."""
    return float(a * (film * shape.radius_x / a**2 / shape.opening) ** (2.0 / 3.0))


def resolves_inlet(nodes: float, *, fitted: bool) -> bool:
    """Return True if a grid with so many nodes across the inlet gives the film.

    Above these central films are right to 8 %, and mostly to 3 %: docs/measured/film.md.
    """
    return nodes >= _NODES[fitted]
