"""Other names that the field, or an earlier version, has for the keys of a scene, and what stands in their place."""

import logging
import re
import tomllib
from collections.abc import Mapping
from functools import lru_cache
from importlib.resources import files
from typing import Any, NamedTuple

_log = logging.getLogger(__name__)
# models of film in earlier versions, and the film.correction of the regression level that they stand for
_FORMER = {"auto": "blocks", "map": "map"}


class Meant(NamedTuple):
    """The meaning of another name of a key."""

    sentence: str
    keys: tuple[str, ...]  # of the same table, that the sentence asks for


@lru_cache(maxsize=1)
def tables() -> dict[str, dict[str, Meant]]:
    """Return what is said of each other name, by table without its number; `scene` is the whole."""
    text = (files("contact_core") / "data" / "other_names.toml").read_text("utf-8")
    return {
        table: {name: Meant(row["says"], tuple(row.get("keys", ()))) for row in rows for name in row["names"].split()}
        for table, rows in tomllib.loads(text).items()
    }


def meant(path: str, key: str) -> Meant | None:
    """Return what a key that the table at a dotted path does not have stands for; None if that is not known."""
    said = tables().get(re.sub(r"\.steps\[\d+\]$|_[12]$", "", path) or "scene", {})
    return said.get(key) or said.get(key.lower().replace("-", "_").replace("'", ""))


def with_correction(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene's table with film.correction in place of a model that earlier versions had for it."""
    film = table.get("film")
    former = film.get("model") if isinstance(film, Mapping) else film
    if not isinstance(former, str) or former not in _FORMER:
        return dict(table)
    rest = film if isinstance(film, Mapping) else {}
    return {**table, "film": {**rest, "model": "regression", "correction": _correction_of(former)}}


def current(overrides: Mapping[str, str]) -> dict[str, str]:
    """Return overrides with film.correction in place of a model that earlier versions had for it."""
    found: dict[str, str] = {}
    for key, value in overrides.items():
        if key in ("film", "film.model") and value in _FORMER:
            found |= {"film.model": "regression", "film.correction": _correction_of(value)}
        else:
            found[key] = value
    return found


def _correction_of(former: str) -> str:
    """Return the film.correction that a former model of film stands for, with a note."""
    correction = _FORMER[former]
    _log.warning("film.model = '%s' is film.model = 'regression' with film.correction = '%s'.", former, correction)
    return correction
