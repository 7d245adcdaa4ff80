"""The regression level corrected by what deterministic solutions say: Gaussian conditioning (kriging), in closed form.

What the regression level deviates by, over the half width that it states, is taken as a Gaussian field of variance one
(over 1.96^2). Part of it is common to all contacts of one pair of surfaces, part is smooth in `Place`, part is smooth
on one pair of surfaces alone, and the rest, the nugget, is of each contact: the sampling of a deterministic block.
Given its values in some places (`Knots`), mean and variance elsewhere follow. Far from all knots this is the regression
level with its own half width; a half width never grows. Where the solutions deviate by more than their half widths say,
what is left is wider by as much.

The model: Kennedy & O'Hagan, Biometrika 87 (2000) 1, doi:10.1093/biomet/87.1.1, of one ratio. The constants:
`regression.correlation` of the benchmarks of revision 869ed0dc.
"""

import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy  # its parts are loaded at their first use
from numpy.typing import NDArray

from ..kernels.arrays import Array
from ..scene import Scene
from .correction import CORRECTED
from .places import Guards, Place, place_of

ABSOLUTE = "contact_load_ratio"  # its error is in its unit, the others' are relative
_NARROWEST = 1e-3  # half width from which on a deviation tells something
_WIDE = 1.96  # standard deviations in a half width
_LEAST = 0.05  # of the regression level's value, that is left of a corrected one
_GUARDS = Guards(1e-4, np.log, np.maximum)


class Correlation(NamedTuple):
    """How deviations of one output go together; the four shares sum to one."""

    common: float  # to all contacts of one pair of surfaces
    smooth: float  # over places
    paired: float  # likewise, of one pair alone
    nugget: float  # of each contact
    lengths: tuple[float, ...]  # over which the smooth part changes, in the coordinates of `Place`
    wider: float  # factor on what is left: so that half widths cover 95 % of contacts left out, which have long tails


CORRELATIONS: dict[str, Correlation] = {
    "friction_coefficient": Correlation(0.0, 0.58, 0.36, 0.06, (0.62, 1.2, 0.36, 0.2, 1.7), 1.15),
    "h_c": Correlation(0.33, 0.29, 0.34, 0.04, (0.47, 1.6, 0.21, 0.23, 3.4), 1.2),
    "contact_load_ratio": Correlation(0.0, 0.51, 0.44, 0.05, (0.71, 0.78, 0.28, 0.24, 2.3), 1.2),
}


def pair_of(scene: Scene) -> str:
    """Return a name for the pair of surfaces of a scene: contacts of one pair deviate alike."""
    return f"{zlib.crc32(repr((scene.surface_1, scene.surface_2)).encode()):08x}"


def place(outputs: Mapping[str, Any], load: Any, speeds: tuple[Any, Any], pressed: Any) -> Place:
    """Return the place of outputs of the regression level; not finite where there is no load.

    `load` [N], `speeds` of both bodies [m/s], `pressed` is Hertz's largest pressure over the hardness.
    """
    share = np.asarray(outputs["contact_load_ratio"], np.float64)
    mean, slide = 0.5 * np.abs(np.add(*speeds)), np.abs(np.subtract(*speeds))
    oil = np.abs(np.subtract(outputs["friction_force"], outputs["friction_solid"]))
    with np.errstate(divide="ignore", invalid="ignore"):
        return place_of(_GUARDS, outputs["lambda_ratio"], mean, slide, pressed, share, oil, load)


@dataclass(frozen=True)
class Knots:
    """Contacts that are solved: their places and deviations, over the half widths that the regression level states."""

    pairs: NDArray[Any]  # name of the pair of surfaces, [n]
    places: Array  # [n, coordinates of `Place`]
    off: Array  # deviation over half width, [n, outputs of `CORRECTED`]; NaN: not known
    own: Array  # half width of the solution itself over that of the regression level, [n, outputs]

    @property
    def count(self) -> int:
        """Number of knots."""
        return len(self.places)

    def but(self, left_out: int) -> "Knots":
        """Return the knots without one of them."""
        kept = np.arange(self.count) != left_out
        return Knots(self.pairs[kept], self.places[kept], self.off[kept], self.own[kept])


NO_KNOTS = Knots(np.empty(0, object), np.empty((0, 5)), np.empty((0, 3)), np.empty((0, 3)))


def knots(pairs: list[Any], places: list[Place], fast: list[Any], deep: list[Any]) -> Knots:
    """Return knots from outputs of both levels, given as mappings; what the deterministic level lacks is None."""
    found = [_deviations(one, other) for one, other in zip(fast, deep, strict=True)]
    if not found:
        return NO_KNOTS
    off, own = np.array(found).transpose(1, 0, 2)
    return Knots(np.array(pairs, object), np.array(places, np.float64).reshape(len(found), -1), off, own)


