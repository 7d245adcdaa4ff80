"""Stresses that roughness adds to those below smooth bodies, by curves fitted to the deterministic level.

All stresses are over Hertz's largest pressure. Points of a track at one place across it differ by the roughness that
they meet: the amplitude of their load cycle has a mean, a spread and a skewness, those of a Pearson III distribution.

Pressure of roughness that is pressed flat has the rms height E* slope / 2 (Persson, J. Chem. Phys. 115 (2001) 3840,
doi:10.1063/1.1388626); quantiles: Wilson & Hilferty, PNAS 17 (1931) 684, doi:10.1073/pnas.17.12.684.
Constants: `stress.curves` of the benchmarks of revision 869ed0dc.
"""

import math
from dataclasses import dataclass, fields
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..laws.elementary import Numbers

_FAINT = 1e-9  # of the local pressure: roughness that is felt by nobody
_OWN = 3.0  # power of the other body's share of the roughness in what a body meets, chosen


class Rough(NamedTuple):
    """Numbers of a contact's roughness on which the stresses below it depend."""

    steepness: float  # q, E* slope / Hertz's largest pressure
    clearance: float  # Z, film of the smooth bodies / composite roughness
    slip: float  # sliding over entrainment speed
    load_ratio: float  # W_c
    meetings: Array  # correlation lengths of the other body that pass a point of each body within 2 a, [2]
    depths: Array  # over the correlation length, [layers]
    spots: float  # squares of the correlation length on Hertz's contact, at most on the patch


def meetings(speeds: tuple[float, float], lengths: float, shares: tuple[float, float]) -> Array:
    """Return how much of the other body's roughness passes points of both bodies on their way through the contact.

    `lengths` is the way 2 a in correlation lengths, `shares` those of the bodies in the variance of the roughness. A
    body meets its own roughness always in the same place.
    """
    sliding = abs(speeds[0] - speeds[1])
    found = [
        lengths * sliding / max(abs(speed), 0.1 * sliding, 1e-30) * (1.0 - share) ** _OWN
        for speed, share in zip(speeds, shares, strict=True)
    ]
    return np.array(found)


@dataclass(frozen=True)
class Pressures:
    """Rms deviation of the pressure from Hertz's.

    q/2 is what Persson (J. Chem. Phys. 115 (2001) 3840, doi:10.1063/1.1388626) finds for waves pressed flat, q = E*
    slope / p.

    P = (q/2) / (1 + q/Q) / [1 + A Z^B q^D / (1 + slip / S)]: pressed flat by dry contact, the more the less steep, and
    parted by a film unless it slides. q is of the local pressure of smooth bodies, as P.
    """

    steep: float = 9.26  # Q
    parted: float = 0.357  # A
    film: float = 0.58  # B
    film_steep: float = 0.993  # D
    sliding: float = 0.146  # S

    def at(self, rough: Rough, chords: Array) -> Array:
        """Return P over Hertz's largest pressure where the local pressure is `chords` of that, [rows]."""
        q = rough.steepness / chords
        parted = self.parted * rough.clearance**self.film / (1.0 + rough.slip / self.sliding)
        film: Array = q**self.film_steep * parted
        found: Array = 0.5 * rough.steepness / ((1.0 + q / self.steep) * (1.0 + film))
        return found


