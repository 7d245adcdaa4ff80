"""modelDescription.xml of FMI 3.0 for co-simulation."""

from collections.abc import Iterable, Sequence
from xml.etree import ElementTree as ET

from ..flavours import Flavour
from ..variables import Kind, Variable
from . import describe
from .describe import Model, value_text

VERSION = "3.0"
_TYPES: dict[Kind, str] = {"Real": "Float64", "Integer": "Int32", "Boolean": "Boolean", "String": "String"}
_CAPABILITIES = {
    "needsExecutionTool": False,
    "canBeInstantiatedOnlyOncePerProcess": False,
    "canGetAndSetFMUState": True,
    "canSerializeFMUState": True,
    "canHandleVariableCommunicationStepSize": True,
}
_FURTHER: dict[Flavour, dict[str, bool]] = {  # the attributes of FMI 3.0 are false by default
    "isolated": {},
    "native": {
        "providesDirectionalDerivatives": True,
        "providesAdjointDerivatives": True,
        "providesIntermediateUpdate": True,
        "canReturnEarlyAfterIntermediateUpdate": True,
    },
}


def description(model: Model, table: Sequence[Variable], flavour: Flavour) -> bytes:
    """Return modelDescription.xml; variables are in order of value references. Equal arguments give equal bytes."""
    root = ET.Element(
        "fmiModelDescription",
        {
            "fmiVersion": VERSION,
            "modelName": model.name,
            "instantiationToken": model.guid,
            **describe.origin(model, flavour),
        },
    )
    capabilities = _CAPABILITIES | _FURTHER[flavour]
    ET.SubElement(
        root,
        "CoSimulation",
        {"modelIdentifier": model.name, **{name: value_text(value) for name, value in capabilities.items()}},
    )
    describe.add_units(root, table)
    _types(root, table)
    describe.add_log_categories(root)
    describe.add_experiment(root, model)
    listed = ET.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(table):
        listed.append(_variable(reference, variable, capabilities.get("providesIntermediateUpdate", False)))
    _structure(root, table)
    return describe.document(root)


def _types(root: ET.Element, table: Iterable[Variable]) -> None:
    """Add every kind of physical quantity in use."""
    definitions = ET.SubElement(root, "TypeDefinitions")
    for name, attributes in describe.quantities(table).items():
        ET.SubElement(definitions, "Float64Type", {"name": name, **attributes})


def _variable(reference: int, variable: Variable, updates: bool) -> ET.Element:
    """Return the element of a variable; `updates`: outputs can be read in intermediate updates."""
    attributes = describe.role(reference, variable) | describe.numeric(variable)
    if updates and variable.causality == "output":
        attributes["intermediateUpdate"] = "true"
    element = ET.Element(_TYPES[variable.kind], attributes)
    if variable.has_start and variable.kind == "String":
        ET.SubElement(element, "Start", {"value": str(variable.start)})
    elif variable.has_start:
        element.set("start", value_text(variable.start))
    return element


def _structure(root: ET.Element, table: Sequence[Variable]) -> None:
    """Add the dependencies of outputs, by value references."""
    structure = ET.SubElement(root, "ModelStructure")
    for name, unknowns in (("Output", describe.outputs(table)), ("InitialUnknown", describe.initial_unknowns(table))):
        for unknown in unknowns:
            reference = {"valueReference": str(unknown.position)}
            ET.SubElement(structure, name, reference | describe.dependencies(unknown.depends, 0))
