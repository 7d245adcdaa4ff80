"""Contacts of rough bodies solved over one pass at the deterministic level, and the load cycles below their tracks."""

import time
import zipfile
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.folders import RESULTS
from benchmarks.regression.points import between, speed_for, spread
from contact_core import ContactError, OperatingPoint, Scene, advance, initial_state
from contact_core.deterministic.subsurface import Pass, Traction, passed
from contact_core.scene import Case
from contact_core.surfaces.patches import track_rows

STORE = RESULTS / "stress" / "curves"
COUNTS = {"mtm_zddp": (30, 12), "azam_case_a": (12, 8), "fzg_flank": (36, 14), "ball_209_inner": (0, 4)}  # fit, check
LAMBDAS = (0.02, 2.0)
LOADS = (0.4, 1.3)  # of the scene's
SLIDES = (0.003, 1.0)  # slide-roll ratio, of either sign
ROUGHNESS = {"mtm_zddp": (0.25, 1.5), "azam_case_a": (0.25, 1.5), "fzg_flank": (0.25, 1.25), "ball_209_inner": (1.0, 6.0)}
SMOOTHER = (1.0, 6.0)  # roughness of the smoother body over the scene's
LENGTH = {"mtm_zddp": (1.5, 4.0), "azam_case_a": (1.5, 4.0), "fzg_flank": (0.7, 2.0), "ball_209_inner": (0.7, 2.0)}
SOLIDS = (0.05, 0.2)  # coefficient of boundary friction
NODES, INSTANTS = 65, 32
COARSE = {"stress.layers": "2"}  # while solving: what counts are the tractions


@dataclass(frozen=True)
class StressPoint:
    """A contact on fresh surfaces."""

    scene: str
    load: float  # N
    speed: float  # m/s, mean
    srr: float
    roughness: float  # of both bodies over the scene's
    smoother: float  # of body 1 besides
    length: float  # correlation length over the scene's
    friction: float  # of the solids
    seed: int  # added to the scene's

    def build(self, level: str = "deterministic", changes: dict[str, str] | None = None) -> Scene:
        """The scene at 65 nodes, whose blocks are whole passes."""
        shipped = Scene.from_toml(self.scene)
        made = {
            "stress.model": "half_space",
            "stress.instants": str(INSTANTS),
            "tribofilm.beyond_fit": "extrapolate",
            "film.points": str(NODES),
            "control.mixed_instants": str(NODES - 1),
            "control.driver": "mixed",
            "boundary_friction.bare": repr(self.friction),
            "boundary_friction.film": repr(self.friction),
        }
        for name, surface, factor in (
            ("surface_1", shipped.surface_1, self.roughness * self.smoother),
            ("surface_2", shipped.surface_2, self.roughness),
        ):
            made[f"{name}.rq"] = f"{surface.rq * factor!r} m"
            made[f"{name}.correlation_length"] = f"{surface.correlation_length * self.length!r} m"
            made[f"{name}.seed"] = str(surface.seed + self.seed)
        return Scene.from_toml(self.scene, made | (changes or {})).at_level(level)

    @property
    def operating_point(self) -> OperatingPoint:
        """With the surface speeds, at the scene's temperature."""
        half, duty = 0.5 * self.srr * self.speed, Scene.from_toml(self.scene).operation.point
        return OperatingPoint(self.load, self.speed + half, self.speed - half, duty.temperature)


class Found(NamedTuple):
    """A pass over a point: tractions of its instants, the cycles below both bodies, and outputs."""

    point: StressPoint
    case: Case
    rows: int
    tractions: list[Traction]
    load_ratio: float
    seconds: float

    @property
    def passed(self) -> Pass:
        """Load cycles of both bodies."""
        return passed(self.case, self.rows, self.tractions)

    @property
    def track(self) -> np.ndarray:
        """Rows of the track."""
        return track_rows(self.case.scene, self.rows)


def points(name: str, *, check: bool) -> list[StressPoint]:
    """Points of the fit, or those that are held back from it: another part of the same sequence."""
    shipped, (fit, held) = Scene.from_toml(name), COUNTS[name]
    cubes = spread(fit + held, 7)[fit:] if check else spread(fit, 7)
    return [_point(shipped, name, cube.tolist(), 100 * (k + 1) + 50 * check) for k, cube in enumerate(cubes)]


def _point(shipped: Scene, name: str, cube: list[float], seed: int) -> StressPoint:
    duty = shipped.operation.point
    signed = 2.0 * cube[2] - 1.0
    srr = float(np.copysign(SLIDES[0] * (SLIDES[1] / SLIDES[0]) ** abs(signed), signed))
    roughness, smoother = between(*ROUGHNESS[name], cube[3]), between(*SMOOTHER, cube[5] ** 2)
    if name == "fzg_flank":  # both flanks alike
        smoother = 1.0
    load, length = duty.load * between(*LOADS, cube[0]), between(*LENGTH[name], cube[4])
    found = StressPoint(name, load, 1.0, srr, roughness, smoother, length, between(*SOLIDS, cube[6]), seed)
    ratio = LAMBDAS[0] * (LAMBDAS[1] / LAMBDAS[0]) ** cube[1]
    return replace(found, speed=speed_for(found.build(), ratio, load, duty.temperature))


def solved(name: str, *, check: bool) -> Iterator[Found]:
    """Yield the points that the deterministic level does not refuse, those that are finished from the store."""
    for k, point in enumerate(points(name, check=check)):
        file = STORE / f"{name}_{'check' if check else 'fit'}_{k}.npz"
        stored = _read(file, point)
        if stored is None:
            stored = _solve(point)
            STORE.mkdir(parents=True, exist_ok=True)
            np.savez_compressed(file, point=repr(asdict(point)), **stored)
            print(file.name, {key: f"{stored[key]:.3g}" for key in ("load_ratio", "seconds")}, flush=True)
        if stored["pressure"].size:
            yield _found(point, stored)


def _found(point: StressPoint, stored: dict[str, np.ndarray]) -> Found:
    pressure, shear = (stored[key].astype(np.float64) for key in ("pressure", "shear"))
    tractions = [
        Traction(p, q, (int(place[0]), int(place[1])))
        for p, q, place in zip(pressure, shear, stored["places"], strict=True)
    ]
    case = Case.bind(point.build(), point.operating_point)
    return Found(point, case, pressure.shape[1], tractions, float(stored["load_ratio"]), float(stored["seconds"]))


def _read(file: Path, point: StressPoint) -> dict[str, np.ndarray] | None:
    try:
        stored = dict(np.load(file))
    except (FileNotFoundError, zipfile.BadZipFile):
        return None
    return stored if str(stored.pop("point")) == repr(asdict(point)) else None


def _solve(point: StressPoint) -> dict[str, np.ndarray]:
    """Return the tractions of a pass of a new contact; empty ones of a point that is refused."""
    scene, start = point.build(changes=COARSE), time.process_time()
    try:
        state, out = advance(scene, point.operating_point, initial_state(scene), 0.0)
    except ContactError as error:
        print(f"refused: {point}: {error}", flush=True)
        return {key: np.empty(0) for key in ("pressure", "shear", "places")} | {
            key: np.array(np.nan) for key in ("load_ratio", "seconds")
        }
    assert state.below is not None
    shape = (len(state.below.places), state.rows, -1)
    return {
        "pressure": state.below.pressure.reshape(shape).astype(np.float32),
        "shear": state.below.shear.reshape(shape).astype(np.float32),
        "places": state.below.places,
        "load_ratio": np.array(out.contact_load_ratio),
        "seconds": np.array(time.process_time() - start),
    }