@dataclass(frozen=True)
class Added:
    """One stress of a load cycle over that of smooth bodies S: its distribution over the points of a track.

    With p = P over the local pressure of smooth bodies, n what the other body lets a point meet, x = z/l: the spread is
    s = size p^growth exp[-(x/reach)^shape], the mean s [mean + meeting ln(1 + n) + rough ln p] - relief P S, the
    skewness [skew + skew_rough p + skew_parted (1 - W_c)] exp(-x/skew_reach) / (1 + skew_meeting n). The hydrostatic
    stress is that of smooth bodies.
    """

    size: Numbers
    growth: Numbers
    reach: Numbers
    shape: Numbers
    mean: Numbers
    meeting: Numbers
    rough: Numbers
    relief: Numbers
    skew: Numbers
    skew_rough: Numbers
    skew_parted: Numbers
    skew_reach: Numbers
    skew_meeting: Numbers

    def quantiles(self, smooth: Array, pressures: Array, chords: Array, rough: Rough, scores: Array) -> Array:
        """Return the stress [2, ..., layers, rows, scores] of both bodies at quantiles of normal `scores`.

        `smooth` [..., layers, rows] is that of smooth bodies, `pressures` are P and `chords` local pressures, [rows].
        Constants are numbers, or arrays [..., 1, 1].
        """
        local = np.maximum(pressures / chords, _FAINT)
        z = rough.depths[:, None]
        n = (rough.meetings[:, None] * chords).reshape(2, *(1,) * (smooth.ndim - 1), chords.size)
        spread = (self.size * chords * local**self.growth) * np.exp(-((z / self.reach) ** self.shape))
        level = self.mean + self.meeting * np.log1p(n) + self.rough * np.log(local)
        middle = smooth * (1.0 - self.relief * pressures) + spread * level
        skewed = self.skew + self.skew_parted * (1.0 - rough.load_ratio) + self.skew_rough * local
        skew = np.exp(z / -self.skew_reach) * skewed / (1.0 + self.skew_meeting * n)
        found: Array = middle[..., None] + spread[..., None] * _pearson(skew[..., None], scores)
        return np.maximum(found, 0.0)

    @staticmethod
    def together(curves: "tuple[Added, ...]") -> "Added":
        """Return several curves as one, for arrays of as many stresses."""
        return Added(*(np.array([getattr(c, f.name) for c in curves])[:, None, None] for f in fields(Added)))


def _pearson(skew: Array, scores: Array) -> Array:
    """Return quantiles of the Pearson III distribution of mean 0 and variance 1, for normal scores."""
    third = np.maximum(skew, 1e-3) / 6.0
    base = np.maximum((1.0 - third * third) + third * scores, 0.0)
    found: Array = (base * base * base - 1.0) / (3.0 * third)
    return found


@dataclass(frozen=True)
class Largest:
    """Largest von Mises stress of a depth: that of smooth bodies and P^growth (a ln N + c (1 - W_c)) exp[-(x/r)^g].

    N is the number of spots, P the rms over the contact.
    """

    growth: float = 1.33
    spots: float = 0.542  # a
    parted: float = 0.764  # c
    reach: float = 1.2  # r
    shape: float = 1.34  # g

    def at(self, smooth: Array, pressure: float, rough: Rough) -> Array:
        """Return it [layers]; `pressure` is P."""
        size = self.spots * math.log(max(rough.spots, 1.0)) + self.parted * (1.0 - rough.load_ratio)
        found: Array = smooth + pressure**self.growth * size * np.exp(-((rough.depths / self.reach) ** self.shape))
        return found


@dataclass(frozen=True)
class NearSurface:
    """All curves, and the ranges of the contacts that they were fitted to."""

    pressures: Pressures = Pressures()
    shear: Added = Added(0.181, 1.18, 1.23, 1.25, 0.633, 0.754, 0.471, 0.0498, -0.309, 2.03, 1.68, 1.51, 0.307)
    dang_van: Added = Added(0.161, 1.14, 1.25, 1.24, 0.806, 0.54, 0.255, 0.0377, -0.461, 2.0, 1.62, 2.2, 0.339)
    largest: Largest = Largest()

    @cached_property
    def both(self) -> Added:
        """Curves of the shear and of Dang Van's stress."""
        return Added.together((self.shear, self.dang_van))


CURVES = NearSurface()
FITTED = {"steepness": (0.25, 4.2), "clearance": (0.02, 1.7), "slip": (0.003, 0.91)}
HALF_WIDTH = 0.25  # of the stress that does the damage, relative: 95 % of the points that were held back
