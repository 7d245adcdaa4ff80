"""The level of a map: the regression level, corrected by what deterministic solutions of one scene have left."""

from dataclasses import dataclass
from typing import ClassVar

from ..quantities import parameter
from .regression import Regression


@dataclass(frozen=True)
class Mapped(Regression):
    """The regression level everywhere, corrected within the ranges of a map of the scene (`tribofmu map`)."""

    name: ClassVar[str] = "map"

    file: str = parameter(
        "", "the map: a file, or the name of a shipped one; empty: the shipped one of the scene's name", default=""
    )
