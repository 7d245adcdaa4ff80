"""What each page of docs/measured depends on, and whether it is still what its command would write today.

A page ends with a digest of every group of sources that its figures follow from, and of its own benchmark. Only the run
that writes a page puts them there. Sources are those from which this process was started, as they were then.
"""

import re
from collections.abc import Mapping
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path
from typing import NamedTuple

from benchmarks.digests import defaults, digest, imported, meaning
from benchmarks.folders import RESULTS, ROOT

ITSELF, UNMARKED = "benchmark", "unmarked"
DEFAULTS = ("calls", "control")  # of which only these count: what follows from them belongs to other groups

# Patterns of files, * across folders; those after a - are left out. Left out altogether: error outputs, and what reads,
# checks and stores a scene or a state.
GROUPS: dict[str, tuple[str, ...]] = {
    "film": (*(f"contact_core/{room}/*.py" for room in ("kernels", "laws", "shapes", "reference", "film")),
             "-contact_core/film/estimate.py", "-contact_core/film/refined.py", "-contact_core/film/grid_steps.py", "-contact_core/film/grid_error.py", "-contact_core/film/inlet_loss.py",
             "-contact_core/laws/equations.py", "-contact_core/laws/symbols.py", "-contact_core/film/regression.py", "-contact_core/kernels/cache.py", "-contact_core/laws/load_sharing.py",
             "-contact_core/kernels/subsurface.py", "-contact_core/kernels/stress_measures.py", "-contact_core/reference/stresses.py"),
    "calls": ("contact_core/calls/*.py", "-contact_core/calls/subsurface_stress.py"),
    "stress": ("contact_core/kernels/subsurface.py", "contact_core/kernels/stress_measures.py", "contact_core/reference/stresses.py",
               "contact_core/calls/subsurface_stress.py"),
    "control": ("contact_core/scene/records.py",),
    "estimate": ("contact_core/film/estimate.py", "contact_core/film/refined.py", "contact_core/film/grid_steps.py",
                 "contact_core/calls/refinement.py"),
    "grid_error": ("contact_core/film/grid_error.py", "contact_core/film/inlet_loss.py", "contact_core/deterministic/solution_error.py",
                   "contact_core/scene/accuracy.py"),
    "evolution": ("contact_core/deterministic/*.py", "-contact_core/deterministic/outputs.py",
                  "-contact_core/deterministic/__init__.py",
                  "-contact_core/deterministic/solution_error.py", "contact_core/surfaces/*.py",
                  "-contact_core/surfaces/track_means.py", "-contact_core/surfaces/damage_classes.py",
                  "contact_core/state/bulk_temperature.py",
                  *(f"contact_core/scene/{name}.py" for name in ("case", "height_map", "heights", "operation", "self_affine", "surface"))),
    "uncertainty": ("contact_core/deterministic/outputs.py", "contact_core/state/trends.py"),
    "regression": ("contact_core/regression/*.py", "contact_core/film/regression.py", "contact_core/laws/load_sharing.py",
                   "contact_core/surfaces/track_means.py", "contact_core/surfaces/damage_classes.py"),
    "correction": ("contact_core/corrections/kriging.py", "contact_core/corrections/blocks.py"),
    "map": (*(f"contact_core/corrections/{name}.py" for name in ("map", "query", "fitting", "knot", "moved")),
            "system_models/run/map_build.py", "system_models/run/map_ranges.py"),
    "data": ("contact_core/data/*.toml", "-contact_core/data/scenes/*"),
    "azam_case_a": ("contact_core/data/scenes/azam_case_a.toml",),
    "mtm_zddp": ("contact_core/data/scenes/mtm_zddp.toml",),
    "thesis": ("contact_core/data/scenes/azam_case_a_thesis.toml", "contact_core/data/scenes/mtm_zddp_thesis.toml"),
    "fzg_flank": ("contact_core/data/scenes/fzg_flank.toml",),
    "ball_209_inner": ("contact_core/data/scenes/ball_209_inner.toml",),
    "dimple_rolling": ("contact_core/data/scenes/dimple_rolling.*",),
    "cam_tappet": ("contact_core/data/scenes/cam_tappet.toml",),
    "pin_on_disc": ("contact_core/data/scenes/pin_on_disc.toml",),
    "measurements": ("system_models/validation/data/*.csv", "-system_models/validation/data/asperity_load_share.csv", "system_models/validation/dimple.py",
                     "system_models/validation/optical_films.py", "system_models/validation/tables.py",
                     "system_models/validation/traction.py"),
    "asperity_load": ("system_models/validation/asperity_load.py", "system_models/validation/data/asperity_load_share.csv"),
    "stribeck": ("system_models/run/stribeck.py", "system_models/run/duty.py", "system_models/run/duty_table.py"),
    "fit": ("system_models/run/fit*.py", "-system_models/run/fit_report.py", "system_models/run/duty_table.py"),
    "machines": ("system_models/machines/*.py", "system_models/machines/*.toml", "system_models/machines/*.csv",
                 "system_models/parts/*.py",
                 "-system_models/machines/export.py", "-system_models/machines/report.py", "-system_models/machines/*/report.py"),
    "master": ("system_models/master/*.py", "system_models/numerics/*.py", "-system_models/master/ssp.py"),
    "ssp": ("system_models/master/ssp.py", "system_models/machines/export.py"),
    "fmu": ("fmu_src/*.py", "fmu_src/*.c", "fmu_src/*.h", "system_models/fmu/*.py", "-fmu_src/package/*"),
    "native": ("fmu_src/native/*.py", "fmu_src/native/*.c", "fmu_src/native/*.h"),
    "models": ("benchmarks/models/*.py", "benchmarks/models/*.c", "benchmarks/models/*.h", "benchmarks/hosts/*.py",
               "benchmarks/hosts/*.c", "benchmarks/hosts/*.h"),
    "faults": ("benchmarks/house/faults/*.toml",),
    "core": ("contact_core/*.py",),
}  # fmt: skip
LEVELS = ("film", "evolution", "control", "regression", "data")
CIRCLES = ("data", "azam_case_a", "mtm_zddp")
SHAPES = (*CIRCLES, "fzg_flank", "ball_209_inner")
RIGS = ("film", "regression", "machines", "master", *SHAPES)


