"""Machines from TOML: which kind it is, its contacts and components, its duty, and how it is simulated.

    kind = "ball_bearing"        # or "gear_pair", "ball_on_disc"
    description = "..."

    [contact]                    # a scene, and what is different from it
    scene = "ball_209_inner"
    film.model = "regression"

    [drive]                      # the machine's components, by their names: see help of the kind's module
    [duty]                       # signals against time: see `timeline`
    [simulate]                   # the arguments of `master.simulate`

Any contact can be deterministic: `deterministic = ["inner_1"]`.
"""

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from contact_core.errors import SceneError
from contact_core.quantities import LEVELS, out_of_range
from contact_core.scene import Scene
from contact_core.scene.toml import build, did_you_mean, flat

from ..master.reading import settings, value
from .assembly import Assembly, Contact
from .files import folder, shipped

_VALUES = ("description", "deterministic")  # what is no table
_KINDS = ("ball_on_disc", "ball_bearing", "gear_pair")  # and the modules that assemble them


class Machine(NamedTuple):
    """A machine as its file has it."""

    name: str
    kind: str
    table: dict[str, Any]
    folder: Path  # from which the paths in it start


def read(source: str, changes: Mapping[str, str] | None = None) -> Machine:
    """A machine by name or by the path of a file; `changes` maps dotted keys to new values.

    Raises SceneError with a sentence that says what is wrong and what would be right.
    """
    path = Path(source)
    try:
        file = path if source.endswith(".toml") else folder() / f"{source}.toml"
        table = tomllib.loads(file.read_text("utf-8"))
    except OSError as error:
        raise SceneError(
            f"There is no machine '{source}' ({error.strerror}).{did_you_mean(source, list(shipped()))} Shipped are "
            f"{', '.join(shipped())}; or give the path of a .toml file."
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SceneError(f"The machine's file '{source}' is not valid TOML: {error}.") from None
    for key, text in (changes or {}).items():
        _put(table, key, value(text))
    table.setdefault("description", path.stem)
    if changes:
        table["description"] = f"{table['description']} (changed)"
    kind = table.pop("kind", None)
    if kind not in _KINDS:
        raise SceneError(f"kind = {kind!r} is not one of {', '.join(_KINDS)}.{did_you_mean(str(kind), list(_KINDS))}")
    return Machine(path.stem, kind, table, file.parent)


def _put(table: dict[str, Any], key: str, item: Any) -> None:
    """Set a dotted key."""
    *path, last = key.split(".")
    for name in path:
        table = table.setdefault(name, {})
        if not isinstance(table, dict):
            raise SceneError(f"'{key}' cannot be set: '{name}' is a value, not a table.")
    table[last] = item


def assemble(machine: Machine) -> Assembly:
    """The co-simulation of a machine. Raises SceneError for what is missing, unknown or out of range."""
    assembler: Callable[[Machine], Assembly] = import_module(f".{machine.kind}", __package__).assemble
    return assembler(machine)


def record(cls: type, table: Mapping[str, Any], name: str) -> Any:
    """The dataclass of a table of the file, its numbers within their ranges."""
    if name not in table:
        raise SceneError(f"The table [{name}] is missing. Known keys are those of {cls.__name__}.")
    found = build(cls, table[name], name)
    for sentence in out_of_range(found, name):
        raise SceneError(sentence)
    return found


def scene_of(table: Mapping[str, Any]) -> Scene:
    """The scene of the table [contact]: the one that it names, with what else it says."""
    values = dict(table.get("contact", {}))
    if "scene" not in values:
        raise SceneError("contact.scene is missing. It names a shipped scene, or the path of one.")
    base = str(values.pop("scene"))
    return Scene.from_toml(base, {key: str(item) for key, item in flat(values).items()})


def at_levels(contacts: Mapping[str, Contact], table: Mapping[str, Any]) -> dict[str, Contact]:
    """The contacts at the level of their scene, those that the file names under `deterministic` at that one."""
    deep = table.get("deterministic", [])
    if not isinstance(deep, list):
        raise SceneError(f'deterministic = {deep!r} must be a list of contacts, such as ["{next(iter(contacts))}"].')
    for name in deep:
        if name not in contacts:
            raise SceneError(
                f"deterministic names no contact: '{name}'.{did_you_mean(str(name), list(contacts))} Known are "
                f"{', '.join(contacts)}."
            )
    level = {"fidelity": len(LEVELS)}
    return {
        name: replace(contact, parameters={**contact.parameters, **level}) if name in deep else contact
        for name, contact in contacts.items()
    }


def simulation(table: Mapping[str, Any], duration: float) -> dict[str, Any]:
    """The arguments for `master.simulate`; a duty of `duration` [s] is simulated to its end if nothing is said."""
    given = settings(table.get("simulate", {}))
    if "step_size" not in given:
        raise SceneError('simulate.step_size is missing. Write for example step_size = "10 ms".')
    return {"stop_time": duration, **given}


def check_keys(machine: Machine, *known: str) -> None:
    """Raise SceneError if the file has a table or key at its top that its kind does not know, or no table for one."""
    for key, item in machine.table.items():
        if key not in known:
            raise SceneError(
                f"A {machine.kind} has no '{key}'.{did_you_mean(key, list(known))} Known are {', '.join(known)}."
            )
        if key not in _VALUES and not isinstance(item, Mapping):
            raise SceneError(f"{key} = {item!r} must be a table: [{key}] with its keys, or --set {key}.KEY=VALUE.")
