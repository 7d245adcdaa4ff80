"""The committed libraries of the isolated flavour: imports, exports, and equality with a build of the sources."""

import re
import shutil
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest
from fmu_host import unpacked

from benchmarks.hosts.native_host import OK, NativeHost, compiled, plain_environment
from contact_core import Scene
from fmu_src.isolated.library import build, image
from fmu_src.package.build import binaries
from fmu_src.package.build import build as build_fmu

pytestmark = pytest.mark.fmu

COMMITTED = {name: build.FOLDER / "binaries" / name / platform.library for name, platform in build.PLATFORMS.items()}
OLDEST_GLIBC = (2, 17)


def declared() -> set[str]:
    """Functions of FMI 2.0 and 3.0, by their headers."""
    headers = sorted((Path(find_spec("fmpy").origin).parent / "c-code").glob("fmi[23]Functions.h"))
    return {name for file in headers for name in re.findall(r"FMI\d_Export\s+\w+\s+(fmi\d\w+);", file.read_text())}


@pytest.mark.parametrize("platform", COMMITTED)
def test_every_function_of_fmi_and_nothing_else_is_exported(platform: str) -> None:
    assert len(declared()) == 44 + 75
    assert set(image.read(COMMITTED[platform].read_bytes()).exports) == declared()


def test_linux_needs_an_old_c_library_and_no_python() -> None:
    found = image.read(COMMITTED["linux64"].read_bytes())
    assert set(found.libraries) <= {"libc.so.6", "libdl.so.2", "libpthread.so.0"}
    assert len(found.imports) > 20
    for name in found.imports:
        symbol, _, version = name.partition("@GLIBC_")
        assert tuple(map(int, version.split("."))) <= OLDEST_GLIBC, name
        assert not symbol.startswith(("Py", "_Py"))


def test_windows_needs_what_every_windows_10_has_and_no_python() -> None:
    found = image.read(COMMITTED["win64"].read_bytes())
    assert "KERNEL32.dll" in found.libraries
    assert all(re.fullmatch(r"KERNEL32\.dll|api-ms-win-crt-[a-z]+-l1-1-0\.dll", name) for name in found.libraries)
    assert "CreateProcessW" in found.imports
    assert not [name for name in found.imports if name.startswith(("Py", "_Py"))]


def test_an_isolated_fmu_takes_all_of_them() -> None:
    suffixes = {"linux64": ".so", "win64": ".dll"}
    expected = {f"binaries/{name}/Model{suffixes[name]}": path.read_bytes() for name, path in COMMITTED.items()}
    assert binaries("isolated", "Model") == expected


@pytest.mark.parametrize("platform", COMMITTED)
def test_no_source_is_newer_than_its_library(platform: str) -> None:
    made_from = COMMITTED[platform].with_name(build.MADE_FROM).read_text().strip()
    way_out = "Run python -m fmu_src.isolated.library.build and commit the libraries."
    assert build.fingerprint(platform) == made_from, way_out


@pytest.mark.skipif(not build.available("zig"), reason="needs zig: pip install tribofmu[native]")
@pytest.mark.parametrize("platform", COMMITTED)
def test_zig_makes_the_committed_bytes(platform: str, tmp_path: Path) -> None:
    assert build.build(platform, "zig", tmp_path).read_bytes() == COMMITTED[platform].read_bytes()


@pytest.mark.skipif(not build.available("gcc"), reason="needs gcc")
@pytest.mark.long
def test_the_sources_behave_as_the_committed_library(scene: Scene, tmp_path: Path) -> None:
    program = compiled(tmp_path)
    file = build_fmu(scene, tmp_path / "small.fmu", "isolated")
    shipped, rebuilt = unpacked(file, tmp_path / "shipped"), unpacked(file, tmp_path / "rebuilt")
    (library,) = (rebuilt / "binaries" / "linux64").iterdir()
    assert library.read_bytes() == COMMITTED["linux64"].read_bytes()
    shutil.copyfile(build.build("linux64", "gcc", tmp_path), library)
    assert library.read_bytes() != COMMITTED["linux64"].read_bytes()
    assert scenario(program, rebuilt) == scenario(program, shipped)


def scenario(program: Path, folder: Path) -> list[object]:
    """Every answer of a short run with a rollback, refused calls and wrong references."""
    found: list[object] = []
    with NativeHost(program, plain_environment()) as host:
        fmu = host.load(folder)
        instance = fmu.instance()
        assert instance.created.status == OK
        found.append(instance.initialise(load=40.0))
        for command in ("save", "restore"):
            found.append(instance.ask(command, 0))
            found.append((instance.step(1.0, load=50.0), instance.outputs()))
        found += [instance.ask("getr", 9999), instance.ask("setr", 9999, 1.0), instance.ask("derivative", 1, 2)]
        found += [instance.ask("freestate", 0), instance.ask("reset"), instance.outputs(), instance.log]
        found.append(fmu.host.load(folder, guid="other").instance(1).created)
        instance.free()
        found.append(instance.ask("step", 0.0, 1.0))
    return [*found, host.code]


@pytest.mark.skipif(not find_spec("hatchling"), reason="needs hatchling")
def test_the_wheel_has_libraries_and_sources(tmp_path: Path) -> None:
    root = build.FOLDER.parents[2]
    make = "import sys; from hatchling.build import build_wheel; print(build_wheel(sys.argv[1]))"
    subprocess.run([sys.executable, "-c", make, str(tmp_path)], cwd=root, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    expected = [path.relative_to(root).as_posix() for path in (*build.FOLDER.glob("*.[ch]"), *COMMITTED.values())]
    assert len(expected) > 10
    assert set(expected) <= set(names)