class Source(NamedTuple):
    """The command of a page, and the groups that its figures follow from."""

    command: str
    groups: tuple[str, ...]


PAGES: dict[str, Source] = {
    "film/core_smooth": Source("film.core smooth", ("film", "calls")),
    "film/core_cost": Source("film.core cost", ("film", "calls", "evolution", "control", "data", "mtm_zddp")),
    "film/core_accuracy": Source("film.core accuracy", ("film", "calls")),
    "film/core_lambda": Source("film.core lambda", ("film",)),
    "film/core_starts": Source("film.core starts", ("film", "evolution", "control", "data", "mtm_zddp")),
    "film/elliptical": Source("film.elliptical", ("film", "calls")),
    "film/line_contacts": Source("film.line_contacts", ("film", "calls")),
    "film/transient": Source("film.transient", ("film", "evolution", "control", "data", "mtm_zddp", "fzg_flank")),
    "film/hard_cases": Source("film.hard_cases report", ("film", "calls", "data", "azam_case_a")),
    "film/error_estimate": Source("film.error_estimate", ("film", "calls", "estimate")),
    "film/flux": Source("film.flux", ("film", "evolution", "control", *CIRCLES)),
    "film/moving": Source("film.moving", ("film", "evolution", "control", *CIRCLES)),
    "film/time_step": Source("film.time_step", ("film", "evolution", "control", *CIRCLES)),
    "film/two_hours": Source("film.two_hours", ("film", "evolution", "control", *CIRCLES)),
    "film/steady": Source("film.steady", ("film",)),
    "film/tolerance": Source("film.tolerance", ("film", "evolution", "control", "data", "mtm_zddp")),
    "film/measured": Source(
        "film.measured", ("film", "calls", "evolution", "control", "data", "dimple_rolling", "measurements")
    ),
    "film/peers": Source("film.peers", ("film", "calls", "evolution")),
    "film/accuracy": Source("film.accuracy", ("film", "calls", "estimate")),
    "film/inlet": Source("film.inlet", ("film", "calls", "grid_error")),
    "film/grid_error": Source(
        "film.grid_error", ("film", "evolution", "control", "uncertainty", "grid_error", *CIRCLES, "fzg_flank")
    ),
    "speed_error": Source("speed_error", (*LEVELS, "uncertainty", "grid_error", *SHAPES)),
    "stress/micropitting": Source("stress.micropitting", ("film", "stress", "evolution", "control", "data")),
    "stress/field": Source("stress.field", ("film", "calls", "stress")),
    "stress/curves": Source("stress.curves", (*LEVELS, "stress", *SHAPES)),
    "surfaces/transition": Source("surfaces.transition", (*LEVELS, *SHAPES)),
    "surfaces/asperity_layer": Source("surfaces.asperity_layer", ("film",)),
    "surfaces/asperity_load_share": Source(
        "surfaces.asperity_load_share",
        ("film", "evolution", "control", "uncertainty", "grid_error", *SHAPES, "pin_on_disc", "asperity_load"),
    ),
    "surfaces/grids": Source("surfaces.grids", ("film", "evolution", "control", "data", "azam_case_a")),
    "surfaces/finishes": Source("surfaces.finishes", ()),
    "surfaces/hardness": Source("surfaces.hardness", ("film", "evolution", "control", *CIRCLES)),
    "surfaces/film_wear": Source(
        "surfaces.film_wear", ("film", "evolution", "regression", "control", "data", "azam_case_a")
    ),
    "surfaces/evolution": Source("surfaces.evolution", ("film", "evolution", "control", "uncertainty", *CIRCLES)),
    "surfaces/stribeck": Source(
        "surfaces.stribeck", ("film", "evolution", "control", "stribeck", *SHAPES, "cam_tappet")
    ),
    "surfaces/tribofilm": Source("surfaces.tribofilm", (*LEVELS, *CIRCLES)),
    "surfaces/fit": Source("surfaces.fit", (*LEVELS, "fit", "mtm_zddp", "measurements")),
    "thesis/validation": Source("thesis.validation", ("film", "evolution", "control", *CIRCLES, "thesis")),
    "regression/curves": Source("regression.curves check", (*LEVELS, "azam_case_a", "mtm_zddp")),
    "regression/coverage": Source("regression.coverage", (*LEVELS, "azam_case_a", "mtm_zddp")),
    "regression/shapes": Source("regression.shapes page", (*LEVELS, "mtm_zddp", "fzg_flank", "ball_209_inner")),
    "regression/held_back": Source("regression.held_back", (*LEVELS, *SHAPES, "cam_tappet")),
    "regression/correlation": Source("regression.correlation", (*LEVELS, "correction", *SHAPES, "cam_tappet")),
    "regression/map": Source("regression.map", (*LEVELS, "correction", "map", "mtm_zddp")),
    "regression/hottest": Source("regression.hottest", (*LEVELS, *SHAPES)),
    "regression/cost": Source("regression.cost", ("film", "regression", *CIRCLES)),
    "friction/traction": Source("friction.traction", (*LEVELS, "azam_case_a", "mtm_zddp")),
    "friction/published_traction": Source("friction.published_traction", (*LEVELS, "fzg_flank", "measurements")),
    "friction/laws_cost": Source("friction.laws_cost", ("film", "evolution", "control", "data", "azam_case_a")),
    "machines/bearing_loads": Source("machines.bearing_loads", RIGS),
    "machines/rolling": Source("machines.rolling", (*RIGS, *LEVELS, "evolution", "control")),
    "machines/bearing_torque": Source("machines.bearing_torque", RIGS),
    "machines/bearing_memory": Source("machines.bearing_memory", RIGS),
    "machines/bearing_life": Source("machines.bearing_life", (*RIGS, "evolution", "control")),
    "machines/gear_path": Source("machines.gear_path", RIGS),
    "machines/gear_friction": Source("machines.gear_friction", (*RIGS, "evolution", "control")),
    "machines/gear_ratings": Source("machines.gear_ratings", RIGS),
    "machines/corrected": Source(
        "machines.corrected page", (*RIGS, "evolution", "control", "correction", "cam_tappet")
    ),
    "machines/rig_levels": Source("machines.rig_levels", (*RIGS, "evolution", "control")),
    "machines/tolerance": Source("machines.tolerance", RIGS),
    "machines/native": Source("machines.native", (*RIGS, "ssp", "native")),
    "machines/thousand_hours": Source("machines.thousand_hours", (*RIGS, "native")),
    "fmu/overhead": Source("fmu.overhead", ("regression", "fmu", "models")),
    "fmu/endurance": Source("fmu.endurance", ("fmu", "models")),
    "fmu/native": Source("fmu.native", ("regression", "fmu", "native", "models", *SHAPES)),
    "coupling/accuracy": Source("coupling.accuracy", ("master", "models")),
    "coupling/cost": Source("coupling.cost", ("master", "models")),
    "coupling/masters": Source("coupling.masters", ("master", "models")),
    "coupling/ssp_importers": Source("coupling.ssp_importers", ("master", "ssp", "machines")),
    "house/faults": Source("house.faults", ("faults",)),
    "house/soak": Source("house.soak", ("evolution", "regression", "machines")),
    "house/stays": Source("house.stays", ("evolution", "control", "regression", "core")),
}
FORMAT = ("benchmarks.pages", "benchmarks.folders", "benchmarks.digests", "benchmarks.dependencies")  # change no figure


