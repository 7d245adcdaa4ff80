"""A system and how to simulate it, from TOML: docs/how-to/cosim.md.

Every key stands in a table, so the tables can come in any order: in TOML, a key after a heading belongs to it.
"""

import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from contact_core.errors import ContactError, did_you_mean
from contact_core.scene import units
from contact_core.scene.toml import NO_UTF_8

from ..fmu.errors import CouplingError
from .settings import Settings
from .system import System

_ARCHIVE = b"PK\x03\x04"  # first bytes of SSP and FMU
_CHANGEABLE = ("parameters", "simulate")


def read(path: str | Path, changes: Iterable[tuple[str, str]] = ()) -> tuple[System, dict[str, Any]]:
    """Return the system of a TOML file, and the arguments for `simulate` that it names.

    changes: keys "parameters.FMU.VARIABLE" or "simulate.NAME" with values as TOML has them, or as plain text; they win
    over the file. Raises CouplingError for a file that cannot be read or coupled.
    """
    path = Path(path)
    try:
        tables = _tables(path)
        for key, text in changes:
            _change(tables, key, text)
        return _system(tables, path.parent), settings(tables["simulate"])
    except ContactError as error:
        raise CouplingError(f"In '{path}': {error}") from None


def _tables(path: Path) -> dict[str, dict[str, Any]]:
    """Return all tables, flat where the keys are variables."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise CouplingError(f"The file cannot be read: {error.strerror}. Name a TOML file of a system.") from None
    if content.startswith(_ARCHIVE):
        raise CouplingError(_of_archive(path))
    try:
        file = tomllib.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise CouplingError(f"This is not valid TOML: {NO_UTF_8}") from None
    except tomllib.TOMLDecodeError as error:
        raise CouplingError(f"This is not valid TOML: {error}. Correct it.") from None
    tables: dict[str, dict[str, Any]] = {name: {} for name in ("fmus", "parameters", "schedule", *_KEYS)}
    for name, table in file.items():
        if name not in tables:
            raise _unknown("A system", name, list(tables), "tables")
        if not isinstance(table, dict):
            raise CouplingError(f"{name} = {_shown(table)} must be a table. Write [{name}], and its keys below.")
        tables[name] = table
    for name, known in _KEYS.items():
        for key in tables[name]:
            if key not in known:
                raise _unknown(f"[{name}]", key, list(known), "keys")
    return tables | {name: _flat(name, tables[name]) for name in ("parameters", "schedule")}


def _of_archive(path: Path) -> str:
    """Return a sentence on an archive that is given in place of a TOML file."""
    if path.suffix.lower() == ".ssp":
        return "This is an SSP, which is written here (--ssp) and not read. Name the TOML file of the system."
    if path.suffix.lower() == ".fmu":
        return (
            f'This is an FMU, not the TOML file of a system. Write one: [fmus] block = "{path.name}", and [simulate] '
            'stop_time = "10 s", step_size = "10 ms".'
        )
    return "This is an archive, not the TOML file of a system. Name that."


def _unknown(where: str, name: str, known: list[str], what: str) -> CouplingError:
    home = next((f"[{table}]" for table, keys in _KEYS.items() if name in keys), None)
    hint = f" It belongs to {home}." if home else did_you_mean(name, known)
    return CouplingError(f"{where} has no '{name}'.{hint} Its {what} are {', '.join(known)}.")


def _flat(name: str, table: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    """Return values by variable: `a.b = 1`, `"a.b" = 1` and `a = { b = 1 }` are the same."""
    found: dict[str, Any] = {}
    for key, value in table.items():
        entries = _flat(name, value, f"{path}{key}.") if isinstance(value, dict) else {f"{path}{key}": value}
        if twice := found.keys() & entries.keys():
            raise CouplingError(f"[{name}] has '{twice.pop()}' twice. Leave one of them out.")
        found |= entries
    return found


def _change(tables: dict[str, dict[str, Any]], key: str, text: str) -> None:
    table, _, name = key.partition(".")
    if table not in _CHANGEABLE or not name:
        raise CouplingError(
            f"'{key}' cannot be set from outside the file.{did_you_mean(table, list(_CHANGEABLE))} "
            "Name parameters.FMU.VARIABLE, or simulate.NAME such as simulate.stop_time."
        )
    if table in _KEYS and name not in _KEYS[table]:
        raise _unknown(f"[{table}]", name, list(_KEYS[table]), "keys")
    tables[table][name] = value(text)


def value(text: str) -> Any:
    """Return the value that TOML gives for a text, else the text: 0.5, true, ["a.x"], 10 ms, jacobi."""
    try:
        parsed = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    return parsed["value"] if len(parsed) == 1 else text


def _system(tables: Mapping[str, dict[str, Any]], folder: Path) -> System:
    if not tables["fmus"]:
        raise CouplingError('[fmus] is missing. Name the FMUs and their files, such as block = "block.fmu".')
    coupling = {key: _COUPLING[key](f"coupling.{key}", value) for key, value in tables["coupling"].items()}
    return System(
        {name: folder / _fmu(name, path) for name, path in tables["fmus"].items()},
        parameters=tables["parameters"],
        schedule={name: _steps(f"schedule.{name}", steps) for name, steps in tables["schedule"].items()},
        **coupling,
    )


def _fmu(name: str, path: Any) -> str:
    if not isinstance(path, str):
        raise CouplingError(f"fmus.{name} = {_shown(path)} must be the path of an .fmu file, as text.")
    return path


def settings(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments for `simulate` from a table; those that are "none" keep their default.

    Raises CouplingError for one that is unknown or of the wrong type.
    """
    for key in table:
        if key not in _SIMULATE:
            raise _unknown("[simulate]", key, list(_SIMULATE), "keys")
    return {key: _SIMULATE[key](f"simulate.{key}", item) for key, item in table.items() if item != "none"}


