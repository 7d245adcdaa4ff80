"""What a contact is and which physics it needs: frozen records read from TOML, checked before anything is computed."""

import hashlib
import json
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import Field, dataclass, field, fields, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

from ..errors import OperatingPointError, SceneError
from ..film import FILMS, Deterministic, Regression
from ..laws.boundary_friction import FilmBlend
from ..laws.density import DowsonHigginson, Incompressible
from ..laws.heat import FlashTemperature, NoHeat, TemperatureField
from ..laws.plasticity import ElasticPerfectlyPlastic
from ..laws.rheology import Carreau, Eyring, Newtonian
from ..laws.supply import Flooded, Meniscus, SupplyFilm
from ..laws.tribofilm import Andersson, Combined, Ghanbarzadeh, Gosvami, NoTribofilm, ZhangSpikes
from ..laws.viscosity import AstmD341, Barus, Modulus, Roelands
from ..laws.wear import Archard, NoWear
from ..quantities import TABLE, input_parameter, numbers, out_of_range, parameter, with_numbers
from ..reference import Hertz
from ..shapes import GEOMETRIES, Geometry, LineGeometry, PointGeometry, RollerGeometry, Shape
from .toml import build, did_you_mean, models_of, override, read_table, unbuild

_SEEDS = 2**31  # of a surface: what FMI's integers can tell apart
_SEED_STEP = 1_327_217_885  # the odd number nearest to _SEEDS over the golden ratio
_ROOM = 2.4  # side of the grid over the half width of Hertz's contact, at least
_BESIDE = 1.02  # side of the grid over the length of a roller
_INPUTS_ANYWAY = ("geometry.radius_x", "geometry.radius_y")


@dataclass(frozen=True)
class Solids:
    """Elasticity of the pair."""

    reduced_modulus: float = parameter(
        "Pa", "E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2]", above=1e3, most=1e13, quantity="Stress"
    )


@dataclass(frozen=True)
class Surface:
    """Roughness of one body: Gaussian heights, autocorrelation rq^2 exp(-(r/correlation_length)^2). rq = 0 is
    smooth.
    """

    rq: float = parameter("m", "rms roughness", least=0.0, most=1e-4)
    correlation_length: float = parameter("m", "correlation length", above=0.0, most=1.0, shapes_arrays=True)
    seed: int = parameter("", "number of the realisation", least=0, most=_SEEDS - 1)


@dataclass(frozen=True)
class Lubricant:
    """The oil."""

    viscosity: Roelands | Barus | Modulus | AstmD341
    density: DowsonHigginson | Incompressible
    rheology: Newtonian | Eyring | Carreau
    conductivity: float = parameter("W/(m K)", "thermal conductivity of the oil", above=0.0, most=10.0, default=0.14)
    flow: str = parameter(
        "",
        "what Reynolds' equation sees: newtonian, the viscosity at the inlet's temperature; local, that of the local "
        "temperature, thinned by the local shear",
        choices=("newtonian", "local"),
        default="newtonian",
    )
    cavitation: str = parameter(
        "",
        "where oil would be under tension: reynolds, it has no pressure and its gap counts as full; mass_conserving, "
        "the gap holds what flows in, and is full where that is more than it can hold",
        choices=("reynolds", "mass_conserving"),
        default="reynolds",
    )
    supply: Flooded | SupplyFilm | Meniscus = field(default=Flooded())


@dataclass(frozen=True)
class Control:
    """How the evolution over time is cut into blocks, in each of which the contact is solved at a few instants."""

    change: float = parameter(
        "m", "largest change of film or wear in a block, as rms over the track", above=0.0, most=1e-6
    )
    dry_above: float = parameter(
        "", "contact_load_ratio above which dry pressures drive the blocks", least=0.0, most=2.0
    )
    input_change: float = parameter("", "relative change of an input that asks for a new solution", least=0.0, most=1.0)
    driver: str = parameter(
        "",
        "whose pressures drive film and wear: mixed lubrication's, dry contact's, or by contact_load_ratio",
        choices=("auto", "mixed", "dry"),
        default="auto",
    )
    dry_instants: int = parameter("", "instants of a block driven dry", least=1, most=1000, default=3)
    mixed_instants: int = parameter(
        "",
        "instants of a block driven by mixed lubrication; 0: as many as an eighth of a pass takes",
        least=0,
        most=1000,
        default=0,
    )
    longest: float = parameter("s", "longest block", above=0.0, most=1e9, default=120.0)
    inputs: str = parameter(
        "",
        "what a change of load, speeds or radii finds: quasi_steady, a film that has long settled; transient, the one "
        "that was there, which follows",
        choices=("quasi_steady", "transient"),
        default="quasi_steady",
    )


