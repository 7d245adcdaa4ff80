"""Machines from TOML: kind, contacts and components, duty, and how they are simulated: docs/how-to/machines.md."""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from contact_core.errors import SceneError, did_you_mean
from contact_core.quantities import LEVELS
from contact_core.scene.intervals import Interval, applicable, listed
from contact_core.scene.toml import NO_UTF_8, still_assumed

from ..master.reading import settings, value
from ..run import duty_table
from . import timeline
from .assembly import Assembly, Contact
from .files import shipped, shipped_files
from .kind import Design, Kind
from .registry import kinds

_VALUES = ("description", "deterministic")  # keys that are no tables


class Machine(NamedTuple):
    """A machine as its file has it."""

    name: str
    kind: str
    table: dict[str, Any]
    folder: Path  # from which the paths in it start


def read(source: str, changes: Mapping[str, str] | None = None, duty: Path | None = None) -> Machine:
    """Read a machine by name or by the path of a file; `changes` maps dotted keys to new values.

    `duty` is a table of the duty in place of the steps or cycles of the file; changes hold for both.
    Raises SceneError with a sentence on the error and its remedy.
    """
    path = Path(source)
    try:
        file = path if source.endswith(".toml") else shipped_files().get(source, path)
        table = tomllib.loads(file.read_text("utf-8-sig"))
    except OSError as error:
        raise SceneError(
            f"There is no machine '{source}' ({error.strerror}).{did_you_mean(source, list(shipped()))} Shipped are "
            f"{', '.join(shipped())}; or give the path of a .toml file."
        ) from None
    except UnicodeDecodeError:
        raise SceneError(f"The machine's file '{source}' is not valid TOML: {NO_UTF_8}") from None
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"The machine's file '{source}' is not valid TOML: {error}.") from None
    if duty:
        own = table.get("duty", {})
        table["duty"] = timeline.with_file(own if isinstance(own, Mapping) else {}, duty.absolute())
    for key, text in (changes or {}).items():
        _put(table, key, value(text))
    if isinstance(table.get("intervals"), Mapping):
        table["intervals"] = still_assumed(table["intervals"], changes or ())
    table.setdefault("description", path.stem)
    if changes:
        table["description"] = f"{table['description']} (changed)"
    kind = table.pop("kind", None)
    known = list(kinds())
    if kind not in known:
        raise SceneError(f"kind = {kind!r} is not one of {', '.join(known)}.{did_you_mean(str(kind), known)}")
    own = table.get("duty")
    if changes and isinstance(own, Mapping) and "file" in own:
        duty_table.refuse_hidden(file.parent / str(own["file"]), kinds()[kind].signals, "duty", changes)
    return Machine(path.stem, kind, table, file.parent)


ATTRIBUTE = "machine_json"  # of a machine's result


def described(machine: Machine) -> dict[str, str]:
    """Return the machine as an attribute of its result, from which `from_attribute` makes it again."""
    parts = {**machine._asdict(), "folder": str(machine.folder.absolute())}
    return {ATTRIBUTE: json.dumps(parts, default=str)}


def from_attribute(text: str) -> Machine:
    parts = json.loads(text)
    return Machine(**{**parts, "folder": Path(parts["folder"])})


def _put(table: dict[str, Any], key: str, item: Any) -> None:
    """Set a dotted key."""
    *path, last = key.split(".")
    for name in path:
        table = table.setdefault(name, {})
        if not isinstance(table, dict):
            raise SceneError(f"'{key}' cannot be set: '{name}' is a value, not a table.")
    table[last] = item


def assemble(machine: Machine) -> Assembly:
    """Return the co-simulation of a machine. Raises SceneError for what is missing, unknown or out of range."""
    kind, table = kinds()[machine.kind], machine.table
    _check_keys(machine, kind)
    duty = duty_of(machine)
    design = kind.design(table, duty)
    assembly = Assembly(
        name=machine.name,
        description=str(table["description"]),
        parts=design.parts,
        contacts=_at_levels(design.contacts, table),
        connections=design.connections,
        parameters={},
        schedule=design.schedule,
        settings=_simulation(table, duty.end),
        reported=design.reported,
        intervals=_intervals(table.get("intervals", {}), design),
    )
    for interval in assembly.intervals:
        assembly.ends(interval)
    return assembly


def _intervals(table: Mapping[str, Any], design: Design) -> tuple[Interval, ...]:
    """Return the intervals that the machine and its contacts' scene assume. Raises SceneError for impossible ones."""
    own = {each["key"]: Interval(**each) for each in listed(table)}
    theirs = applicable(next(iter(design.contacts.values())).scene)
    of_contacts = [replace(each, key=", ".join(f"contact.{key}" for key in each.keys)) for each in theirs]
    return tuple(({each.key: each for each in of_contacts} | own).values())


def duty_of(machine: Machine) -> timeline.Timeline:
    """Return the duty of a machine for as long as it is simulated."""
    kind, table = kinds()[machine.kind], machine.table
    stop = settings(table.get("simulate", {})).get("stop_time")
    return timeline.read(table.get("duty", {}), kind.signals, machine.folder, kind.needed, stop)


def _at_levels(contacts: Mapping[str, Contact], table: Mapping[str, Any]) -> dict[str, Contact]:
    """Return the contacts at the level of their scene, those listed under `deterministic` at that level."""
    deep = table.get("deterministic", [])
    if not isinstance(deep, list):
        raise SceneError(f'deterministic = {deep!r} must be a list of contacts, such as ["{next(iter(contacts))}"].')
    for name in deep:
        if name not in contacts:
            raise SceneError(
                f"deterministic names no contact: '{name}'.{did_you_mean(str(name), list(contacts))} Known are "
                f"{', '.join(contacts)}."
            )
    level = {"fidelity": 1 + LEVELS.index("deterministic")}
    return {
        name: replace(contact, parameters={**contact.parameters, **level}) if name in deep else contact
        for name, contact in contacts.items()
    }


def _simulation(table: Mapping[str, Any], duration: float) -> dict[str, Any]:
    """Return the arguments for `master.simulate`; without a stop time a duty of `duration` [s] runs to its end."""
    given = settings(table.get("simulate", {}))
    if "step_size" not in given:
        raise SceneError('simulate.step_size is missing. Write for example step_size = "10 ms".')
    return {"stop_time": duration, **given}


def _check_keys(machine: Machine, kind: Kind) -> None:
    """Raise SceneError for a table or key that the kind does not know, or a value in place of a table."""
    known = ["description", *kind.tables, "contact", "deterministic", "duty", "intervals", "simulate"]
    for key, item in machine.table.items():
        if key not in known:
            raise SceneError(f"A {kind.name} has no '{key}'.{did_you_mean(key, known)} Known are {', '.join(known)}.")
        if key not in _VALUES and not isinstance(item, Mapping):
            raise SceneError(f"{key} = {item!r} must be a table: [{key}] with its keys, or --set {key}.KEY=VALUE.")
