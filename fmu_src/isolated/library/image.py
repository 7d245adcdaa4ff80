"""Read imports and exports of a shared library. The file is not trusted.

ELF: System V ABI, chapters 4 and 5; versions of symbols: Linux Standard Base. PE: Microsoft, "PE Format".
"""

import re
import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import repeat

_DYNAMIC, _DYNAMIC_SYMBOLS = 6, 11  # types of sections (ELF)
_VERSIONS, _NEEDED_VERSIONS = 0x6FFFFFFF, 0x6FFFFFFE
_NOWHERE = 8  # type of a section without bytes in the file (ELF)
_NEEDED = 1  # entry of the dynamic section
_GLOBAL = 1  # binding of a symbol that must be found; weak ones may be missing
_SIGNATURE = int.from_bytes(b"PE\0\0", "little")
_PE32, _PE64 = 0x10B, 0x20B  # kinds of optional headers
_MOST_SECTIONS = 96  # of a PE file: Windows loads no more

# machine in the header -> FMI 3's name of the platform
_ELF_MACHINES = {62: "x86_64-linux", 183: "aarch64-linux"}
_PE_MACHINES = {0x14C: "x86-windows", 0x8664: "x86_64-windows", 0xAA64: "aarch64-windows"}
PLATFORMS = frozenset([*_ELF_MACHINES.values(), *_PE_MACHINES.values()])

_UNKNOWN = "it is neither a 64-bit ELF nor a PE file"


class ImageError(ValueError):
    """A library of an unknown kind, or a damaged one; the message says which."""


class DamagedError(ImageError):
    """A library whose file is truncated or corrupt."""

    def __init__(self) -> None:
        super().__init__("it is damaged")


@dataclass(frozen=True)
class Image:
    """Sorted names. An import of ELF carries its version: memcpy@GLIBC_2.14."""

    libraries: tuple[str, ...]  # which the loader must find
    imports: tuple[str, ...]
    exports: tuple[str, ...]
    unbound: tuple[str, ...] = ()  # imports without library and version
    glibc: str = ""  # least version, if any


def read(data: bytes) -> Image:
    """Return the image of a file: little-endian ELF of 64 bits, or PE. Raises ImageError."""
    if data[:6] == b"\x7fELF\x02\x01":
        return _elf(_File(data))
    if data[:2] == b"MZ":
        return _pe(_File(data))
    raise ImageError(_UNKNOWN)


def platform(data: bytes) -> str:
    """Return which of PLATFORMS a library is for, by its header; empty if none. Raises DamagedError."""
    file = _File(data)
    if data[:6] == b"\x7fELF\x02\x01":
        (machine,) = file.numbers("<H", 18)
        return _ELF_MACHINES.get(machine, "")
    if data[:2] == b"MZ":
        (header,) = file.numbers("<I", 60)
        signature, machine = file.numbers("<IH", header)
        return _PE_MACHINES.get(machine, "") if signature == _SIGNATURE else ""
    return ""


class _File:
    """Reads within the bounds of a file and a budget of bytes, which ends circular tables."""

    def __init__(self, data: bytes):
        self._data = data
        self._left = 4 * len(data)  # bytes

    def numbers(self, layout: str, at: int) -> tuple[int, ...]:
        self._spend(at, struct.calcsize(layout))
        return struct.unpack_from(layout, self._data, at)

    def rows(self, layout: str, at: int, count: int) -> Iterator[tuple[int, ...]]:
        size = struct.calcsize(layout)
        return (self.numbers(layout, at + k * size) for k in range(count))

    def text(self, at: int) -> str:
        end = self._data.find(b"\0", at)
        self._spend(at, end + 1 - at)
        return self._data[at:end].decode("ascii", "replace")

    def must_hold(self, at: int, size: int) -> None:
        """Raise DamagedError if the file ends earlier."""
        if at + size > len(self._data):
            raise DamagedError

    def _spend(self, at: int, size: int) -> None:
        self.must_hold(at, size)
        self._left -= size
        if size <= 0 or self._left < 0:
            raise DamagedError


# ELF


@dataclass(frozen=True)
class _Section:
    kind: int
    offset: int
    size: int
    link: int


