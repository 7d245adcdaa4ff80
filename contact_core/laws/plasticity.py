"""Largest pressure, and yielding of the surfaces above it."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..quantities import parameter
from .base import Hardening, Plasticity
from .equations import Equations


@dataclass(frozen=True)
class ElasticPerfectlyPlastic:
    """The pressure is at most the hardness; the overlap beyond it stays as permanent depth.

    The hardness falls linearly from the steel's, at the foot of a tribofilm, to the full film's at its top. The depth
    to which the surfaces have been pressed in decides what touches: the thicker film, both films or, beyond both, the
    steel (Andersson et al., Faraday Discuss. 156 (2012) 343, doi:10.1039/c2fd00132b, as in Azam, PhD thesis, University
    of Leeds 2018, section 5.5.2 and Figure 5-4).

    `indentation` says which depth counts: "none", zero, as if all films have healed before every pass; "total", all
    that has been pressed into both facing nodes before, as if a film never healed; "iterated", what the very solution
    presses in, as the thesis reads; "iterated_total", both together. With the last two the depth is part of the
    solution: soft films yield and harden until the solids below are reached, and each body takes the depth of what is
    softer, the thicker film first. With the first two the hardness is known before, and each body takes half.
    """

    name: ClassVar[str] = "elastic_perfectly_plastic"
    source: ClassVar[str] = (
        "Azam et al. 2019, doi:10.1016/j.triboint.2018.11.011; films pressed in: Andersson et al. 2012, "
        "doi:10.1039/c2fd00132b"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "p ≤ H(c),   H(c) = H_{steel} − (H_{steel} − H_{film}) c",
            "c h_{max} = max[max(h_1, h_2) − U, (h_1 + h_2 − U)/2, 0]",
        ),
        "h_i are the tribofilms, h_max is their full thickness. U is the plastic depth that plasticity.indentation "
        "counts.",
        symbols={
            "H": "hardness under the local tribofilm [Pa]",
            "H_{steel}": "hardness",
            "H_{film}": "film_hardness",
            "c": "tribofilm above the plastic depth, over its full thickness, 0 to 1 [1]",
            "h_{max}": "full thickness of the tribofilm, tribofilm.full_thickness [m]",
            "h_1": "tribofilm of body 1 [m]",
            "h_2": "tribofilm of body 2 [m]",
            "U": "plastic depth that indentation counts [m]",
        },
    )

    hardness: float = parameter("Pa", "hardness of the bare solids", above=1e6, most=1e12)
    film_hardness: float = parameter("Pa", "hardness of a full tribofilm", above=1e6, most=1e12)
    indentation: str = parameter(
        "",
        "plastic depth that hardens the tribofilms: none; total, of all instants before; iterated, of the instant "
        "itself, solved with it; iterated_total, both",
        choices=("none", "total", "iterated", "iterated_total"),
        default="none",
    )

    @property
    def error(self) -> str:
        if self.film_hardness <= self.hardness:
            return ""
        return (
            f"plasticity.film_hardness = {self.film_hardness:g} Pa is above plasticity.hardness = "
            f"{self.hardness:g} Pa; a tribofilm is taken to be softer than its solid."
        )

    @property
    def remembers(self) -> bool:
        return self.indentation in ("total", "iterated_total")

    @property
    def iterated(self) -> bool:
        """True if the depth of an instant itself counts."""
        return self.indentation in ("iterated", "iterated_total")

    def limit(self, film_1: Array, film_2: Array, depth: Array | float, full_thickness: float) -> Array:
        """Return the largest pressure [Pa] between films [m] that a plastic `depth` [m] has pressed in.

        full_thickness [m] is h_max.

        The film left above the depth U is h' - U while U < |h1 - h2| (h' the thicker one), (h1 + h2 - U) / 2 up to
        U = h1 + h2, then nothing: the largest of the three at every depth.
        """
        left = np.maximum(np.maximum(film_1, film_2) - depth, 0.5 * (film_1 + film_2 - depth))
        return self.under(np.clip(left / full_thickness, 0.0, 1.0))

    def hardening(self, film_1: Array, film_2: Array, depth: Array | float, full_thickness: float) -> Hardening:
        """Return how films [m] yield above `limit`: the depth u [m] that a pressure p [Pa] adds to `depth`.

        u = slope [max(p - first, 0) + max(p - second, 0)] inverts p = `limit` at depth + u, for films up to their full
        thickness.
        """
        first = self.limit(film_1, film_2, depth, full_thickness)
        second = np.maximum(first, self.under(np.clip(np.minimum(film_1, film_2) / full_thickness, 0.0, 1.0)))
        softening = self.hardness - self.film_hardness
        return Hardening(first, second, full_thickness / softening if softening > 0.0 else 0.0)

    def shares(self, film_1: Array, film_2: Array, depth: Array | float, overlap: Array) -> tuple[Array, Array]:
        """Return the parts of an overlap [m], pressed in after a `depth` [m], that body 1 and body 2 take.

        Iterated, the thicker film yields down to the thickness of the other one; then both yield, and both solids.
        """
        if not self.iterated:
            return 0.5 * overlap, 0.5 * overlap
        alone = np.clip(np.abs(film_1 - film_2) - depth, 0.0, overlap)
        half = 0.5 * (overlap - alone)
        first = half + np.where(film_1 > film_2, alone, 0.0)
        return first, overlap - first

    def under(self, cover: Any) -> Any:
        return self.hardness - (self.hardness - self.film_hardness) * cover


LAWS: tuple[type[Plasticity], ...] = (ElasticPerfectlyPlastic,)
