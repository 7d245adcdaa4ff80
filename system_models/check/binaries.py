"""What a shared library asks of its host: libraries and symbols, read from ELF and PE files.

ELF: System V ABI, chapters 4 and 5, and the GNU symbol versions of the Linux Standard Base. PE: Microsoft's PE format.
"""

import re
import struct
from dataclasses import dataclass

_DYNAMIC, _DYNAMIC_SYMBOLS, _SYMBOL_VERSIONS = 6, 11, 0x6FFFFFFF  # sh_type
_NEEDED, _RPATH, _RUNPATH = 1, 15, 29  # d_tag
_GLOBAL = 1  # binding of a symbol that must be found; weak ones may be missing
_UNVERSIONED = 1  # largest version index that no needed library defines


class UnreadableError(Exception):
    """A library in no format known here, or a damaged one; the message says which."""


@dataclass(frozen=True)
class Library:
    """The links of a library."""

    needed: tuple[str, ...]  # libraries that its loader must find
    undefined: tuple[str, ...]  # symbols that it wants without saying of which library
    exported: frozenset[str]
    glibc: str = ""  # least version, where there is one
    runpath: str = ""


def read_library(data: bytes) -> Library:
    """Read a 64-bit ELF or a PE library. Raises UnreadableError."""
    try:
        if data[:6] == b"\x7fELF\x02\x01":
            return _Elf(data).library()
        if data[:2] == b"MZ":
            return _Pe(data).library()
    except (struct.error, IndexError, ValueError):
        raise UnreadableError("the file is damaged") from None
    raise UnreadableError("neither 64-bit little-endian ELF nor PE")


def _text(data: bytes, start: int) -> str:
    return data[start : data.index(b"\0", start)].decode("ascii", "replace")


@dataclass(frozen=True)
class _Section:
    kind: int
    offset: int
    size: int
    link: int


class _Elf:
    def __init__(self, data: bytes):
        self._data = data
        (start,) = struct.unpack_from("<Q", data, 0x28)
        size, count = struct.unpack_from("<HH", data, 0x3A)
        headers = [struct.unpack_from("<IIQQQQII", data, start + i * size) for i in range(count)]
        self._sections = [_Section(h[1], h[4], h[5], h[6]) for h in headers]

    def library(self) -> Library:
        table = self._one(_DYNAMIC_SYMBOLS)
        dynamic = self._one(_DYNAMIC)
        if table is None or dynamic is None:
            raise UnreadableError("it has no table of dynamic symbols")
        versions = self._rows(self._one(_SYMBOL_VERSIONS), "<H")
        undefined, exported = [], set()
        for row, (name, info, _, section, _, _) in enumerate(self._rows(table, "<IBBHQQ")):
            text = self._string(table, name)
            if section:
                exported.add(text)
            elif info >> 4 == _GLOBAL and (not versions or versions[row][0] & 0x7FFF <= _UNVERSIONED):
                undefined.append(text)
        entries = [(tag, value) for tag, value in self._rows(dynamic, "<QQ")]
        return Library(
            tuple(self._string(dynamic, value) for tag, value in entries if tag == _NEEDED),
            tuple(sorted(undefined)),
            frozenset(exported),
            self._glibc(self._sections[table.link]),
            ":".join(self._string(dynamic, value) for tag, value in entries if tag in (_RPATH, _RUNPATH)),
        )

    def _one(self, kind: int) -> _Section | None:
        return next((section for section in self._sections if section.kind == kind), None)

    def _rows(self, section: _Section | None, layout: str) -> list[tuple[int, ...]]:
        if section is None:
            return []
        return list(struct.iter_unpack(layout, self._data[section.offset : section.offset + section.size]))

    def _string(self, section: _Section, offset: int) -> str:
        return _text(self._data, self._sections[section.link].offset + offset)

    def _glibc(self, strings: _Section) -> str:
        text = self._data[strings.offset : strings.offset + strings.size]
        found = {tuple(map(int, match.split(b"."))) for match in re.findall(rb"GLIBC_(\d+(?:\.\d+)+)", text)}
        return ".".join(map(str, max(found))) if found else ""


class _Pe:
    def __init__(self, data: bytes):
        self._data = data
        (start,) = struct.unpack_from("<I", data, 0x3C)
        if data[start : start + 4] != b"PE\0\0":
            raise UnreadableError("it has no PE header")
        (count,) = struct.unpack_from("<H", data, start + 6)
        (size,) = struct.unpack_from("<H", data, start + 20)
        optional = start + 24
        (magic,) = struct.unpack_from("<H", data, optional)
        self._directories = optional + (112 if magic == 0x20B else 96)  # PE32+ or PE32
        headers = [struct.unpack_from("<8sIIII", data, optional + size + 40 * i) for i in range(count)]
        self._sections = [(address, raw, length) for _, _, address, length, raw in headers]

    def library(self) -> Library:
        return Library(tuple(self._imports()), (), frozenset(self._exports()))

    def _offset(self, address: int) -> int:
        """Where in the file lies what is loaded to `address`."""
        for start, raw, length in self._sections:
            if start <= address < start + length:
                return address - start + raw
        raise UnreadableError("an address lies in no section")

    def _directory(self, index: int) -> int:
        return struct.unpack_from("<I", self._data, self._directories + 8 * index)[0]

    def _imports(self) -> list[str]:
        names: list[str] = []
        if not self._directory(1):
            return names
        row = self._offset(self._directory(1))
        while name := struct.unpack_from("<I", self._data, row + 12)[0]:
            names.append(_text(self._data, self._offset(name)))
            row += 20
        return names

    def _exports(self) -> list[str]:
        if not self._directory(0):
            return []
        table = self._offset(self._directory(0))
        (count,) = struct.unpack_from("<I", self._data, table + 24)
        (names,) = struct.unpack_from("<I", self._data, table + 32)
        addresses = struct.unpack_from(f"<{count}I", self._data, self._offset(names))
        return [_text(self._data, self._offset(address)) for address in addresses]
