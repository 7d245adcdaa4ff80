"""Damage of the material below both tracks at the regression level, by classes of points."""

from dataclasses import dataclass, fields

import numpy as np

from ..arrays import Array

# shares of the points of a row, counted from those that the roughness loads least, at which a class ends
EDGES = np.array([0.25, 0.5, 0.65, 0.75, 0.82, 0.88, 0.92, 0.95, 0.97, 0.985, 0.995, 1.0])
WEIGHTS = np.diff(EDGES, prepend=0.0)


@dataclass(frozen=True)
class Classes:
    """Damage by layer and class, [layers, rows * classes]: the classes of one row after those of the one before.

    Rows lie in the middle of equal parts of |y| < b; lines have one.
    """

    damage_1: Array  # 1 where the material fails
    damage_2: Array
    pits_1: Array  # depth broken out [m], [rows * classes]
    pits_2: Array
    lag: Array  # depth worn since the damage was last moved up [m], [2]

    def __post_init__(self) -> None:
        for array in vars(self).values():
            array.setflags(write=False)

    @property
    def damage(self) -> tuple[Array, Array]:
        """Damage of body 1 and 2."""
        return self.damage_1, self.damage_2

    @property
    def pits(self) -> tuple[Array, Array]:
        """Depths broken out of body 1 and 2 [m]."""
        return self.pits_1, self.pits_2

    def alike(self, other: "Classes") -> bool:
        """Return True if all arrays are equal."""
        return all(np.array_equal(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))


def unharmed_classes(layers: int, rows: int) -> Classes:
    """Return the classes of new bodies."""
    none, whole = np.zeros((layers, rows * WEIGHTS.size)), np.zeros(rows * WEIGHTS.size)
    return Classes(none, none, whole, whole, np.zeros(2))
