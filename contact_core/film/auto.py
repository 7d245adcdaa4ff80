"""The level in between: the regression level, corrected by deterministic blocks where it is not sure enough."""

from dataclasses import dataclass
from typing import ClassVar

from .regression import Regression


@dataclass(frozen=True)
class Auto(Regression):
    """The regression level everywhere; where friction or film are less sure than asked for, a deterministic block."""

    name: ClassVar[str] = "auto"
