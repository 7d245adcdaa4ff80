"""What a contact is and which physics it needs: frozen records read from TOML, checked before anything is computed."""

import difflib
import hashlib
import json
import math
import tomllib
from collections.abc import Mapping
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Any, get_type_hints

from . import units
from .errors import OperatingPointError, SceneError
from .film import FILMS, Deterministic
from .laws import SLOTS
from .laws.boundary_friction import FilmBlend
from .laws.density import DowsonHigginson, Incompressible
from .laws.heat import FlashTemperature, NoHeat
from .laws.plasticity import ElasticPerfectlyPlastic
from .laws.rheology import EyringLimited
from .laws.tribofilm import Ghanbarzadeh, NoTribofilm
from .laws.viscosity import Barus, Roelands
from .laws.wear import Archard, NoWear
from .quantities import INPUTS, out_of_range, parameter
from .reference import Hertz, hertz_point


@dataclass(frozen=True)
class Geometry:
    """Undeformed shape and the way a surface point travels between two passes through the contact."""

    radius_x: float = parameter("m", "combined radius of curvature along x", above=0.0, most=100.0)
    radius_y: float = parameter("m", "combined radius of curvature along y", above=0.0, most=100.0)
    track_length_1: float = parameter("m", "travel of a point of body 1 between two passes", above=0.0, most=1e3)
    track_length_2: float = parameter("m", "travel of a point of body 2 between two passes", above=0.0, most=1e3)


@dataclass(frozen=True)
class Solids:
    """Elasticity of the pair."""

    reduced_modulus: float = parameter("Pa", "E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2]", above=1e3, most=1e13)


@dataclass(frozen=True)
class Surface:
    """Roughness of one body: Gaussian heights, autocorrelation rq^2 exp(-(r/correlation_length)^2). rq = 0 is smooth."""

    rq: float = parameter("m", "rms roughness", least=0.0, most=1e-4)
    correlation_length: float = parameter("m", "correlation length", above=0.0, most=1.0, shapes_arrays=True)
    seed: int = parameter("", "number of the realisation", least=0, most=2**31 - 1)


@dataclass(frozen=True)
class Lubricant:
    """The oil."""

    viscosity: Roelands | Barus
    density: DowsonHigginson | Incompressible
    rheology: EyringLimited


@dataclass(frozen=True)
class Control:
    """How the evolution over time is cut into blocks, in each of which the contact is solved once."""

    change: float = parameter("m", "largest change of film or wear in a block, as rms over the track", above=0.0, most=1e-6)
    dry_above: float = parameter("", "contact_load_ratio above which dry pressures drive the blocks", least=0.0, most=2.0)
    input_change: float = parameter("", "relative change of an input that asks for a new solution", least=0.0, most=1.0)


@dataclass(frozen=True)
class OperatingPoint:
    """What is asked of the contact in one step."""

    load: float = parameter("N", "normal load", least=0.0, most=1e6)
    speed_1: float = parameter("m/s", "surface speed of body 1 along x", least=-1e3, most=1e3)
    speed_2: float = parameter("m/s", "surface speed of body 2 along x", least=-1e3, most=1e3)
    temperature: float = parameter("K", "oil temperature", least=200.0, most=600.0)

    @property
    def entrainment_speed(self) -> float:
        """u_e = (u1 + u2) / 2 [m/s]."""
        return 0.5 * (self.speed_1 + self.speed_2)

    @property
    def sliding_speed(self) -> float:
        """u_s = u1 - u2 [m/s]."""
        return self.speed_1 - self.speed_2

    def check(self) -> None:
        """Raise OperatingPointError with one sentence for each value that cannot be used."""
        sentences = list(out_of_range(self, ""))
        if sentences:
            raise OperatingPointError(" ".join(sentences))