def _elf(file: _File) -> Image:
    segments, table, segment_count, length = file.numbers("<QQ8xH2xH", 32)
    for offset, size in file.rows("<8xQ16xQ16x", segments, segment_count):
        file.must_hold(offset, size)
    sections = [_Section(*row) for row in file.rows("<4xI16xQQI20x", table, length)]
    for part in sections:
        if part.kind != _NOWHERE:
            file.must_hold(part.offset, part.size)
    by_kind = {section.kind: section for section in sections}
    if _DYNAMIC not in by_kind or _DYNAMIC_SYMBOLS not in by_kind:
        raise ImageError("it has no table of dynamic symbols")
    symbols, dynamic = by_kind[_DYNAMIC_SYMBOLS], by_kind[_DYNAMIC]
    if symbols.link >= len(sections):
        raise DamagedError
    names = sections[symbols.link].offset
    count = symbols.size // 24
    needed, numbers = by_kind.get(_NEEDED_VERSIONS), by_kind.get(_VERSIONS)
    versions = dict(_needed_versions(file, needed.offset, names)) if needed else {}
    chosen = file.rows("<H", numbers.offset, count) if numbers else repeat((0,), count)
    imports, exports, unbound = [], [], []
    for row, (number,) in zip(file.rows("<IBxH16x", symbols.offset, count), chosen, strict=True):
        name, info, section = row
        version = versions.get(number & 0x7FFF)
        if section:
            exports.append(file.text(names + name))
        elif info >> 4 == _GLOBAL and version:
            imports.append(f"{file.text(names + name)}@{version}")
        elif info >> 4 == _GLOBAL:
            unbound.append(file.text(names + name))
    entries = file.rows("<QQ", dynamic.offset, dynamic.size // 16)
    libraries = [file.text(names + value) for tag, value in entries if tag == _NEEDED]
    return Image(
        tuple(sorted(libraries)),
        tuple(sorted(imports + unbound)),
        tuple(sorted(exports)),
        tuple(sorted(unbound)),
        _least_glibc(versions.values()),
    )


def _needed_versions(file: _File, at: int, names: int) -> Iterator[tuple[int, str]]:
    """Yield number and name of every required version of a library."""
    following = 1
    while following:
        count, first, following = file.numbers("<2xH4xII", at)
        entry = at + first
        for _ in range(count):
            number, name, onward = file.numbers("<6xHII", entry)
            yield number, file.text(names + name)
            entry += onward
        at += following


def _least_glibc(versions: Iterable[str]) -> str:
    """Return the newest of the required versions of glibc."""
    found = [match[1] for version in versions if (match := re.fullmatch(r"GLIBC_([0-9]{1,4}(\.[0-9]{1,4})+)", version))]
    return max(found, key=lambda text: [int(word) for word in text.split(".")], default="")


# PE


def _pe(file: _File) -> Image:
    (header,) = file.numbers("<I", 60)
    signature, count, optional, kind = file.numbers("<I2xH12xH2xH", header)
    if signature != _SIGNATURE or kind not in (_PE32, _PE64):
        raise ImageError(_UNKNOWN)
    if count > _MOST_SECTIONS:
        raise DamagedError
    sections = [*file.rows("<8x4I16x", header + 24 + optional, count)]
    for _, _, stored, offset in sections:
        file.must_hold(offset, stored)
    exported, _, imported, _ = file.numbers("<4I", header + 24 + (112 if kind == _PE64 else 96))
    libraries, imports = _pe_imports(file, imported, sections, wide=kind == _PE64)
    exports = _pe_exports(file, exported, sections)
    return Image(tuple(sorted(libraries)), tuple(sorted(imports)), tuple(sorted(exports)))


def _place(address: int, sections: list[tuple[int, ...]]) -> int:
    """Return the offset in the file of a relative virtual address."""
    for _, start, stored, offset in sections:
        if start <= address < start + stored:
            return address - start + offset
    raise DamagedError


def _pe_exports(file: _File, directory: int, sections: list[tuple[int, ...]]) -> list[str]:
    if not directory:
        return []
    count, names = file.numbers("<I4xI", _place(directory, sections) + 24)
    if not count:
        return []
    return [file.text(_place(name, sections)) for (name,) in file.rows("<I", _place(names, sections), count)]


def _pe_imports(
    file: _File, directory: int, sections: list[tuple[int, ...]], wide: bool
) -> tuple[list[str], list[str]]:
    libraries: list[str] = []
    names: list[str] = []
    if not directory:
        return libraries, names
    layout, by_number = ("<Q", 1 << 63) if wide else ("<I", 1 << 31)
    at = _place(directory, sections)
    while (row := file.numbers("<I8xII", at))[1]:
        lookup, library, addresses = row
        libraries.append(file.text(_place(library, sections)))
        entry = _place(lookup or addresses, sections)  # some linkers write only the latter
        while hint := file.numbers(layout, entry)[0]:
            names.append(f"#{hint & 0xFFFF}" if hint & by_number else file.text(_place(hint, sections) + 2))
            entry += struct.calcsize(layout)
        at += 20
    return libraries, names
