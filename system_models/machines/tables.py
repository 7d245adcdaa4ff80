"""The tables of a machine's file as records: a part, a scene."""

from collections.abc import Mapping
from typing import Any

from contact_core.errors import SceneError
from contact_core.quantities import out_of_range
from contact_core.scene import Assumed, Scene
from contact_core.scene.toml import build, flat


def record(cls: type, table: Mapping[str, Any], name: str) -> Any:
    """Return the dataclass `cls` of the table `name`, its numbers within their ranges."""
    if name not in table:
        raise SceneError(f"The table [{name}] is missing. Known keys are those of {cls.__name__}.")
    found = build(cls, table[name], name)
    for sentence in out_of_range(found, name):
        raise SceneError(sentence)
    return found


def scene_of(table: Mapping[str, Any]) -> Scene:
    """Return the scene of the table [contact]: the named scene with the changes of the other keys."""
    return scene_and_assumed(table)[0]


def scene_and_assumed(table: Mapping[str, Any]) -> tuple[Scene, tuple[Assumed, ...]]:
    """Return the same with the values that neither the scene nor the machine gives."""
    return Scene.read(*contact_of(table))


def contact_of(table: Mapping[str, Any]) -> tuple[str, dict[str, str]]:
    """Return the scene that the table [contact] names, and its changes of it, by dotted key."""
    values = dict(table.get("contact", {}))
    if "scene" not in values:
        raise SceneError("contact.scene is missing. It names a shipped scene, or the path of one.")
    base = str(values.pop("scene"))
    return base, {key: _text(item) for key, item in flat(values).items()}


def _text(item: Any) -> str:
    return ",".join(map(str, item)) if isinstance(item, list) else str(item)
