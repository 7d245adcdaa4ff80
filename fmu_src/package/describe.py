"""What model descriptions of FMI 2.0 and 3.0 share: contents, units, types, attributes, dependencies."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from xml.etree import ElementTree as ET

import pythonfmu

import contact_core
from contact_core.assumed import LEAST, assumed
from contact_core.assumed import text as half_width
from contact_core.errors import ContactError
from contact_core.quantities import CELSIUS, measured
from contact_core.scene import Scene, units

from ..flavours import Flavour, Version
from ..native.built_in import native_variables
from ..runtime.guarded import LOG_CATEGORIES
from ..runtime.resources import MODEL, guid
from ..variables import Value, Variable, variables
from . import licences
from .usable import usable

INITIAL = {"parameter": "exact", "output": "calculated"}  # other causalities have one kind, which is left out


@dataclass(frozen=True)
class Model:
    """Contents of a model description except its variables."""

    name: str
    guid: str
    text: str
    experiment: Mapping[str, float]  # startTime, stopTime, stepSize, tolerance


@dataclass(frozen=True)
class Unknown:
    """One output and the variables on which it depends, all as positions in the table; None: on every known."""

    position: int
    depends: tuple[int, ...] | None


def described(scene: Scene, flavour: Flavour, version: Version = 2) -> Model:
    """Return the contents for the FMU of a scene; `version` is FMI's."""
    experiment = {"startTime": 0.0, "stopTime": scene.operation.duration, "stepSize": scene.operation.interval}
    if scene.film.tolerance is not None:
        experiment["tolerance"] = scene.film.tolerance
    return Model(MODEL, guid(scene, flavour, version), scene.description, experiment)


def variables_of(scene: Scene, flavour: Flavour) -> tuple[Variable, ...]:
    """Return the variables that the FMU of a scene describes; their order is that of the value references."""
    table = native_variables(scene) if flavour == "native" else variables(scene)
    return with_assumptions(scene, usable(scene, table))


def value_text(value: Value) -> str:
    """Return the text of a value that reads back to the same bits."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def document(root: ET.Element) -> bytes:
    """Return the XML file of an element and all below it."""
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


# the root element


def origin(model: Model, flavour: Flavour) -> dict[str, str]:
    """Return the root's attributes that tell what the FMU is and where it comes from."""
    tool = f"tribofmu {contact_core.__version__}"
    return {
        "description": model.text,
        **licences.owner(),
        "version": contact_core.__version__,
        "generationTool": tool if flavour == "native" else f"{tool} with pythonfmu {pythonfmu.__version__}",
        "variableNamingConvention": "structured",
    }


def add_units(root: ET.Element, table: Iterable[Variable]) -> None:
    """Add every unit in use, as exponents of the SI base units, with its display units."""
    displays: dict[str, set[str]] = {}
    for variable in table:
        if variable.kind == "Real":
            displays.setdefault(_unit_name(variable), set()).update({variable.display} - {""})
    definitions = ET.SubElement(root, "UnitDefinitions")
    for name in sorted(displays):
        factor, (metre, kilogram, second, kelvin, radian) = units.unit(name)
        exponents = {"kg": kilogram, "m": metre, "s": second, "K": kelvin, "rad": radian}
        unit = ET.SubElement(definitions, "Unit", {"name": name})
        base = ET.SubElement(unit, "BaseUnit", {key: str(n) for key, n in exponents.items() if n})
        if factor != 1.0:
            base.set("factor", value_text(factor))
        for display in sorted(displays[name]):
            ET.SubElement(unit, "DisplayUnit", {"name": display, **_conversion(display)})


