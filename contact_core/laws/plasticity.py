"""Largest pressure, and yielding of the surfaces above it."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter
from .base import Plasticity
from .equations import Equations

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ElasticPerfectlyPlastic:
    """The pressure is at most the hardness; the overlap beyond it stays as permanent depth, half on each body.

    The hardness falls linearly from the steel's, at the foot of a tribofilm, to the full film's at its top. The depth
    to which the surfaces have been pressed in decides what touches: the thicker film, both films or, beyond both, the
    steel (Andersson et al., Faraday Discuss. 156 (2012) 343, doi:10.1039/c2fd00132b, as in Azam, PhD thesis, University
    of Leeds 2018, section 5.5.2 and Figure 5-4).

    `indentation` says which depth counts for `limit`: "none", zero, as if all films have healed before every pass;
    "total", all that has been pressed into both facing nodes so far, as if a film never healed.
    """

    name: ClassVar[str] = "elastic_perfectly_plastic"
    source: ClassVar[str] = "Azam et al. 2019, doi:10.1016/j.triboint.2018.11.011"
    equations: ClassVar[Equations] = Equations(
        ("p ≤ H(c),   H(c) = H_{steel} − (H_{steel} − H_{film}) c",),
        "c is the thickness of the tribofilm over its full thickness; each body takes half of the plastic depth.",
    )

    hardness: float = parameter("Pa", "hardness of the bare solids", above=1e6, most=1e12)
    film_hardness: float = parameter("Pa", "hardness of a full tribofilm", above=1e6, most=1e12)
    indentation: str = parameter(
        "", "plastic depth that hardens the tribofilms", choices=("none", "total"), default="none"
    )

    @property
    def error(self) -> str:
        """Sentence on constants that contradict each other, or an empty text."""
        if self.film_hardness <= self.hardness:
            return ""
        return (
            f"plasticity.film_hardness = {self.film_hardness:g} Pa is above plasticity.hardness = "
            f"{self.hardness:g} Pa; a tribofilm is taken to be softer than its solid."
        )

    def limit(self, film_1: Array, film_2: Array, depth: Array | float, full_thickness: float) -> Array:
        """Return the largest pressure [Pa] between films [m] that a plastic `depth` [m] has pressed in.

        full_thickness [m] is h_max.

        The film left above the depth U is h' - U while U < |h1 - h2| (h' the thicker one), (h1 + h2 - U) / 2 up to
        U = h1 + h2, then nothing: the largest of the three at every depth.
        """
        left = np.maximum(np.maximum(film_1, film_2) - depth, 0.5 * (film_1 + film_2 - depth))
        return self.under(np.clip(left / full_thickness, 0.0, 1.0))

    def under(self, cover: Any) -> Any:
        """Return the hardness [Pa] under a film of `cover` (0 to 1) of its full thickness."""
        return self.hardness - (self.hardness - self.film_hardness) * cover


LAWS: tuple[type[Plasticity], ...] = (ElasticPerfectlyPlastic,)