@dataclass(frozen=True)
class Operation:
    """The duty shipped with a scene: its point of reference, how long, and a table of changes if there are any."""

    load: float = parameter("N", "normal load", above=0.0, most=1e6)
    speed_1: float = parameter("m/s", "surface speed of body 1 along x", least=-1e3, most=1e3)
    speed_2: float = parameter("m/s", "surface speed of body 2 along x", least=-1e3, most=1e3)
    temperature: float = parameter("K", "oil temperature", least=200.0, most=600.0)
    duration: float = parameter("s", "test time", above=0.0, most=1e9)
    interval: float = parameter("s", "communication step: time between two rows of the result", above=0.0, most=1e9)
    largest_load: float = parameter("N", "largest load of the duty; 0: the load above", least=0.0, most=1e6, default=0.0)
    file: str = parameter("", "CSV of the duty; empty: constant", default="")

    @property
    def point(self) -> OperatingPoint:
        """The operating point of reference."""
        return OperatingPoint(self.load, self.speed_1, self.speed_2, self.temperature)


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
    heat: NoHeat | FlashTemperature
    tribofilm: NoTribofilm | Ghanbarzadeh
    wear: NoWear | Archard
    film: Deterministic
    control: Control
    operation: Operation

    @staticmethod
    def from_toml(source: str | Path, overrides: Mapping[str, str] | None = None) -> "Scene":
        """Read a shipped scene by name or a TOML file by path; `overrides` maps dotted keys to new values.

        Raises SceneError with every sentence that says what is wrong and what would be right.
        """
        table = read_table(source)
        for key, value in (overrides or {}).items():
            _override(table, key, value)
        return Scene.from_dict(table)

    @staticmethod
    def from_dict(table: Mapping[str, Any]) -> "Scene":
        """Build and check a scene from nested tables as TOML gives them."""
        scene: Scene = _build(Scene, dict(table), "")
        errors = scene.check()
        if errors:
            raise SceneError(" ".join(sentence for _, sentence in errors))
        return scene

    def to_dict(self) -> dict[str, Any]:
        """Nested tables, from which `from_dict` makes an equal scene, bit for bit."""
        return _unbuild(self)

    def hertz(self, load: float) -> Hertz:
        """Hertz's contact of the smooth, dry bodies at a load [N] above zero."""
        return hertz_point(load, self.geometry.radius_x, self.geometry.radius_y, self.solids.reduced_modulus)

    @property
    def largest_load(self) -> float:
        """Largest load [N] that the scene's grid has to hold."""
        return max(self.operation.largest_load, self.operation.load)

    def digest(self) -> str:
        """Fingerprint of what a stored state depends on: shape, surfaces and grid."""
        table = self.to_dict()
        parts = {key: table[key] for key in ("geometry", "surface_1", "surface_2")}
        parts["grid"] = [self.film.points, self.film.domain]
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:16]

    def check(self) -> list[tuple[str, str]]:
        """Return (rule, sentence) for everything that makes the scene unusable."""
        found = [("range", sentence) for sentence in out_of_range(self, "")]
        if found:
            return found
        hertz, half = self.hertz(self.largest_load), 0.5 * self.film.domain
        if half < 1.2 * max(hertz.a, hertz.b):
            found.append(("domain", (
                f"film.domain = {self.film.domain:g} m is too small: at {self.largest_load:g} N the Hertz contact is "
                f"{2 * hertz.a:.3g} m by {2 * hertz.b:.3g} m. Use at least {2.9 * max(hertz.a, hertz.b):.2g} m.")))
        if hertz.pressure_max >= self.plasticity.hardness:
            found.append(("hardness", (
                f"The Hertz pressure at {self.largest_load:g} N is {hertz.pressure_max:.3g} Pa, above plasticity.hardness = "
                f"{self.plasticity.hardness:g} Pa. Lower the load or raise the hardness.")))
        if self.plasticity.film_hardness > self.plasticity.hardness:
            found.append(("hardness", (
                f"plasticity.film_hardness = {self.plasticity.film_hardness:g} Pa is above plasticity.hardness = "
                f"{self.plasticity.hardness:g} Pa; a tribofilm softer than its solid is assumed.")))
        for name, surface in (("surface_1", self.surface_1), ("surface_2", self.surface_2)):
            nodes = surface.correlation_length / self.film.spacing
            if surface.rq > 0.0 and nodes < 1.0 - 1e-9:
                found.append(("resolution", (
                    f"{name}.correlation_length = {surface.correlation_length:g} m is {nodes:.2f} nodes of the grid; at least 1 "
                    f"is needed. Use film.points = {1 + math.ceil(self.film.domain / surface.correlation_length)} or more, or a "
                    f"longer correlation length.")))
        return found

    def warnings(self) -> list[str]:
        """Return sentences on what can be computed but is not resolved well."""
        found = []
        for name, surface in (("surface_1", self.surface_1), ("surface_2", self.surface_2)):
            nodes = surface.correlation_length / self.film.spacing
            if surface.rq > 0.0 and nodes < 2.0 - 0.06:  # 8 um on 129 nodes over 0.5 mm is 2.05, over 0.53 mm 1.93
                found.append(f"{name} has {nodes:.2f} nodes per correlation length; 2 or more resolve it.")
        if not self.tribofilm.covers(self.operation.temperature):
            found.append(f"The tribofilm's constants were fitted at another temperature than {self.operation.temperature:g} K.")
        return found