def _deviations(fast: Mapping[str, Any], deep: Mapping[str, Any] | None) -> tuple[list[float], list[float]]:
    """Return the deviations of the outputs, and the half widths of the solution, over the stated half widths."""
    off, own = [], []
    for name, error in CORRECTED.items():
        size = 1.0 if name == ABSOLUTE else float(fast[name])
        half = size * float(fast[error])
        known = deep is not None and half > _NARROWEST * size
        solved = float(deep[name]) if deep is not None else math.nan
        off.append((solved - float(fast[name])) / half if known else math.nan)
        width = float(deep[error]) * (1.0 if name == ABSOLUTE else solved) if deep is not None else math.nan
        own.append(width / half if known else math.nan)
    return off, own


class Conditioned(NamedTuple):
    """Means of the deviations over the stated half widths, and what is left of these, [places, outputs]."""

    mean: Array
    left: Array

    def of(self, outputs: Mapping[str, Any]) -> dict[str, Any]:
        """Return the corrected outputs and the errors that they state, from those of the regression level."""
        found: dict[str, Any] = {}
        for k, (name, error) in enumerate(CORRECTED.items()):
            stated = np.asarray(outputs[error], np.float64)
            shift, left = stated * self.mean[..., k], stated * self.left[..., k]
            if name == ABSOLUTE:
                found |= {name: np.clip(outputs[name] + shift, 0.0, 1.0), error: left}
            else:
                factor = np.maximum(1.0 + shift, _LEAST)
                found |= {name: outputs[name] * factor, error: left / factor}
        return found


class _Known(NamedTuple):
    """Knots that know an output: solved for once."""

    law: Correlation
    pairs: NDArray[Any]
    places: Array
    factor: tuple[Array, bool]
    weights: Array
    wider: float  # factor on what is left


class Conditioner:
    """Knots, solved for; says what they make of other places."""

    def __init__(self, given: Knots) -> None:
        """Solve for the weights of the knots."""
        self._known = [self._solved(given, k, law) for k, law in enumerate(map(CORRELATIONS.__getitem__, CORRECTED))]

    @staticmethod
    def _solved(given: Knots, output: int, law: Correlation) -> _Known | None:
        known = np.isfinite(given.off[:, output]) & np.isfinite(given.places).all(1)
        if not known.any():
            return None
        places, pairs = given.places[known], given.pairs[known]
        noise = law.nugget + given.own[known, output] ** 2
        factor = scipy.linalg.cho_factor(covariance(law, pairs, places, pairs, places) + np.diag(noise))
        off = given.off[known, output]
        weights = scipy.linalg.cho_solve(factor, off)
        surprise = _WIDE * math.sqrt(float(off @ weights) / len(off))  # one, if they deviate as their half widths say
        return _Known(law, pairs, places, factor, weights, law.wider * max(surprise, 1.0))

    def at(self, pairs: NDArray[Any], places: Array) -> Conditioned:
        """Return what the knots say of places, [places, coordinates] on `pairs` of surfaces."""
        means, lefts = np.zeros((len(places), len(CORRECTED))), np.ones((len(places), len(CORRECTED)))
        usable = np.isfinite(places).all(1)
        for k, known in enumerate(self._known):
            if known is None or not usable.any():
                continue
            across = covariance(known.law, pairs[usable], places[usable], known.pairs, known.places)
            means[usable, k] = across @ known.weights
            told = np.einsum("ij,ji->i", across, scipy.linalg.cho_solve(known.factor, across.T))
            lefts[usable, k] = np.minimum(known.wider * np.sqrt(np.clip(1.0 - told, 0.0, 1.0)), 1.0)
        return Conditioned(means, lefts)


def nearness(law: Correlation, places: Array, others: Array) -> Array:
    """Return the correlation of the smooth part between places, [places, others]."""
    lengths = np.array(law.lengths)
    apart = (places[:, None, :] - others[None, :, :]) / lengths
    return np.asarray(np.exp(-0.5 * np.sum(apart * apart, 2)))


def covariance(law: Correlation, pairs: NDArray[Any], places: Array, of: NDArray[Any], at: Array) -> Array:
    """Return the covariance of deviations, without the nugget, between places and others, [places, others]."""
    same = pairs[:, None] == of[None, :]
    return np.asarray(law.common * same + (law.smooth + law.paired * same) * nearness(law, places, at))
