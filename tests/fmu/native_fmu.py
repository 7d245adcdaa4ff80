"""FMUs of the native flavour with a hand-made contact in place of the generated one."""

import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

from fmu_host import SMALL

from contact_core import Scene
from fmu_src.native.build import Compiler, Fmi, binaries, runtime
from fmu_src.native.model import model_c
from fmu_src.variables import Variable, variables

TOKEN = "5f4a2f0e-8a53-5b0a-9c39-0e3a8d1f7c11"
STATES = "2c9f1a77-0d5e-5c43-9a61-4f6b8d2e7a30"
MODEL = "MixedContact"
CONTACT = Path(__file__).with_name("native") / "contact.c"
_HEADER = """#ifndef CONTACT_H
#define CONTACT_H
typedef struct {{ double {inputs}; }} contact_inputs;
typedef struct {{ double film, worn, cycles; }} contact_state;
typedef struct {{ double {outputs}; }} contact_outputs;
typedef struct {{ char text[512]; }} contact_message;
int contact_initialise(const contact_inputs *in, contact_state *state, contact_outputs *out, contact_message *why);
int contact_step(const contact_inputs *in, double dt, contact_state *state, contact_outputs *out, contact_message *why);
int contact_derivatives(const contact_inputs *in, const contact_state *state, contact_outputs *out,
                        contact_message *why);
#endif
"""


def table() -> tuple[Variable, ...]:
    """Variables of the scene of `quick` in conftest.py."""
    return variables(Scene.from_toml("mtm_zddp", SMALL).at_level("regression"))


def sources(fmi: Fmi) -> dict[str, bytes]:
    """Every file of the FMU's sources."""
    listed = table()
    inputs, outputs = ([v.name for v in listed if v.causality == causality] for causality in ("input", "output"))
    header = _HEADER.format(inputs=", ".join(inputs), outputs=", ".join(outputs))
    return runtime(fmi) | {
        "contact.h": header.encode(),
        "contact.c": CONTACT.read_bytes(),
        "model.c": model_c(listed, TOKEN, STATES).encode(),
    }


def all_sources() -> dict[str, bytes]:
    """The sources of both versions of FMI."""
    return sources(2) | sources(3)


def write(folder: Path, files: dict[str, bytes]) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


def unpacked(folder: Path, fmi: Fmi, compiler: Compiler = "gcc") -> Path:
    """The FMU as a folder, for this Linux."""
    platform = "linux64" if fmi == 2 else "x86_64-linux"
    libraries = binaries(sources(fmi), fmi, MODEL, compiler, [platform])
    return write(folder, libraries | {"modelDescription.xml": description(fmi)})


def packed(folder: Path, fmi: Fmi) -> Path:
    """The FMU as a file."""
    root = unpacked(folder / f"fmi{fmi}", fmi)
    path = folder / f"native_{fmi}.fmu"
    with zipfile.ZipFile(path, "w") as archive:
        for file in sorted(root.rglob("*")):
            archive.write(file, file.relative_to(root))
    return path


def description(fmi: Fmi) -> bytes:
    """The least model description."""
    capabilities = {"modelIdentifier": MODEL, "canHandleVariableCommunicationStepSize": "true"}
    state = "canGetAndSetFMUstate" if fmi == 2 else "canGetAndSetFMUState"
    serialize = "canSerializeFMUstate" if fmi == 2 else "canSerializeFMUState"
    derivative = "providesDirectionalDerivative" if fmi == 2 else "providesDirectionalDerivatives"
    capabilities |= {name: "true" for name in (state, serialize, derivative)}
    if fmi == 3:
        capabilities |= {"canReturnEarlyAfterIntermediateUpdate": "true", "providesIntermediateUpdate": "true"}
    token = "guid" if fmi == 2 else "instantiationToken"
    root = ET.Element("fmiModelDescription", {"fmiVersion": f"{fmi}.0", "modelName": MODEL, token: TOKEN})
    ET.SubElement(root, "CoSimulation", capabilities)
    listed, structure = ET.SubElement(root, "ModelVariables"), ET.SubElement(root, "ModelStructure")
    fill = _fmi2 if fmi == 2 else _fmi3
    fill(listed, structure)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True)


def _attributes(reference: int, v: Variable) -> dict[str, str]:
    found = {"name": v.name, "valueReference": str(reference), "causality": v.causality, "variability": v.variability}
    return found | ({"initial": "exact"} if v.causality == "parameter" else {})


def _start(v: Variable) -> str:
    return str(v.start).lower() if isinstance(v.start, bool) else str(v.start)


def _fmi2(listed: ET.Element, structure: ET.Element) -> None:
    outputs, unknowns = (ET.SubElement(structure, name) for name in ("Outputs", "InitialUnknowns"))
    for reference, v in enumerate(table()):
        initial = {"initial": "calculated"} if v.causality == "output" else {}
        element = ET.SubElement(listed, "ScalarVariable", _attributes(reference, v) | initial)
        ET.SubElement(element, v.kind, {"start": _start(v)} if v.has_start else {})
        if v.causality == "output":
            ET.SubElement(outputs, "Unknown", {"index": str(reference + 1), "dependencies": "", "dependenciesKind": ""})
            ET.SubElement(unknowns, "Unknown", {"index": str(reference + 1)})


_KINDS3 = {"Real": "Float64", "Integer": "Int32", "Boolean": "Boolean", "String": "String"}


def _fmi3(listed: ET.Element, structure: ET.Element) -> None:
    for reference, v in enumerate(table()):
        initial = {"initial": "calculated"} if v.causality == "output" else {}
        element = ET.SubElement(listed, _KINDS3[v.kind], _attributes(reference, v) | initial)
        if v.kind == "String":
            ET.SubElement(element, "Start", {"value": _start(v)})
        elif v.has_start:
            element.set("start", _start(v))
    for name in ("Output", "InitialUnknown"):
        for reference, v in enumerate(table()):
            if v.causality == "output":
                ET.SubElement(structure, name, {"valueReference": str(reference)})
