"""Export of a system as SSP 1.0 [1]: FMUs, connections with units and factors, parameters and start values.

Options of the simulation are left out; inputs that change by a schedule are refused. A step size stands in an
annotation of OMSimulator, which reads no file without it [2]. Conversions of units are written into connections, and
importers asked to do none: many do none. FMI 3.0 came later: its variables are written with the nearest type.

[1] Modelica Association, System Structure and Parameterization 1.0, 2019, https://ssp-standard.org.
[2] Open Source Modelica Consortium, OMSimulator, schema/oms.xsd, https://github.com/OpenModelica/OMSimulator.
"""

import math
import re
import zipfile
from collections.abc import Iterable
from decimal import Decimal
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from fmpy.model_description import ModelVariable

import contact_core

from ..fmu.errors import CouplingError
from ..fmu.model import Model
from .system import Connection, Port, System, Value

_SPACES = {
    name: f"http://ssp-standard.org/SSP1/SystemStructure{title}"
    for name, title in (("ssd", "Description"), ("ssc", "Common"), ("ssv", "ParameterValues"))
} | {"oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd"}
_TYPES = {"real": "Real", "integer": "Integer", "boolean": "Boolean", "string": "String"}
_BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad", "factor", "offset")
_EPOCH = (1980, 1, 1, 0, 0, 0)  # of every entry: the same system gives the same bytes


def export_ssp(
    system: System, path: str | Path, stop_time: float | None = None, step_size: float | None = None
) -> Path:
    """Write a system and its FMUs into an .ssp file, and return its path.

    stop_time and step_size [s] are proposals to its importers; without step_size OMSimulator cannot read the file.
    Raises CouplingError if a schedule has more than a start value, for elements of arrays that are connected or set,
    and if the file cannot be written.
    """
    path = Path(path)
    for name, time in (("stop_time", stop_time), ("step_size", step_size)):
        if time is not None and not (math.isfinite(time) and time > 0.0):
            raise CouplingError(f"{name} = {time!r} must be a time above 0 s. Give one, or leave it out.")
    _check_arrays(system)
    sources = _sources(system.models.values())
    root = _structure(system, path.stem, stop_time, step_size, sources)
    text = ElementTree.tostring(root, "utf-8", xml_declaration=True)
    try:
        with zipfile.ZipFile(path, "w") as file:
            file.writestr(zipfile.ZipInfo("SystemStructure.ssd", _EPOCH), text, zipfile.ZIP_DEFLATED)
            for fmu, source in sources.items():
                file.writestr(zipfile.ZipInfo(source, _EPOCH), fmu.read_bytes())
    except OSError as error:
        raise CouplingError(f"'{path}' cannot be written: {error.strerror}. Name another file.") from None
    return path


def _sources(models: Iterable[Model]) -> dict[Path, str]:
    """Return the place of each FMU in the archive: every file once, under a name that needs no escape in a URI."""
    found: dict[Path, str] = {}
    for model in models:
        name = re.sub(r"[^\w.-]", "_", model.path.stem, flags=re.ASCII)
        taken = {*found.values()}
        proposals = (f"resources/{name}{suffix}.fmu" for suffix in ("", *(f"_{i}" for i in range(2, len(taken) + 2))))
        found.setdefault(model.path.resolve(), next(source for source in proposals if source not in taken))
    return found


def _structure(
    system: System, name: str, stop_time: float | None, step_size: float | None, sources: dict[Path, str]
) -> Element:
    for prefix, uri in _SPACES.items():
        ElementTree.register_namespace(prefix, uri)
    tool = f"tribofmu {contact_core.__version__}"
    root = Element(_tag("ssd:SystemStructureDescription"), version="1.0", name=name, generationTool=tool)
    top = SubElement(root, _tag("ssd:System"), name=name)
    elements = SubElement(top, _tag("ssd:Elements"))
    units: dict[str, dict[str, str]] = {}
    starts = system.parameters | {name: _constant(name, steps) for name, steps in system.schedule.items()}
    for model in system.models.values():
        component = SubElement(
            elements,
            _tag("ssd:Component"),
            name=model.name,
            type="application/x-fmu-sharedlibrary",
            source=sources[model.path.resolve()],
            implementation="CoSimulation",
        )
        _add_connectors(component, _ports(system, model), units)
        _add_parameters(component, [(system.port(name), value) for name, value in starts.items()], model)
    if system.connections:
        _add_connections(SubElement(top, _tag("ssd:Connections")), system.connections)
    if step_size is not None:
        _add_step_size(SubElement(top, _tag("ssd:Annotations")), step_size)
    if units:
        listed = SubElement(root, _tag("ssd:Units"))
        for unit, base in sorted(units.items()):
            SubElement(SubElement(listed, _tag("ssc:Unit"), name=unit), _tag("ssc:BaseUnit"), base)
    experiment = SubElement(root, _tag("ssd:DefaultExperiment"), startTime="0.0")
    if stop_time is not None:
        experiment.set("stopTime", repr(float(stop_time)))
    ElementTree.indent(root)
    return root