def shipped_scenes() -> dict[str, str]:
    """Names and descriptions of the scenes that come with the package."""
    folder = files(__package__) / "data" / "scenes"
    tables = {p.name.removesuffix(".toml"): p for p in folder.iterdir() if p.name.endswith(".toml")}
    return {name: str(tomllib.loads(tables[name].read_text("utf-8"))["description"]) for name in sorted(tables)}


def read_table(source: str | Path) -> dict[str, Any]:
    """Read a scene's TOML by name or path, as nested tables."""
    shipped = files(__package__) / "data" / "scenes" / f"{source}.toml"
    path = Path(source)
    try:
        if path.suffix == ".toml":
            text = path.read_text("utf-8")
        elif shipped.is_file():
            text = shipped.read_text("utf-8")
        else:
            names = list(shipped_scenes())
            raise SceneError(f"There is no scene '{source}'.{_did_you_mean(str(source), names)} Shipped are "
                             f"{', '.join(names)}; or give the path of a .toml file.")
        return tomllib.loads(text)
    except OSError as error:
        raise SceneError(f"The scene file '{source}' cannot be read: {error.strerror}.") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SceneError(f"The scene file '{source}' is not valid TOML: {error}.") from None


def _did_you_mean(word: str, choices: list[str]) -> str:
    close = difflib.get_close_matches(word, choices, n=1, cutoff=0.5)
    return f" Did you mean '{close[0]}'?" if close else ""


def _override(table: dict[str, Any], key: str, value: str) -> None:
    """Set a dotted key; a new `model` drops the parameters of the old one."""
    *path, last = key.split(".")
    for part in path:
        table = table.setdefault(part, {})
        if not isinstance(table, dict):
            raise SceneError(f"'{key}' cannot be set: '{part}' is a value, not a table.")
    if last == "model" and table.get("model") != value:
        table.clear()
    table[last] = value


def _build(cls: type, table: Any, path: str) -> Any:
    """Make a record of `cls` from a table; every complaint names the table and the key."""
    if not isinstance(table, Mapping):
        raise SceneError(f"[{path}] must be a table.")
    table = _with_named_set(dict(table), path)
    known, hints = {f.name: f for f in fields(cls)}, get_type_hints(cls)
    for key in table:
        if key not in known:
            where = f"[{path}]" if path else "The scene"
            raise SceneError(f"{where} has no key '{key}'.{_did_you_mean(key, list(known))} Known are {', '.join(known)}.")
    values = {}
    for name, f in known.items():
        full = f"{path}.{name}" if path else name
        if name not in table and f.default is not MISSING:
            continue
        if name not in table:
            raise SceneError(f"'{full}' is missing. {_hint(f)}")
        values[name] = _value(hints[name], table[name], full, f)
    return cls(**values)


def _value(hint: Any, raw: Any, full: str, f: "Field[Any]") -> Any:
    slot = full.rpartition(".")[2]
    models = None if f.metadata else SLOTS.get(slot) or (FILMS if slot == "film" else None)
    if models:
        return _build_law(models, raw, full)
    if is_dataclass(hint):
        return _build(hint, raw, full)  # type: ignore[arg-type]
    if hint is float:
        return units.parse(raw, f.metadata["unit"], full)
    if hint is int:
        number = units.parse(raw, "", full)
        if number != int(number):
            raise SceneError(f"{full} = {raw!r} must be a whole number.")
        return int(number)
    if not isinstance(raw, str):
        raise SceneError(f"{full} = {raw!r} must be text in quotes.")
    return raw


