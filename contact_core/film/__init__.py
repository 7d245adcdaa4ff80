"""The fidelities of the film: which object sits in `scene.film`."""

from ..kernels.convergence import Convergence
from .deterministic import Deterministic
from .regression import Regression

FILMS: tuple[type[Deterministic] | type[Regression], ...] = (Deterministic, Regression)

__all__ = ["FILMS", "Convergence", "Deterministic", "Regression"]
