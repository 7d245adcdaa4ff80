"""The archive of an FMU: read within bounds, refused in a sentence where it is damaged or not fit to be unpacked."""

import stat
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from lxml import etree

from .errors import FmuError
from .printable import printable

DESCRIPTION = "modelDescription.xml"

_LARGE = 256 << 20  # bytes to which any file may unpack; larger ones may be so many times their packed size:
_DENSEST = 100  # models, libraries and tables are packed 2 to 20 times, files made to fill memory or disk 1000 times
_LONGEST_DOCUMENT = 64 << 20  # bytes: read as XML it takes up to ten times as much memory
_LONGEST_NAME = 255  # bytes of a file or folder: no file system has more
_ENCRYPTED = 1  # bit of the flags of a file
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # FMI has no others


class Archive:
    """An FMU as a file. Everything that it raises is an FmuError, whatever the file holds."""

    def __init__(self, path: Path, archive: zipfile.ZipFile) -> None:
        self.path, self._zip = path, archive
        self.infos = archive.infolist()
        if reason := self._unreadable():
            raise FmuError(f"'{path}' cannot be read as an FMU: {reason}")

    @property
    def names(self) -> list[str]:
        return [info.filename for info in self.infos if not info.filename.endswith("/")]

    def size(self, name: str) -> int:
        """Return the size of a file in bytes."""
        return self._zip.getinfo(name).file_size

    def read(self, name: str) -> bytes:
        """Return the content of a file."""
        with _translated(self.path, name), self._zip.open(name) as file:
            # of this length and no other: without it, zipfile unpacks whatever there is
            return file.read(self.size(name))

    def document(self, name: str) -> etree._Element:
        """Return the root of a document in XML."""
        if name not in self.names:
            raise FmuError(f"'{self.path}' holds no {name} at its top: it is not an FMU.")
        if self.size(name) > _LONGEST_DOCUMENT:
            raise FmuError(
                f"{name} in '{self.path}' has {self.size(name) >> 20} MB, and at most {_LONGEST_DOCUMENT >> 20} MB are "
                "read. Export the FMU with fewer variables."
            )
        data = self.read(name)
        with _translated(self.path, name):
            return parsed(data)

    def unpack(self, folder: str | Path) -> None:
        if reason := self.unfit():
            raise FmuError(f"'{self.path}' is not fit to be unpacked: {reason} Export the FMU again.")
        try:
            self._zip.extractall(folder)
        except OSError as error:
            raise FmuError(
                f"'{self.path}' cannot be unpacked into '{folder}': {error.strerror}. Make room, set TMPDIR to another "
                "folder, or export the FMU again."
            ) from None
        except Exception as error:
            raise FmuError(f"'{self.path}' is damaged: {_said(error)}. Build or copy the FMU again.") from None

    def unfit(self) -> str:
        """Return why it must not be unpacked, as a sentence; an empty text if it may be."""
        for info in self.infos:
            name = printable(info.orig_filename)
            if not info.filename or _leaves(info.orig_filename):
                return f"'{name}' must be relative, without '..', and with '/' between folders."
            if any(len(part.encode()) > _LONGEST_NAME for part in PurePosixPath(info.filename).parts):
                return f"'{name[:20]}...' has a name of more than {_LONGEST_NAME} bytes, which no file can have."
            if stat.S_ISLNK(info.external_attr >> 16):
                return f"'{name}' is a symbolic link; an FMU has files only."
        folders = {str(parent) for info in self.infos for parent in PurePosixPath(info.filename).parents}
        if both := sorted(folders.intersection(self.names)):
            return f"'{printable(both[0])}' is a file and a folder, too."
        return ""

    def damage(self) -> str:
        """Read all and return the first error of its files, as a sentence; an empty text if all are whole."""
        try:
            damaged = self._zip.testzip()
        except Exception as error:
            return f"The archive cannot be read to its end: {_said(error)}."
        return f"'{printable(damaged)}' is damaged: its checksum is wrong." if damaged else ""

    def _unreadable(self) -> str:
        """Return why nothing of it is read, as a sentence: it is encrypted, of an unusual kind, or endless."""
        for info in self.infos:
            name = printable(info.filename)
            if info.flag_bits & _ENCRYPTED:
                return f"'{name}' is encrypted. Export the FMU without a password."
            if info.compress_type not in _METHODS:
                return f"'{name}' is packed by another method than deflate, the one of FMI. Export the FMU again."
        sizes = [(f"'{printable(info.filename)}'", info.file_size, info.compress_size) for info in self.infos]
        whole = sum(size for _, size, _ in sizes), self.path.stat().st_size
        for name, size, packed in [*sizes, ("all of it", *whole)]:
            if size > max(_LARGE, _DENSEST * packed):
                return (
                    f"{name} would unpack to {size >> 20} MB, {size // max(packed, 1)} times its size. More than "
                    f"{_DENSEST} times are taken up to {_LARGE >> 20} MB only. Export the FMU again."
                )
        return ""


@contextmanager
def opened(path: Path) -> Iterator[Archive]:
    try:
        archive = zipfile.ZipFile(path)
    except OSError as error:
        raise FmuError(f"'{path}' cannot be read: {error.strerror}. Give the path of an .fmu file.") from None
    except Exception:  # not only BadZipFile, of one whose directory is damaged
        raise FmuError(f"'{path}' is not a zip archive, or is cut short. Build or copy the FMU again.") from None
    with archive:
        yield Archive(path, archive)


def parsed(data: bytes) -> etree._Element:
    """Return the root of a document in XML. Raises ValueError for one that could define entities: FMI has none."""
    root = etree.fromstring(data, etree.XMLParser(resolve_entities=False, no_network=True))
    if root.getroottree().docinfo.doctype:
        raise ValueError("it has a DOCTYPE, which FMI does not know")
    return root


def _leaves(name: str) -> bool:
    """Return True for a name that is not one of a file below the folder on every system."""
    return "\\" in name or name.startswith("/") or ":" in name.split("/")[0] or ".." in PurePosixPath(name).parts


@contextmanager
def _translated(path: Path, name: str) -> Iterator[None]:
    """Raise as FmuError what zipfile, zlib and lxml raise for a damaged file, which are a dozen kinds."""
    try:
        yield
    except Exception as error:
        what = f"{printable(name)} in '{path}'"
        raise FmuError(f"{what} cannot be read: {_said(error)}. Build or copy the FMU again.") from None


def _said(error: Exception) -> str:
    """Return what an exception says, without a full stop."""
    return printable(str(error)).rstrip(".") or type(error).__name__
