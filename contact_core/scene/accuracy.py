"""Choice of grid, tolerance, blocks and instants of a scene that asks for an accuracy, `control.accuracy`.

What the scene says of the fields in `records.CHOSEN` stays; the others are chosen, the cheapest that will do.
"""

import math
from collections.abc import Collection, Mapping
from typing import Any, TypeVar

from ..errors import SceneError
from ..film.grid_error import film_error, inlet_error, load_ratio_error
from ..quantities import UNSOLVED
from .checks import duty_points
from .fields import SceneFields
from .hertz_grid import POINTS, inlet, room_for_hertz, room_for_inlet, with_values
from .records import CHOSEN

Scene = TypeVar("Scene", bound=SceneFields)

_PATCHES = 129  # of a state at the regression level
_GRID = 0.97  # part of the accuracy that is left to the grid: errors add up as squares
_INLET = 0.24  # part that is left to the film missing where the domain cuts the inlet off
_TYPICAL_SHARE = 0.5  # W_c: which it will be is not known before
# of time steps and sampling at an accuracy of 5 %: stated errors of the shipped scenes are then 2 to 5 %
_AT = 0.05
_CHANGE, _LEAST_CHANGE, _LARGEST_CHANGE = 3e-9, 0.3e-9, 6e-9  # m
_DRY_INSTANTS, _MOST_DRY = 3, 24
_INSTANTS = 16  # of a mixed block: as many on every grid
_TOLERANCE, _LEAST_TOLERANCE = 3e-3, 3e-4


def provisional(table: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return a scene's table with values in place of those that are to be chosen, and the dotted names of these.

    Without `control.accuracy` the table stays as it is, and there are none.
    """
    control = table.get("control")
    if not isinstance(control, Mapping) or "accuracy" not in control:
        return dict(table), []
    values = {"film.points": POINTS[0], "film.domain": "1 m", "control.change": f"{_CHANGE} m"}
    filled: dict[str, Any] = {**table, "film": dict(table.get("film", {})), "control": dict(control)}
    open_fields = []
    for name in CHOSEN:
        part, field = name.split(".")
        if field in filled[part]:
            continue
        open_fields.append(name)
        if name in values:
            filled[part][field] = values[name]
    return filled, open_fields


def planned(scene: Scene, open_fields: Collection[str]) -> Scene:
    """Return the scene with its open fields chosen for its `control.accuracy`.

    Raises SceneError if no grid that could be chosen is fine enough.
    """
    accuracy = scene.control.accuracy
    if accuracy is None or not open_fields or not 0.0 < accuracy <= 1.0:  # what is out of range is refused later
        return scene
    if scene.film.fidelity in UNSOLVED:
        return _for_patches(scene, open_fields)
    finer = _AT / accuracy
    values: dict[str, Any] = {
        "film.tolerance": min(max(_TOLERANCE / finer, _LEAST_TOLERANCE), _TOLERANCE),
        "control.change": min(max(_CHANGE / finer, _LEAST_CHANGE), _LARGEST_CHANGE),
        "control.dry_instants": min(max(math.ceil(_DRY_INSTANTS * finer), _DRY_INSTANTS), _MOST_DRY),
    }
    if "film.domain" in open_fields:
        values["film.domain"] = max(room_for_hertz(scene), room_for_inlet(scene, _INLET * accuracy))
        scene = with_values(scene, {"film.domain": values["film.domain"]})
    if "film.points" in open_fields:
        values["film.points"] = _points(scene, accuracy)
    points = values.get("film.points", scene.film.points)
    values["control.mixed_instants"] = max(math.ceil(_INSTANTS * min(finer, 1.0)), math.ceil((points - 1) / 8))
    return with_values(scene, {name: values[name] for name in open_fields})


def _for_patches(scene: Scene, open_fields: Collection[str]) -> Scene:
    """Return a scene of the regression level, whose answers know no grid, with one for the patches of its state."""
    if "film.domain" in open_fields:
        scene = with_values(scene, {"film.domain": room_for_hertz(scene)})
    return with_values(scene, {"film.points": _PATCHES}) if "film.points" in open_fields else scene


def _points(scene: SceneFields, accuracy: float) -> int:
    """Return the fewest nodes along x that keep the error by the grid below the accuracy."""
    least = min(_error(scene, points) for points in POINTS)
    for points in POINTS:
        if _error(scene, points) <= _GRID * accuracy:
            return points
    raise SceneError(
        f"control.accuracy = {100.0 * accuracy:.3g} % cannot be had: on {POINTS[-1]} nodes, the most that are chosen, "
        f"over {1e3 * scene.film.domain:.3g} mm the error by the grid alone is {100.0 * least:.3g} %. Give at least "
        f"{100.0 * least / _GRID:.3g} %, or set film.points yourself and read the errors that are stated."
    )


def _error(scene: SceneFields, points: int) -> float:
    """Return the largest error by a grid over the operating points of the scene.

    Friction has no larger one than W_c, which is absolute, where solids carry half of the load.
    """
    found = []
    for op in (point for _, point in duty_points(scene) if point.load > 0.0):
        rougher = (scene.surface_1, scene.surface_2)[scene.rougher]
        spacing = scene.film.domain / (points - 1)
        nodes = 0.0 if rougher.smooth else rougher.length / spacing, inlet_error(inlet(scene, op) / spacing)
        share = 0.0 if rougher.smooth and not _layered(scene) else _TYPICAL_SHARE
        found += [film_error(share, *nodes), load_ratio_error(share, *nodes)]
    return max(found)


def _layered(scene: SceneFields) -> bool:
    return any(s.microroughness and s.microroughness.rms > 0.0 for s in (scene.surface_1, scene.surface_2))
