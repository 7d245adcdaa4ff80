"""An FMU file, opened: its archive, and its model description as XML and as fmpy's object."""

import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import fmpy
from fmpy.model_description import ModelDescription
from lxml import etree

from contact_core.errors import ContactError

DESCRIPTION = "modelDescription.xml"
_SUFFIXES = {".so", ".dll", ".dylib"}


class FmuError(ContactError):
    """A file that cannot be read as an FMU."""


@dataclass(frozen=True)
class Package:
    """An FMU that could be opened. `description` is None where fmpy cannot interpret it; `problem` says why."""

    path: Path
    archive: zipfile.ZipFile
    root: etree._Element
    description: ModelDescription | None
    problem: str = ""

    @property
    def names(self) -> list[str]:
        """The files in the archive."""
        return [name for name in self.archive.namelist() if not name.endswith("/")]

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
    try:
        archive = zipfile.ZipFile(path)
    except OSError as error:
        raise FmuError(f"'{path}' cannot be read: {error.strerror}. Give the path of an .fmu file.") from None
    except zipfile.BadZipFile:
        raise FmuError(f"'{path}' is not a zip archive, or is cut short. Build or copy the FMU again.") from None
    with archive:
        yield _package(path, archive)


def _package(path: Path, archive: zipfile.ZipFile) -> Package:
    try:
        root = etree.fromstring(archive.read(DESCRIPTION), etree.XMLParser(resolve_entities=False))
    except KeyError:
        raise FmuError(f"'{path}' holds no {DESCRIPTION} at its top: it is not an FMU.") from None
    except (etree.XMLSyntaxError, zipfile.BadZipFile, zlib.error) as error:
        raise FmuError(f"{DESCRIPTION} in '{path}' cannot be read: {error}. Build the FMU again.") from None
    try:
        return Package(path, archive, root, fmpy.read_model_description(str(path), validate=False))
    except Exception as error:  # fmpy raises many errors for a wrong document
        return Package(path, archive, root, None, f"{type(error).__name__}: {error}")