def _tag(name: str) -> str:
    prefix, _, local = name.partition(":")
    return f"{{{_SPACES[prefix]}}}{local}"


def _ports(system: System, model: Model) -> list[Port]:
    """Return the outputs that can be recorded and whatever is connected; importers stumble over inputs that are not."""
    ends = [port for c in system.connections for port in (c.source, c.target)]
    found = [port for port in system.outputs(None) if port.variable.name not in port.model.elements]
    ports = {port.name: port for port in (*found, *ends) if port.model is model}
    return [ports[name] for name in sorted(ports)]


def _check_arrays(system: System) -> None:
    """Raise CouplingError for elements of arrays that are connected or set: SSP 1.0 has none."""
    names = [name for c in system.connections for name in (c.source.name, c.target.name)]
    for port in map(system.port, [*names, *system.parameters, *system.schedule]):
        if port.variable.name in port.model.elements:
            raise CouplingError(f"'{port.name}' is an element of an array, which SSP 1.0 cannot name. Leave it out.")


def _constant(name: str, steps: list[tuple[float, Value]]) -> Value:
    """Return the value of a schedule that has one from the start on."""
    if steps[-1][0] > 0.0:
        raise CouplingError(
            f"'{name}' changes by a schedule, which SSP cannot say. Give it one value as a parameter, "
            "or connect it to an FMU that brings the values."
        )
    return steps[-1][1]


def _add_connectors(component: Element, ports: list[Port], units: dict[str, dict[str, str]]) -> None:
    if not ports:
        return
    connectors = SubElement(component, _tag("ssd:Connectors"))
    for port in ports:
        variable = port.variable
        connector = SubElement(connectors, _tag("ssd:Connector"), name=variable.name, kind=variable.causality)
        if variable.type == "Enumeration":
            continue  # its items are in the FMU
        entry = SubElement(connector, _tag(f"ssc:{_TYPES[port.kind]}"))
        base = _base_unit(port)
        if base is not None and units.setdefault(variable.unit, base) == base:
            entry.set("unit", variable.unit)


def _base_unit(port: Port) -> dict[str, str] | None:
    """Return the attributes of a variable's unit, if its FMU defines it; importers find there what is left out here."""
    for unit in port.model.description.unitDefinitions:
        if unit.name == port.variable.unit and unit.baseUnit is not None:
            usual = {"factor": 1.0, "offset": 0.0}
            values = {name: getattr(unit.baseUnit, name) for name in _BASE}
            return {name: repr(value) for name, value in values.items() if value != usual.get(name, 0)}
    return None


def _add_parameters(component: Element, starts: list[tuple[Port, Value]], model: Model) -> None:
    own = [(port.variable, value) for port, value in starts if port.model is model]
    if not own:
        return
    binding = SubElement(SubElement(component, _tag("ssd:ParameterBindings")), _tag("ssd:ParameterBinding"))
    values = SubElement(binding, _tag("ssd:ParameterValues"))
    table = SubElement(values, _tag("ssv:ParameterSet"), version="1.0", name="initialValues")
    parameters = SubElement(table, _tag("ssv:Parameters"))
    for variable, value in own:
        kind, text = _written(variable, value)
        SubElement(SubElement(parameters, _tag("ssv:Parameter"), name=variable.name), _tag(f"ssv:{kind}"), value=text)


def _written(variable: ModelVariable, value: Value) -> tuple[str, str]:
    if variable.type == "Enumeration" and variable.declaredType is not None:
        names = {int(item.value): item.name for item in variable.declaredType.items or ()}
        return ("Enumeration", names[int(value)]) if value in names else ("Integer", repr(value))
    if isinstance(value, bool):
        return "Boolean", str(value).lower()
    return {float: "Real", int: "Integer", str: "String"}[type(value)], str(value)


def _add_connections(parent: Element, connections: Iterable[Connection]) -> None:
    for connection in connections:
        source, target = connection.source, connection.target
        element = SubElement(
            parent,
            _tag("ssd:Connection"),
            startElement=source.model.name,
            startConnector=source.variable.name,
            endElement=target.model.name,
            endConnector=target.variable.name,
        )
        if source.variable.unit != target.variable.unit:
            element.set("suppressUnitConversion", "true")
        if (connection.factor, connection.offset) != (1.0, 0.0):
            factor, offset = repr(connection.factor), repr(connection.offset)
            SubElement(element, _tag("ssc:LinearTransformation"), factor=factor, offset=offset)


def _add_step_size(parent: Element, step_size: float) -> None:
    """Add the annotation that OMSimulator writes for fixed steps, in decimals, as its schema has them."""
    annotation = SubElement(parent, _tag("ssc:Annotation"), type="org.openmodelica")
    information = SubElement(SubElement(annotation, _tag("oms:Annotations")), _tag("oms:SimulationInformation"))
    step = f"{Decimal(repr(float(step_size))):f}"
    attributes = {"description": "oms-ma", "stepSize": step, "relativeTolerance": "0.0001"}
    SubElement(information, _tag("oms:FixedStepMaster"), attributes)
