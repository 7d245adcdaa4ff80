"""modelDescription.xml of FMI 2.0 for co-simulation."""

from collections.abc import Iterable, Sequence
from xml.etree import ElementTree as ET

from ..flavours import Flavour
from ..variables import Variable
from . import describe
from .describe import Model, value_text

_CAPABILITIES = {
    "canHandleVariableCommunicationStepSize": True,
    "canInterpolateInputs": False,
    "canBeInstantiatedOnlyOncePerProcess": False,
    "canNotUseMemoryManagementFunctions": True,
    "canGetAndSetFMUstate": True,
    "canSerializeFMUstate": True,
}


def description(model: Model, table: Sequence[Variable], flavour: Flavour, sources: Iterable[str] = ()) -> bytes:
    """Return modelDescription.xml; variables are in order of value references. Equal arguments give equal bytes.

    `sources` names the files to compile, if the FMU has any.
    """
    root = ET.Element(
        "fmiModelDescription",
        {"fmiVersion": "2.0", "modelName": model.name, "guid": model.guid, **describe.origin(model, flavour)},
    )
    capabilities = _CAPABILITIES | ({"providesDirectionalDerivative": True} if flavour == "native" else {})
    interface = ET.SubElement(
        root,
        "CoSimulation",
        {
            "modelIdentifier": model.name,
            # An isolated FMU starts the process it needs by itself. An embedded one needs a host in Python.
            "needsExecutionTool": value_text(flavour == "embedded"),
            **{name: value_text(value) for name, value in capabilities.items()},
        },
    )
    _source_files(interface, sources)
    describe.add_units(root, table)
    _types(root, table)
    describe.add_log_categories(root)
    describe.add_experiment(root, model)
    listed = ET.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(table):
        listed.append(_scalar_variable(reference, variable))
    _structure(root, table)
    return describe.document(root)


def _source_files(interface: ET.Element, names: Iterable[str]) -> None:
    """Add the files to compile, if there are any."""
    elements = [ET.Element("File", {"name": name}) for name in names]
    if elements:
        ET.SubElement(interface, "SourceFiles").extend(elements)


def _types(root: ET.Element, table: Iterable[Variable]) -> None:
    """Add every kind of physical quantity in use."""
    definitions = ET.SubElement(root, "TypeDefinitions")
    for name, attributes in describe.quantities(table).items():
        ET.SubElement(ET.SubElement(definitions, "SimpleType", {"name": name}), "Real", attributes)


def _scalar_variable(reference: int, variable: Variable) -> ET.Element:
    element = ET.Element("ScalarVariable", describe.role(reference, variable))
    typed = ET.SubElement(element, variable.kind, describe.numeric(variable))
    if variable.has_start:
        typed.set("start", value_text(variable.start))
    return element


def _structure(root: ET.Element, table: Sequence[Variable]) -> None:
    """Add the dependencies of outputs; FMI 2.0 counts variables from 1."""
    structure = ET.SubElement(root, "ModelStructure")
    for name, unknowns in (("Outputs", describe.outputs(table)), ("InitialUnknowns", describe.initial_unknowns(table))):
        listed = ET.SubElement(structure, name)
        for unknown in unknowns:
            index = {"index": str(1 + unknown.position)}
            ET.SubElement(listed, "Unknown", index | describe.dependencies(unknown.depends, 1))
