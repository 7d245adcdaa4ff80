"""Surfaces of both bodies from their track means: tribofilms, roughness, cover."""

import math
from typing import NamedTuple

from ..film import Regression
from ..scene import Scene
from ..state import Mean

Means = tuple[Mean, Mean]

_LEVELLED = 4.0  # roughness as new over that of worn solids, down to which as many peaks are in contact


class Tribofilm(NamedTuple):
    """A body's tribofilm, and the roughness under and with it."""

    thickness: float  # mean where there is one [m]
    roughness: float  # rms deviation of its thickness over the track [m]
    both: float  # rms roughness of solid and tribofilm [m]
    raised: float  # by which it makes a rough solid rougher, see `_with_film` [m]
    solid: float  # rms roughness of the solid [m]
    oxide: float = 0.0  # thickness of the oxide that no tribofilm covers [m]


Tribofilms = tuple[Tribofilm, Tribofilm]


def tribofilms_of(means: Means) -> Tribofilms:
    """Return the tribofilms of both bodies."""
    first, second = means
    return _tribofilm_of(first), _tribofilm_of(second)


def _tribofilm_of(mean: Mean) -> Tribofilm:
    """Return a tribofilm that lies evenly on the highest part of a track of Gaussian heights (assumed)."""
    share = mean.coverage
    if share == 0.0:
        return Tribofilm(0.0, 0.0, mean.roughness, 0.0, mean.roughness, mean.oxide)
    thickness = max(mean.growth - mean.removal, 0.0) / share
    apart = share * (1.0 - share)
    roughness = math.sqrt(apart) * thickness
    # the normal density at the height above which `share` of the heights lie, to 8 % from 2 to 98 %
    density = 0.3989 * (4.0 * apart) ** 0.8
    raised = 2.0 * density * thickness
    both = _with_film(mean.roughness, raised, roughness)
    return Tribofilm(thickness, roughness, both, raised, mean.roughness, mean.oxide)


def _with_film(solid: float, raised: float, film: float) -> float:
    """Return the rms roughness [m] of a solid under a tribofilm that lies on its highest part."""
    return math.sqrt((solid + raised) * solid + film * film)


def peaks_of(film: Tribofilm, rms: float) -> float:
    """Return the rms roughness [m] of a solid of rms roughness `rms` [m] as new, by the peaks that wear leaves it.

    Wear levels peaks, but as many stay in contact, solved down to a quarter of the roughness; with less left, it is
    taken to fall in proportion.
    """
    return min(rms, _LEVELLED * film.solid)


def under_film(film: Tribofilm, solid: float) -> float:
    """Return the rms roughness [m] of a solid of rms roughness `solid` [m] under a tribofilm."""
    return _with_film(solid, film.raised, film.roughness)


def composite_roughness(tribofilms: Tribofilms) -> float:
    """Return the composite rms roughness [m]."""
    return math.hypot(tribofilms[0].both, tribofilms[1].both)


def mean_cover(scene: Scene, tribofilms: Tribofilms) -> float:
    """Return the mean cover of both bodies where they touch."""
    return min(0.5 * (tribofilms[0].thickness + tribofilms[1].thickness) / scene.tribofilm.full_thickness, 1.0)


def added_friction(scene: Scene, tribofilms: Tribofilms) -> float:
    """Return what oxides add to the coefficient of boundary friction where the bodies touch."""
    law = scene.oxide
    if not law.grows:
        return 0.0
    oxides = 0.5 * (law.cover(tribofilms[0].oxide) + law.cover(tribofilms[1].oxide))
    return float(law.added_friction(scene.boundary_friction.bare, oxides, mean_cover(scene, tribofilms)))


def hardness_of(scene: Scene, tribofilms: Tribofilms) -> float:
    """Return the hardness [Pa] where they touch: under the thicker tribofilm."""
    thickest = min(max(tribofilms[0].thickness, tribofilms[1].thickness) / scene.tribofilm.full_thickness, 1.0)
    return float(scene.plasticity.under(thickest))


def regression_film(scene: Scene) -> Regression:
    """Return the scene's film record, which is of this level."""
    assert isinstance(scene.film, Regression)
    return scene.film
