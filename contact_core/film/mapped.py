"""The level of a map: the regression level, corrected by what deterministic solutions of one scene have left."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

from ..quantities import parameter
from .regression import Regression

MAP_SUFFIX = ".json"  # of files of maps


@dataclass(frozen=True)
class Mapped(Regression):
    """The regression level everywhere, corrected within the ranges of a map of the scene (`tribofmu map`)."""

    name: ClassVar[str] = "map"

    file: str = parameter(
        "", "the map: a file, or the name of a shipped one; empty: the shipped one of the scene's name", default=""
    )

    def found_in(self, folders: tuple[Path, ...]) -> "Mapped":
        """Return the record with the path of its file as found in one of the folders, if it is in any."""
        if self.file.endswith(MAP_SUFFIX):
            for folder in folders:
                if (folder / self.file).is_file():
                    return replace(self, file=str((folder / self.file).resolve()))
        return self
