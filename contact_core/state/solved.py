"""Deterministic solutions that a state keeps to correct the regression level by."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Solved:
    """One row for each solution; `contact_core.auto` knows what the columns are."""

    rows: NDArray[np.float64]  # [solutions, columns]

    def __post_init__(self) -> None:
        self.rows.setflags(write=False)
