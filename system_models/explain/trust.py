"""How sure a scene's results are: its range of validity, the errors that it states, and commands that show more."""

from collections.abc import Iterator

from contact_core.assumed import HEADS, assumed, told
from contact_core.errors import ContactError
from contact_core.quantities import UNSOLVED
from contact_core.scene import Scene
from fmu_src.package.document.contact import limits
from fmu_src.package.document.levels import LEVELS

from .wording import readable


def validity(scene: Scene) -> Iterator[tuple[str, str, str]]:
    """Yield quantity, value and meaning of the limits of the model at the scene's operating point."""
    yield from limits(scene)


def summary(scene: Scene) -> str:
    """Return a sentence on the contact at the scene's operating point."""
    point, hertz = scene.operation.point, scene.hertz(scene.operation.load)
    across = "" if scene.geometry.face_width is not None or hertz.a == hertz.b else f" by {readable(hertz.b, 'm', 3)}"
    rolling = point.entrainment_speed
    slip = f", slide-to-roll ratio {100.0 * point.sliding_speed / rolling:.3g} %" if rolling else ""
    return (
        f"At {readable(scene.operation.load, 'N', 3)}: Hertz pressure {readable(hertz.pressure_max, 'Pa', 3)}, half "
        f"width {readable(hertz.a, 'm', 3)}{across}; entrainment {readable(rolling, 'm/s', 3)}, sliding "
        f"{readable(point.sliding_speed, 'm/s', 3)}{slip}."
    )


def sentences(scene: Scene) -> Iterator[str]:
    """Yield sentences on the errors that the scene's level states, and on what is not resolved well."""
    stated = ["error_friction", "error_film", "error_load_ratio (absolute)"]
    stated += ["error_tribofilm_1 and _2"] if scene.tribofilm.source else []
    stated += ["error_wear"] if scene.wear.wears else []
    stated += ["error_damage"] if scene.fatigue.damages else []
    level = scene.film.fidelity
    yield (
        f"Every result of this level ({level}) states half widths of 95 % intervals: {', '.join(stated)}. "
        f"{LEVELS[level].errors} They are errors of the solution: that of a law is not in them, and that of a number "
        "that is assumed stands beside them, by its interval."
    )
    yield from scene.warnings()


def assumptions(scene: Scene) -> list[tuple[str, ...]]:
    """Return the head and the rows of a table of the scene's intervals and their worth at its operating point."""
    try:
        rows = told(scene.intervals, assumed(scene, scene.operation.point))
    except ContactError:  # the regression level has no answer there
        return []
    return [HEADS, *rows] if rows else []


def commands(source: str, scene: Scene) -> Iterator[tuple[str, str]]:
    """Yield commands with what they show."""
    yield f"tribofmu run {source}", "results with their errors"
    if scene.film.fidelity in UNSOLVED:
        yield f"tribofmu run {source} --set film.model=deterministic", "the level that this one is fitted to"
    else:
        yield f"tribofmu run {source} --accuracy 5%", "chooses grid, tolerance and blocks for that error"
        yield f"tribofmu run {source} --grid {2 * (scene.film.points - 1) + 1}", "the error by the grid: compare"
    if not (scene.surface_1.smooth and scene.surface_2.smooth):
        seeds = " ".join(f"surface_{i}.seed={s.seed + 100}" for i, s in ((1, scene.surface_1), (2, scene.surface_2)))
        yield f"tribofmu run {source} --set {seeds}", "other surfaces of the same statistics"
        yield f"tribofmu surfaces {source}", "what the grid shows of the surfaces"
