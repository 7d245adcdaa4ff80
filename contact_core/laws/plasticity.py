"""Where the pressure is cut off, and whose surface yields."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter


@dataclass(frozen=True)
class ElasticPerfectlyPlastic:
    """The pressure never exceeds the hardness; what overlaps beyond it stays as permanent depth, half on each body.

    The hardness falls linearly from the steel's to the full tribofilm's with the thicker of the two facing films
    (Azam, PhD thesis, University of Leeds 2018, section 5.4; no strengthening by plastic depth).
    """

    name: ClassVar[str] = "elastic_perfectly_plastic"
    source: ClassVar[str] = "Azam et al. 2019, doi:10.1016/j.triboint.2018.11.011"

    hardness: float = parameter("Pa", "hardness of the bare solids", above=1e6, most=1e12)
    film_hardness: float = parameter("Pa", "hardness of a full tribofilm", above=1e6, most=1e12)

    def limit(self, cover: NDArray[np.float64]) -> NDArray[np.float64]:
        """Largest pressure [Pa] where the thicker film is `cover` (0 to 1) of its full thickness."""
        return self.hardness - (self.hardness - self.film_hardness) * cover


LAWS = (ElasticPerfectlyPlastic,)
