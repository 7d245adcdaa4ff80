"""Contacts that no curve and no half width was fitted to, on new and on rubbed surfaces, at the deterministic level."""

import json
import math
import time
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from benchmarks.claims import kept as folder_of
from contact_core import ContactError, ContactState, OperatingPoint, Scene, advance, initial_state
from contact_core.reference.point_films import at_no_pressure
from contact_core.surfaces.track_means import means_of

FASTEST = 95.0  # m/s, of the mean speed: the faster surface stays below 100 m/s
SECTION = "regression/held_back"
SEED = 2309  # no other benchmark of this level draws with it
FRESH, RUBBED = 12, 4  # points of each scene
# between which: loads over the reference, lambda, slide-roll ratio, temperature over the reference [K]
RANGES: dict[str, tuple[tuple[float, float], ...]] = {
    "azam_case_a": ((0.15, 1.3), (0.01, 4.0), (0.01, 2.0), (-25.0, 25.0)),
    "mtm_zddp": ((0.15, 1.3), (0.01, 4.0), (0.01, 2.0), (-25.0, 25.0)),
    "ball_209_inner": ((0.15, 2.5), (0.1, 8.0), (0.001, 0.1), (-45.0, 20.0)),
    "fzg_flank": ((0.1, 1.3), (0.05, 3.0), (0.05, 1.3), (-30.0, 20.0)),
    "cam_tappet": ((0.1, 1.3), (0.05, 2.0), (0.3, 4.0), (-30.0, 20.0)),
}
RUB = 0.08  # lambda at which surfaces rub, at the reference load and temperature
MINUTES = (5.0, 20.0)  # after which their states are kept
FASTER = 0.05, 4.0  # films of rubbed points over the composite roughness as new
OBSERVED = (
    "friction_coefficient",
    "friction_solid",
    "friction_fluid",
    "h_c",
    "contact_load_ratio",
    "contact_area_ratio",
    "lambda_ratio",
    "tribofilm_1",
    "tribofilm_2",
    "roughness_1",
    "roughness_2",
    "wear_rate_2",
    "range_flags",
    "unconverged",
)
EVOLVING = {"tribofilm.beyond_fit": "extrapolate"}


@dataclass(frozen=True)
class Held:
    """An operating point of a scene on surfaces of a seed, new or after some minutes of rubbing."""

    scene: str
    load: float  # N
    speed: float  # m/s, mean
    srr: float
    temperature: float  # K
    seed: int  # added to the scene's
    minutes: float = 0.0  # 0: new surfaces

    def build(self) -> Scene:
        """Return the scene with surfaces of the seed, at the deterministic level on its own grid."""
        return seeded(self.scene, self.seed)

    @property
    def operating_point(self) -> OperatingPoint:
        """With the surface speeds."""
        half = 0.5 * self.srr * self.speed
        return OperatingPoint(self.load, self.speed + half, self.speed - half, self.temperature)


def smooth_film(scene: Scene, load: float, speed: float, temperature: float) -> float:
    """Central film [m] of the smooth bodies by the formula of their shape."""
    oil = at_no_pressure(scene.lubricant.viscosity, temperature)
    return scene.shape().film(load, speed, *oil, scene.solids.reduced_modulus)


def composite_roughness(scene: Scene) -> float:
    """Rms roughness of both bodies together [m]."""
    return float(np.hypot(scene.surface_1.rq, scene.surface_2.rq))


def speed_for(scene: Scene, ratio: float, load: float, temperature: float) -> float:
    """Mean speed [m/s] at which the smooth film is `ratio` times the roughness, at most the fastest one."""
    film = ratio * composite_roughness(scene)

    def excess(log: float) -> float:
        return smooth_film(scene, load, float(np.exp(log)), temperature) - film

    fastest = float(np.log(FASTEST))
    return FASTEST if excess(fastest) < 0.0 else float(np.exp(brentq(excess, np.log(1e-7), fastest)))


def seeded(name: str, seed: int) -> Scene:
    """Return a shipped scene at the deterministic level with other seeds of its surfaces."""
    shipped = Scene.from_toml(name)
    seeds = {f"surface_{i}.seed": str(s.seed + seed) for i, s in ((1, shipped.surface_1), (2, shipped.surface_2))}
    return Scene.from_toml(name, EVOLVING | seeds).at_level("deterministic")