def add_log_categories(root: ET.Element) -> None:
    categories = ET.SubElement(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        ET.SubElement(categories, "Category", {"name": name, "description": text})


def add_experiment(root: ET.Element, model: Model) -> None:
    ET.SubElement(root, "DefaultExperiment", {name: value_text(value) for name, value in model.experiment.items()})


def _unit_name(variable: Variable) -> str:
    return variable.unit or "1"


def _conversion(display: str) -> dict[str, str]:
    """Return the attributes of display value = factor * SI value + offset."""
    if display == "degC":
        return {"offset": f"{-CELSIUS}"}
    return {"factor": f"{1.0 / units.unit(display)[0]:.15g}"}


# types and variables


def quantities(table: Iterable[Variable]) -> dict[str, dict[str, str]]:
    """Return name and attributes of every kind of physical quantity in use, sorted by name."""
    alike: dict[str, list[Variable]] = {}
    for variable in table:
        if variable.quantity:
            alike.setdefault(variable.quantity, []).append(variable)
    return {name: _of_quantity(name, alike[name]) for name in sorted(alike)}


def _of_quantity(name: str, alike: Sequence[Variable]) -> dict[str, str]:
    """Return the attributes common to variables of one quantity."""
    (unit,) = {_unit_name(v) for v in alike}
    (relative,) = {v.relative for v in alike}
    common = {"quantity": measured(unit) if relative else name, "unit": unit}
    displays = {v.display for v in alike}
    if len(displays) == 1 and (display := displays.pop()):
        common["displayUnit"] = display
    return common | ({"relativeQuantity": "true"} if relative else {})


def role(reference: int, variable: Variable) -> dict[str, str]:
    """Return the attributes that variables of every kind have."""
    attributes = {
        "name": variable.name,
        "valueReference": str(reference),
        "description": variable.text,
        "causality": variable.causality,
        "variability": variable.variability,
    }
    if initial := INITIAL.get(variable.causality):
        attributes["initial"] = initial
    return attributes


def numeric(variable: Variable) -> dict[str, str]:
    """Return the attributes on quantity, unit, range and nominal."""
    found: dict[str, str] = {}
    if variable.quantity:
        found["declaredType"] = variable.quantity
    if variable.kind == "Real":
        found["unit"] = _unit_name(variable)
        if variable.display:
            found["displayUnit"] = variable.display
        if variable.relative:
            found["relativeQuantity"] = "true"
    for name, bound in (("min", variable.minimum), ("max", variable.maximum)):
        if math.isfinite(bound) and variable.kind in ("Real", "Integer"):
            found[name] = str(int(bound)) if variable.kind == "Integer" else value_text(float(bound))
    if variable.nominal is not None:
        found["nominal"] = value_text(variable.nominal)
    return found


# dependencies


def outputs(table: Sequence[Variable]) -> list[Unknown]:
    """Return on what outputs depend between steps: on the state and on the inputs that each names."""
    place = _places(table)
    return [Unknown(place[v.name], _sorted(place[known] for known in v.direct)) for v in _outputs(table)]


def initial_unknowns(table: Sequence[Variable]) -> list[Unknown]:
    """Return on what outputs depend at the start: on all that can be set, for which FMI needs no list, or on part."""
    place, every = _places(table), [v.name for v in table if v.has_start]
    known = {v.name: _at_start(v, table) for v in _outputs(table)}
    return [
        Unknown(place[name], None if names == every else _sorted(place[known] for known in names))
        for name, names in known.items()
    ]


def _places(table: Sequence[Variable]) -> dict[str, int]:
    return {v.name: place for place, v in enumerate(table)}


def _outputs(table: Sequence[Variable]) -> list[Variable]:
    return [v for v in table if v.causality == "output"]


def _sorted(places: Iterable[int]) -> tuple[int, ...]:
    return tuple(sorted({*places}))


def _at_start(output: Variable, table: Sequence[Variable]) -> list[str]:
    """Return the inputs and parameters on which the first value of an output depends."""
    inputs = None if output.at_start is None else {*output.direct, *output.at_start}
    return [
        v.name
        for v in table
        if v.causality == "parameter" or (v.causality == "input" and (inputs is None or v.name in inputs))
    ]


def dependencies(depends: tuple[int, ...] | None, first: int) -> dict[str, str]:
    """Return the attributes of an unknown; the table's first variable has the number `first`."""
    if depends is None:
        return {}
    known = [str(first + place) for place in depends]
    return {"dependencies": " ".join(known), "dependenciesKind": " ".join(["dependent"] * len(known))}


def with_assumptions(scene: Scene, table: Iterable[Variable]) -> tuple[Variable, ...]:
    """Return the variables with the half widths by what the scene assumes, at its own operating point, in words."""
    try:
        worth = assumed(scene, scene.operation.point)
    except ContactError:  # the regression level has no answer there
        return tuple(table)
    halves = {name: half_width(name, each.together) for name, each in worth.items() if each.together >= LEAST[name]}
    return tuple(replace(v, text=f"{v.text}{_words(v, halves)}") for v in table)


def _words(variable: Variable, halves: dict[str, str]) -> str:
    output = variable.name.removesuffix("_1").removesuffix("_2")
    if variable.causality != "output" or output not in halves:
        return ""
    return f"; by what the scene assumes +- {halves[output]} at its own operating point"
