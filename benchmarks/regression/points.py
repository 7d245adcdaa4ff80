"""Operating points on fresh surfaces and their outputs at a fidelity level, as columns of numbers."""

import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.stats import qmc

from benchmarks.folders import RESULTS
from contact_core import ContactError, OperatingPoint, Scene, advance, initial_state, solve
from contact_core.film.instant import Grid
from contact_core.film.outputs import film_outputs
from contact_core.laws.load_sharing import rms_slope, sliding_ratio
from contact_core.reference.point_films import at_no_pressure
from contact_core.scene import Case
from contact_core.surfaces.patches import track_rows
from contact_core.surfaces.track_means import means_of

STORE = RESULTS / "regression"
SCENES = ("azam_case_a", "mtm_zddp")
LAMBDAS = (0.003, 5.0)
LOADS = (0.3, 1.3)  # of the reference load
BELOW = (0.2, 2.0)  # of the microroughness
RUBBING = (5, 10, 20, 40, 60, 90, 120)  # minutes at which rubbed tracks are observed
AVERAGED = 5  # minutes of exposure that count as the present one
FASTEST = 95.0  # m/s, of the mean speed: the faster surface stays below 100 m/s
OBSERVED = (
    "friction_coefficient",
    "contact_load_ratio",
    "contact_area_ratio",
    "h_c",
    "lambda_ratio",
    "pressure_max",
    "range_flags",
    "unconverged",
    "blocks_dry",
)
Columns = dict[str, np.ndarray]
Overrides = dict[str, str]


@dataclass(frozen=True)
class Point:
    """One scene at one operating point."""

    scene: str
    group: str
    load: float  # N
    speed: float  # m/s, mean
    srr: float
    temperature: float  # K
    roughness: float = 1.0  # of the scene's rms roughness
    length: float = 1.0  # of the scene's correlation length
    seed: int = 0  # added to the scene's
    below: float = 1.0  # of the scene's microroughness

    def build(self, overrides: Overrides) -> Scene:
        """The scene with this roughness; further `overrides` by dotted name."""
        shipped = Scene.from_toml(self.scene)
        changes = {"tribofilm.beyond_fit": "extrapolate"} | overrides
        for name, surface in (("surface_1", shipped.surface_1), ("surface_2", shipped.surface_2)):
            changes[f"{name}.rq"] = f"{surface.rq * self.roughness:.17g} m"
            changes[f"{name}.correlation_length"] = f"{surface.correlation_length * self.length:.17g} m"
            changes[f"{name}.microroughness.rms"] = f"{surface.microroughness.rms * self.below:.17g} m"
            changes[f"{name}.seed"] = str(surface.seed + self.seed)
        return Scene.from_toml(self.scene, changes)

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


def spread(count: int, dimensions: int) -> np.ndarray:
    """Evenly scattered points of the unit cube [count, dimensions], always the same."""
    sequence = qmc.Halton(dimensions, scramble=False)
    sequence.fast_forward(1)
    return sequence.random(count)


def between(low: float, high: float, share: float) -> float:
    """Linear interpolation."""
    return low + (high - low) * share


def observe(point: Point, overrides: Overrides) -> dict[str, float]:
    """Outputs of the first block on fresh surfaces. Raises ContactError if the point is refused."""
    scene, op = point.build(overrides), point.operating_point
    start = time.process_time()
    state, out = advance(scene, op, initial_state(scene), 0.0)
    found = {name: float(getattr(out, name)) for name in OBSERVED} | {"seconds": time.process_time() - start}
    if scene.film.name != "deterministic":
        return found
    rougher = 0 if scene.surface_1.rq > scene.surface_2.rq else 1
    rows = track_rows(scene, state.rows)
    for name, i in (("exposed_rougher", rougher), ("exposed_smoother", 1 - rougher)):  # by the clock, see WHOLE_PASS
        found[name] = float(state.bodies[i].exposure[rows].mean()) / scene.tribofilm.rate(op.temperature)
    return found | numbers_of(scene, op)


