"""The level of a map: the regression level, corrected by what deterministic solutions of one scene have left."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

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


def map_file(film: Any) -> str | None:
    """Return the map that a record names, empty for the shipped one of the scene's name; None for other levels."""
    return film.file if isinstance(film, Mapped) else None


def with_map_found(film: Any, folders: tuple[Path, ...]) -> Any:
    """Return a record with the path of the file of its map as found in one of the folders, if there is any."""
    file = map_file(film)
    if file is not None and file.endswith(MAP_SUFFIX):
        for folder in folders:
            if (folder / file).is_file():
                return replace(film, file=str((folder / file).resolve()))
    return film
