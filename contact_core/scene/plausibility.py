"""Numbers of a scene that can be computed but look like mistakes: of a unit, a sign, a digit.

Their answers would come without a warning and mean nothing. A command asks them back before it runs.
"""

from collections.abc import Iterable, Iterator

from . import intervals
from .checks import duty_points
from .fields import SceneFields
from .operation import OperatingPoint

Named = tuple[str, OperatingPoint]

STEEPEST = 0.5  # rms slope: ground steel has 0.05 to 0.1, blasted and eroded surfaces up to 0.5
DEEPEST = 10.0  # rms roughness over the approach of the smooth bodies
MOST_SLIDING = 4.0  # slide-to-roll ratio of surfaces that move against each other; 2: one of them rests


def doubts(scene: SceneFields, points: Iterable[Named] | None = None) -> list[str]:
    """Return a sentence, with the way out, on each number that looks like a mistake.

    points: names and values of operating points (default: those of the scene). Of several that are doubted for the
    same reason the first is told.
    """
    first: dict[OperatingPoint, str] = {}
    for name, point in duty_points(scene) if points is None else points:
        first.setdefault(point, name)
    named = [(name, point) for point, name in first.items()]
    motions = [said for name, point in named if (said := _of_motion(name, point))]
    of_films = _first([*_of_films(scene, named)])
    return [*of_roughness(scene), *_first(motions), *of_films, *intervals.doubts(scene)]


def _first(found: list[str]) -> list[str]:
    more = f" {len(found) - 1} more are like it." if len(found) > 1 else ""
    return [f"{sentence}{more}" for sentence in found[:1]]


def of_roughness(scene: SceneFields) -> Iterator[str]:
    """Yield a sentence for each body that is rougher than the contact is deep, or steeper than surfaces are."""
    hertz, radius = scene.hertz(scene.largest_load), scene.geometry.radius_x
    depth = hertz.a**2 / radius
    for name, surface in (("surface_1", scene.surface_1), ("surface_2", scene.surface_2)):
        if surface.smooth:
            continue
        if surface.rms > DEEPEST * depth:
            yield (
                f"{name} has {surface.rms:.3g} m rms, but the load presses smooth bodies together by {depth:.2g} m "
                f"only, in a contact {2 * hertz.a:.2g} m long: no such contact is there. Is {name}.rq in the right "
                "unit (nm, um)?"
            )
        elif surface.slope > STEEPEST:
            yield (
                f"{name} has an rms slope of {surface.slope:.2g}, steeper than surfaces are (0.01 to {STEEPEST:g}): "
                f"{surface.rms:.3g} m rms over a correlation length of {surface.length:.3g} m. Are both in the right "
                "unit (nm, um)?"
            )


def _of_motion(name: str, point: OperatingPoint) -> str:
    entrained = point.entrainment_speed
    if point.speed_1 * point.speed_2 >= 0.0 or abs(point.sliding_speed) <= MOST_SLIDING * abs(entrained):
        return ""
    ratio = f"{100.0 * point.sliding_speed / entrained:+.0f} %" if entrained else "infinite"
    return (
        f"{name}: speed_1 = {point.speed_1:g} m/s and speed_2 = {point.speed_2:g} m/s are against each other: the "
        f"slide-to-roll ratio is {ratio}, and {abs(entrained):.3g} m/s draw oil in. Surfaces that roll on each other "
        "have speeds of the same sign."
    )


def _of_films(scene: SceneFields, named: Iterable[Named]) -> Iterator[str]:
    oil, modulus = scene.lubricant.viscosity, scene.solids.reduced_modulus
    for name, point in named:
        speed, shape, warm = abs(point.entrainment_speed), scene.shape(point), point.inlet_temperature
        if point.load <= 0.0 or speed == 0.0:  # what cannot be is refused elsewhere
            continue
        hertz = shape.hertz(point.load, modulus)
        film = shape.smooth(point.load, speed, oil, warm, modulus).film
        if film > 2.0 * min(hertz.a, hertz.b):
            yield (
                f"{name}: the film of smooth bodies would be {film:.2g} m thick in a contact only {2 * hertz.a:.2g} m "
                f"long. Are load ({point.load:g} N), speeds ({speed:g} m/s), radius_x ({shape.radius_x:g} m) and the "
                f"oil's viscosity ({float(oil(0.0, warm)):.3g} Pa s) in the right units?"
            )