def observe_rubbed(point: Point, overrides: Overrides) -> dict[str, float]:
    """What two hours of rubbing make of both bodies' tracks, for each of `RUBBING` minutes and each body.

    Its growth over the law's full thickness, and its coverage: that growth over the same where it is rubbed, each node counting by its exposure. The rms roughness of its solid over the new one's, and the depth worn,
    summed over the composite roughness of its time.
    """
    scene, op = point.build(overrides), point.operating_point
    start = time.process_time()
    state, out = advance(scene, op, initial_state(scene), 0.0)
    rows, rougher = track_rows(scene, state.rows), 0 if scene.surface_1.rq > scene.surface_2.rq else 1
    new, depths, last = means_of(scene, state), np.zeros(2), list[tuple[np.ndarray, ...]]()
    found = {name: float(getattr(out, name)) for name in OBSERVED}
    for minute in range(1, RUBBING[-1] + 1):
        worn, sigma = np.array([out.wear_depth_1, out.wear_depth_2]), np.hypot(out.roughness_1, out.roughness_2)
        state, out = advance(scene, op, state, 60.0)
        depths += (np.array([out.wear_depth_1, out.wear_depth_2]) - worn) / sigma
        last = [*last[1 - AVERAGED :], tuple(body.exposure[rows] for body in state.bodies)]
        if minute not in RUBBING:
            continue
        now = means_of(scene, state)
        found[f"area_{minute}"], found[f"dry_{minute}"] = out.contact_area_ratio, float(out.blocks_dry > 0)
        for name, i in (("rougher", rougher), ("smoother", 1 - rougher)):
            exposed, growth = np.mean([moment[i] for moment in last], axis=0), state.bodies[i].growth[rows]
            where = float((exposed * growth).mean() / exposed.mean())
            found[f"growth_{name}_{minute}"] = float(growth.mean()) / scene.tribofilm.full_thickness
            found[f"coverage_{name}_{minute}"] = float(growth.mean()) / where
            found[f"smoothed_{name}_{minute}"] = now[i].roughness / new[i].roughness
            found[f"worn_{name}_{minute}"] = float(depths[i])
    return found | {"seconds": time.process_time() - start} | numbers_of(scene, op)


def observe_dry(point: Point, overrides: Overrides) -> dict[str, float]:
    """The same of the dry contact, whose area is all that is asked, at one instant."""
    scene, op = point.build(overrides), point.operating_point
    fields = solve(scene, op, initial_state(scene), dry=True)
    out = film_outputs(
        Grid(fields.x, fields.y), fields.film, fields.gap, fields.touching, op.load, scene.hertz(op.load)
    )
    return {name: out[name] for name in ("contact_area_ratio", "h_c", "pressure_max")} | numbers_of(scene, op)


def numbers_of(scene: Scene, op: OperatingPoint) -> dict[str, float]:
    """Variables that the laws may depend on."""
    sigma, hertz, shape = composite_roughness(scene), scene.hertz(op.load), scene.shape()
    rq, lengths = zip(*((s.rq, s.correlation_length) for s in (scene.surface_1, scene.surface_2)), strict=True)
    film = smooth_film(scene, op.load, op.entrainment_speed, op.temperature)
    thick, below = shape.depths(film, hertz.a, hertz.b), Case.bind(scene, op).microroughness
    return {
        "sigma": sigma,
        "lambda": film / sigma,
        "slope": float(rms_slope(rq[0], lengths[0], rq[1], lengths[1])),
        "slope_below": below.slope if below else 0.0,
        "mean_pressure": hertz.pressure_mean,
        "largest_pressure": hertz.pressure_max,
        "density": float(scene.lubricant.density(np.array(hertz.pressure_mean))),
        "modulus": scene.solids.reduced_modulus,
        "hardness": scene.plasticity.hardness,
        "width": hertz.a,
        "thick_x": thick[0],
        "thick_y": thick[1],
        "correlation_length": lengths[int(np.argmax(rq))],
        "spacing": scene.film.spacing,
        "floor": scene.film.floor,
        "microroughness": below.rms if below else 0.0,
        "spin": op.spin,
        "slip": sliding_ratio(np.hypot(op.sliding_speed, hertz.lever_share * op.spin * hertz.b), op.entrainment_speed),
    }


def run(
    name: str,
    points: Iterable[Point],
    overrides: Overrides,
    observer: Callable[[Point, Overrides], dict[str, float]] = observe,
) -> Columns:
    """Solve the points, or read them from the store if it has just these. Refused ones are NaN."""
    points = list(points)
    file = STORE / f"{name}.npz"
    if file.exists():
        stored = dict(np.load(file))
        if str(stored.pop("overrides")) == repr(sorted(overrides.items())) and _hold(stored, points):
            return stored | with_numbers(points, overrides)
    rows = []
    for point in points:
        try:
            found = observer(point, overrides)
        except ContactError as error:
            print(f"refused: {point}: {error}", flush=True)
            found = {}
        rows.append(asdict(point) | found)
        shown = {
            k: f"{found[k]:.3g}"
            for k in ("lambda", "contact_load_ratio", "contact_area_ratio", "seconds")
            if k in found
        }
        print(f"{name} {len(rows)}/{len(points)}", shown, flush=True)
    names = max(rows, key=len)
    columns = {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}
    STORE.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(file, overrides=repr(sorted(overrides.items())), **columns)
    return columns


def with_numbers(points: list[Any], overrides: Overrides) -> Columns:
    """Columns of `numbers_of`, which cost nothing."""
    rows = [numbers_of(point.build(overrides), point.operating_point) for point in points]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _hold(stored: Columns, points: list[Point]) -> bool:
    """Return whether the columns belong to these points, up to rounding."""
    asked = {f.name: np.array([getattr(point, f.name) for point in points]) for f in fields(Point)}

    def same(a: np.ndarray, b: np.ndarray) -> bool:
        return a.shape == b.shape and bool(np.allclose(a, b, rtol=1e-6) if a.dtype.kind == "f" else (a == b).all())

    return all(same(values, stored[name]) for name, values in asked.items())


