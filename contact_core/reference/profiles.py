"""Profiles of rollers: depth [m] of their surface below the cylinder, at y [m] from the middle of their length.

Beyond the ends, where there is no roller, the drop is infinite.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from ..kernels.arrays import Array


def logarithmic_drop(
    y: ArrayLike, length: float, depth: float, crowned: float = 1.0, end_drop: float = math.inf
) -> Array:
    """Return the drop depth ln{1 / [1 - (1 - exp(-end_drop / depth)) s^2]}.

    s = 0 to 1 over the crowned part of either half.

    `crowned` is the share of the length [m] that is crowned, the middle is straight; end_drop [m] is that of the ends.
    Crowned throughout and with an infinite end_drop it is Lundberg's depth ln{1 / [1 - (2 y / length)^2]}, under which
    the load [N] is spread evenly if the depth is 2 load / (pi E' length); ISO 16281 takes 0.00035 roller diameters.
    Source: Lundberg, Forsch. Ing.-Wes. 10 (1939) 201; end_drop = depth ln[length / (0.6066 a)], a Hertz's half width:
    Johns & Gohar, Tribol. Int. 14 (1981) 131; in general: Fujiwara & Kawase, NTN Tech. Rev. 75 (2007) 140.
    """
    y = np.abs(np.asarray(y, dtype=np.float64))
    s = np.clip(1.0 - (0.5 * length - y) / (0.5 * length * crowned), 0.0, 1.0)
    kept = -math.expm1(-end_drop / depth)
    with np.errstate(divide="ignore"):
        drop = -depth * np.log1p(-kept * s * s)
    return np.where(y <= 0.5 * length, drop, math.inf)


def rounded_drop(y: ArrayLike, length: float, straight: float, radius: float) -> Array:
    """Return the drop of a straight middle [m] and ends of circular arcs [m] tangent to it.

    Without a middle, of a crown.
    """
    y = np.abs(np.asarray(y, dtype=np.float64))
    beyond = np.clip(y - 0.5 * straight, 0.0, radius)
    drop = beyond * beyond / (radius + np.sqrt(radius * radius - beyond * beyond))
    return np.where((y <= 0.5 * length) & (y - 0.5 * straight <= radius), drop, math.inf)