def _seconds(key: str, value: Any) -> float:
    return _number(key, value) if not isinstance(value, str) else units.parse(value, "s", key)


def _times(key: str, value: Any) -> list[float]:
    return [_seconds(f"{key}[{i}]", time) for i, time in enumerate(_list(key, value, 'times, such as ["1 s", "3 s"]'))]


def _number(key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise CouplingError(f"{key} = {_shown(value)} must be a number.")
    try:
        return float(value)
    except OverflowError:
        raise CouplingError(f"{key} = {_shown(value)} is too large. Give at most 1e308.") from None


def _one_of(*choices: Any) -> Callable[[str, Any], Any]:
    def checked(key: str, value: Any) -> Any:
        if value not in choices or isinstance(value, bool):
            raise CouplingError(f"{key} = {_shown(value)} must be one of {', '.join(map(repr, choices))}.")
        return value

    return checked


def _text(key: str, value: Any) -> str:
    if not isinstance(value, str):
        raise CouplingError(f"{key} = {_shown(value)} must be text in quotes.")
    return value


def _list(key: str, value: Any, what: str) -> list[Any]:
    if not isinstance(value, list):
        raise CouplingError(f"{key} = {_shown(value)} must be a list of {what}.")
    return value


def _names(key: str, value: Any) -> list[str]:
    return [_text(f"{key}[{i}]", name) for i, name in enumerate(_list(key, value, 'variables, such as ["block.x"]'))]


def _connections(key: str, value: Any) -> list[list[Any]]:
    what = 'outputs and inputs, such as [["block.v", "contact.speed_1"]]'
    return [_list(f"{key}[{i}]", entry, "output, input and factor") for i, entry in enumerate(_list(key, value, what))]


def _bonds(key: str, value: Any) -> list[tuple[str, ...]]:
    pairs = _list(key, value, 'pairs of outputs, such as [["contact.friction_force", "block.v"]]')
    found = [tuple(_names(f"{key}[{i}]", pair)) for i, pair in enumerate(pairs)]
    for pair in found:
        if len(pair) != 2:
            raise CouplingError(f"{key} has {_shown(list(pair))}, but a bond is a pair of outputs.")
    return found


def _derivatives(key: str, value: Any) -> dict[tuple[str, str], str]:
    found = {}
    for entry in _list(key, value, "tables with `of`, `by` and `is`"):
        if not isinstance(entry, dict) or entry.keys() != {"of", "by", "is"}:
            raise CouplingError(
                f"{key} has {_shown(entry)}, but a derivative is a table with `of`, an output, `by`, an input, "
                "and `is`, the output that is the derivative."
            )
        of, by, name = (_text(f"{key}.{part}", entry[part]) for part in ("of", "by", "is"))
        found[of, by] = name
    return found


def _steps(key: str, value: Any) -> list[tuple[float, Any]]:
    what = 'pairs of time and value, such as [[0, 10.0], ["5 s", 20.0]]'
    for pair in _list(key, value, what):
        if not isinstance(pair, list) or len(pair) != 2:
            raise CouplingError(f"{key} has {_shown(pair)}, but it must be a list of {what}.")
    return [(_seconds(key, time), level) for time, level in value]


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


_COUPLING: dict[str, Callable[[str, Any], Any]] = {
    "connections": _connections,
    "events": _names,
    "bonds": _bonds,
    "derivatives": _derivatives,
}
_FORMS: dict[str, Callable[[str, Any], Any]] = {  # of settings
    "seconds": _seconds,
    "number": _number,
    "names": _names,
    "times": _times,
}
_SIMULATE: dict[str, Callable[[str, Any], Any]] = {
    f.name: _one_of(*f.metadata["choices"]) if f.metadata["choices"] else _FORMS[f.metadata["read"]]
    for f in fields(Settings)
} | {"outputs": _names}
_KEYS: dict[str, dict[str, Callable[[str, Any], Any]]] = {"coupling": _COUPLING, "simulate": _SIMULATE}