class Tree:
    """The files of a source tree, by path from its root, and the digests of groups of them."""

    def __init__(self, files: Mapping[str, bytes]) -> None:
        self.files = dict(files)
        self._known: dict[str, str] = {}

    @classmethod
    def of(cls, root: Path) -> "Tree":
        """The tree in a folder, as it is now."""
        kept = (
            path
            for room in ("benchmarks", "contact_core", "fmu_src", "system_models")
            for path in (root / room).rglob("*")
        )
        return cls({path.relative_to(root).as_posix(): path.read_bytes() for path in kept if _is_source(path)})

    def members(self, group: str) -> list[str]:
        """Paths of a group; a pattern with a - takes away from those before it."""
        found: dict[str, None] = {}
        for pattern in GROUPS[group]:
            if pattern.startswith("-"):
                found = {path: None for path in found if not fnmatchcase(path, pattern[1:])}
            else:
                found |= {path: None for path in self.files if fnmatchcase(path, pattern)}
        return sorted(found)

    def digest_of(self, group: str) -> str:
        """Return the digest of a group."""
        if group not in self._known:
            files = {path: self.files[path] for path in self.members(group)}
            says = (
                defaults(text) if group in DEFAULTS else _brief(path, self.files[path]) for path, text in files.items()
            )
            self._known[group] = digest([f"{path} {said}" for path, said in zip(files, says, strict=True)])
        return self._known[group]

    def benchmark(self, page: str) -> str:
        """Return the digest of the modules of benchmarks that write a page."""
        found, new = set[str](), {f"benchmarks.{page.replace('/', '.')}"}
        while new:
            name = new.pop()
            path = f"{name.replace('.', '/')}.py"
            if path in self.files and path not in found and name not in FORMAT:
                found.add(path)
                new |= imported(self.files[path], "benchmarks")
        return digest([f"{path} {_brief(path, self.files[path])}" for path in sorted(found)])

    def digests(self, page: str) -> dict[str, str]:
        """Digests of all that a page depends on, its own benchmark last."""
        return {group: self.digest_of(group) for group in PAGES[page].groups} | {ITSELF: self.benchmark(page)}


