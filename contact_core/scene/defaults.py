"""What a scene that does not say otherwise has: laws switched off, usual numbers of the field, numerical settings.

Every default that a scene takes is listed as `Assumed`, but for those of fields in the records (film.tolerance). What a
data sheet and a drawing give has none, nor have the constants of a law that is chosen by its `model`.
"""

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, fields, replace
from typing import Any, NamedTuple

from ..errors import SceneError, did_you_mean
from ..laws.viscosity import AstmD341
from ..quantities import out_of_range
from .bases import USUAL, Base, base_of
from .finishes import (
    LAYS,
    LENGTH_PER_RQ,
    LONGEST,
    MOST_BELOW,
    ends_of_finish,
    longest_below,
    part_below,
    values_of_finish,
)
from .intervals import Ends, listed, of_sets
from .records import ACCURACY
from .toml import DATA_SHEET, models_of, with_named_set
from .units import parse


class Assumed(NamedTuple):
    """A value that a scene does not give."""

    key: str  # dotted; that of a table where a law is taken as a whole
    value: str  # as it would stand in the scene
    why: str  # where it comes from
    kind: str = "assumed"  # or "numerical": of how the contact is solved, or without effect on it; or "off"


_TABLES = (
    "geometry", "solids", "surface_1", "surface_2", "lubricant", "plasticity", "boundary_friction", "heat",
    "tribofilm", "wear", "film", "control", "operation",
)  # fmt: skip
_NO_LAW = "none"
_OFF = ("heat", "tribofilm", "wear")
_CHANGING = ("tribofilm", "wear", "oxide", "fatigue")  # with one of them surfaces change from pass to pass
_STEEL = "of steel in contact with steel, assumed as in the shipped scenes"
_NUMERICAL = "numerical"
_LAWS: dict[str, tuple[dict[str, Any], str, dict[str, Ends]]] = {
    "lubricant.density": ({"model": "dowson_higginson"}, "the usual law of mineral oils", {}),
    "lubricant.rheology": (
        {"model": "eyring", "eyring_stress": "5 MPa", "limiting_coefficient": 0.047},
        "a paraffinic mineral oil, Hoglund, Wear 232 (1999) 176; the stress is assumed",
        {"eyring_stress": ("3 MPa", "9 MPa"), "limiting_coefficient": (0.04, 0.061)},
    ),
    "boundary_friction": (
        {"model": "film_blend", "bare": 0.13, "film": 0.115, "slip_speed": "1 um/s"}, _STEEL,
        {"bare": (0.1, 0.15), "film": (0.09, 0.13)},
    ),
}  # fmt: skip
_PLASTICITY = {"set": "steel"}
_CONTROL = {"change": "3 nm", "input_change": 0.02}
_FLOOR = "1 nm"
_LENGTH = 8e-6  # m, of roughness: as in the shipped scenes
_HIGHEST = 1e-7  # m, microroughness that a scene which gives none may have, at most
_NO_LAYER = "lumped"  # film.criterion that microroughness does not go with
_REFERENCE = "40 degC"
# relative half widths of a family's bends, its Eyring stress, and the rise and bend of its conductivity
_BEND, _STRESS, _RISE = 0.2, 0.35, 0.2
_WAVES = 0.5  # relative half width of the longest wave of a finish's microroughness, as in the shipped scenes
_ROW, _STEADY = "60 s", "60 s"
_NAME = "contact"


def completed_by_defaults(table: Mapping[str, Any]) -> tuple[dict[str, Any], list[Assumed]]:
    """Return a scene's table with the values that it does not give, and a list of these.

    What has no default is left out; `toml.build` names it.
    """
    filling = _Filling(table)
    for part in _OFF:
        filling.give(part, _NO_LAW, "switched off", "off")
    _oil(filling)
    for part, (law, why, ends) in _LAWS.items():
        filling.give_law(part, law, why, ends)
    filling.give("plasticity", _PLASTICITY, "hardness of steel")
    for key, value in _CONTROL.items():
        if f"control.{key}" != "control.change" or not filling.has(ACCURACY):  # which chooses the changes itself
            filling.give(f"control.{key}", value, "of the blocks over time", _NUMERICAL)
    filling.give("film.model", "deterministic", "solved node by node", _NUMERICAL)
    if filling.needs("film", "floor"):
        why = "thickness of the adsorbed layer, assumed as in the shipped scenes"
        filling.give("film.floor", _FLOOR, why, ends=("0.5 nm", "2 nm"))
    _surfaces(filling)
    _bodies(filling)
    _duty(filling)
    filling.name()
    filling.list_intervals()
    return filling.table, filling.assumed


