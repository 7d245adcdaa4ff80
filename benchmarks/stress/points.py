"""Contacts of rough bodies solved over one pass at the deterministic level, and the load cycles below their tracks."""

import time
import zipfile
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.folders import RESULTS
from benchmarks.regression.points import between, speed_for, spread
from contact_core import ContactError, OperatingPoint, Scene, advance, initial_state
from contact_core.deterministic.subsurface import Traction, outputs_of_stress, passed
from contact_core.scene import Case
from contact_core.surfaces.damage_classes import rows_of
from contact_core.surfaces.patches import track_rows

STORE = RESULTS / "stress" / "curves"
COUNTS = {"mtm_zddp": (30, 12), "azam_case_a": (12, 8), "fzg_flank": (36, 14), "ball_209_inner": (0, 4)}  # fit, check
LAMBDAS = (0.02, 2.0)
LOADS = (0.4, 1.3)  # of the scene's
SLIDES = (0.003, 1.0)  # slide-roll ratio, of either sign
ROUGHNESS = {
    "mtm_zddp": (0.25, 1.5),
    "azam_case_a": (0.25, 1.5),
    "fzg_flank": (0.25, 1.25),
    "ball_209_inner": (1.0, 6.0),
}
SMOOTHER = (1.0, 6.0)  # roughness of the smoother body over the scene's
LENGTH = {"mtm_zddp": (1.5, 4.0), "azam_case_a": (1.5, 4.0), "fzg_flank": (0.7, 2.0), "ball_209_inner": (0.7, 2.0)}
SOLIDS = (0.05, 0.2)  # coefficient of boundary friction
NODES, INSTANTS = 65, 32
PROBABILITIES = np.array([0.05, 0.25, 0.5, 0.75, 0.9, 0.97, 0.99])
EXPONENTS = (6.0, 10.0, 16.0)  # of lines of lives
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

    def build(self, changes: dict[str, str] | None = None) -> Scene:
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
        return Scene.from_toml(self.scene, made | (changes or {})).at_level("deterministic")

    @property
    def operating_point(self) -> OperatingPoint:
        """With the surface speeds, at the scene's temperature."""
        half, duty = 0.5 * self.srr * self.speed, Scene.from_toml(self.scene).operation.point
        return OperatingPoint(self.load, self.speed + half, self.speed - half, duty.temperature)


@dataclass(frozen=True)
class Seen:
    """What a pass over a contact does below its tracks. Stresses are over Hertz's largest pressure."""

    point: StressPoint
    load_ratio: float
    friction: float  # shear over pressure
    pressure: float  # rms deviation from Hertz's within his contact
    quantiles: np.ndarray  # of cycles at `PROBABILITIES`: [bodies, quantiles, rows, stresses of a cycle, layers]
    equivalent: (
        np.ndarray
    )  # stresses that do the damage of a track by `EXPONENTS`: [bodies, shear or Dang Van's, exponents]
    von_mises: np.ndarray  # largest of each layer, mean over the instants
    dang_van_ratio: float
    near_surface_share: float
    seconds: float

    @property
    def case(self) -> Case:
        """The contact at the deterministic level."""
        return Case.bind(self.point.build(), self.point.operating_point)


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


def solved(name: str, *, check: bool) -> list[Seen]:
    """Return the points that the deterministic level does not refuse, those that are finished from the store."""
    found = []
    for k, point in enumerate(points(name, check=check)):
        file = STORE / f"{name}_{'check' if check else 'fit'}_{k}.npz"
        stored = _read(file, point)
        if stored is None:
            stored = _solve(point)
            STORE.mkdir(parents=True, exist_ok=True)
            np.savez_compressed(file, point=repr(asdict(point)), **stored)
            print(
                file.name, {key: f"{stored[key]:.3g}" for key in ("load_ratio", "seconds") if key in stored}, flush=True
            )
        if stored:
            single = {key: float(value) for key, value in stored.items() if value.ndim == 0}
            found.append(Seen(point, **(stored | single)))
    return found


def _read(file: Path, point: StressPoint) -> dict[str, np.ndarray] | None:
    try:
        stored = dict(np.load(file))
    except (FileNotFoundError, zipfile.BadZipFile):
        return None
    return stored if str(stored.pop("point")) == repr(asdict(point)) else None


def _solve(point: StressPoint) -> dict[str, np.ndarray]:
    """Return the fields of `Seen` of a new contact; none of a point that is refused."""
    start, coarse = time.process_time(), point.build(COARSE)
    try:
        state, out = advance(coarse, point.operating_point, initial_state(coarse), 0.0)
    except ContactError as error:
        print(f"refused: {point}: {error}", flush=True)
        return {}
    assert state.below is not None
    shape = (len(state.below.places), state.rows, -1)
    tractions = [
        Traction(p, q, (int(place[0]), int(place[1])))
        for p, q, place in zip(
            state.below.pressure.reshape(shape), state.below.shear.reshape(shape), state.below.places, strict=True
        )
    ]
    case = Case.bind(point.build(), point.operating_point)
    seen = _seen(case, state.rows, tractions) | {"load_ratio": out.contact_load_ratio}
    return {key: np.array(value) for key, value in (seen | {"seconds": time.process_time() - start}).items()}


def _seen(case: Case, rows: int, tractions: list[Traction]) -> dict[str, Any]:
    scene, largest = case.scene, case.hertz.pressure_max
    found, track = passed(case, rows, tractions), track_rows(scene, rows)
    parts = rows_of(scene).size
    y = np.abs(scene.grid(rows).y[track]) / scene.hertz(scene.operation.load).b
    part = np.minimum((y * parts).astype(int), parts - 1) if parts > 1 else np.zeros(y.size, int)
    cycles = [np.stack(cycle)[:, :, track] / largest for cycle in found.cycles]  # [stresses, layers, rows, columns]
    quantiles = [
        np.stack([np.quantile(body[:, :, part == j], PROBABILITIES, axis=(2, 3)) for j in range(parts)], axis=1)
        for body in cycles
    ]
    equivalent = [
        [[(body[which].max(axis=0) ** m).mean() ** (1.0 / m) for m in EXPONENTS] for which in (0, 2)] for body in cycles
    ]
    grid, hertz = scene.grid(rows), case.hertz
    smooth = (
        largest
        * np.sqrt(
            np.maximum(
                1.0 - (grid.x[None, :] / hertz.a) ** 2 - (0.0 if parts == 1 else (grid.y[:, None] / hertz.b) ** 2), 0.0
            )
        )
        * np.ones((rows, 1))
    )
    off = np.mean([((traction.pressure - smooth)[smooth > 0.0] ** 2).mean() for traction in tractions])
    shear, pressure = (
        sum(float(part.sum()) for part in parts)
        for parts in zip(*((t.shear, t.pressure) for t in tractions), strict=True)
    )
    outputs = outputs_of_stress(case, rows, found)
    return {
        "friction": abs(shear) / pressure,
        "pressure": float(np.sqrt(off)) / largest,
        "quantiles": np.stack(quantiles),
        "equivalent": np.array(equivalent),
        "von_mises": found.von_mises / largest,
        "dang_van_ratio": outputs["dang_van_ratio"],
        "near_surface_share": outputs["near_surface_share"],
    }