@cache
def _brief(path: str, content: bytes) -> str:
    return digest([meaning(path, content)])


def _is_source(path: Path) -> bool:
    return path.suffix in (".py", ".toml", ".csv", ".c", ".h") and "__pycache__" not in path.parts


SOURCES = Tree.of(ROOT)  # of this process: read before anything is measured, as they may change meanwhile


def stamp(page: str, tree: Tree = SOURCES) -> str:
    """Return the last line of a page that is written now."""
    return f"<!-- depends on {', '.join(f'{name} {found}' for name, found in tree.digests(page).items())} -->"


def stamped(text: str) -> dict[str, str]:
    """Digests that a page was written with, by group; none if it does not say."""
    found = re.search(r"^<!-- depends on (.*) -->\s*\Z", text, re.MULTILINE)
    return dict(part.split() for part in found[1].split(", ")) if found else {}


def changed(page: str, text: str, tree: Tree = SOURCES) -> list[str]:
    """What has changed since a page was written, by group; UNMARKED if it does not say what it depends on."""
    then, now = stamped(text), tree.digests(page)
    return sorted(name for name in {*then, *now} if then.get(name) != now.get(name)) if then else [UNMARKED]


def kept(page: str) -> Path:
    """Folder for the runs of a page that takes hours: another one for other sources, so that none is taken for today's."""
    return RESULTS / page / digest([SOURCES.digest_of(group) for group in PAGES[page].groups])