@dataclass(frozen=True)
class OperatingPoint:
    """What is asked of the contact in one step."""

    load: float = input_parameter("load")
    speed_1: float = input_parameter("speed_1")
    speed_2: float = input_parameter("speed_2")
    temperature: float = input_parameter("temperature")
    spin: float = input_parameter("spin", default=0.0)
    body_temperature_1: float | None = input_parameter("body_temperature_1", default=None)  # None: the oil's
    body_temperature_2: float | None = input_parameter("body_temperature_2", default=None)
    radius_x: float | None = input_parameter("radius_x", default=None)  # None: the scene's
    radius_y: float | None = input_parameter("radius_y", default=None)

    @property
    def entrainment_speed(self) -> float:
        """u_e = (u1 + u2) / 2 [m/s]."""
        return 0.5 * (self.speed_1 + self.speed_2)

    @property
    def sliding_speed(self) -> float:
        """u_s = u1 - u2 [m/s]."""
        return self.speed_1 - self.speed_2

    @property
    def slides(self) -> bool:
        """Whether the bodies slide anywhere in the contact."""
        return self.speed_1 != self.speed_2 or self.spin != 0.0

    @property
    def bodies(self) -> tuple[float, float]:
        """Bulk temperatures [K]; the oil's where nothing else is said."""
        one, two = self.body_temperature_1, self.body_temperature_2
        return self.temperature if one is None else one, self.temperature if two is None else two

    @property
    def inlet_temperature(self) -> float:
        """Temperature [K] of the oil that the bodies draw in: the mean of their own."""
        one, two = self.bodies
        return 0.5 * (one + two)

    def check(self) -> None:
        """Raise OperatingPointError with one sentence for each value that cannot be used."""
        values = vars(self)
        if all(values[name] is None or least <= values[name] <= most for name, least, most in _RANGES):
            return  # the common case, at a fraction of the cost
        sentences = list(out_of_range(self, ""))
        if sentences:
            raise OperatingPointError(" ".join(sentences))


_RANGES = tuple((f.name, f.metadata["least"], f.metadata["most"]) for f in fields(OperatingPoint))


@dataclass(frozen=True)
class Step:
    """A change of the duty at a time; what is not given keeps the value of `[operation]`."""

    time: float = parameter("s", "time of the change", least=0.0, most=1e9)
    load: float | None = input_parameter("load", default=None)
    speed_1: float | None = input_parameter("speed_1", default=None)
    speed_2: float | None = input_parameter("speed_2", default=None)
    temperature: float | None = input_parameter("temperature", default=None)
    spin: float | None = input_parameter("spin", default=None)
    body_temperature_1: float | None = input_parameter("body_temperature_1", default=None)
    body_temperature_2: float | None = input_parameter("body_temperature_2", default=None)
    radius_x: float | None = input_parameter("radius_x", default=None)
    radius_y: float | None = input_parameter("radius_y", default=None)


@dataclass(frozen=True)
class Operation:
    """The duty shipped with a scene: its point of reference, how long, and its changes if there are any."""

    load: float = parameter("N", "normal load", above=0.0, most=TABLE["load"].maximum)
    speed_1: float = input_parameter("speed_1")
    speed_2: float = input_parameter("speed_2")
    temperature: float = input_parameter("temperature")
    duration: float = parameter("s", "test time", above=0.0, most=1e9)
    interval: float = parameter("s", "communication step: time between two rows of the result", above=0.0, most=1e9)
    largest_load: float = parameter(
        "N", "largest load of the duty; 0: the load above", least=0.0, most=1e6, default=0.0
    )
    steps: tuple[Step, ...] = parameter("", "changes of the duty, in the order of time", default=())
    file: str = parameter("", "CSV of the duty, instead of steps", default="")
    spin: float = input_parameter("spin", default=0.0)
    body_temperature_1: float | None = input_parameter("body_temperature_1", default=None)
    body_temperature_2: float | None = input_parameter("body_temperature_2", default=None)
    radius_x: float | None = input_parameter("radius_x", default=None)  # None: the geometry's
    radius_y: float | None = input_parameter("radius_y", default=None)

    @property
    def point(self) -> OperatingPoint:
        """The operating point of reference."""
        return OperatingPoint(**{f.name: getattr(self, f.name) for f in fields(OperatingPoint)})


