"""FMUs of which the archive is damaged, locked, endless or hostile: `check` and `cosim` say so in a sentence."""

import io
import stat
import tempfile
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from system_models.check import report
from system_models.check.package import opened
from system_models.cli.main import main
from system_models.fmu import archive
from system_models.fmu.errors import CouplingError, FmuError
from system_models.fmu.model import Model

XML = "modelDescription.xml"
DESCRIPTION = """<?xml version="1.0"?>{doctype}
<fmiModelDescription fmiVersion="3.0" modelName="three" instantiationToken="3">
  <CoSimulation modelIdentifier="three"/>
  <ModelVariables>
    <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
    <Float64 name="x" valueReference="1" causality="output" initial="exact" start="1"/>
  </ModelVariables>
  <ModelStructure><Output valueReference="1" dependencies=""/></ModelStructure>
</fmiModelDescription>
"""


def packed(files: dict[str, str]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as fmu:
        for name, text in files.items():
            info = zipfile.ZipInfo("x")
            info.filename = name  # as it is: the constructor changes backslashes and zeros
            fmu.writestr(info, text, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


GOOD = packed({XML: DESCRIPTION.format(doctype=""), "sources/three.c": "int x;\n" * 20, "resources/": ""})


def read_by_all(data: bytes) -> None:
    """Judged, coupled and unpacked: what is raised for a user to read is left, all else fails the test."""
    with tempfile.TemporaryDirectory() as folder:
        fmu = Path(folder, "it.fmu")
        fmu.write_bytes(data)
        with suppress(FmuError), opened(fmu) as package:
            report.static.archive(package)
            report.static.icon(package)
        with suppress(CouplingError):
            _ = Model("it", fmu).initial_dependencies
        with suppress(FmuError), archive.opened(fmu) as file:
            file.unpack(Path(folder, "below", "unpacked"))
        assert {path.name for path in Path(folder).iterdir()} <= {"it.fmu", "below"}
        assert {path.name for path in Path(folder).glob("below/*")} <= {"unpacked"}


# most of an archive is its packed content: damage of its records is more often of its end
PLACES = st.one_of(st.integers(0, len(GOOD)), st.integers(-330, -1))
DAMAGE = st.tuples(PLACES, st.integers(0, 30), st.one_of(st.binary(max_size=9), st.sampled_from([b"\xff" * 4])))


@given(st.lists(DAMAGE, min_size=1, max_size=5))
def test_an_archive_with_any_damage_is_read_or_refused_in_a_sentence(damages: list[tuple[int, int, bytes]]) -> None:
    data = bytearray(GOOD)
    for place, count, instead in damages:
        begin = place % (len(data) + 1)
        data[begin : begin + count] = instead
    read_by_all(bytes(data))


PARTS = st.sampled_from(["..", ".", "", "a", "C:", "resources", "x" * 300, "\x1b[31m", "\0", "\u202e", "~", "nul"])
NAMES = st.one_of(st.text(max_size=9), st.lists(PARTS, max_size=4).map("/".join), st.lists(PARTS).map("\\".join))


@given(st.lists(NAMES, max_size=4))
def test_files_of_any_name_stay_in_the_folder_or_are_refused(names: list[str]) -> None:
    plain = {name: "x" for name in names if name.isascii() or name.encode("utf-8", "ignore").decode() == name}
    read_by_all(packed({XML: DESCRIPTION.format(doctype=""), **plain}))


def patched(record: bytes, offset: int, value: bytes) -> bytes:
    """A copy of which every record of a kind says something else."""
    data, place = bytearray(GOOD), -1
    while (place := data.find(record, place + 1)) >= 0:
        data[place + offset : place + offset + len(value)] = value
    return bytes(data)


def with_a_link() -> bytes:
    info = zipfile.ZipInfo("resources/link")
    info.create_system, info.external_attr = 3, (stat.S_IFLNK | 0o777) << 16
    buffer = io.BytesIO(GOOD)
    with zipfile.ZipFile(buffer, "a") as fmu:
        fmu.writestr(info, "/etc")
    return buffer.getvalue()


DIRECTORY = b"PK\1\2"
REFUSED = {  # by both commands
    "encrypted": (patched(DIRECTORY, 8, b"\1"), "'modelDescription.xml' is encrypted"),
    "method": (patched(DIRECTORY, 10, b"\x63"), "packed by another method than deflate"),
    "bomb": (patched(DIRECTORY, 24, (1 << 30).to_bytes(4, "little")), "would unpack to 1024 MB"),
    "long": (patched(DIRECTORY, 24, (80 << 20).to_bytes(4, "little")), "has 80 MB, and at most 64 MB are read"),
    "header": (patched(b"PK\3\4", 0, b"PK\3\5"), "Bad magic number"),
    "garbled": (GOOD[: 30 + len(XML)] + b"\xff" + GOOD[31 + len(XML) :], "Error -3 while decompressing data"),
    "external": (packed({XML: DESCRIPTION.format(doctype='<!DOCTYPE x SYSTEM "file:///etc/hostname">')}), "DOCTYPE"),
    "entity": (packed({XML: DESCRIPTION.format(doctype='<!DOCTYPE x [<!ENTITY a "b">]>')}), "it has a DOCTYPE"),
    "none": (packed({"sources/three.c": ""}), "holds no modelDescription.xml"),
    "text": (b"no archive", "is not a zip archive, or is cut short"),
}


@pytest.mark.parametrize("name", REFUSED)
@pytest.mark.parametrize("command", ["check", "cosim"])
def test_what_cannot_be_read_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, command: str
) -> None:
    data, said = REFUSED[name]
    (tmp_path / "it.fmu").write_bytes(data)
    (tmp_path / "it.toml").write_text('[fmus]\na = "it.fmu"\n[simulate]\nstop_time = 1.0\nstep_size = 0.1\n')
    assert main([command, str(tmp_path / ("it.fmu" if command == "check" else "it.toml"))]) == 2
    assert said in capsys.readouterr().err


UNFIT: dict[str, tuple[Callable[[], bytes], str]] = {
    "backslash": (lambda: packed({XML: DESCRIPTION.format(doctype=""), "a\\b": ""}), "must be relative, without"),
    "absolute": (lambda: packed({XML: DESCRIPTION.format(doctype=""), "/tmp/b": ""}), "must be relative, without"),
    "link": (with_a_link, "'resources/link' is a symbolic link"),
    "both": (lambda: packed({XML: DESCRIPTION.format(doctype=""), "a": "", "a/b": ""}), "'a' is a file and a folder"),
    "control": (lambda: packed({XML: DESCRIPTION.format(doctype=""), "\x1b[31m\\": ""}), r"'\x1b[31m\' must be"),
    "long": (
        lambda: packed({XML: DESCRIPTION.format(doctype=""), f"a/{'b' * 256}": ""}),
        "a name of more than 255 bytes",
    ),
}


@pytest.mark.parametrize("name", UNFIT)
def test_what_must_not_be_unpacked_is_judged_and_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    make, said = UNFIT[name]
    fmu = tmp_path / "it.fmu"
    fmu.write_bytes(make())
    assert main(["check", str(fmu)]) == 1
    printed = capsys.readouterr().out
    assert any(line.startswith("archive ") and " fail " in line and said in line for line in printed.splitlines())
    assert "\x1b" not in printed
    with archive.opened(fmu) as file, pytest.raises(FmuError, match="is not fit to be unpacked"):
        file.unpack(tmp_path / "unpacked")


def test_a_file_that_is_there_twice_fails_where_hosts_would_differ(tmp_path: Path) -> None:
    for second, verdict in (("int x;\n" * 20, "note"), ("int y;", "fail")):
        buffer = io.BytesIO(GOOD)
        with zipfile.ZipFile(buffer, "a") as fmu, pytest.warns(UserWarning, match="Duplicate"):
            fmu.writestr("sources/three.c", second)
        (tmp_path / "it.fmu").write_bytes(buffer.getvalue())
        with opened(tmp_path / "it.fmu") as package:
            assert report.static.archive(package).verdict == verdict


@pytest.mark.parametrize("library", ["../../three", "/tmp/three", "..\\\\three"])
def test_a_library_out_of_the_folder_is_not_loaded(tmp_path: Path, library: str) -> None:
    outside = DESCRIPTION.format(doctype="").replace('modelIdentifier="three"', f'modelIdentifier="{library}"')
    (tmp_path / "it.fmu").write_bytes(packed({XML: outside}))
    with pytest.raises(CouplingError, match="as its library, a path and no name"):
        Model("it", tmp_path / "it.fmu")