def held(name: str) -> list[Held]:
    """Return the points of a scene: new surfaces, then rubbed ones."""
    draw = np.random.Generator(np.random.Philox(key=[SEED, list(RANGES).index(name)]))
    shipped, duty = Scene.from_toml(name), Scene.from_toml(name).operation.point
    loads, lambdas, ratios, warmer = RANGES[name]

    def log(ends: tuple[float, float]) -> float:
        return float(np.exp(draw.uniform(math.log(ends[0]), math.log(ends[1]))))

    found = []
    for k in range(FRESH + RUBBED):
        rubbed = k >= FRESH
        load, temperature = duty.load * log(loads), duty.temperature + float(draw.uniform(*warmer))
        speed = speed_for(shipped, log(FASTER if rubbed else lambdas), load, temperature)
        srr, seed = float(draw.choice([-1.0, 1.0])) * log(ratios), int(draw.integers(1000, 9000))
        if rubbed:
            found.append(Held(name, load, speed, srr, temperature, SEED, MINUTES[k % len(MINUTES)]))
        else:
            found.append(Held(name, load, speed, srr, temperature, seed))
    return found


def rubbed_state(point: Held) -> ContactState:
    """Return the surfaces of a rub after its minutes; states stay in the store."""
    scene, duty = point.build(), point.build().operation.point
    state, now = initial_state(scene), 0.0
    speed = speed_for(scene, RUB, duty.load, duty.temperature)
    half = 0.5 * speed * duty.sliding_speed / duty.entrainment_speed
    op = OperatingPoint(duty.load, speed + half, speed - half, duty.temperature)
    for minutes in (m for m in MINUTES if m <= point.minutes):
        file = folder_of(SECTION) / f"{point.scene}_{minutes:g}.state"
        if file.exists():
            state = ContactState.from_bytes(file.read_bytes(), scene)
        else:
            state = advance(scene, op, state, 60.0 * (minutes - now))[0]
            file.write_bytes(state.to_bytes())
        now = minutes
    return state


def observe(point: Held) -> dict[str, Any]:
    """Return the outputs of the deterministic level, and the track means of surfaces that have rubbed."""
    scene, start = point.build(), time.process_time()
    state = rubbed_state(point) if point.minutes else initial_state(scene)
    means = [asdict(mean) for mean in means_of(scene, state)] if point.minutes else None
    out = advance(scene, point.operating_point, state, 0.0)[1]
    found = {name: float(getattr(out, name)) for name in OBSERVED}
    return found | {"means": means, "sigma": composite_roughness(scene), "seconds": time.process_time() - start}


def stored(name: str) -> list[tuple[Held, dict[str, Any]]]:
    """Return the points of a scene that are solved."""
    kept = _kept(name)
    return [(point, kept[key]) for point in held(name) if (key := json.dumps(asdict(point))) in kept]


def _kept(name: str) -> dict[str, dict[str, Any]]:
    file = folder_of(SECTION) / f"{name}.json"
    return {row.pop("key"): row for row in json.loads(file.read_text())} if file.exists() else {}


def solved(name: str, *, fresh: bool = True, rubbed: bool = True) -> list[tuple[Held, dict[str, Any]]]:
    """Return the points of a scene with what the deterministic level says of them; {"refused": why} if it refuses.

    What is kept in the store of the same point is not solved again.
    """
    file, kept = folder_of(SECTION) / f"{name}.json", _kept(name)
    rows = []
    for k, point in enumerate(held(name)):
        if not (rubbed if point.minutes else fresh):
            continue
        key = json.dumps(asdict(point))
        if key not in kept:
            try:
                kept[key] = observe(point)
            except ContactError as error:
                kept[key] = {"refused": str(error)}
            file.write_text(json.dumps([row | {"key": each} for each, row in kept.items()]))
            told = {n: f"{kept[key].get(n, math.nan):.3g}" for n in ("contact_load_ratio", "h_c", "seconds")}
            print(name, k, told, kept[key].get("refused", ""), flush=True)
        rows.append((point, kept[key]))
    return rows