def _build_law(models: tuple[type, ...], raw: Any, path: str) -> Any:
    if not isinstance(raw, Mapping):
        raise SceneError(f"[{path}] must be a table with a 'model'.")
    table, names = _with_named_set(dict(raw), path), {m.name: m for m in models}  # type: ignore[attr-defined]
    model = table.pop("model", None)
    if model not in names:
        said = f"has no model '{model}'." + _did_you_mean(str(model), list(names)) if model else "needs a 'model'."
        raise SceneError(f"[{path}] {said} Known are {', '.join(names)}.")
    return _build(names[model], table, path)


_SET_FILES = {"lubricant": "lubricants", "solids": "solids", "heat": "solids", "plasticity": "solids",
              "tribofilm": "tribofilms"}


def _with_named_set(table: dict[str, Any], path: str) -> dict[str, Any]:
    """Replace `set = "name"` by the named values of data/*.toml; keys written beside it win."""
    name = table.pop("set", None)
    if name is None:
        return table
    if path not in _SET_FILES:
        raise SceneError(f"[{path}] has no named sets. Known are sets for {', '.join(_SET_FILES)}.")
    data = tomllib.loads((files(__package__) / "data" / f"{_SET_FILES[path]}.toml").read_text("utf-8"))
    sets = {key: value[path] for key, value in data.items() if isinstance(value.get(path), dict)}
    if name not in sets:
        raise SceneError(f"[{path}] has no set '{name}'.{_did_you_mean(str(name), list(sets))} Known are {', '.join(sets)}.")
    return _merged(sets[name], table)


def _merged(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    merged = dict(base)
    for key, value in over.items():
        both = isinstance(value, Mapping) and isinstance(merged.get(key), Mapping)
        merged[key] = _merged(merged[key], value) if both else value
    return merged


def _hint(f: "Field[Any]") -> str:
    if "unit" not in f.metadata:
        return "Add the table."
    return f"It is the {f.metadata['text']}" + (f" [{f.metadata['unit']}]." if f.metadata["unit"] else ".")


def _unbuild(record: Any) -> dict[str, Any]:
    table: dict[str, Any] = {"model": record.name} if type(record) in _all_models() else {}
    for f in fields(record):
        value = getattr(record, f.name)
        if is_dataclass(value):
            table[f.name] = _unbuild(value)
        elif isinstance(value, float) and f.metadata["unit"]:
            table[f.name] = f"{value!r} {f.metadata['unit']}"
        else:
            table[f.name] = value
    return table


def _all_models() -> set[type]:
    return {model for models in (*SLOTS.values(), FILMS) for model in models}



def tunables(scene: Scene) -> dict[str, tuple[float | int, "Field[Any]"]]:
    """Every number of the scene that changes no array's shape, by dotted name: (value, dataclass field)."""
    found: dict[str, tuple[float | int, Field[Any]]] = {}

    def visit(record: Any, path: str) -> None:
        for f in fields(record):
            value, name = getattr(record, f.name), f"{path}.{f.name}" if path else f.name
            if is_dataclass(value):
                visit(value, name)
            elif isinstance(value, (int, float)) and not f.metadata["shapes_arrays"]:
                found[name] = (value, f)

    for part in ("geometry", "solids", "surface_1", "surface_2", "lubricant", "plasticity", "boundary_friction", "heat",
                 "tribofilm", "wear", "film", "control"):
        visit(getattr(scene, part), part)
    return found


def with_values(scene: Scene, values: Mapping[str, float | int]) -> Scene:
    """Return the scene with some of its `tunables` changed (SI), checked like a new one."""
    known = list(tunables(scene))
    for name in values:
        if name not in known:
            raise SceneError(f"'{name}' is not a number that can be changed in a scene.{_did_you_mean(name, known)}")

    def rebuild(record: Any, path: str) -> Any:
        changes = {}
        for f in fields(record):
            name = f"{path}.{f.name}" if path else f.name
            if is_dataclass(getattr(record, f.name)):
                changes[f.name] = rebuild(getattr(record, f.name), name)
            elif name in values:
                changes[f.name] = values[name]
        return replace(record, **changes)

    changed: Scene = rebuild(scene, "")
    errors = changed.check()
    if errors:
        raise SceneError(" ".join(sentence for _, sentence in errors))
    return changed
