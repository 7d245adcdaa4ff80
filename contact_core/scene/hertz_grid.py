"""Grid of a scene that gives none, from Hertz's contact of its bodies at the largest load.

Along x 2.88 half widths, or Hertz's contact and, on either side, three times the length of the inlet by the film of a
formula: a shorter grid cuts the inlet off and the film down (by 2 % with three, 5 % with two, 20 % with half of one, of
a ball at 10 m/s). Lines have five, as nothing stands for what lies beyond their grid (by 3 %; 7 % with three). Along y
as much; where Hertz's contact is an ellipse longer than 1.5 to 1, 2.88 of its half widths there. At least five
correlation lengths, unless that more than doubles it.

129 nodes along x (65 where the ellipse is longer than 4 to 1), or as many, up to 257, as show two in a correlation
length. A correlation length that is assumed is at least as long as two nodes.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

from ..film import Regression
from ..film.inlet_loss import inlets_for, is_light
from ..film.lengths import inlet_length
from ..quantities import UNSOLVED
from .checks import duty_points
from .defaults import Assumed
from .fields import ROOM, SceneFields
from .operation import OperatingPoint
from .units import parse

Scene = TypeVar("Scene", bound=SceneFields)

POINTS = (65, 97, 129, 193, 257, 385, 513)
HALF_WIDTHS = 1.2 * ROOM  # of Hertz's contact along a side of the grid
_USUAL, _FEWEST, _MOST = 129, 65, 257
_ELLIPSE, _LONG_ELLIPSE = 1.5, 4.0  # longer half width over the shorter one
_INLETS = {True: 6.0, False: 10.0}  # that there is room for, on both sides together; with a far field beyond the grid
_LENGTHS = 5.0  # correlation lengths along a side
_NODES = 1.95  # in a correlation length
_LENGTHENED = ("correlation_length", "correlation_length_across")
PROVISIONAL = {"points": POINTS[0], "domain": "1 m"}


def provisional(table: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return a scene's table with values in place of a grid that it does not give, and the fields of these."""
    film = table.get("film")
    if not isinstance(film, Mapping):
        return dict(table), []
    missing = {name: value for name, value in PROVISIONAL.items() if name not in film}
    corrected = film.get("correction") == "blocks"
    solved = film.get("model") != Regression.name or corrected  # others have a grid of their own, for their patches
    return ({**table, "film": {**film, **missing}} if solved else dict(table)), list(missing)


def fitted(scene: Scene, open_fields: Collection[str]) -> Scene:
    """Return the scene with its open fields of film chosen, and with film.width of a long ellipse; unchecked."""
    if "domain" in open_fields:
        scene = _sized(scene)
    if "points" not in open_fields:
        return scene
    solved = scene.film.fidelity not in UNSOLVED
    least = _FEWEST if solved and _ratio(scene) > _LONG_ELLIPSE else _USUAL
    nodes = _NODES if solved else 1.0
    shortest = min((each.length for each in _rough(scene)), default=math.inf)
    wanted = 1.0 + nodes * scene.film.domain / shortest
    return with_values(scene, {"film.points": next((n for n in POINTS if max(least, wanted) <= n <= _MOST), _MOST)})


def assumed(scene: SceneFields, open_fields: Collection[str]) -> list[Assumed]:
    """Return the grid that has been chosen for these open fields."""
    film, why = scene.film, "from Hertz's contact at the largest load"
    values = {"points": f"{film.points}", "domain": _text(film.domain)}
    found = [Assumed(f"film.{name}", values[name], why, "numerical") for name in open_fields]
    if "domain" in open_fields and film.width > 0.0:
        found.append(Assumed("film.width", _text(film.width), why, "numerical"))
    return found


def resolved(
    scene: Scene, assumed: Sequence[Assumed], open_fields: Collection[str]
) -> tuple[Scene, tuple[Assumed, ...]]:
    """Return the scene on its own grid with correlation lengths of two nodes at least where they are assumed.

    The list of what is assumed is returned with them. A grid that the scene gives changes no surface.
    """
    kept, least = [], f"{2e6 * scene.film.spacing:.4g} um"
    for each in assumed:
        part, _, field = each.key.partition(".")
        lengthens = field in _LENGTHENED and "points" in open_fields and not getattr(scene, part).smooth
        if lengthens and getattr(getattr(scene, part), field) < _NODES * scene.film.spacing:
            scene = with_values(scene, {each.key: parse(least, "m", each.key)})
            each = each._replace(value=least, why="assumed: two nodes of the grid")
        kept.append(each)
    return scene, tuple(kept)


