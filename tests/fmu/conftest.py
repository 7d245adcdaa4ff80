"""Fixtures: small FMUs (17 nodes, unresolved; every law in use), each built once a run."""

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from built import Built
from fmu_host import LINE, SMALL, Host, hosted
from isolated import FAULTS, SCRIPT, UNSAVED

from benchmarks.hosts.native_host import compiled, embedding_environment, plain_environment
from contact_core import Scene
from fmu_src.flavours import WITH_PYTHON, Flavour
from fmu_src.runtime.resources import module_name


@pytest.fixture(scope="session", autouse=True)
def python_of_isolated_fmus() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TRIBOFMU_PYTHON", sys.executable)
        yield


@pytest.fixture(scope="session")
def scene() -> Scene:
    return Scene.from_toml("mtm_zddp", SMALL)


@pytest.fixture(scope="session")
def other_scene() -> Scene:
    return Scene.from_toml("azam_case_a", SMALL | {"tribofilm.model": "none"})


@pytest.fixture(scope="session")
def line_scene() -> Scene:
    return Scene.from_toml("fzg_flank", LINE)


@pytest.fixture(scope="session")
def line_file(line_scene: Scene, built: Built) -> Path:
    return built.fmu(line_scene, "embedded")


@pytest.fixture(scope="session")
def line_folder(line_scene: Scene, built: Built) -> Path:
    return built.unpacked(line_scene, "embedded")


@pytest.fixture(scope="session")
def fmu_file(scene: Scene, built: Built) -> Path:
    return built.fmu(scene, "embedded")


@pytest.fixture(scope="session")
def folder(scene: Scene, built: Built) -> Path:
    return built.unpacked(scene, "embedded")


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
def isolated_folder(quick: Scene, built: Built) -> Path:
    return built.unpacked(quick)


@pytest.fixture(scope="session")
def faulty_folder(quick: Scene, isolated_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("faulty") / "fmu"
    shutil.copytree(isolated_folder, folder)
    faults = "".join(f"\n        if load == {load}:\n            {what}" for load, (what, _) in FAULTS.items())
    (folder / "resources" / f"{module_name(quick)}.py").write_text(SCRIPT.format(faults=faults, unsaved=UNSAVED))
    return folder


@pytest.fixture(scope="session", params=WITH_PYTHON)
def flavour(request: pytest.FixtureRequest) -> Flavour:
    return request.param


@pytest.fixture(scope="session")
def flavoured_file(flavour: Flavour, scene: Scene, built: Built) -> Path:
    return built.fmu(scene, flavour)


@pytest.fixture(scope="session")
def flavoured_folder(flavour: Flavour, scene: Scene, built: Built) -> Path:
    return built.unpacked(scene, flavour)


@pytest.fixture(scope="session")
def quick_file(flavour: Flavour, quick: Scene, built: Built) -> Path:
    """A contact at the regression level: many instances cost little."""
    return built.fmu(quick, flavour)


@pytest.fixture(scope="session")
def quick_folder(flavour: Flavour, quick: Scene, built: Built) -> Path:
    return built.unpacked(quick, flavour)


@pytest.fixture(scope="session")
def native_program(built: Built) -> Path:
    """A host written in C."""
    if shutil.which("gcc") is None:
        pytest.skip("the host in C needs gcc")
    return built.folder("host in C", compiled) / "c_host"


@pytest.fixture(scope="session")
def embedding() -> dict[str, str]:
    """Environment with which the host in C can load the embedded flavour."""
    environment = embedding_environment()
    if environment is None:
        pytest.skip("this Python has no shared library that a host in C could load beforehand")
    return environment


@pytest.fixture(scope="session")
def native_environment(flavour: Flavour, request: pytest.FixtureRequest) -> dict[str, str]:
    """Environment of the host in C for a flavour."""
    return request.getfixturevalue("embedding") if flavour == "embedded" else plain_environment()