def told(assumed: Sequence[Assumed]) -> str:
    """Return a line on the values that a scene does not give, empty without any."""
    said = []
    for kind in ("assumed", "numerical", "off"):
        named = [each.key if kind == "off" else f"{each.key} {each.value}" for each in assumed if each.kind == kind]
        said += [f"{kind}: {', '.join(named)}"] if named else []
    return "; ".join(said)


class _Filling:
    """A scene's table that is being completed."""

    def __init__(self, table: Mapping[str, Any]) -> None:
        self.table: dict[str, Any] = copy.deepcopy(dict(table))
        self.assumed: list[Assumed] = []
        self.intervals: dict[str, Ends] = dict(of_sets(self.table))
        self.known = {key: _expanded(value, key) for key, value in self.table.items()}  # sets by their values

    def get(self, key: str) -> Any:
        """Return the value of a dotted key, in the table or in a named set; None: not there."""
        found: Any = self.known
        for part in key.split("."):
            found = found.get(part) if isinstance(found, Mapping) else None
        return found

    def take(self, key: str) -> Any:
        """Return the value of a dotted key, and take it out of the table; None: not there."""
        value = self.get(key)
        part, _, last = key.rpartition(".")
        for root in (self.table, self.known):
            if isinstance(root.get(part), dict):
                root[part].pop(last, None)
        return value

    def has(self, key: str) -> bool:
        """Return True if the table, or a set that it names, gives a dotted key."""
        return self.get(key) is not None

    def give(self, key: str, value: Any, why: str, kind: str = "assumed", ends: Ends | None = None) -> None:
        """Set a dotted key, and the interval of its value, unless it is there, or its table is no table."""
        if self.has(key):
            return
        *path, last = key.split(".")
        for root in (self.table, self.known):
            node = root
            for part in path:
                node = node.setdefault(part, {})
                if not isinstance(node, dict):
                    return
            node[last] = copy.deepcopy(value)
        self.assumed.append(Assumed(key, _text(value), why, kind))
        if ends is not None:
            self.intervals[key] = ends

    def give_law(self, path: str, law: Mapping[str, Any], why: str, ends: Mapping[str, Ends]) -> None:
        """Set a law, or the keys of it that a table of this law, or of no named one, leaves out; `ends` by key."""
        given = self.get(path)
        if given is None:
            self.give(path, dict(law), why)
            self.intervals |= {f"{path}.{key}": each for key, each in ends.items()}
        elif isinstance(given, Mapping) and given.get("model", law["model"]) == law["model"] and set(given) <= set(law):
            for key, value in law.items():
                self.give(f"{path}.{key}", value, why, ends=ends.get(key))

    def list_intervals(self) -> None:
        """Set the intervals of sets and defaults, which those of the scene itself replace, as a list."""
        own = self.table.get("intervals", {})
        if isinstance(own, Mapping):
            self.table["intervals"] = listed({**self.intervals, **own})

    def needs(self, part: str, field: str) -> bool:
        """Return True if the record that the table chooses has a field without a default of its own."""
        records = {record.name: record for record in models_of(part)}
        record = records.get(str(self.get(f"{part}.model")))
        return record is not None and any(f.name == field and f.default is MISSING for f in fields(record))

    def number(self, key: str, unit: str) -> float | None:
        """Return the value of a key in SI; None if it is not there, or no such quantity: reading it will say so."""
        try:
            return parse(self.get(key), unit, key)
        except SceneError:
            return None

    @property
    def layered(self) -> bool:
        """True unless the film's criterion does not go with roughness below the grid."""
        return bool(self.get("film.criterion") != _NO_LAYER)

    def acts(self, part: str) -> bool:
        """Return True if the table chooses a law other than 'none' for a slot."""
        given = self.get(part)
        return given is not None and (given.get("model") if isinstance(given, Mapping) else given) != _NO_LAW

    def taken(self, part: str) -> dict[str, Any]:
        """Return `finish` and `lay` of a surface and leave them out of its table, in which its set is written out."""
        surface = {key: value for key, value in self.known[part].items() if key not in ("finish", "lay")}
        said = {key: value for key, value in self.known[part].items() if key not in surface}
        self.known[part] = surface
        self.table[part] = copy.deepcopy(surface)
        return said

    def name(self) -> None:
        """Set name and description, and empty tables for those that are missing: their keys will be named."""
        self.table.setdefault("name", _NAME)
        for part in _TABLES:
            self.table.setdefault(part, {})
        said = [self.get(f"operation.{key}") for key in ("load", "speed_1", "speed_2", "temperature")]
        self.table.setdefault("description", f"{self.table['name']}: {', '.join(str(each) for each in said if each)}")


