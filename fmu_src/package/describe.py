"""modelDescription.xml: variables, units, structure and capabilities."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree as ET

import pythonfmu

import contact_core
from contact_core.quantities import measured
from contact_core.scene import Scene, units

from ..flavours import Flavour
from ..runtime.guarded import LOG_CATEGORIES
from ..runtime.resources import MODEL, guid
from ..variables import Value, Variable

_CAPABILITIES = {
    "canHandleVariableCommunicationStepSize": True,
    "canInterpolateInputs": False,
    "canBeInstantiatedOnlyOncePerProcess": False,
    "canNotUseMemoryManagementFunctions": True,
    "canGetAndSetFMUstate": True,
    "canSerializeFMUstate": True,
}
_INITIAL = {"parameter": "exact", "output": "calculated"}  # other causalities have one kind, which is left out


@dataclass(frozen=True)
class Model:
    """Contents of a model description beside variables."""

    name: str
    guid: str
    text: str
    experiment: Mapping[str, float]  # startTime, stopTime, stepSize, tolerance


def described(scene: Scene, flavour: Flavour) -> Model:
    """Return the contents for the FMU of a scene."""
    experiment = {"startTime": 0.0, "stopTime": scene.operation.duration, "stepSize": scene.operation.interval}
    if scene.film.tolerance is not None:
        experiment["tolerance"] = scene.film.tolerance
    return Model(MODEL, guid(scene, flavour), scene.description, experiment)


def xml(model: Model, table: Sequence[Variable], flavour: Flavour) -> bytes:
    """Return the model description; variables are in order of value references. Equal arguments give equal bytes."""
    root = ET.Element(
        "fmiModelDescription",
        {
            "fmiVersion": "2.0",
            "modelName": model.name,
            "guid": model.guid,
            "description": model.text,
            "version": contact_core.__version__,
            "generationTool": f"tribofmu {contact_core.__version__} with pythonfmu {pythonfmu.__version__}",
            "variableNamingConvention": "structured",
        },
    )
    ET.SubElement(
        root,
        "CoSimulation",
        {
            "modelIdentifier": model.name,
            # An isolated FMU starts the process it needs by itself. An embedded one needs a host in Python.
            "needsExecutionTool": _text(flavour == "embedded"),
            **{name: _text(value) for name, value in _CAPABILITIES.items()},
        },
    )
    _units(root, table)
    _types(root, table)
    categories = ET.SubElement(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        ET.SubElement(categories, "Category", {"name": name, "description": text})
    ET.SubElement(root, "DefaultExperiment", {name: _text(value) for name, value in model.experiment.items()})
    listed = ET.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(table):
        listed.append(_scalar_variable(reference, variable))
    _structure(root, table)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _text(value: Value) -> str:
    """Return the text of a value that reads back to the same bits."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _unit_name(variable: Variable) -> str:
    return variable.unit or "1"


def _units(root: ET.Element, table: Iterable[Variable]) -> None:
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
            base.set("factor", _text(factor))
        for display in sorted(displays[name]):
            ET.SubElement(unit, "DisplayUnit", {"name": display, **_conversion(display)})


def _types(root: ET.Element, table: Iterable[Variable]) -> None:
    """Add every kind of physical quantity in use."""
    alike: dict[str, list[Variable]] = {}
    for variable in table:
        if variable.quantity:
            alike.setdefault(variable.quantity, []).append(variable)
    definitions = ET.SubElement(root, "TypeDefinitions")
    for name in sorted(alike):
        simple = ET.SubElement(definitions, "SimpleType", {"name": name})
        ET.SubElement(simple, "Real", _of_quantity(name, alike[name]))


def _of_quantity(name: str, alike: Sequence[Variable]) -> dict[str, str]:
    """Return the attributes common to variables of one quantity."""
    (unit,) = {_unit_name(v) for v in alike}
    (relative,) = {v.relative for v in alike}
    common = {"quantity": measured(unit) if relative else name, "unit": unit}
    displays = {v.display for v in alike}
    if len(displays) == 1 and (display := displays.pop()):
        common["displayUnit"] = display
    return common | ({"relativeQuantity": "true"} if relative else {})


def _conversion(display: str) -> dict[str, str]:
    """Return the attributes of display value = factor * SI value + offset."""
    if display == "degC":
        return {"offset": "-273.15"}
    return {"factor": f"{1.0 / units.unit(display)[0]:.15g}"}


def _scalar_variable(reference: int, variable: Variable) -> ET.Element:
    attributes = {
        "name": variable.name,
        "valueReference": str(reference),
        "description": variable.text,
        "causality": variable.causality,
        "variability": variable.variability,
    }
    if initial := _INITIAL.get(variable.causality):
        attributes["initial"] = initial
    element = ET.Element("ScalarVariable", attributes)
    typed = ET.SubElement(element, variable.kind)
    if variable.quantity:
        typed.set("declaredType", variable.quantity)
    if variable.kind == "Real":
        typed.set("unit", _unit_name(variable))
        if variable.display:
            typed.set("displayUnit", variable.display)
        if variable.relative:
            typed.set("relativeQuantity", "true")
    for name, bound in (("min", variable.minimum), ("max", variable.maximum)):
        if math.isfinite(bound) and variable.kind in ("Real", "Integer"):
            typed.set(name, str(int(bound)) if variable.kind == "Integer" else _text(float(bound)))
    if variable.nominal is not None:
        typed.set("nominal", _text(variable.nominal))
    if variable.has_start:
        typed.set("start", _text(variable.start))
    return element


def _structure(root: ET.Element, table: Sequence[Variable]) -> None:
    """Add the dependencies of outputs.

    Between steps an output depends on the state and on the inputs it names; at the start on everything that can be set,
    for which FMI needs no list, or on part of it.
    """
    index = {v.name: i for i, v in enumerate(table, 1)}
    outputs = [v for v in table if v.causality == "output"]
    every = [v.name for v in table if v.has_start]
    structure = ET.SubElement(root, "ModelStructure")
    for name in ("Outputs", "InitialUnknowns"):
        listed = ET.SubElement(structure, name)
        for v in outputs:
            depends = v.direct if name == "Outputs" else _at_start(v, table)
            unknown = ET.SubElement(listed, "Unknown", {"index": str(index[v.name])})
            if name == "Outputs" or depends != every:
                unknown.attrib |= _dependencies(sorted({index[known] for known in depends}))


def _at_start(output: Variable, table: Sequence[Variable]) -> list[str]:
    """Return the inputs and parameters on which the first value of an output depends."""
    inputs = None if output.at_start is None else {*output.direct, *output.at_start}
    return [
        v.name
        for v in table
        if v.causality == "parameter" or (v.causality == "input" and (inputs is None or v.name in inputs))
    ]


def _dependencies(indices: Iterable[int]) -> dict[str, str]:
    known = list(map(str, indices))
    return {"dependencies": " ".join(known), "dependenciesKind": " ".join(["dependent"] * len(known))}
