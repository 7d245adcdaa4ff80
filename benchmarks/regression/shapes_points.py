"""Contacts of gears, ball bearings and rigs, solved at the deterministic level, as columns of numbers."""

import math
import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path

import numpy as np

from benchmarks.folders import RESULTS
from benchmarks.regression.points import Columns, speed_for, with_numbers
from contact_core import ContactError, ContactState, OperatingPoint, Scene, advance, initial_state
from contact_core.film.fitted import Extent
from contact_core.film.lengths import inlet_length
from contact_core.reference import Hertz
from contact_core.reference.point_films import at_no_pressure
from contact_core.shapes import Point
from contact_core.state import Outputs

STORE = RESULTS / "regression_shapes"
ORIGIN = {  # scene of each shape; soft: under a tribofilm's hardness; rolling, sliding: by slide-roll ratio; thin: by lambda
    "line": "fzg_flank",
    "ellipse": "ball_209_inner",
    "circle": "mtm_zddp",
    "soft line": "fzg_flank",
    "rolling line": "fzg_flank",
    "sliding line": "cam_tappet",
    "thin line": "fzg_flank",
    "cam line": "cam_tappet",
    "light circle": "mtm_zddp",
}
FIT, WIDTH, CHECK = 1, 2, 5  # seeds: the first two for constants and half widths, the last tells if they hold
COUNTS = {
    "line": 30,
    "ellipse": 12,
    "circle": 6,
    "soft line": 6,
    "rolling line": 12,
    "sliding line": 8,
    "thin line": 36,
    "cam line": 36,
    "light circle": 12,
}  # points of the fit
OTHERS = {
    "line": 8,
    "ellipse": 6,
    "circle": 4,
    "soft line": 3,
    "rolling line": 0,
    "sliding line": 0,
    "thin line": 10,
    "cam line": 10,
    "light circle": 4,
}  # of the other seeds
RUBBED, RUNS, MINUTES = 3, 3, 10.0  # seed, contacts of each shape, and for how long they rub
LIGHT = 600.0  # N, at most, of ellipses that rub: others take long
KELVIN = 273.15
STEEL = 6e9  # Pa, hardness
BALL = 6.35e-3  # m, radius
RACES = (5.1093e-3, 7.590e-3)  # m, radii along x on the inner and the outer ring
NODES = (65, 81, 97, 129)  # along x, of an ellipse
INLET = 1.5  # nodes that resolve an inlet
SPINNING = 0.5  # share of the ellipses that spin
BELOW = (2e-9, 20e-9)  # m, rms of the microroughness
# radius along x [m] and ranges of load [N], lambda, slide-roll ratio, Rq of each body [m], temperature [degC]
THIN = {
    "thin line": (8.729e-3, (300.0, 9000.0), (0.03, 2.5), (0.02, 1.5), (0.1e-6, 0.4e-6), (50.0, 110.0)),
    "cam line": (23.83e-3, (100.0, 1500.0), (0.04, 2.5), (0.1, 4.5), (0.08e-6, 0.3e-6), (50.0, 110.0)),
}
COARSE = (8e-9, 20e-9)  # m, rms of the microroughness of thin lines
PRESSED = 0.8  # of the hardness, at most, by Hertz's pressure
OBSERVED = (
    "friction_coefficient",
    "friction_solid",
    "friction_fluid",
    "spin_torque",
    "power_loss",
    "rolling_resistance",
    "h_c",
    "lambda_ratio",
    "contact_load_ratio",
    "contact_area_ratio",
    "pressure_max",
    "wear_rate_1",
    "wear_rate_2",
    "error_friction",
    "error_film",
    "unconverged",
    "range_flags",
)


