"""One small FMU, built and unpacked once: 17 nodes, every law in use: what flows, not how well it is resolved."""

import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from fmu_host import Host, hosted
from native_host import compiled

from contact_core import Scene
from fmu_src import build

SMALL = {
    "film.points": "17",
    "surface_1.correlation_length": "32 um",
    "surface_2.correlation_length": "32 um",
}


def unpacked(fmu: Path, folder: Path) -> Path:
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    return folder


@pytest.fixture(scope="session")
def scene() -> Scene:
    return Scene.from_toml("mtm_zddp", SMALL)


@pytest.fixture(scope="session")
def other_scene() -> Scene:
    return Scene.from_toml("azam_case_a", SMALL | {"tribofilm.model": "none"})


@pytest.fixture(scope="session")
def fmu_file(scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(scene, tmp_path_factory.mktemp("fmu") / "small.fmu", "embedded")


@pytest.fixture(scope="session")
def folder(fmu_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return unpacked(fmu_file, tmp_path_factory.mktemp("unpacked"))


@pytest.fixture
def host(folder: Path) -> Iterator[Host]:
    with hosted(folder) as host:
        yield host


@pytest.fixture(scope="session")
def stored(folder: Path) -> bytes:
    """State of an FMU after its first step."""
    with hosted(folder) as host:
        host.initialise()
        host.step(60.0)
        return host.state()


@pytest.fixture
def stepped(host: Host, stored: bytes) -> Host:
    """An FMU after its first step."""
    host.restore(stored)
    return host


@pytest.fixture(scope="session")
def quick() -> Scene:
    return Scene.from_toml("mtm_zddp", SMALL).at_level("regression")


@pytest.fixture(scope="session")
def quick_folder(quick: Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("isolated")
    return unpacked(build(quick, folder / "quick.fmu"), folder / "quick")


@pytest.fixture(scope="session")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled(tmp_path_factory.mktemp("c_host"))
