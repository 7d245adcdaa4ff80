"""Deterministic solutions that a state keeps to correct the regression level by."""

from dataclasses import dataclass

from ..arrays import Array


@dataclass(frozen=True)
class Solved:
    """One row for each solution; `contact_core.auto` knows what the columns are."""

    rows: Array  # [solutions, columns]

    def __post_init__(self) -> None:
        self.rows.setflags(write=False)
