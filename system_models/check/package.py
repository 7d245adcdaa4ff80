"""An FMU file, opened: its archive, and its model description as XML and as fmpy's object."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import fmpy
from fmpy.model_description import ModelDescription
from lxml import etree

from ..fmu import archive
from ..fmu.archive import DESCRIPTION, Archive

_SUFFIXES = {".so", ".dll", ".dylib"}


@dataclass(frozen=True)
class Package:
    """An FMU that could be opened. `description` is None where fmpy cannot interpret it; `problem` says why."""

    path: Path
    archive: Archive
    root: etree._Element
    description: ModelDescription | None
    problem: str = ""

    @property
    def names(self) -> list[str]:
        """The files in the archive."""
        return self.archive.names

    @property
    def version(self) -> str:
        """The FMI version, such as 2.0."""
        return self.root.get("fmiVersion", "")

    @property
    def runs(self) -> bool:
        """True for the FMI versions that can be run here."""
        return self.version == "2.0" or self.version.startswith("3.")

    @property
    def platform(self) -> str:
        """FMI's name of this machine: the folder of its binaries."""
        return fmpy.platform_tuple if self.version.startswith("3") else fmpy.platform

    @property
    def identifiers(self) -> set[str]:
        """The names of the binaries, without suffix."""
        kinds = ("CoSimulation", "ModelExchange", "ScheduledExecution")
        return {e.get("modelIdentifier", "") for kind in kinds for e in self.root.findall(kind)}

    @property
    def binaries(self) -> dict[str, str]:
        """The binary of the model by platform."""
        paths = [PurePosixPath(name) for name in self.names]
        return {
            p.parts[1]: str(p)
            for p in paths
            if len(p.parts) == 3 and p.parts[0] == "binaries" and p.stem in self.identifiers and p.suffix in _SUFFIXES
        }

    @property
    def sources(self) -> list[str]:
        """The source files, for hosts that compile."""
        return [name for name in self.names if name.startswith("sources/")]

    @property
    def needs_tool(self) -> bool:
        """True if an interface declares needsExecutionTool."""
        return any(e.get("needsExecutionTool") in ("true", "1") for e in self.root if "modelIdentifier" in e.attrib)


@contextmanager
def opened(path: Path) -> Iterator[Package]:
    """Open an FMU. Raises FmuError if it is no archive with a model description."""
    with archive.opened(path) as file:
        root = file.document(DESCRIPTION)
        yield Package(path, file, root, *_interpreted(path))


def _interpreted(path: Path) -> tuple[ModelDescription | None, str]:
    """Return fmpy's description, or why there is none."""
    try:
        return fmpy.read_model_description(str(path), validate=False), ""
    except Exception as error:  # fmpy raises many errors for a wrong document
        return None, f"{type(error).__name__}: {error}"
