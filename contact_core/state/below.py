"""What a state keeps of the material below the surfaces: sampled tractions, load cycles and damage."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Below:
    """Tractions of the instants of a pass, and the damage they do. `damage_i`, `per_cycle_i` are [layers * rows, nx - 1].

    They lie on the patch of body i at fixed depths below its present surface, layer under layer.
    """

    pressure: Array  # on the surfaces at the instants [Pa], [instants * rows, nx], the oldest first
    shear: Array  # on body 2 along +x [Pa], likewise
    places: Array  # of the patches of both bodies along +x [nodes], [instants, 2]
    damage_1: Array  # 1 where the material fails
    damage_2: Array
    per_cycle_1: Array  # damage per load cycle, by that pass
    per_cycle_2: Array

    def __post_init__(self) -> None:
        for array in vars(self).values():
            array.setflags(write=False)

    @property
    def damage(self) -> tuple[Array, Array]:
        """Damage of body 1 and 2."""
        return self.damage_1, self.damage_2

    @property
    def per_cycle(self) -> tuple[Array, Array]:
        """Damage per load cycle of body 1 and 2."""
        return self.per_cycle_1, self.per_cycle_2
