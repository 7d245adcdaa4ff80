"""Share of the force between two spur gears that each pair of teeth carries.

The force [N] acts along the line of action; all of it is on the pairs in contact at any moment.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact_core.arrays import Array

from .geometry import SpurGearPair, fixed
from .path import Numbers

_STEEL = 206e9  # Pa, of the teeth that ISO 6336 is fitted to
_DEDENDUM = 1.25  # of the basic rack, in modules


@dataclass(frozen=True)
class Sharing:
    """Law by which pairs of teeth share the load.

    Rigid: F_i = F / n. Elastic: F_i = b c(x) max(delta - relief_i, 0), sum of F_i = F, c(x) = c' [0.55 + 1.8 x (1 -
    x)], x being the share of the path passed and c' the stiffness of ISO 6336-1:2006, section 9.3; Cai & Hayashi 1994.

    "rigid": in equal parts. "elastic": each as stiff as `pair_stiffness`, all deflected alike; linear tip relief takes
    off the tip `relief` and less toward `relief_length` before it, measured along the line of action.
    """

    model: str = fixed("", "law of sharing", choices=("rigid", "elastic"), default="rigid")
    relief_1: float = fixed("m", "relief at the pinion's tip", least=0.0, most=1e-3, default=0.0)
    relief_2: float = fixed("m", "relief at the wheel's tip", least=0.0, most=1e-3, default=0.0)
    relief_length_1: float = fixed("m", "part of the path that it takes, before E", least=0.0, most=1.0, default=0.0)
    relief_length_2: float = fixed("m", "part of the path that it takes, after A", least=0.0, most=1.0, default=0.0)

    def wrong(self, pair: SpurGearPair) -> Iterator[str]:
        """Yield a sentence for each rule that the numbers break together."""
        path, total = pair.end - pair.start, pair.shift_1 + pair.shift_2
        reliefs = (self.relief_1, self.relief_length_1), (self.relief_2, self.relief_length_2)
        for body, (depth, length) in enumerate(reliefs, 1):
            said = f"relief_{body} = {1e6 * depth:g} um"
            if self.model == "rigid" and depth > 0.0:
                yield f"{said} does nothing to rigid teeth. Use model = 'elastic', or leave it out."
            if (depth > 0.0) != (length > 0.0):
                yield f"{said} and relief_length_{body} = {1e3 * length:g} mm must both be above 0, or both 0."
            if length > path:
                yield f"relief_length_{body} = {1e3 * length:g} mm is above {1e3 * path:.4g} mm, the path of contact."
        if self.model == "elastic" and not (pair.shift_1 >= pair.shift_2 and -0.5 <= total <= 2.0):
            yield (
                f"shift_1 = {pair.shift_1:g} and shift_2 = {pair.shift_2:g}: ISO 6336-1 knows the stiffness of teeth "
                "with shift_1 >= shift_2 and a sum from -0.5 to 2. Use model = 'rigid'."
            )


def single_stiffness(pair: SpurGearPair) -> float:
    """Return c', largest stiffness of a pair of teeth per face width [N/m2].

    For discs without rim, specific loads from 100 N/mm, and a basic rack with a dedendum of 1.25 modules.
    Source: ISO 6336-1:2006, section 9.3, method B.
    """
    z1, z2, x1, x2 = pair.teeth_1, pair.teeth_2, pair.shift_1, pair.shift_2
    flexibility = (
        0.04723
        + 0.15551 / z1
        + 0.25791 / z2
        - 0.00635 * x1
        - 0.11654 * x1 / z1
        - 0.00193 * x2
        - 0.24188 * x2 / z2
        + 0.00529 * x1 * x1
        + 0.00182 * x2 * x2
    )  # mm um/N
    measured = 0.8  # of the theory
    rack = (1.0 + 0.5 * (1.2 - _DEDENDUM)) * (1.0 - 0.02 * (20.0 - np.degrees(pair.pressure_angle)))
    return float(1e9 * measured * rack / flexibility * pair.elastic_modulus / _STEEL)


def mean_stiffness(pair: SpurGearPair) -> float:
    """Return c_gamma, stiffness of a mesh per face width, averaged over its cycle [N/m2], for contact ratios from 1.2.

    Source: ISO 6336-1:2006, section 9.3.
    """
    return single_stiffness(pair) * (0.75 * pair.contact_ratio + 0.25)


def pair_stiffness(pair: SpurGearPair, position: Numbers) -> Numbers:
    """Return the stiffness of a pair of teeth per face width [N/m2] at a position [m]: c', at its path's ends 55 %.

    Source of the parabola: Cai & Hayashi, J. Mech. Des. 116 (1994) 558.
    """
    along = (position - pair.start) / (pair.end - pair.start)
    return single_stiffness(pair) * (0.55 + 1.8 * along * (1.0 - along))


def loads(pair: SpurGearPair, sharing: Sharing, force: float, position: Array) -> Array:
    """Return the load [N] >= 0 of the pair of teeth at each position [m], under a force [N] >= 0 between the gears.

    Pairs are in contact from A up to E; outside there is none.
    """
    others = np.arange(-int(pair.contact_ratio) - 1, int(pair.contact_ratio) + 2)  # the middle one is the pair itself
    there = np.asarray(position, dtype=np.float64)[..., None] + others * pair.base_pitch
    touching = (there >= pair.start) & (there < pair.end)
    middle = touching[..., len(others) // 2]
    if sharing.model == "rigid":
        return np.where(middle, force / np.maximum(touching.sum(axis=-1), 1), 0.0)
    stiffness = np.where(touching, pair.face_width * pair_stiffness(pair, there), 0.0)
    gap = np.where(touching, _relief(pair, sharing, there), 0.0)
    deflection = _common_deflection(stiffness, gap, touching, force)
    own = len(others) // 2
    return np.where(middle, stiffness[..., own] * np.maximum(deflection - gap[..., own], 0.0), 0.0)


def _relief(pair: SpurGearPair, sharing: Sharing, position: Array) -> Array:
    """Return the tip relief [m]."""
    taken = np.zeros_like(position)
    if sharing.relief_1 > 0.0:
        beyond = position - (pair.end - sharing.relief_length_1)
        taken += sharing.relief_1 * np.maximum(beyond, 0.0) / sharing.relief_length_1
    if sharing.relief_2 > 0.0:
        beyond = pair.start + sharing.relief_length_2 - position
        taken += sharing.relief_2 * np.maximum(beyond, 0.0) / sharing.relief_length_2
    return taken


def _common_deflection(stiffness: Array, gap: Array, touching: NDArray[np.bool_], force: float) -> Array:
    """Return the deflection [m] at which springs [..., n] of a stiffness, each behind its gap, carry a force together.

    With the springs in the order of their gaps, the first m carry it if that does not close the gap of the next.
    """
    order = np.argsort(np.where(touching, gap, np.inf), axis=-1)
    k, k_gap = (np.take_along_axis(a, order, axis=-1).cumsum(axis=-1) for a in (stiffness, stiffness * gap))
    asked = (force + k_gap) / np.maximum(k, 1.0)  # N/m: at a contact ratio of 1 rounding may leave none in contact
    return asked.min(axis=-1)
