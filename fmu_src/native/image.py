"""What a shared library takes from others and gives to them: ELF of 64-bit Linux, PE of 64-bit Windows."""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_DYNAMIC, _DYNAMIC_SYMBOLS = 6, 11  # types of sections (ELF)
_NEEDED = 1  # entry of the dynamic section
_VERSIONS, _NEEDED_VERSIONS = 0x6FFFFFFF, 0x6FFFFFFE
_EXPORTS, _IMPORTS = 0, 1  # directories (PE)


@dataclass(frozen=True)
class Image:
    """Names, sorted. An import of ELF carries its version: memcpy@GLIBC_2.14."""

    libraries: tuple[str, ...]
    imports: tuple[str, ...]
    exports: tuple[str, ...]


def read(path: Path) -> Image:
    """The image in a file. Raises ValueError if it is of no known kind."""
    data = path.read_bytes()
    if data[:6] == b"\x7fELF\x02\x01":
        return _elf(data)
    if data[:2] == b"MZ":
        return _pe(data)
    raise ValueError(f"{path} is neither a 64-bit ELF nor a PE file.")


def _text(data: bytes, at: int) -> str:
    return data[at : data.index(b"\0", at)].decode()


# ELF: System V ABI, AMD64 supplement; versions: Linux Standard Base, "Symbol Versioning"


@dataclass(frozen=True)
class _Section:
    kind: int
    offset: int
    size: int
    link: int


def _elf(data: bytes) -> Image:
    table, size, count = struct.unpack_from("<Q10xHH", data, 40)
    sections = []
    for k in range(count):
        kind, offset, length, link = struct.unpack_from("<4xI16xQQI", data, table + k * size)
        sections.append(_Section(kind, offset, length, link))
    by_kind = {section.kind: section for section in sections}
    symbols, dynamic = by_kind[_DYNAMIC_SYMBOLS], by_kind[_DYNAMIC]
    names = sections[symbols.link].offset
    versions = dict(_needed_versions(data, by_kind[_NEEDED_VERSIONS], names)) if _NEEDED_VERSIONS in by_kind else {}
    imports, exports = [], []
    for k in range(1, symbols.size // 24):
        name, info, section = struct.unpack_from("<IBxH", data, symbols.offset + 24 * k)
        (version,) = struct.unpack_from("<H", data, by_kind[_VERSIONS].offset + 2 * k) if versions else (0,)
        text = _text(data, names + name)
        if section:
            exports.append(text)
        elif info >> 4 == 1:  # global: weak ones need not be there
            imports.append("@".join(filter(None, (text, versions.get(version & 0x7FFF)))))
    entries = struct.iter_unpack("<qQ", data[dynamic.offset : dynamic.offset + dynamic.size])
    libraries = [_text(data, names + value) for tag, value in entries if tag == _NEEDED]
    return Image(tuple(sorted(libraries)), tuple(sorted(imports)), tuple(sorted(exports)))


def _needed_versions(data: bytes, section: _Section, names: int) -> Iterator[tuple[int, str]]:
    """Number and name of every version that is asked of a library."""
    at, following = section.offset, 1
    while following:
        count, _, first, following = struct.unpack_from("<2xHIII", data, at)
        entry = at + first
        for _ in range(count):
            number, name, onward = struct.unpack_from("<6xHII", data, entry)
            yield number, _text(data, names + name)
            entry += onward
        at += following


# PE: Microsoft, "PE Format"


def _pe(data: bytes) -> Image:
    (header,) = struct.unpack_from("<I", data, 60)
    sections, optional = struct.unpack_from("<H12xH", data, header + 6)
    if data[header : header + 4] != b"PE\0\0" or data[header + 24 : header + 26] != b"\x0b\x02":
        raise ValueError("The PE file is none for 64-bit Windows.")
    directories = struct.unpack_from("<IIII", data, header + 24 + 112)
    at = header + 24 + optional
    placed = [struct.unpack_from("<8xIIII", data, at + 40 * k) for k in range(sections)]
    libraries, imports = _pe_imports(data, directories[2 * _IMPORTS], placed)
    exports = _pe_exports(data, directories[2 * _EXPORTS], placed)
    return Image(tuple(sorted(libraries)), tuple(sorted(imports)), tuple(sorted(exports)))


def _place(address: int, sections: list[tuple[int, ...]]) -> int:
    """Offset in the file of a relative virtual address."""
    for size, start, stored, offset in sections:
        if start <= address < start + max(size, stored):
            return address - start + offset
    raise ValueError(f"The PE file has nothing at {address:#x}.")


def _pe_exports(data: bytes, directory: int, sections: list[tuple[int, ...]]) -> list[str]:
    if not directory:
        return []
    count, names = struct.unpack_from("<I4xI", data, _place(directory, sections) + 24)
    table = struct.unpack_from(f"<{count}I", data, _place(names, sections))
    return [_text(data, _place(name, sections)) for name in table]


def _pe_imports(data: bytes, directory: int, sections: list[tuple[int, ...]]) -> tuple[list[str], list[str]]:
    libraries: list[str] = []
    names: list[str] = []
    at = _place(directory, sections)
    while True:
        lookup, library = struct.unpack_from("<I8xI", data, at)
        if not library:
            return libraries, names
        libraries.append(_text(data, _place(library, sections)))
        entry = _place(lookup, sections)
        while (hint := struct.unpack_from("<Q", data, entry)[0]) != 0:
            names.append(f"#{hint & 0xFFFF}" if hint >> 63 else _text(data, _place(hint, sections) + 2))
            entry += 8
        at += 20
