"""Tables and libraries of the native flavour: model.c, platforms, compilers."""

import shutil
import struct
from dataclasses import replace

import native_fmu
import pytest

from fmu_src.isolated.library import image
from fmu_src.native import build, files, model

pytestmark = [pytest.mark.fmu]

needs_zig = pytest.mark.skipif(not build.available("zig"), reason="needs zig: pip install tribofmu[native]")


def test_texts_become_literals_of_c() -> None:
    assert model.c_text('a "b" \\ é??') == '"a \\042b\\042 \\134 \\303\\251\\077\\077"'


def test_every_variable_stands_in_order_of_its_value_reference() -> None:
    text = model.model_c(native_fmu.table(), native_fmu.TOKEN, native_fmu.STATES)
    rows = text.split("MODEL_VARIABLES[] = {\n")[1].split("\n};")[0].splitlines()
    listed = native_fmu.table()
    assert [row.split('"')[1] for row in rows] == [v.name for v in listed]
    of = dict(zip((v.name for v in listed), rows, strict=True))
    assert '"load", REAL, INPUT, PLACE_OF_INPUT(load), 53.7}' in of["load"]
    assert "REAL, DERIVATIVE, PLACE_OF_OUTPUT(dfriction_dload), 0.0}" in of["dfriction_dload"]
    assert "BOOLEAN, VALID, 0, 0.0}" in of["valid"]
    assert "INTEGER, FIXED, 0, 1.0}" in of["fidelity"]
    assert "STRING, FIXED, 0, 0.0}" in of["initial_state"]


def test_what_the_sources_cannot_hold_is_refused() -> None:
    listed = list(native_fmu.table())
    with pytest.raises(ValueError, match="longer than 39 characters"):
        model.model_c(listed, 40 * "x", "states")
    load = replace(listed[0], maximum=float("inf"))
    with pytest.raises(ValueError, match="input load must be a Real with minimum"):
        model.model_c([load, *listed[1:]], "token", "states")
    state = next(k for k, v in enumerate(listed) if v.name == "initial_state")
    listed[state] = replace(listed[state], start="file")
    with pytest.raises(ValueError, match="initial_state starts as 'file'"):
        model.model_c(listed, "token", "states")


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
@pytest.mark.parametrize(("fmi", "platform"), [(2, "linux64"), (3, "x86_64-linux")])
def test_gcc_builds_for_this_linux_only(fmi: build.Fmi, platform: str) -> None:
    assert list(build.binaries(native_fmu.sources(fmi), fmi, "M", "gcc")) == [f"binaries/{platform}/M.so"]
    with pytest.raises(ValueError, match=rf"gcc does not build for win, but for {platform}\."):
        build.binaries(native_fmu.sources(fmi), fmi, "M", "gcc", ["win"])


def test_without_a_compiler_the_message_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build, "available", lambda compiler: False)
    with pytest.raises(FileNotFoundError, match=r"Install zig \(pip install tribofmu\[native\]\) or gcc"):
        build.default_compiler()


@needs_zig
def test_zig_names_platforms_as_each_version_of_fmi_does() -> None:
    assert build.platforms(2, "zig") == ("linux64", "win64", "darwin64")
    assert build.platforms(3, "zig") == (
        "x86_64-linux",
        "aarch64-linux",
        "x86_64-windows",
        "x86_64-darwin",
        "aarch64-darwin",
    )


@needs_zig
def test_zig_needs_an_old_c_library_and_gives_equal_bytes_again() -> None:
    chosen = ["x86_64-linux", "aarch64-darwin"]
    first, second = (build.binaries(native_fmu.sources(3), 3, "M", "zig", chosen) for _ in range(2))
    assert first == second
    found = image.read(first["binaries/x86_64-linux/M.so"])
    assert set(found.libraries) <= {"libc.so.6", "libm.so.6"}
    assert tuple(map(int, found.glibc.split("."))) <= (2, 17)


def test_a_universal_library_holds_its_parts_at_aligned_places() -> None:
    parts = [
        struct.pack("<III", 0xFEEDFACF, processor, kind) + bytes(n)
        for processor, kind, n in ((7, 3, 5), (12, 0, 40000))
    ]
    joined = build.universal(parts)
    magic, count = struct.unpack_from(">II", joined)
    assert (magic, count) == (0xCAFEBABE, 2)
    for k, part in enumerate(parts):
        processor, kind, offset, size, align = struct.unpack_from(">IIIII", joined, 8 + 20 * k)
        assert struct.pack("<II", processor, kind) == part[4:12]
        assert joined[offset : offset + size] == part
        assert offset % (1 << align) == 0


def test_the_runtime_is_all_sources_of_its_folder() -> None:
    names = {path.name for path in build.FOLDER.iterdir() if path.suffix in (".c", ".h")}
    assert names == {*build.RUNTIME[2], *build.RUNTIME[3], *files.WHERE_NEEDED}
    assert all((build.FOLDER / name).read_bytes() == data for name, data in build.runtime(3).items())
