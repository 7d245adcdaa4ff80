"""What a state keeps of the material below the surfaces: sampled tractions, load cycles and damage."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array


@dataclass(frozen=True)
class Below:
    """Tractions of the pass in progress, and the damage they do. Fields of a body are [layers * rows, nx - 1].

    They lie on its patch at fixed depths below its present surface, layer under layer.
    """

    pressure: Array  # on the surfaces at the instants so far [Pa], [instants * rows, nx], the oldest first
    shear: Array  # on body 2 along +x [Pa], likewise
    places: Array  # of the patches of both bodies along +x [nodes], [instants, 2]
    held: float  # time since the last whole pass [s]
    damage_1: Array  # 1 where the material fails
    damage_2: Array
    per_cycle_1: Array  # damage per load cycle
    per_cycle_2: Array
    rate: Array  # at which the mean damages of both tracks rise [1/s], [2]
    spread: Array  # its standard deviation from pass to pass [1/s], [2]
    short: Array  # by how much half of the instants find less [1/s], [2]
    step: Array  # by which the rate has changed when it was found [1/s], [2]
    late: Array  # error of the mean damages by rates that are late, [2]
    few: Array  # the same by few instants, [2]
    variance: Array  # of the mean damages by the passes, [2]

    def __post_init__(self) -> None:
        for array in vars(self).values():
            if isinstance(array, np.ndarray):
                array.setflags(write=False)

    @property
    def damage(self) -> tuple[Array, Array]:
        """Damage of body 1 and 2."""
        return self.damage_1, self.damage_2

    @property
    def per_cycle(self) -> tuple[Array, Array]:
        """Damage per load cycle of body 1 and 2."""
        return self.per_cycle_1, self.per_cycle_2

    def errors(self, body: int) -> tuple[float, float]:
        """Return the half widths of the error of a track's mean damage, by late rates and by few instants."""
        late = abs(float(self.late[body])) + 0.5 * abs(float(self.step[body])) * self.held
        return late, abs(float(self.few[body])) + 2.0 * float(self.variance[body]) ** 0.5


def nothing_below(layers: int, rows: int, columns: int) -> Below:
    """Return what lies below new surfaces, before the first instant."""
    fresh = np.zeros((layers * rows, columns))
    nothing, none = np.zeros(2), np.empty((0, 0))
    return Below(none, none, none, 0.0, *(fresh,) * 4, *(nothing,) * 7)
