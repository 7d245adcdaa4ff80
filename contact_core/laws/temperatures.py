"""Heat and temperatures of a contact: what a law of heat takes and returns."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array

Nodes = NDArray[np.bool_]
Pair = tuple[float, float]  # of body 1 and 2


@dataclass(frozen=True)
class Rubbing:
    """Heat of a contact, and the contact that it warms. Arrays [ny, nx]."""

    dissipation: Array  # heat of friction per area [W/m2]
    gap: Array  # [m]
    solid: Nodes  # where solids touch
    inside: Nodes  # under pressure
    spacing: float  # of the grid [m]
    speeds: Pair  # of both surfaces along x, relative to the contact [m/s]
    bodies: Pair  # bulk temperatures [K]
    oil_conductivity: float | Array  # [W/(m K)]
    face: float | None = None  # length [m] along which the rows repeat themselves; None: they do not

    @property
    def total(self) -> float:
        """Heat of the whole contact [W]."""
        return float(self.dissipation.sum()) * self.spacing**2


@dataclass(frozen=True)
class Temperatures:
    """Temperatures [K], one number or [ny, nx], and the heat [W] that leaves the contact through each body."""

    surface_1: float | Array
    surface_2: float | Array
    film: float | Array  # mean over its thickness
    into_1: float  # into_1 + into_2: all that is dissipated
    into_2: float
    flash_rise: float  # of the surfaces above the bulk, mean over the real contact and both bodies
    solved: bool

    def hottest(self, nodes: int) -> float:
        """Return the mean [K] of so many of the hottest nodes, each at the temperature of its warmer surface."""
        warmer = np.maximum(self.surface_1, self.surface_2).ravel()
        if warmer.size <= nodes:
            return float(warmer.mean())
        return float(np.partition(warmer, -nodes)[-nodes:].mean())
