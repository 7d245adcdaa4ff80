"""Several surfaces of one body in a scene: `surface_i.files` or `surface_i.seeds`, each of them a member.

A file is a set (PATH.toml, the set that is called after its file, or PATH.toml:NAME) or heights (.npy, .csv) with
spacing and unit in [surface_i.heights]. Lists of both bodies are paired.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import SceneError

_BODIES = ("surface_1", "surface_2")
_ONE = {"files": "file", "seeds": "seed"}  # a list, and the key of one of it
_SETS = ".toml"
LISTS = frozenset(f"{body}.{key}" for body in _BODIES for key in _ONE)
FILES = frozenset(f"{body}.file" for body in _BODIES)


class Members(NamedTuple):
    """The members of an ensemble: the lists that they are from, and for each its name and what makes a scene of it."""

    keys: tuple[str, ...]  # such as surface_2.files
    names: tuple[str, ...]
    settings: tuple[tuple[tuple[str, str], ...], ...]  # overrides of the scene

    @property
    def text(self) -> str:
        """A sentence on the members."""
        return f"Ensemble of {len(self.names)} surfaces ({', '.join(self.keys)}): {', '.join(self.names)}."


def members(table: Mapping[str, Any]) -> Members | None:
    """Return the members of a scene's tables; None if they are one contact.

    Raises SceneError for a list that cannot be used, or lists of different lengths.
    """
    lists = {f"{body}.{key}": _listed(f"{body}.{key}", value) for body, key, value in _lists(table)}
    if not lists:
        return None
    lengths = {len(each) for each in lists.values()}
    if len(lengths) > 1:
        said = " and ".join(f"{key} has {len(each)}" for key, each in lists.items())
        raise SceneError(f"{said}: members are pairs of them. Give lists of equal length, or one list alone.")
    rows = list(zip(*lists.values(), strict=True))
    twice = next((row for row in rows if rows.count(row) > 1), None)
    if twice:
        raise SceneError(f"{', '.join(lists)}: {' with '.join(twice)} is there twice. Give each member once.")
    single = [f"{key.rpartition('.')[0]}.{_ONE[key.rpartition('.')[2]]}" for key in lists]
    return Members(
        tuple(lists),
        tuple(" with ".join(row) for row in rows),
        tuple(tuple(zip(single, row, strict=True)) for row in rows),
    )


def refuse_lists(table: Mapping[str, Any]) -> None:
    """Raise SceneError if a scene's tables are those of an ensemble, with the ways out."""
    found = members(table)
    if found is None:
        return
    picked = " ".join(f"{key}={value}" for key, value in found.settings[0])
    raise SceneError(
        f"This is an ensemble of {len(found.names)} surfaces ({' and '.join(found.keys)}), not one contact. "
        f"`tribofmu run` and `tribofmu explain` take it as it is; here pick a member, such as --set {picked}, or write "
        "that in the scene in place of the list."
    )


def taken(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene's tables with each `surface_i.file` as the set, or the file of heights, that it is."""
    return {
        key: _taken(value) if key in _BODIES and isinstance(value, Mapping) else value for key, value in table.items()
    }


def _taken(surface: Mapping[str, Any]) -> dict[str, Any]:
    rest = {key: value for key, value in surface.items() if key != "file"}
    return with_file(rest, str(surface["file"])) if "file" in surface else rest


def with_file(surface: Mapping[str, Any], file: str) -> dict[str, Any]:
    """Return the table of a surface with a file: a set, beside which its own keys win, or one of heights."""
    if is_set(file):
        name = file if f"{_SETS}:" in file else f"{file}:{Path(file).stem.lower()}"
        return {**surface, "set": name}
    heights = surface.get("heights", {})
    return {**surface, "heights": {**(heights if isinstance(heights, Mapping) else {}), "file": file}}


def is_set(file: str) -> bool:
    """Return whether a file is one of sets."""
    return file.endswith(_SETS) or f"{_SETS}:" in file


def _lists(table: Mapping[str, Any]) -> list[tuple[str, str, Any]]:
    """Return body, key and value of the lists in a scene's tables."""
    parts = [(body, table[body]) for body in _BODIES if isinstance(table.get(body), Mapping)]
    return [(body, key, part[key]) for body, part in parts for key in _ONE if key in part]


def _listed(key: str, value: Any) -> tuple[str, ...]:
    """Return a list as texts, given as such or by commas."""
    found = value.split(",") if isinstance(value, str) else value
    kind = str if key.endswith("files") else int
    good = isinstance(found, list) and all(isinstance(each, (str, kind)) for each in found)
    texts = tuple(str(each).strip() for each in found) if good else ()
    if len(texts) < 2 or not all(texts):
        example = '["disc_a.toml", "disc_b.toml"]' if kind is str else "[1, 2, 3]"
        raise SceneError(f"{key} = {value!r} must be a list of two or more, such as {example}.")
    return texts
