"""The fidelities of the film, behind one method `solve`."""

from .deterministic import Deterministic

FILMS: tuple[type, ...] = (Deterministic,)

__all__ = ["FILMS", "Deterministic"]
