"""The fidelity levels of the film, and the record of its convergence.

`FILMS`: the records that `scene.film` may be.
"""

from ..kernels.convergence import Convergence
from .deterministic import Deterministic
from .regression import Regression

FILMS: tuple[type[Deterministic] | type[Regression], ...] = (Deterministic, Regression)

__all__ = ["FILMS", "Convergence", "Deterministic", "Regression"]
