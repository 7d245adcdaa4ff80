"""Numbers of a scene that may be changed without reading it anew: parameters of an FMU and of studies."""

from collections.abc import Mapping
from dataclasses import Field
from typing import Any

from ..errors import SceneError, did_you_mean
from ..quantities import numbers, with_numbers
from .scene import Scene, checked

_INPUTS = ("geometry.radius_x", "geometry.radius_y")
_PARTS = (
    "geometry",
    "solids",
    "surface_1",
    "surface_2",
    "lubricant",
    "plasticity",
    "boundary_friction",
    "heat",
    "tribofilm",
    "wear",
    "oxide",
    "stress",
    "fatigue",
    "scuffing",
    "film",
    "control",
)


def tunables(scene: Scene) -> dict[str, tuple[float | int, "Field[Any]"]]:
    """Return every number of the scene that changes no array's shape and is no input.

    The keys are dotted names, the values (value, dataclass field).
    """
    return {
        name: (value, f)
        for part in _PARTS
        for name, value, f in numbers(getattr(scene, part), part)
        if name not in _INPUTS
    }


def with_values(scene: Scene, values: Mapping[str, float | int]) -> Scene:
    """Return the scene with some of its `tunables` changed (SI), checked like a new one.

    Raises SceneError that names what was changed: a sentence may speak of what follows from it.
    """
    known = tunables(scene)
    for name in values:
        if name not in known:
            raise SceneError(
                f"'{name}' is not a number that can be changed in a scene.{did_you_mean(name, list(known))}"
            )
    try:
        return checked(with_numbers(scene, values))
    except SceneError as error:
        changed = [f"{name} = {value:g}" for name, value in values.items() if value != known[name][0]]
        unnamed = [each for each in changed if each.split(" ")[0] not in str(error)]
        if not unnamed:
            raise
        raise SceneError(f"{error} The scene was changed by {', '.join(unnamed)}.") from None