@dataclass(frozen=True)
class ShapePoint:
    """A contact on fresh surfaces, on a grid of its own, and what is asked of it."""

    shape: str
    radius: float  # m, along x
    load: float  # N
    speed: float  # m/s, mean
    srr: float
    spin: float  # rad/s
    temperature: float  # K
    rq_1: float  # m
    rq_2: float  # m
    below_1: float  # m, rms of the microroughness
    below_2: float
    hardness: float = STEEL  # Pa, of bodies without a tribofilm

    def build(self, changes: dict[str, str] | None = None) -> Scene:
        """The scene on a grid that holds the contact."""
        shipped = Scene.from_toml(ORIGIN[self.shape])
        made = {
            "tribofilm.beyond_fit": "extrapolate",
            "geometry.radius_x": f"{self.radius} m",
            "operation.load": f"{self.load} N",
            "surface_1.rq": f"{self.rq_1} m",
            "surface_2.rq": f"{self.rq_2} m",
            "surface_1.microroughness.rms": f"{self.below_1} m",
            "surface_2.microroughness.rms": f"{self.below_2} m",
        }
        if self.shape == "ellipse":
            made |= self._grid(shipped)
        if self.hardness != STEEL:
            made |= {"plasticity.hardness": f"{self.hardness} Pa", "plasticity.film_hardness": f"{self.hardness} Pa"}
        return Scene.from_toml(ORIGIN[self.shape], made | (changes or {})).at_level("deterministic")

    def _grid(self, shipped: Scene) -> dict[str, str]:
        """Grid of an ellipse: as wide as the film needs, and fine enough for its inlet if possible."""
        hertz, inlet, need = self._film(shipped)
        length = shipped.surface_1.correlation_length
        domain = max(2.0 * min(need.left, 1.15 * hertz.a + 5.0 * inlet), 2.8 * hertz.a, 5.5 * length)
        fine = (n for n in NODES if domain / (n - 1) <= min(inlet / INLET, 0.5 * length))
        width = max(2.0 * min(need.side, 1.15 * hertz.b + 5.0 * inlet), 2.6 * hertz.b, domain)
        return {"film.domain": f"{domain} m", "film.width": f"{width} m", "film.points": str(next(fine, 0))}

    def _film(self, shipped: Scene) -> tuple[Hertz, float, Extent]:
        """Hertz's contact, the inlet's length [m] and the room that the film needs."""
        shape, modulus = Point(self.radius, shipped.geometry.radius_y), shipped.solids.reduced_modulus
        oil = at_no_pressure(shipped.lubricant.viscosity, self.temperature)
        hertz, film = shape.hertz(self.load, modulus), shape.film(self.load, self.speed, *oil, modulus)
        return hertz, inlet_length(hertz.a, shape, film), Extent.of(shape, self.load, modulus, film)

    @property
    def resolved(self) -> bool:
        """Whether the grid resolves the inlet of an ellipse; otherwise its film depends on the grid."""
        return self.shape != "ellipse" or self._grid(Scene.from_toml(ORIGIN[self.shape]))["film.points"] != "0"

    @property
    def squashed(self) -> bool:
        """Whether the pressure is close to the hardness."""
        return self.hardness < STEEL and self.build().hertz(self.load).pressure_max > PRESSED * self.hardness

    @property
    def operating_point(self) -> OperatingPoint:
        """With the surface speeds."""
        half = 0.5 * self.srr * self.speed
        return OperatingPoint(self.load, self.speed + half, self.speed - half, self.temperature, self.spin)


def points(shape: str, seed: int, count: int) -> list[ShapePoint]:
    """Random contacts over what a shape meets in its system."""
    draw = np.random.Generator(np.random.Philox(key=[seed, list(ORIGIN).index(shape)]))

    def log(low: float, high: float) -> float:
        return float(np.exp(draw.uniform(math.log(low), math.log(high))))

    def sign() -> float:
        return float(draw.choice([-1.0, 1.0]))

    found = list[ShapePoint]()
    while len(found) < count:
        spin, hardness = 0.0, STEEL
        if shape.endswith("line"):
            radius, load = draw.uniform(3.9e-3, 8.8e-3), 14.0 * log(50.0 if shape == "soft line" else 5.0, 540.0)
            speed, srr, warm = log(0.3, 5.0), draw.uniform(-1.3, 1.3), draw.uniform(40.0, 120.0)
            rough = log(0.1e-6, 0.4e-6), log(0.1e-6, 0.4e-6)
            if shape == "rolling line":
                srr = sign() * log(3e-3, 0.3)
            if shape == "sliding line":
                radius, load, speed = draw.uniform(10e-3, 30e-3), 14.0 * log(5.0, 120.0), log(0.1, 2.0)
                srr, rough = sign() * log(0.5, 5.0), (log(0.05e-6, 0.3e-6), log(0.05e-6, 0.3e-6))
            if shape == "soft line":
                hardness = draw.uniform(2e9, 4e9)
        elif shape == "ellipse":
            radius, load = draw.choice(RACES), log(20.0, 4500.0)
            speed, srr, warm = log(0.05, 15.0), sign() * log(1e-3, 2e-2), draw.uniform(30.0, 120.0)
            rough = log(10e-9, 50e-9), log(10e-9, 50e-9)
            if draw.random() < SPINNING:
                spin = sign() * log(0.02, 0.3) * speed / BALL
        else:
            radius, load = 9.525e-3, log(5.0, 75.0)
            speed, srr, warm = log(5e-3, 4.0), sign() * log(5e-3, 2.0), draw.uniform(40.0, 120.0)
            rough = log(10e-9, 40e-9), log(10e-9, 200e-9)
            if shape == "light circle":
                load, rough = log(3.0, 30.0), (log(20e-9, 60e-9), log(80e-9, 250e-9))
        below = log(*BELOW), log(*BELOW)
        if shape in THIN:
            radius, loads, lambdas, ratios, roughest, warmest = THIN[shape]
            load, srr, warm = log(*loads), sign() * log(*ratios), draw.uniform(*warmest)
            rough, below = (log(*roughest), log(*roughest)), (log(*COARSE), log(*COARSE))
        numbers = float(radius), load, speed, float(srr), spin, KELVIN + float(warm), *rough, *below, float(hardness)
        point = ShapePoint(shape, *numbers)
        if shape in THIN:
            point = replace(point, speed=speed_for(point.build(), log(*lambdas), load, point.temperature))
        if point.resolved and not point.squashed:
            found.append(point)
    return found


