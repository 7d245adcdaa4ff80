"""What the means of both bodies say of the surfaces that meet: tribofilms, roughness, cover."""

import math
from typing import NamedTuple

from ..film import Regression
from ..scene import Scene
from ..state import Mean

Means = tuple[Mean, Mean]


class Film(NamedTuple):
    """What the tribofilm makes of a body."""

    thickness: float  # mean where there is one [m]
    roughness: float  # rms deviation of its thickness over the track [m]
    both: float  # rms roughness of solid and tribofilm [m]


Films = tuple[Film, Film]


def films_of(means: Means) -> Films:
    """The tribofilms of both bodies."""
    first, second = means
    return _film_of(first), _film_of(second)


def _film_of(mean: Mean) -> Film:
    """A tribofilm that lies evenly on the highest part of a track of Gaussian heights (assumed)."""
    share = mean.coverage
    if share == 0.0:
        return Film(0.0, 0.0, mean.roughness)
    thickness = max(mean.growth - mean.removal, 0.0) / share
    apart = share * (1.0 - share)
    roughness = math.sqrt(apart) * thickness
    # the normal density at the height above which `share` of the heights lie, to 8 % from 2 to 98 %
    density = 0.3989 * (4.0 * apart) ** 0.8
    heights = mean.roughness
    return Film(
        thickness, roughness, math.sqrt((heights + 2.0 * density * thickness) * heights + roughness * roughness)
    )


def composite_roughness(films: Films) -> float:
    """Composite rms roughness [m]."""
    return math.hypot(films[0].both, films[1].both)


def mean_cover(scene: Scene, films: Films) -> float:
    """Mean cover of both bodies where they touch."""
    return min(0.5 * (films[0].thickness + films[1].thickness) / scene.tribofilm.full_thickness, 1.0)


def hardness_of(scene: Scene, films: Films) -> float:
    """Hardness [Pa] where they touch: under the thicker tribofilm."""
    thickest = min(max(films[0].thickness, films[1].thickness) / scene.tribofilm.full_thickness, 1.0)
    return float(scene.plasticity.under(thickest))


def scene_film(scene: Scene) -> Regression:
    """The scene's film, which is of this level."""
    assert isinstance(scene.film, Regression)
    return scene.film
