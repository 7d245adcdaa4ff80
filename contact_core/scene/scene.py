"""The scene: a frozen record of a contact and its physics, read from TOML and checked before anything is computed."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from functools import cached_property
from numbers import Real
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from ..errors import SceneError, did_you_mean
from ..film import Deterministic, Regression
from ..film.regression import CORRECTIONS, with_map_found
from ..quantities import LEVELS, out_of_range
from . import checks, ensemble, hertz_grid, plausibility
from .accuracy import planned, provisional
from .defaults import Assumed, completed_by_defaults
from .fields import SceneFields
from .height_map import HeightMap
from .heights import Heights
from .intervals import applicable
from .operation import OperatingPoint
from .other_names import with_correction
from .problems import TableError
from .surface import SEEDS
from .toml import build, completed, given, located
from .units import parse

_TO_START = "All else has a default; `tribofmu new NAME` writes a scene to start from."
_SEED_STEP = 1_327_217_885  # the odd number nearest to SEEDS over the golden ratio


class Scene(SceneFields):
    """The complete description of one contact, checked."""

    @staticmethod
    def from_toml(source: str | Path, overrides: Mapping[str, str] | None = None) -> "Scene":
        """Read a shipped scene by name or a TOML file by path; `overrides` maps dotted keys to new values.

        Files of heights, sets and maps are looked for beside the scene's file, then in the working folder, those of
        sets in `overrides` the other way round. Raises SceneError with every sentence that says what is wrong and what
        would be right.
        """
        return Scene.read(source, overrides)[0]

    @staticmethod
    def read(source: str | Path, overrides: Mapping[str, str] | None = None) -> "tuple[Scene, tuple[Assumed, ...]]":
        """Read a scene as `from_toml` does; return it with the values that neither file nor overrides give.

        A file without a `name` is called after itself.
        """
        table, folders = given(source, overrides or {})
        table.setdefault("name", re.sub(r"[^\w-]", "_", Path(source).stem))
        return _built(table, folders)

    @staticmethod
    def from_dict(table: Mapping[str, Any], *folders: Path) -> "Scene":
        """Build and check a scene from nested tables as TOML gives them.

        Files of heights, sets and maps are looked for in the folders, in their order; without any in the working
        folder.
        """
        return _built(table, folders or (Path(),))[0]

    def with_heights(
        self, body: int, heights: ArrayLike, spacing: float | str, unit: str = "m", beyond: str = "mirrored"
    ) -> "Scene":
        """Return the scene with heights [ny, nx] in a unit added to the roughness of body 1 or 2.

        `spacing` is the distance between neighbours, a number in m or text such as "8 um"; rows run along x. `Heights`
        says what `unit` and `beyond` may be. Raises SceneError if they cannot be used.
        """
        if body not in (1, 2):
            raise SceneError(f"body = {body!r} must be 1 or 2.")
        name = f"surface_{body}"
        if not isinstance(spacing, Real) or isinstance(spacing, bool):
            spacing = parse(spacing, "m", f"{name}.heights.spacing")
        digest = HeightMap.of(f"{name}.heights", heights)
        given = Heights(float(spacing), unit, beyond=beyond, digest=digest)
        surface: Any = replace(getattr(self, name), heights=given)
        return checked(replace(self, **{name: surface}))

    def at_level(self, level: str) -> "Scene":
        """Return the scene at a level or correction, on the same grid: both levels share their states.

        `level` is deterministic, regression, or the latter with its correction, blocks or map. Of `quantities.LEVELS`
        auto stands for blocks: its name as a fidelity. Fields that only the film of the other level has get their
        defaults. Raises SceneError for an unknown one.
        """
        level = CORRECTIONS.get(level, level)
        if level not in LEVELS:
            known = ["deterministic", "regression", *list(CORRECTIONS)[1:]]
            raise SceneError(f"There is no level '{level}'.{did_you_mean(level, known)} Known are {', '.join(known)}.")
        if self.film.fidelity == level:
            return self
        corrections = {fidelity: correction for correction, fidelity in CORRECTIONS.items()}
        record: type[Deterministic] | type[Regression] = Regression if level in corrections else Deterministic
        given: dict[str, Any] = {"correction": corrections[level]} if level in corrections else {}
        if type(self.film) is record:
            return replace(self, film=replace(self.film, **given))
        shared = {f.name for f in fields(record)} & {f.name for f in fields(self.film)}
        film = record(**{name: getattr(self.film, name) for name in shared}, **given)
        return replace(self, film=film.with_sharing(self.geometry.sharing()))

    def realisation(self, seed: int) -> "Scene":
        """Return the scene with other surfaces of the same statistics; 0: its own.

        Both bodies stay independent of each other. Their own seeds step by 2^31 over the golden ratio, modulo 2^31: no
        two seeds repeat a surface, and up to seed 10,000 the derived seeds stay at least 100,000 from the scene's own.
        Raises SceneError for a negative seed.
        """
        if not 0 <= seed < SEEDS:
            raise SceneError(f"seed = {seed} must be at least 0 and at most {SEEDS - 1}.")
        if seed == 0:
            return self
        first, second = (
            replace(surface, seed=(surface.seed + seed * _SEED_STEP) % SEEDS)
            for surface in (self.surface_1, self.surface_2)
        )
        return replace(self, surface_1=first, surface_2=second)

    def refusal(self, op: OperatingPoint) -> str:
        """Return why the scene cannot have an operating point, or an empty text."""
        return checks.refusal(self, op)

    @cached_property
    def refused(self) -> str:
        """Sentences on what `replace` lets through: numbers outside their ranges, or wear that contradicts itself."""
        return " ".join(out_of_range(self, "")) or " ".join(said for _, said in checks.wear_errors(self))

    def check(self) -> list[tuple[str, str]]:
        """Return (rule, sentence) for everything that makes the scene unusable."""
        return checks.errors(self)

    def warnings(self) -> list[str]:
        """Return sentences on what can be computed but is not resolved well."""
        return checks.warnings(self)

    def doubts(self, points: Iterable[tuple[str, OperatingPoint]] | None = None) -> list[str]:
        """Return sentences on numbers that look like mistakes, which the commands ask back before they run.

        points: names and values of the operating points to doubt (default: those of the scene).
        """
        return plausibility.doubts(self, points)


def _built(table: Mapping[str, Any], folders: tuple[Path, ...]) -> tuple[Scene, tuple[Assumed, ...]]:
    """Return the checked scene of nested tables, and the values that these do not give."""
    ensemble.refuse_lists(table)
    given, assumed = completed_by_defaults(located(ensemble.taken(with_correction(table)), *folders))
    chosen, for_accuracy = provisional(completed(given))
    filled, of_grid = hertz_grid.provisional(chosen)
    try:
        scene: Scene = build(Scene, filled, "")
    except TableError as error:
        error.way_out = _TO_START
        raise
    first, second = (getattr(scene, name).with_file(name, folders) for name in ("surface_1", "surface_2"))
    film, intervals = with_map_found(scene.film, folders), applicable(scene)
    scene = replace(scene, surface_1=first, surface_2=second, film=film, intervals=intervals)
    if of_grid:
        _refuse_ranges(scene)  # first, for the contact's size is asked for
    scene = planned(hertz_grid.fitted(scene, of_grid), for_accuracy)
    scene, taken = hertz_grid.resolved(scene, assumed, of_grid)
    return checked(scene), (*taken, *hertz_grid.assumed(scene, of_grid))


def _refuse_ranges(scene: Scene) -> None:
    sentences = list(out_of_range(scene, ""))
    if sentences:
        raise SceneError(" ".join(sentences))


def checked(scene: Scene) -> Scene:
    """Return the scene as it is. Raises SceneError with all sentences on what makes it unusable."""
    errors = scene.check()
    if errors:
        in_range = all(rule != "range" for rule, _ in errors)
        causes = list(plausibility.of_roughness(scene)) if in_range else []  # of lengths that follow from it
        raise SceneError(" ".join([*causes, *(sentence for _, sentence in errors)]))
    return scene