def observe(point: ShapePoint) -> dict[str, float]:
    """Outputs of the deterministic level."""
    scene, start = point.build(), time.process_time()
    _, out = advance(scene, point.operating_point, initial_state(scene), 0.0)
    return {name: float(getattr(out, name)) for name in OBSERVED} | {"seconds": time.process_time() - start}


def solved(shape: str, seed: int, count: int) -> Columns:
    """The points by the deterministic level, those that are not in the store one after the other. Refused ones are
    NaN.
    """
    asked, file = points(shape, seed, count), STORE / f"{shape}_{seed}.npz"
    rows = _stored(file, asked)
    for point in asked[len(rows) :]:
        try:
            found = observe(point)
        except ContactError as error:
            print(f"refused: {point}: {error}", flush=True)
            found = {}
        rows.append({name: found.get(name, math.nan) for name in (*OBSERVED, "seconds")})
        print(shape, seed, len(rows), {k: f"{found[k]:.3g}" for k in ("h_c", "seconds") if k in found}, flush=True)
        STORE.mkdir(parents=True, exist_ok=True)
        np.savez_compressed(file, **_columns(asked[: len(rows)], rows))
    origin = {"scene": np.full(count, ORIGIN[shape]), "group": np.full(count, shape)}
    return _columns(asked, rows[: len(asked)]) | with_numbers(asked, {}) | origin


def _columns(asked: list[ShapePoint], rows: list[dict[str, float]]) -> Columns:
    whole = [asdict(point) | row for point, row in zip(asked, rows, strict=True)]
    return {name: np.array([row[name] for row in whole]) for name in whole[0]}


def _stored(file: Path, asked: list[ShapePoint]) -> list[dict[str, float]]:
    """Rows of the store that belong to the first of the points asked for."""
    if not file.exists():
        return []
    kept, rows = dict(np.load(file)), list[dict[str, float]]()
    kept.setdefault("hardness", np.full(kept["load"].size, STEEL))
    for k, point in enumerate(asked[: kept["load"].size]):
        same = all(
            kept[f.name][k] == value
            if isinstance(value := getattr(point, f.name), str)
            else np.isclose(kept[f.name][k], value, rtol=1e-9)
            for f in fields(point)
        )
        if not same:
            break
        rows.append({name: float(kept[name][k]) for name in (*OBSERVED, "seconds")})
    return rows


def fitted_to(shapes: Iterable[str]) -> list[Columns]:
    """The points of shapes that constants are fitted to."""
    asked = [(shape, seed, count_of(shape, seed)) for shape in shapes for seed in (FIT, WIDTH)]
    return [solved(*each) for each in asked if each[2]]


def count_of(shape: str, seed: int) -> int:
    """How many points a shape has of a seed."""
    return (COUNTS if seed == FIT else OTHERS)[shape]


def rubbed(shape: str) -> Iterator[tuple[Outputs, Outputs]]:
    """A few contacts that the deterministic level has rubbed: its outputs, and those of the regression level on the same
    surfaces. States stay in the store.
    """
    for k, drawn in enumerate(points(shape, RUBBED, RUNS)):
        point = replace(drawn, load=min(drawn.load, LIGHT)) if shape == "ellipse" else drawn
        file, scene, op = STORE / f"rubbed_{shape}_{k}.state", point.build(), point.operating_point
        if file.exists():
            state = ContactState.from_bytes(file.read_bytes(), scene)
        else:
            state = advance(scene, op, initial_state(scene), 60.0 * MINUTES)[0]
            STORE.mkdir(parents=True, exist_ok=True)
            file.write_bytes(state.to_bytes())
        yield state.outputs, advance(scene.at_level("regression"), op, state, 0.0)[1]