def _full_key(key: str, value: str) -> str:
    """`heat.bulk=oil` is short for `heat.bulk.model=oil`."""
    return f"{key}.model" if value in {law.name for law in models_of(key)} else key  # type: ignore[attr-defined]


def _rank(item: tuple[str, str]) -> int:
    """Order in which an override is applied."""
    return {"set": 0, "model": 1}.get(item[0].rpartition(".")[2], 2)


def _with_sharing(table: Mapping[str, Any]) -> dict[str, Any]:
    """Nested tables of a scene; curves of load sharing that are not named are those fitted to its geometry's like."""
    film, geometry = table.get("film"), table.get("geometry")
    if not isinstance(film, Mapping) or not isinstance(geometry, Mapping) or film.get("model") != Regression.name:
        return dict(table)
    bodies = {law.name: law for law in GEOMETRIES}  # type: ignore[attr-defined]
    usual = bodies.get(geometry.get("model"), PointGeometry).sharing  # type: ignore[attr-defined]
    sharing = film.get("sharing", {})
    if isinstance(sharing, Mapping) and "model" not in sharing:
        film = {**film, "sharing": {"model": usual.name, **sharing}}
    return {**table, "film": film}


@dataclass(frozen=True)
class Scene:
    """One contact: geometry, surfaces, materials and a law in every slot."""

    name: str
    description: str
    geometry: Geometry
    solids: Solids
    surface_1: Surface
    surface_2: Surface
    lubricant: Lubricant
    plasticity: ElasticPerfectlyPlastic
    boundary_friction: FilmBlend
    heat: NoHeat | FlashTemperature | TemperatureField
    tribofilm: NoTribofilm | Ghanbarzadeh | Andersson | ZhangSpikes | Gosvami | Combined
    wear: NoWear | Archard
    film: Deterministic | Regression
    control: Control
    operation: Operation

    @staticmethod
    def from_toml(source: str | Path, overrides: Mapping[str, str] | None = None) -> "Scene":
        """Read a shipped scene by name or a TOML file by path; `overrides` maps dotted keys to new values.

        Raises SceneError with every sentence that says what is wrong and what would be right.
        """
        table = read_table(source)
        # sets and models first: they decide which other keys there are
        changes = {_full_key(key, value): value for key, value in (overrides or {}).items()}
        for key, value in sorted(changes.items(), key=_rank):
            override(table, key, value)
        return Scene.from_dict(table)

    @staticmethod
    def from_dict(table: Mapping[str, Any]) -> "Scene":
        """Build and check a scene from nested tables as TOML gives them."""
        scene: Scene = build(Scene, _with_sharing(table), "")
        errors = scene.check()
        if errors:
            raise SceneError(" ".join(sentence for _, sentence in errors))
        return scene

    def to_dict(self) -> dict[str, Any]:
        """Nested tables, from which `from_dict` makes an equal scene, bit for bit."""
        return unbuild(self)

    def at_level(self, level: str) -> "Scene":
        """The scene with `film.model` = `level`, on the same grid: a state of the one is a state of the other.

        What only the film of the other level knows has its default. Raises SceneError for an unknown level.
        """
        films = {film.name: film for film in FILMS}  # type: ignore[attr-defined]
        if level not in films:
            raise SceneError(
                f"There is no level '{level}'.{did_you_mean(level, list(films))} Known are {', '.join(films)}."
            )
        shared = {f.name for f in fields(films[level])} & {f.name for f in fields(self.film)}
        if level == self.film.name:
            return self
        kept = {name: getattr(self.film, name) for name in shared}
        if level == Regression.name:
            kept["sharing"] = self.geometry.sharing()
        return replace(self, film=films[level](**kept))

    def realisation(self, seed: int) -> "Scene":
        """The scene with other surfaces of the same statistics; 0: its own. Raises SceneError for a negative seed.

        Both bodies stay independent of each other, as two bodies are with any seeds. Their own seeds step by 2^31 over
        the golden ratio, modulo 2^31: a surface comes twice at no two seeds, and up to seed 10,000 it is none that its
        own seed changed by less than 100,000 gives.
        """
        if not 0 <= seed < _SEEDS:
            raise SceneError(f"seed = {seed} must be at least 0 and at most {_SEEDS - 1}.")
        if seed == 0:
            return self
        first, second = (
            replace(surface, seed=(surface.seed + seed * _SEED_STEP) % _SEEDS)
            for surface in (self.surface_1, self.surface_2)
        )
        return replace(self, surface_1=first, surface_2=second)

    def shape(self, op: OperatingPoint | None = None) -> Shape:
        """The undeformed bodies, at an operating point or at the scene's own radii."""
        if op is None or op.radius_x is op.radius_y is None:
            return self._own_shape
        return self.geometry.shape(op.radius_x, op.radius_y)

    @cached_property
    def _own_shape(self) -> Shape:
        return self.geometry.shape()

    def radii(self, op: OperatingPoint) -> tuple[float, ...]:
        """Combined radii of curvature [m] along x and, for points, along y at an operating point."""
        return tuple(value for _, value in _radii(self.shape(op)))

    def hertz(self, load: float) -> Hertz:
        """Hertz's contact of the smooth, dry bodies at a load [N] above zero."""
        return self.shape().hertz(load, self.solids.reduced_modulus)

    def hertz_at(self, op: OperatingPoint) -> Hertz:
        """Hertz's contact of the smooth, dry bodies at an operating point with a load."""
        return self.shape(op).hertz(op.load, self.solids.reduced_modulus)

    @cached_property
    def unit_hertz(self) -> Hertz:
        """Hertz's contact at 1 N: lengths and pressure grow with the cube root of the load, the approach its square."""
        return self.hertz(1.0)

    def unit_hertz_at(self, op: OperatingPoint) -> Hertz:
        """Hertz's contact at 1 N and the radii of an operating point."""
        if op.radius_x is op.radius_y is None:
            return self.unit_hertz
        return _unit_hertz(self.shape(op), self.solids.reduced_modulus)

    @cached_property
    def rows(self) -> int:
        """Rows of nodes that the contact has along y before a scar makes them more."""
        film, shape = self.film, self._own_shape
        if shape.periodic:
            smooth = self.surface_1.rq == self.surface_2.rq == 0.0
            if film.width == 0.0 and smooth:
                return 1  # all are alike
            pairs = round(0.5 * (film.width or film.domain) / film.spacing)
            return max(2 * pairs, 1)  # a grid of half as many rows has the same period
        if film.width > 0.0:
            return round(film.width / film.spacing) + 1
        if isinstance(self.geometry, RollerGeometry):
            step = max(16, (film.points - 1) // 4)  # such rows halve about as often as the nodes along x
            return step * math.ceil(_BESIDE * self.geometry.face_width / film.spacing / step) + 1
        return film.points

    @property
    def repeats(self) -> float:
        """How many times the grid lies in the contact, side by side along y."""
        if not isinstance(self.geometry, LineGeometry):
            return 1.0
        return self.geometry.face_width / (self.rows * self.film.spacing)

    def refusal(self, op: OperatingPoint) -> str:
        """Why the scene cannot have an operating point: of radii that make a contact that its grid cannot hold, or of
        a motion that its shape does not allow. "" if it can.
        """
        if not isinstance(self.geometry, PointGeometry):
            if op.radius_y is not None:
                return f"radius_y = {op.radius_y:g} m: geometry.model = '{self.geometry.name}' has none. Leave it out."
            if op.spin != 0.0 and self._own_shape.periodic:
                return (
                    f"spin = {op.spin:g} rad/s must be 0 where geometry.model = 'line': each part of the face would "
                    "slide otherwise. Use geometry.model = 'roller'."
                )
        inlet = self.lubricant.supply.inlet
        if inlet is not None and op.load > 0.0 and inlet <= (a := self.hertz_at(op).a):
            return (
                f"lubricant.supply.distance = {inlet:g} m must be more than the half width of Hertz's contact, {a:.3g} "
                f"m at {op.load:g} N: no oil would be before it."
            )
        if self.film.name != "deterministic" or op.load == 0.0 or self.shape(op) == self._own_shape:
            return ""
        own, hertz, shape = self.hertz(op.load), self.hertz_at(op), self.shape(op)
        radii = " and ".join(f"{name} = {value:g} m" for name, value in _radii(shape))
        said = f"At {op.load:g} N {radii} make a Hertz"
        for half, before, room in zip((hertz.a, hertz.b), (own.a, own.b), self.room, strict=True):
            if half > max(room, before):  # in proportion to the radii's power `power`
                most = (room / half) ** (1.0 / shape.power)
                return (
                    f"{said} contact of {2 * hertz.a:.3g} m by {2 * hertz.b:.3g} m, too large for "
                    f"film.domain = {self.film.domain:g} m. Use at most "
                    f"{' and '.join(f'{most * value:.3g} m' for _, value in _radii(shape))}, less load, "
                    f"or a scene with a domain of at least {1.2 * _ROOM * half:.2g} m."
                )
        hardness = self.plasticity.hardness
        if hertz.pressure_max > max(hardness, own.pressure_max):
            least = (hertz.pressure_max / hardness) ** (1.0 / (1.0 - shape.power))
            return (
                f"{said} pressure of {hertz.pressure_max:.3g} Pa, above plasticity.hardness = {hardness:g} Pa. Use at "
                f"least {' and '.join(f'{least * value:.3g} m' for _, value in _radii(shape))}, or less load."
            )
        return ""

    @property
    def room(self) -> tuple[float, float]:
        """Largest half widths [m] of Hertz's contact along x and y that the grid has room for."""
        across = (
            math.inf if not isinstance(self.geometry, PointGeometry) else (self.rows - 1) * self.film.spacing / _ROOM
        )
        return self.film.domain / _ROOM, across

    @property
    def largest_load(self) -> float:
        """Largest load [N] that the scene's grid has to hold."""
        operation = self.operation
        return max(operation.largest_load, operation.load, *(step.load or 0.0 for step in operation.steps))

    def digest(self) -> str:
        """Fingerprint of what a stored state depends on: shape, surfaces and grid."""
        return self._digest

    @cached_property
    def _digest(self) -> str:
        table = self.to_dict()
        parts = {key: table[key] for key in ("geometry", "surface_1", "surface_2")}
        parts["grid"] = [self.film.points, self.film.domain, self.rows]
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:16]

    def check(self) -> list[tuple[str, str]]:
        """Return (rule, sentence) for everything that makes the scene unusable."""
        ranges = [("range", sentence) for sentence in out_of_range(self, "")]
        if not re.fullmatch(r"[\w-]+", self.name):  # files are named after it
            ranges.append(("name", f"name = {self.name!r} must be letters, digits, '_' and '-' only."))
        return ranges or [
            *self._shape_errors(), *self._roughness_errors(), *self._oil_errors(), *self._duty_errors()
        ]  # fmt: skip

    def _shape_errors(self) -> Iterator[tuple[str, str]]:
        load, plasticity = self.largest_load, self.plasticity
        hertz = self.hertz(load)
        for name, half, room in zip(("domain", "width"), (hertz.a, hertz.b), self.room, strict=True):
            if half > room:
                name = name if self.film.width > 0.0 else "domain"
                yield (
                    name,
                    f"film.{name} = {getattr(self.film, name):g} m is too small: at {load:g} N the Hertz contact is "
                    f"{2 * hertz.a:.3g} m by {2 * hertz.b:.3g} m. Use at least {1.2 * _ROOM * half:.2g} m.",
                )
                break
        depth = (self.rows - 1) * self.film.spacing
        if isinstance(self.geometry, RollerGeometry) and depth < self.geometry.face_width:
            yield (
                "width",
                f"film.width = {self.film.width:g} m is too small: the ends of geometry.face_width = "
                f"{self.geometry.face_width:g} m must lie on the grid. Use at least {_BESIDE:g} times that, or 0.",
            )
        if hertz.pressure_max >= plasticity.hardness:
            yield (
                "hardness",
                f"The Hertz pressure at {load:g} N is {hertz.pressure_max:.3g} Pa, above plasticity.hardness = "
                f"{plasticity.hardness:g} Pa. Lower the load or raise the hardness.",
            )
        if isinstance(self.geometry, LineGeometry) and getattr(self.film, "criterion", "split") == "lumped":
            yield (
                "criterion",
                "film.criterion = 'lumped' is for point contacts: it finds no film of a line. Use 'split'.",
            )
        for name in ("track_length_1", "track_length_2"):
            if getattr(self.geometry, name) < self.film.domain:
                yield (
                    "track",
                    f"geometry.{name} = {getattr(self.geometry, name):g} m is shorter than film.domain = "
                    f"{self.film.domain:g} m: a point would be in the contact twice at once. Use a longer track.",
                )
        if plasticity.film_hardness > plasticity.hardness:
            yield (
                "hardness",
                f"plasticity.film_hardness = {plasticity.film_hardness:g} Pa is above plasticity.hardness = "
                f"{plasticity.hardness:g} Pa; a tribofilm is taken to be softer than its solid.",
            )

    def _roughness_errors(self) -> Iterator[tuple[str, str]]:
        for name, surface in (("surface_1", self.surface_1), ("surface_2", self.surface_2)):
            length = surface.correlation_length
            nodes = length / self.film.spacing
            if surface.rq > 0.0 and length > self.film.domain / 5.0:
                yield (
                    "resolution",
                    f"{name}.correlation_length = {length:g} m is too long for film.domain = {self.film.domain:g} m. "
                    f"Use at most {self.film.domain / 5.0:g} m, a larger domain, or rq = 0 for a smooth surface.",
                )
            if surface.rq > 0.0 and nodes < 1.0 - 1e-9:
                yield (
                    "resolution",
                    f"{name}.correlation_length = {length:g} m is {nodes:.2f} nodes of the grid; "
                    f"at least 1 is needed. Use film.points = {1 + math.ceil(self.film.domain / length)} or more, "
                    "or a longer correlation length.",
                )

    def _oil_errors(self) -> Iterator[tuple[str, str]]:
        oil = self.lubricant.viscosity
        if isinstance(oil, AstmD341) and oil.viscosity_100 >= oil.viscosity_40:
            yield (
                "viscosity",
                f"lubricant.viscosity.viscosity_100 = {oil.viscosity_100:g} m2/s must be below viscosity_40 = "
                f"{oil.viscosity_40:g} m2/s: oils thin when they warm. Exchange the two if they were mixed up.",
            )

        if self.lubricant.supply.layer is not None and self.lubricant.cavitation != "mass_conserving":
            yield (
                "supply",
                f"lubricant.supply.thickness = {self.lubricant.supply.layer:g} m needs lubricant.cavitation = "
                f"'mass_conserving': with '{self.lubricant.cavitation}' every gap counts as full. Set it, or use the "
                "supply 'meniscus'.",
            )

    def _duty_errors(self) -> Iterator[tuple[str, str]]:
        times = [step.time for step in self.operation.steps]
        if times and self.operation.file:
            yield "duty", f"operation.steps and operation.file = '{self.operation.file}' exclude each other. Keep one."
        for name, point in self._duty_points():
            refusal = self.refusal(point)
            if refusal:
                yield "radii", f"{name}: {refusal}"
        for name, temperature in self._felt_temperatures():
            refusal = self.tribofilm.refusal(temperature)
            if refusal:
                yield "temperature", f"{name}{refusal}"
        if any(late <= early for early, late in pairwise([0.0, *times])):
            yield "duty", f"The times of operation.steps, {times} s, must be above 0 and increase."

    def _duty_points(self) -> Iterator[tuple[str, OperatingPoint]]:
        """The operating points of the duty and their names."""
        yield "operation", self.operation.point
        for i, step in enumerate(self.operation.steps):
            given = {f.name: getattr(step, f.name) for f in fields(OperatingPoint)}
            changed = {name: value for name, value in given.items() if value is not None}
            yield f"operation.steps[{i}]", replace(self.operation.point, **changed)

    def _felt_temperatures(self) -> Iterator[tuple[str, float]]:
        """Temperatures that the duty gives and the tribofilm feels, and the words before their name."""
        for name, point in self._duty_points():
            if self.heat.bulk.name == "inputs":
                yield from ((f"{name}: body {i + 1}, ", warm) for i, warm in enumerate(point.bodies))
            else:
                yield f"{name}.", point.temperature

    def warnings(self) -> list[str]:
        """Return sentences on what can be computed but is not resolved well."""
        found = []
        for name, surface in (("surface_1", self.surface_1), ("surface_2", self.surface_2)):
            nodes = surface.correlation_length / self.film.spacing
            if surface.rq > 0.0 and nodes < 2.0 - 0.06:  # 8 um on 129 nodes over 0.5 mm is 2.05, over 0.53 mm 1.93
                found.append(f"{name} has {nodes:.2f} nodes per correlation length; 2 or more resolve it.")
        if not self.tribofilm.covers(self.operation.temperature):
            found.append(
                f"The tribofilm's constants are extrapolated: they do not hold at {self.operation.temperature:g} K."
            )
        given = (self.operation.body_temperature_1, self.operation.body_temperature_2)
        if given != (None, None) and self.heat.bulk.name != "inputs":
            found.append(f"heat.bulk = '{self.heat.bulk.name}' does not use operation.body_temperature_1 and _2.")
        if (
            self.film.name == "regression"
            and self.lubricant.flow == "local"
            and self.lubricant.rheology.name == "eyring"
        ):
            found.append("film.model = 'regression' thins films by shear for the rheology 'carreau' only.")
        if self.film.name == "regression" and self.tribofilm.abrades:
            found.append(
                f"tribofilm.model = '{self.tribofilm.name}' feels local stresses; film.model = 'regression' knows "
                "their mean and takes them as exponentially distributed: within a factor of two to four."
            )
        return found