def joined(parts: Iterable[Columns]) -> Columns:
    """Tables below each other."""
    parts = list(parts)
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def solved(columns: Columns) -> Columns:
    """Without what was refused."""
    kept = np.isfinite(columns["contact_area_ratio"])
    return {name: values[kept] for name, values in columns.items()}


def sweep_points(scene: str) -> list[Point]:
    """Over film, load and viscosity: as shipped, other amplitudes of roughness, and longer correlation lengths."""
    groups = (
        ("shipped", 30, (1.0, 1.0), (1.0, 1.0)),
        ("amplitude", 14, (0.3, 1.0), (1.0, 1.0)),
        ("length", 12, (1.0, 1.0), (1.25, 3.0)),
        ("microroughness", 16, (1.0, 1.0), (1.0, 1.0)),
    )
    return [
        replace(
            _swept(scene, group, tuple(cube.tolist()), roughness, length, 0 if group == "shipped" else 10 * (k + 1)),
            below=between(*BELOW, float(cube[3])) if group == "microroughness" else 1.0,
        )
        for group, count, roughness, length in groups
        for k, cube in enumerate(spread(count, 4))
    ]


def end_points(scene: str) -> list[Point]:
    """The ends of lambda, as shipped, where the even spread does not reach."""
    shipped = (1.0, 1.0)
    return [
        _swept(scene, "shipped", (ratio, load, 2.0 / 3.0, 0.0), shipped, shipped, 0)
        for ratio in (0.0, 1.0)
        for load in (0.25, 0.75)
    ]


def pass_points(scene: str) -> list[Point]:
    """A few over film and load for whole passes, as shipped."""
    return [_swept(scene, "pass", tuple(cube.tolist()), (1.0, 1.0), (1.0, 1.0), 0) for cube in spread(12, 4)]


def rubbed_points(scene: str) -> list[Point]:
    """For hours of rubbing: as shipped, at two fifths of the load, and with a film of 0.3 of the roughness."""
    shipped = Scene.from_toml(scene)
    duty = shipped.operation.point
    srr = duty.sliding_speed / duty.entrainment_speed
    point = Point(scene, "rubbed", duty.load, duty.entrainment_speed, srr, duty.temperature)
    return [
        point,
        replace(point, load=0.4 * duty.load),
        replace(point, speed=speed_for(shipped, 0.3, duty.load, duty.temperature)),
    ]


def dry_points(scene: str) -> list[Point]:
    """Over load, amplitude and length of roughness."""
    return [
        _swept(scene, "dry", (0.5, a, 0.5, b), (0.3, 1.0), (1.0, 1.0), 10 * k)
        for k, (a, b) in enumerate(spread(16, 2).tolist())
    ] + [
        _swept(scene, "dry", (0.5, a, 0.5, b), (1.0, 1.0), (1.0, 3.0), 10 * k)
        for k, (a, b) in enumerate(spread(16, 2).tolist())
    ]


def _swept(
    name: str,
    group: str,
    cube: tuple[float, ...],
    roughness: tuple[float, float],
    length: tuple[float, float],
    seed: int,
) -> Point:
    scene = Scene.from_toml(name)
    duty = scene.operation.point
    ratio = LAMBDAS[0] * (LAMBDAS[1] / LAMBDAS[0]) ** cube[0]
    load, temperature = duty.load * between(*LOADS, cube[1]), duty.temperature + between(-40.0, 20.0, cube[2])
    srr = duty.sliding_speed / duty.entrainment_speed
    point = Point(
        name, group, load, 1.0, srr, temperature, between(*roughness, cube[3]), between(*length, cube[3]), seed
    )
    return replace(point, speed=speed_for(point.build({}), ratio, load, temperature))


def random_points(scene: str, count: int) -> list[Point]:
    """The check's: load, speed, slide-roll ratio and temperature at random, roughness as shipped."""
    shipped, draw = Scene.from_toml(scene), np.random.default_rng(SCENES.index(scene) + 1)
    duty, points = shipped.operation.point, []
    for _ in range(count):
        load, temperature = duty.load * draw.uniform(*LOADS), duty.temperature + draw.uniform(-5.0, 5.0)
        slowest, fastest = (speed_for(shipped, ratio, duty.load, duty.temperature) for ratio in LAMBDAS)
        speed = float(np.exp(draw.uniform(np.log(slowest), np.log(min(fastest, 60.0)))))
        srr = float(draw.choice([-1.0, 1.0]) * np.exp(draw.uniform(np.log(0.005), np.log(1.0))))
        points.append(Point(scene, "check", load, speed, srr, temperature))
    return points
