"""Imports and exports of shared libraries, intact and damaged ones."""

import random
import shutil
import struct
import subprocess
from importlib.resources import files

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fmu_src.isolated.library import build
from fmu_src.isolated.library.image import DamagedError, Image, ImageError, platform, read

OURS = {name: build.FOLDER / "binaries" / name / platform.library for name, platform in build.PLATFORMS.items()}
OTHERS = files("pythonfmu") / "resources" / "binaries"


@pytest.mark.skipif(not shutil.which("nm"), reason="needs binutils")
def test_the_symbols_are_those_of_nm() -> None:
    listed = subprocess.run(["nm", "-D", OURS["linux64"]], capture_output=True, text=True, check=True).stdout
    words = [line.split() for line in listed.splitlines()]
    found = read(OURS["linux64"].read_bytes())
    assert tuple(sorted(row[1] for row in words if row[0] == "U")) == found.imports
    assert tuple(sorted(row[2] for row in words if len(row) == 3)) == found.exports


def test_an_elf_library_that_expects_symbols_of_its_host() -> None:
    found = read((OTHERS / "linux64" / "libpythonfmu-export.so").read_bytes())
    assert {"fmi2Instantiate", "fmi2DoStep", "fmi2FreeInstance"} <= set(found.exports)
    assert "libc.so.6" in found.libraries
    assert "PyErr_Clear" in found.unbound
    assert set(found.unbound) == {name for name in found.imports if "@" not in name}
    versions = [name.partition("@GLIBC_")[2] for name in found.imports if "@GLIBC_" in name]
    assert found.glibc in versions
    assert all(number(version) <= number(found.glibc) for version in versions)


def number(version: str) -> list[int]:
    return [int(word) for word in version.split(".")]


def test_a_pe_library_names_the_library_of_every_import() -> None:
    found = read((OTHERS / "win64" / "pythonfmu-export.dll").read_bytes())
    assert {"fmi2Instantiate", "fmi2DoStep", "fmi2FreeInstance"} <= set(found.exports)
    assert {"python3.dll", "KERNEL32.dll"} <= set(found.libraries)
    assert "PyErr_Clear" in found.imports
    assert (found.unbound, found.glibc) == ((), "")


def pe_of_32_bits(imports: bytes) -> bytes:
    """A library with one section, loaded to 0x1000, that begins with its table of imports."""
    data = b"MZ".ljust(60, b"\0") + struct.pack("<I", 64)
    data += struct.pack("<4s2xH12xH2xH", b"PE\0\0", 1, 112, 0x10B).ljust(24 + 96, b"\0")
    data += struct.pack("<4I", 0, 0, 0x1000, 40)
    data += struct.pack("<8s4I16x", b".idata", len(imports), 0x1000, len(imports), 256)
    return data.ljust(256, b"\0") + imports


def test_a_pe_library_of_32_bits_is_read() -> None:
    table = struct.pack("<I8xII20x", 0x1028, 0x1034, 0x1028)
    found = read(pe_of_32_bits(table + struct.pack("<III", 0x103E, 1 << 31 | 7, 0) + b"some.dll\0\0\0\0called\0"))
    assert found == Image(("some.dll",), ("#7", "called"), ())


def test_the_platform_is_that_of_the_header() -> None:
    found = {name: platform(library.read_bytes()) for name, library in OURS.items()}
    assert found == {"linux64": "x86_64-linux", "win64": "x86_64-windows"}
    assert platform(pe_of_32_bits(b"")) == ""  # of no machine
    assert platform(b"#!/bin/sh\n") == ""


@pytest.mark.parametrize("name", OURS)
def test_a_library_without_its_end_is_damaged(name: str) -> None:
    data = OURS[name].read_bytes()
    for length in (16, *range(1000, len(data), 1000), len(data) - 1):
        with pytest.raises(DamagedError):
            read(data[:length])


@pytest.mark.parametrize(
    "data",
    [b"", b"#!/bin/sh\n", b"\x7fELF\x01\x01\x01", b"\x7fELF\x02\x02\x01", b"\xcf\xfa\xed\xfe", b"MZ" + bytes(99)],
)
def test_a_file_of_another_kind_is_refused(data: bytes) -> None:
    with pytest.raises(ImageError, match="it is neither a 64-bit ELF nor a PE file"):
        read(data)


def survives(data: bytes) -> bool:
    """True if `data` can be read; exceptions other than ImageError reach the test."""
    try:
        read(data)
    except ImageError:
        return False
    return True


@pytest.mark.parametrize("platform", OURS)
def test_a_library_cut_short_is_read_or_refused(platform: str) -> None:
    data = OURS[platform].read_bytes()
    kept = [survives(data[:length]) for length in range(0, len(data), 61)]
    assert kept.count(False) > 100
    assert not any(kept[: len(kept) // 2])


@pytest.mark.parametrize("platform", OURS)
def test_a_library_with_wrong_bits_is_read_or_refused(platform: str) -> None:
    data = OURS[platform].read_bytes()
    chance = random.Random(1)
    kept = []
    for _ in range(300):
        wrong = bytearray(data)
        for _ in range(chance.choice((1, 10, 100))):
            wrong[chance.randrange(len(wrong))] ^= 1 << chance.randrange(8)
        kept.append(survives(bytes(wrong)))
    assert {True, False} == set(kept)


@pytest.mark.parametrize("platform", OURS)
def test_any_byte_of_the_headers_may_be_wrong(platform: str) -> None:
    data = OURS[platform].read_bytes()
    places = random.Random(1).sample([*range(1024), *range(len(data) - 64 * 40, len(data))], 1000)
    kept = [survives(data[:at] + bytes([value]) + data[at + 1 :]) for at in places for value in (0, 0xFF)]
    assert {True, False} == set(kept)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.sampled_from([b"\x7fELF\x02\x01", b"MZ".ljust(60, b"\0") + b"\x40\0\0\0PE\0\0"]), st.binary(max_size=400))
def test_any_bytes_after_a_right_beginning_are_read_or_refused(start: bytes, rest: bytes) -> None:
    survives(start + rest)


@pytest.mark.long
def test_tables_that_lead_in_circles_are_refused() -> None:
    """A megabyte of libraries each of which imports all of that megabyte: by the letter, 10^10 names."""
    with pytest.raises(ImageError, match="it is damaged"):
        read(pe_of_32_bits(struct.pack("<I", 0x1000) * (1 << 18) + bytes(20)))