def with_values(scene: Scene, values: Mapping[str, Any]) -> Scene:
    """Return the scene with values of dotted fields, unchecked."""
    for name, value in values.items():
        part, field = name.split(".")
        record = getattr(scene, part)
        if field in {f.name for f in fields(record)}:  # the regression level has fewer
            scene = replace(scene, **{part: replace(record, **{field: value})})
    return scene


def room_for_hertz(scene: SceneFields) -> float:
    """Return the length [m] of a grid that the largest contact and its inlet leave room on."""
    hertz = scene.hertz(scene.largest_load)
    square = scene.geometry.bounded_across and scene.film.width == 0.0
    return HALF_WIDTHS * max(hertz.a, hertz.b if square else 0.0)


def room_for_inlet(scene: SceneFields, lost: float) -> float:
    """Return the length [m] of a grid on which at most this part of the film is missing, as it cuts the inlet off."""
    oil, modulus, before = scene.lubricant, scene.solids.reduced_modulus, [0.0]
    for op in (point for _, point in duty_points(scene) if point.load > 0.0 and point.entrainment_speed != 0.0):
        shape = scene.shape(op)
        smooth = shape.smooth(op.load, abs(op.entrainment_speed), oil.viscosity, op.inlet_temperature, modulus)
        before.append(inlet(scene, op) * inlets_for(lost, shape, light=is_light(shape, smooth, oil.supply.layer)))
    return 2.0 * (scene.hertz(scene.largest_load).a + max(before))


def inlet(scene: SceneFields, op: OperatingPoint) -> float:
    """Return the length [m] of the inlet at an operating point, 0 without entrainment."""
    if op.entrainment_speed == 0.0:
        return 0.0
    shape, modulus = scene.shape(op), scene.solids.reduced_modulus
    smooth = shape.smooth(op.load, abs(op.entrainment_speed), scene.lubricant.viscosity, op.inlet_temperature, modulus)
    return inlet_length(shape.hertz(op.load, modulus).a, shape, smooth.film)


def _sized(scene: Scene) -> Scene:
    """Return the scene with the length of its grid, and for a long ellipse its width."""
    hertz, ratio = scene.hertz(scene.largest_load), _ratio(scene)
    square = room_for_hertz(scene)
    if scene.film.fidelity in UNSOLVED:
        domain = max(scene.film.domain, square)
    else:
        if ratio > _ELLIPSE and scene.film.width == 0.0:
            scene = with_values(scene, {"film.width": _as_told(HALF_WIDTHS * hertz.b)})
            square = HALF_WIDTHS * hertz.a
        inlets = _INLETS[scene.shape().has_far_field]
        loaded = [op for _, op in duty_points(scene) if op.load > 0.0]
        domain = max(square, 2.0 * hertz.a + inlets * max(inlet(scene, op) for op in loaded))
    longest = max((_LENGTHS * each.length for each in _rough(scene)), default=0.0)
    domain = longest if domain < longest <= 2.0 * domain else domain
    return with_values(scene, {"film.domain": _as_told(domain)})


def _text(length: float) -> str:
    return f"{1e3 * length:.3g} mm"


def _as_told(length: float) -> float:
    """Return a length [m] as a scene has it that gives its text."""
    return parse(_text(length), "m", "film")


def _ratio(scene: SceneFields) -> float:
    """Return the longer over the shorter half width of Hertz's contact; 1 of what is no ellipse."""
    hertz = scene.hertz(scene.largest_load)
    ellipse = scene.shape().ellipse_radius is not None
    return max(hertz.a / hertz.b, hertz.b / hertz.a) if ellipse else 1.0


def _rough(scene: SceneFields) -> list[Any]:
    return [surface for surface in (scene.surface_1, scene.surface_2) if not surface.smooth]