@lru_cache(maxsize=64)
def _unit_hertz(shape: Shape, reduced_modulus: float) -> Hertz:
    return shape.hertz(1.0, reduced_modulus)


def _radii(shape: Shape) -> list[tuple[str, float]]:
    """Names and values [m] of a shape's radii."""
    return [(name, getattr(shape, name)) for name in ("radius_x", "radius_y") if hasattr(shape, name)]


def with_bodies(scene: Scene, op: OperatingPoint, stored: tuple[float, float] | None) -> OperatingPoint:
    """The operating point with the bulk temperatures that the scene's law gives the bodies; `stored` are a state's."""
    inputs = (op.body_temperature_1, op.body_temperature_2)
    bulk = scene.heat.bulk
    if bulk.name == "oil" and inputs == (None, None):
        return op
    first, second = bulk.bodies(op.temperature, inputs, stored)
    return op if inputs == (first, second) else replace(op, body_temperature_1=first, body_temperature_2=second)


def tunables(scene: Scene) -> dict[str, tuple[float | int, "Field[Any]"]]:
    """Every number of the scene that changes no array's shape and is no input, by dotted name: (value, dataclass
    field).
    """
    parts = (
        "geometry",
        "solids",
        "surface_1",
        "surface_2",
        "lubricant",
        "plasticity",
        "boundary_friction",
        "heat",
        "tribofilm",
        "wear",
        "film",
        "control",
    )
    return {
        name: (value, f)
        for part in parts
        for name, value, f in numbers(getattr(scene, part), part)
        if name not in _INPUTS_ANYWAY
    }


def with_values(scene: Scene, values: Mapping[str, float | int]) -> Scene:
    """Return the scene with some of its `tunables` changed (SI), checked like a new one."""
    known = list(tunables(scene))
    for name in values:
        if name not in known:
            raise SceneError(f"'{name}' is not a number that can be changed in a scene.{did_you_mean(name, known)}")

    changed: Scene = with_numbers(scene, values)
    errors = changed.check()
    if errors:
        raise SceneError(" ".join(sentence for _, sentence in errors))
    return changed