def _expanded(value: Any, path: str) -> Any:
    """Return a table with the values of its sets; a set that cannot be read is left for reading to refuse."""
    if not isinstance(value, Mapping):
        return value
    try:
        table = with_named_set(dict(value), path)
    except SceneError:
        table = dict(value)
    return {key: _expanded(item, f"{path}.{key}") for key, item in table.items()}


def _text(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(_text(item) if key in ("model", "set") else f"{key} {item}" for key, item in value.items())
    return str(value)


def _surfaces(filling: _Filling) -> None:
    for seed, part in enumerate(("surface_1", "surface_2"), 1):
        if filling.has(f"{part}.heights"):
            filling.give(f"{part}.rq", "0 nm", "the file of heights is all of the roughness")
        if filling.has(f"{part}.finish") or filling.has(f"{part}.lay"):
            _finish(filling, part)
        rq = filling.number(f"{part}.rq", "m")
        if filling.get(f"{part}.model") in (None, "gaussian"):
            length = max(_LENGTH, LENGTH_PER_RQ * (rq or 0.0))
            why = "without effect on a smooth body" if rq == 0.0 else "assumed: 8 um as in the shipped scenes, or 40 Rq"
            kind = _NUMERICAL if rq == 0.0 else "assumed"
            ends = None if rq == 0.0 else ("-50 %", "+100 %")
            filling.give(f"{part}.correlation_length", f"{1e6 * length:.4g} um", why, kind, ends)
        filling.give(f"{part}.seed", seed, "number of the random surface", _NUMERICAL)
        if filling.layered and rq and not filling.has(f"{part}.microroughness"):
            most = f"{1e9 * min(MOST_BELOW * rq, _HIGHEST):.3g} nm"
            filling.intervals.setdefault(f"{part}.microroughness.rms", ("0 nm", most))


def _refuse_beside_set(table: Mapping[str, Any], said: str) -> None:
    """Raise SceneError if a table takes a set: that gives all that something beside it would."""
    if "set" in table:
        raise SceneError(f"{said} has no effect beside set = '{table['set']}', which gives all of it. Leave one out.")


def _finish(filling: _Filling, part: str) -> None:
    """Set what the finish of a surface says, but for what the scene says itself."""
    measured, below = filling.has(f"{part}.heights"), filling.has(f"{part}.microroughness")
    if measured and below:
        _refuse_beside_set(filling.table[part], f"{part}.finish")
    said = filling.taken(part)
    lay = said.get("lay")
    if "finish" not in said or lay not in (None, *LAYS):
        raise SceneError(
            f"{part}.lay = {lay!r} must be 'along' or 'across' the motion, beside {part}.finish."
            f"{did_you_mean(str(lay), list(LAYS))}"
        )
    name = str(said["finish"]).lower()
    try:
        own, ends = values_of_finish(name), ends_of_finish(name)
    except SceneError as error:
        raise SceneError(f"{part}.finish: {error}") from None
    why = f"of a {name} surface: data/finishes.toml"
    filling.give(f"{part}.rq", own["rq"], why, ends=ends["rq"])
    rq, own_rq = filling.number(f"{part}.rq", "m") or 0.0, parse(own["rq"], "m", "rq")
    if rq == 0.0 and not measured and not below:  # smooth
        return
    longest = LONGEST
    if filling.get(f"{part}.model") in (None, "gaussian"):
        length = max(parse(own["correlation_length"], "m", "correlation_length"), LENGTH_PER_RQ * rq)
        along, across = (own["lay"] if lay == each and own["lay"] > 1 else 1.0 for each in LAYS)
        filling.give(
            f"{part}.correlation_length", f"{1e6 * along * length:.4g} um", why, ends=ends["correlation_length"]
        )
        if along != across:
            key = f"{part}.correlation_length_across"
            filling.give(key, f"{1e6 * across * length:.4g} um", why, ends=ends["correlation_length"])
        lengths = (filling.number(f"{part}.{key}", "m") for key in ("correlation_length", "correlation_length_across"))
        longest = longest_below(min(found for found in lengths if found))
    if not filling.layered:
        return
    rms = parse(own["microroughness"]["rms"], "m", "rms") * part_below(rq, own_rq) * math.sqrt(longest / LONGEST)
    filling.give(f"{part}.microroughness.rms", f"{1e9 * rms:.3g} nm", why, ends=ends["microroughness.rms"])
    filling.give(f"{part}.microroughness.longest", f"{1e6 * longest:.3g} um", why, ends=_either_way(_WAVES))


def _oil(filling: _Filling) -> None:
    """Set what a data sheet of an oil leaves out, by its family."""
    oil, named = "lubricant.viscosity", filling.take("lubricant.base")
    base, family = base_of(named or USUAL), f"of the base '{named}'" if named else "of a mineral oil, assumed"
    if filling.has(f"{oil}.viscosity_40") or filling.has(f"{oil}.viscosity_100"):
        filling.give(f"{oil}.model", AstmD341.name, "an oil by its data sheet", _NUMERICAL)
    if filling.get(f"{oil}.model") != AstmD341.name:
        if named:
            raise SceneError(f"lubricant.base = '{named}' goes with the data sheet of an oil: give {DATA_SHEET}.")
        return
    filling.give(f"{oil}.reference_temperature", _REFERENCE, "temperature of the pressure coefficient")
    before = len(filling.assumed)
    law = _of_sheet(filling, oil, base)
    if law is None:  # reading the data sheet will be refused
        filling.give(f"{oil}.pressure_coefficient", "0 GPa^-1", family)
        return
    why = f"{family} by its viscosities (Gold et al. 2001), {100.0 * base.interval:.0f} % either way"
    coefficient = f"{1e9 * law.pressure_coefficient:.4g} GPa^-1"
    filling.give(f"{oil}.pressure_coefficient", coefficient, why, ends=_either_way(base.interval))
    for name in ("bend_40", "bend_100"):
        filling.give(f"{oil}.{name}", float(f"{getattr(law, name):.3g}"), family, ends=_either_way(_BEND))
    stress = f"{1e-6 * base.eyring_stress(law):.3g} MPa"
    rheology = {
        "model": "eyring",
        "eyring_stress": stress,
        "limiting_coefficient": base.limiting_coefficient,
        "limiting_fall": f"{base.limiting_fall:g} K^-1",
    }
    falls = (f"{end:g} K^-1" for end in base.limiting_fall_interval)
    ends = {
        "eyring_stress": _either_way(_STRESS),
        "limiting_coefficient": base.limiting_interval,
        "limiting_fall": tuple(falls),
    }
    filling.give_law("lubricant.rheology", rheology, f"{family}; the stress is assumed", ends)
    conductivities = [f"{end:g} W/(m K)" for end in (base.conductivity, *base.conductivity_interval)]
    filling.give("lubricant.conductivity", conductivities[0], family, ends=(conductivities[1], conductivities[2]))
    for name in ("conductivity_rise", "conductivity_bend"):
        filling.give(f"lubricant.{name}", f"{getattr(base, name):g} GPa^-1", family, ends=_either_way(_RISE))
    if named and len(filling.assumed) == before:
        _refuse_beside_set(filling.table["lubricant"], f"lubricant.base = '{named}'")


def _either_way(share: float) -> Ends:
    return f"-{100.0 * share:g} %", f"+{100.0 * share:g} %"


def _of_sheet(filling: _Filling, oil: str, base: Base) -> AstmD341 | None:
    """Return the oil of a data sheet as a family has it; None if the sheet cannot be read."""
    units = {"viscosity_40": "m2/s", "viscosity_100": "m2/s", "density": "kg/m3", "reference_temperature": "K"}
    sheet = {name: filling.number(f"{oil}.{name}", unit) for name, unit in units.items()}
    numbers = {name: value for name, value in sheet.items() if value is not None}
    if len(numbers) < len(sheet):
        return None
    law = AstmD341(**numbers, pressure_coefficient=0.0)
    if list(out_of_range(law, oil)) or law.error:
        return None
    own = filling.number(f"{oil}.pressure_coefficient", "Pa^-1")
    law = base.oil(law)
    return law if own is None else replace(law, pressure_coefficient=own)


def _bodies(filling: _Filling) -> None:
    """Set what a ball on a flat leaves out, and tracks where nothing changes from pass to pass."""
    radius = filling.get("geometry.radius_x")
    if filling.get("geometry.model") in (None, "point"):
        filling.give("geometry.radius_y", radius or "1 m", "that of radius_x: a ball")
    if any(map(filling.acts, _CHANGING)):
        return
    around = 2.0 * math.pi * (filling.number("geometry.radius_x", "m") or 1.0)
    for body in (1, 2):
        why = "a ball's circumference: without wear and tribofilm nothing is kept from pass to pass"
        filling.give(f"geometry.track_length_{body}", f"{1e3 * around:.5g} mm", why, _NUMERICAL)


def _duty(filling: _Filling) -> None:
    """Set the duration of what does not change with time, and the time between rows."""
    changes = any(map(filling.acts, _CHANGING)) or filling.has("heat.bulk")
    if not changes and not filling.get("operation.steps") and not filling.get("operation.file"):
        filling.give("operation.duration", _STEADY, "nothing changes with time", _NUMERICAL)
    duration = filling.number("operation.duration", "s")
    row = filling.get("operation.duration") if duration is not None and duration < parse(_ROW, "s", "") else _ROW
    filling.give("operation.interval", row, "time between rows of the result", _NUMERICAL)
