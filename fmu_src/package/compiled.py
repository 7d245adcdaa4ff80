"""Files of a native FMU: its C99 sources, how to build them, and the libraries built from them."""

from collections.abc import Iterable
from xml.etree import ElementTree as ET

from contact_core.scene import Scene

from ..flavours import Version
from ..native import files as native
from ..runtime.resources import MODEL
from .describe import document
from .fmi3 import VERSION

SOURCES = "sources/"


def files(scene: Scene, fmi: Version, here: bool = False) -> dict[str, bytes]:
    """Return name and content of sources and libraries; `here`: of this platform only.

    Raises SceneError if no C can be generated for the scene, OSError if there is no compiler.
    """
    sources = native.sources(scene, fmi)
    found = {f"{SOURCES}{name}": data for name, data in sources.items()}
    if fmi == 3:
        found[f"{SOURCES}buildDescription.xml"] = build_description(sources, MODEL)
    return found | native.binaries(sources, fmi, MODEL, here)


def to_compile(names: Iterable[str]) -> list[str]:
    """Return those of the files that are compiled, sorted; headers are found beside them."""
    return sorted(name for name in names if name.endswith(".c"))


def build_description(names: Iterable[str], model: str) -> bytes:
    """Return buildDescription.xml of FMI 3.0 for the sources of a model."""
    root = ET.Element("fmiBuildDescription", {"fmiVersion": VERSION})
    configuration = ET.SubElement(root, "BuildConfiguration", {"modelIdentifier": model})
    listed = ET.SubElement(configuration, "SourceFileSet", {"language": "C99"})
    for name in to_compile(names):
        ET.SubElement(listed, "SourceFile", {"name": name})
    ET.SubElement(
        listed,
        "PreprocessorDefinition",
        {
            "name": "FMI3_OVERRIDE_FUNCTION_PREFIX",
            "value": "",
            "optional": "true",  # leave it out to link several FMUs into one program
            "description": "the functions of a shared library have no prefix",
        },
    )
    return document(root)
