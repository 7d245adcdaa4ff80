"""Where each value of a scene comes from: its file, a named set, a setting, an accuracy asked for, or a default.

Comments say it, read here alone: behind a value (a source, "assumed: why", "chosen: why" or a remark), behind a table's
header for all of it, before the first table for the file. A set may have a key `source` instead.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

from .accuracy import provisional
from .finishes import FILE
from .toml import completed, file_of_set, flat, full_key, given, text_of

_LINE = re.compile(r"""((?:[^"'#]|"(?:[^"\\]|\\.)*"|'[^']*')*)(?:#\s*(.*))?$""")  # what a line says, and its comment
_TABLE = re.compile(r"\s*\[+\s*([^\[\]]+?)\s*\]+\s*$")
_KEY = re.compile(r"\s*([\w.\-]+)\s*=")


class Kind(Enum):
    """Where a value comes from."""

    FILE = "the scene's file"
    SET = "a named set"
    SETTING = "a setting of the command"
    ACCURACY = "chosen for control.accuracy"
    DEFAULT = "a default"


@dataclass(frozen=True)
class Origin:
    """Where one value comes from."""

    kind: Kind
    remark: str = ""  # beside the value
    source: str = ""  # of its table or set
    written: Any = None  # the value as it is written there, None of what is not
    set_name: str = ""  # of a set, with its file: "azam_oil, lubricants.toml"

    @property
    def word(self) -> str:
        """Where it comes from in one word: "assumed", "chosen", ...; empty if there is a source."""
        if self.kind not in (Kind.FILE, Kind.SET):
            return {Kind.SETTING: "set", Kind.ACCURACY: "accuracy", Kind.DEFAULT: "default"}[self.kind]
        for said in (self.remark.lower(), self.source.lower()):
            if found := next((word for word in ("assumed", "chosen") if said.startswith(word)), ""):
                return found
        return "" if self.remark or self.source else "assumed"


class Comments(NamedTuple):
    """Comments of a file of TOML."""

    about: str  # of the whole file
    by_key: dict[str, str]  # behind dotted keys
    by_table: dict[str, str]  # behind the headers of tables

    def remark(self, key: str) -> str:
        """Return the comment behind a dotted key, or behind the inline table that it is in."""
        return _nearest(self.by_key, key)

    def source(self, key: str) -> str:
        """Return the comment of the nearest table around a dotted key that has one."""
        return _nearest(self.by_table, key)


def _nearest(comments: Mapping[str, str], key: str) -> str:
    while key and key not in comments:
        key = key.rpartition(".")[0]
    return comments.get(key, "")


def comments_of(text: str) -> Comments:
    """Return the comments of a TOML text: those before the first table, and those behind keys and tables."""
    table, about = "", []
    by_key: dict[str, str] = {}
    by_table: dict[str, str] = {}
    for line in text.splitlines():
        match = _LINE.match(line)
        said, comment = (match[1], (match[2] or "").strip()) if match else (line, "")
        if header := _TABLE.match(said):
            table = header[1]
            by_table |= {table: comment} if comment else {}
        elif key := _KEY.match(said):
            by_key |= {f"{table}.{key[1]}" if table else key[1]: comment} if comment else {}
        elif comment and not table:
            about.append(comment)
    return Comments(" ".join(about), by_key, by_table)


def about(source: str | Path) -> str:
    """Return what the file of a scene says about itself before its first table; SceneError if it cannot be read."""
    return comments_of(text_of(source)).about


def origins(
    source: str | Path, table: Mapping[str, Any], overrides: Mapping[str, str] | None = None
) -> dict[str, Origin]:
    """Return the origin of every value of a scene's full `table` (`Scene.to_dict`) by dotted key.

    `source` and `overrides` are those of `Scene.from_toml`. Raises SceneError if a file cannot be read.
    """
    changes = {full_key(key, value): value for key, value in (overrides or {}).items()}
    original, written = (given(source, settings)[0] for settings in ({}, changes))
    chosen = set(provisional(completed(written))[1])
    kept = {key: value for key, value in flat(original).items() if flat(written).get(key) == value}
    sets = dict([*_sets(original), *_sets(written)])  # a setting of `model` writes out what a set had said
    comments = comments_of(text_of(source))
    values = (key for key in flat(table) if key != "intervals")
    return {key: _origin(key, kept, comments, changes, chosen, sets) for key in values}


class _Set(NamedTuple):
    name: str
    values: dict[str, Any]  # by dotted key of the scene
    comments: Comments
    source: str


def _sets(table: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, _Set]]:
    """Yield the named sets that tables take, by the tables' dotted paths."""
    for key, value in table.items():
        where = f"{path}.{key}" if path else key
        if isinstance(value, Mapping):
            yield from _sets(value, where)
        elif key == "set":
            yield path, _read_set(str(value), path)
        elif key == "finish":
            yield f"{path}.{key}", _read_finish(str(value).lower(), path)


def _read_set(chosen: str, path: str) -> _Set:
    file, name = file_of_set(chosen, path)
    text = text_of(file, "set")
    own, data = next((key, value) for key, value in tomllib.loads(text).items() if key.lower() == name)
    found = comments_of(text)
    inside = (
        {key.removeprefix(f"{own}."): said for key, said in comments.items() if key.startswith(f"{own}.")}
        for comments in (found.by_key, found.by_table)
    )
    values = {f"{path}.{key}": value for key, value in flat(data[path]).items()}
    return _Set(f"{own}, {file.name}", values, Comments("", *inside), str(data.get("source", "")))


def _read_finish(name: str, path: str) -> _Set:
    """Return a finish as a set of a surface; what a scene takes of it may be scaled, and is told as it is taken."""
    found = comments_of(FILE.read_text("utf-8"))
    own = {key.removeprefix(f"{name}."): said for key, said in found.by_key.items() if key.startswith(f"{name}.")}
    inside = {f"{path}.{key}": said for key, said in (own | {"correlation_length_across": own["lay"]}).items()}
    keys = ("rq", "correlation_length", "correlation_length_across", "microroughness.rms", "microroughness.longest")
    return _Set(f"{name}, {FILE.name}", {f"{path}.{key}": None for key in keys}, Comments("", inside, {}), "")


def _origin(
    key: str,
    kept: Mapping[str, Any],
    comments: Comments,
    changes: Mapping[str, str],
    chosen: set[str],
    sets: Mapping[str, _Set],
) -> Origin:
    named = key if key in kept else key.removesuffix(".model")  # `wear = "none"` is short for `wear.model`
    if key in changes or named in changes:
        return Origin(Kind.SETTING, written=changes.get(key, changes.get(named)))
    if named in kept:
        return Origin(Kind.FILE, comments.remark(named), comments.source(named), kept[named])
    for found in sets.values():
        if key in found.values:
            said = found.comments
            source = said.source(key) or found.source
            return Origin(Kind.SET, said.remark(key), source, found.values[key], found.name)
    return Origin(Kind.ACCURACY if key in chosen else Kind.DEFAULT)
