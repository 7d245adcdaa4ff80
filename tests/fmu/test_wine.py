"""The libraries for Windows in a Windows host, under Wine: pip install ziglang, apt-get install wine."""

import os
import shutil
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import pytest
import wine_host
from fmu_host import unpacked
from wine_host import Relay, WineHost, windows_path

from benchmarks.hosts import native_host
from benchmarks.hosts.native_host import ERROR, NONE, OK, Instance, NativeHost, plain_environment
from benchmarks.hosts.processes import soon
from contact_core import Scene
from fmu_src.flavours import Version
from fmu_src.package.build import build

pytestmark = [
    pytest.mark.fmu,
    pytest.mark.skipif(not wine_host.available(), reason="needs Wine and zig"),
]

Hosts = Callable[..., AbstractContextManager[WineHost]]


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return wine_host.compiled(tmp_path_factory.mktemp("programs"))


@pytest.fixture(scope="module")
def windows(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    return wine_host.prefix(tmp_path_factory.mktemp("windows"))


@pytest.fixture(scope="module")
def isolated(scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wine")
    return unpacked(build(scene, folder / "small.fmu", "isolated"), folder / "a ü#+ b")


@pytest.fixture
def relay() -> Iterator[Relay]:
    relay = Relay()
    yield relay
    relay.close()


@pytest.fixture
def hosts(programs: tuple[Path, Path], windows: dict[str, str], relay: Relay) -> Hosts:
    @contextmanager
    def start(**variables: str) -> Iterator[WineHost]:
        host, worker = programs
        with WineHost(host, windows | relay.environment(worker) | variables) as running:
            yield running
        assert running.code == 0

    return start


def run(host: NativeHost, folder: Path, **start: int) -> list[object]:
    """Outputs of three steps, the last again after a restore."""
    instance = host.load(folder).instance()
    assert instance.created.status == OK
    assert set(instance.initialise(**start)) == {OK}
    found: list[object] = []
    for load in (20.0, 40.0):
        assert instance.step(60.0, load=load) == OK
        found.append(instance.outputs())
    assert instance.ask("save", 0).status == OK
    for _ in range(2):
        assert instance.ask("restore", 0).status == OK
        assert instance.ask("step", 120.0, 60.0).status == OK
        found.append(instance.outputs())
    instance.free()
    return found


def stepped(host: WineHost, folder: Path) -> tuple[Instance, list[object]]:
    """An instance with a saved state, and the outputs of the step after it."""
    instance = host.load(folder).instance()
    assert instance.initialise() == [OK] * 3
    assert instance.step(60.0) == OK
    assert instance.ask("save", 0).status == OK
    return instance, continued(instance)


def continued(instance: Instance) -> list[object]:
    assert instance.ask("restore", 0).status == OK
    assert instance.ask("step", 60.0, 60.0).status == OK
    return [instance.outputs()]


def gone(worker) -> bool:
    return soon(lambda: worker.poll() is not None)


def agree(hosts: Hosts, folder: Path, tmp_path: Path, **start: int) -> None:
    """Windows gives the bits of Linux, also after a restore."""
    with hosts() as host:
        found = run(host, folder, **start)
    with NativeHost(native_host.compiled(tmp_path), plain_environment()) as host:
        assert run(host, folder, **start) == found
    assert found[2] == found[3]


def test_windows_gives_the_bits_of_linux(hosts: Hosts, isolated: Path, tmp_path: Path) -> None:
    agree(hosts, isolated, tmp_path, surface_1__seed=3)


def test_windows_gives_the_bits_of_linux_by_fmi_3(hosts: Hosts, scene: Scene, tmp_path: Path) -> None:
    fmu = build(scene, tmp_path / "small.fmu", "isolated", fmi=3)
    agree(hosts, unpacked(fmu, tmp_path / "a ü#+ b"), tmp_path, surface_1__seed=3)


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_native_fmu_for_windows_gives_the_bits_of_linux(
    hosts: Hosts, quick: Scene, relay: Relay, tmp_path: Path, fmi: Version
) -> None:
    fmu = build(quick, tmp_path / "native.fmu", "native", fmi=fmi)
    agree(hosts, unpacked(fmu, tmp_path / "a ü#+ b"), tmp_path)
    assert not relay.commands  # no Python


def test_the_worker_is_started_isolated_and_for_one_instance(hosts: Hosts, isolated: Path, relay: Relay) -> None:
    with hosts() as host:
        fmu = host.load(isolated)
        for number in range(2):
            fmu.instance(number)
    script = windows_path(isolated / "resources" / "start.py")
    assert [command.partition(" ")[2] for command in relay.commands] == [f'-I -X utf8 "{script}" --pipe'] * 2
    assert all(map(gone, relay.workers))


@pytest.mark.parametrize("idle", [True, False])
def test_a_killed_worker_is_an_error_and_its_state_is_restored(
    hosts: Hosts, isolated: Path, relay: Relay, idle: bool
) -> None:
    with hosts() as host:
        instance, undisturbed = stepped(host, isolated)
        other = instance.fmu.instance(1)
        if idle:
            relay.workers[0].kill()
            assert gone(relay.workers[0])
            time.sleep(1.0)  # for the relay to leave, too
        else:
            os.kill(relay.workers[0].pid, signal.SIGSTOP)
            host.tell("step", 0, (60.0).hex(), (60.0).hex())
            time.sleep(0.2)
            relay.workers[0].kill()
            answer = host.answer()
            assert answer.status == ERROR
            assert "lost: It ended with exit code 3" in answer.log[-1][3]
        assert continued(instance) == undisturbed
        assert other.initialise() == [OK] * 3


def test_a_hanging_worker_is_killed_at_the_limit(hosts: Hosts, isolated: Path, relay: Relay) -> None:
    with hosts(TRIBOFMU_TIMEOUT="15") as host:
        instance, undisturbed = stepped(host, isolated)
        os.kill(relay.workers[0].pid, signal.SIGSTOP)
        assert instance.step(60.0) == ERROR
        assert "no answer within 15 s" in instance.log[-1][3]
        assert gone(relay.workers[0])
        assert continued(instance) == undisturbed


def test_workers_end_with_a_killed_host(hosts: Hosts, isolated: Path, relay: Relay) -> None:
    with pytest.raises(AssertionError), hosts() as host:  # its exit code is not 0
        fmu = host.load(isolated)
        for number in range(2):
            assert fmu.instance(number).created.status == OK
        host.process.kill()
    assert len(relay.workers) == 2
    assert all(map(gone, relay.workers))


def test_what_cannot_run_the_model_is_told(hosts: Hosts, isolated: Path, tmp_path: Path) -> None:
    for python, reason in (
        ("C:\\nö\\python.exe", "TRIBOFMU_PYTHON names the Python 'C:\\nö\\python.exe', which cannot be run"),
        ("C:\\windows\\system32\\hostname.exe", "hostname.exe' ended before it was ready."),
    ):
        with hosts(TRIBOFMU_PYTHON=python) as host:
            created = host.load(isolated).instance().created
        assert created.status == NONE
        assert reason in created.log[-1][3]
        assert "Set TRIBOFMU_PYTHON to the Python" in created.log[-1][3]


def test_a_missing_package_is_told(hosts: Hosts, isolated: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(isolated, tmp_path / "fmu"))
    start = folder / "resources" / "start.py"
    start.write_text(start.read_text().replace("fmu_src.isolated.worker", "no_such_package"))
    with hosts() as host:
        created = host.load(folder).instance().created
    assert created.status == NONE
    assert "No module named 'no_such_package'" in created.log[-1][3]


def test_the_interpreter_is_the_recorded_one_or_on_path(
    hosts: Hosts, isolated: Path, programs: tuple[Path, Path], relay: Relay, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(isolated, tmp_path / "fmu"))
    for python in ("python.exe", "recorded.exe"):
        shutil.copy(programs[1], tmp_path / python)
    with hosts(TRIBOFMU_PYTHON="", WINEPATH=windows_path(tmp_path)) as host:
        assert host.load(folder).instance().created.status == OK
    (folder / "resources" / "python.txt").write_text(windows_path(tmp_path / "recorded.exe"))
    with hosts(TRIBOFMU_PYTHON="", WINEPATH=windows_path(tmp_path)) as host:
        assert host.load(folder).instance().created.status == OK
    started = [command.partition('"')[2].partition('"')[0] for command in relay.commands]
    assert started == [windows_path(tmp_path / python) for python in ("python.exe", "recorded.exe")]


def test_resources_are_found_by_uri_if_not_beside_the_library(hosts: Hosts, isolated: Path, tmp_path: Path) -> None:
    (tmp_path / "binaries" / "win64").mkdir(parents=True)
    shutil.copy(isolated / "modelDescription.xml", tmp_path)
    shutil.copy(isolated / "binaries" / "win64" / "MixedContact.dll", tmp_path / "binaries" / "win64")
    uri = (isolated / "resources").as_uri().replace("file://", "file:///Z:")
    with hosts() as host:
        assert host.load(tmp_path, uri=uri).instance().created.status == OK
        missing = host.load(tmp_path, uri="file:///Z:/nowhere").instance(1).created
    assert missing.status == NONE
    assert "nor" in missing.log[-1][3]


def test_instances_start_in_threads_at_once_and_end_when_freed(hosts: Hosts, isolated: Path, relay: Relay) -> None:
    with hosts() as host:
        fmu = host.load(isolated)
        assert host.together(("instantiate", number, fmu.number, 1) for number in range(4)).status == OK
        assert len(relay.workers) == 4
        assert [worker.poll() for worker in relay.workers] == [None] * 4
        assert host.together(("free", number) for number in range(4)).status == OK
        assert all(map(gone, relay.workers))


def test_instances_live_on_in_a_host_that_loads_the_library_again_for_each(hosts: Hosts, isolated: Path) -> None:
    with hosts() as host:
        fmu = host.load(isolated)
        instances = []
        for number in range(2):
            assert host.ask("reload", fmu.number).status == OK
            instances.append(fmu.instance(number))
            assert set(instances[-1].initialise()) == {OK}
        assert [instance.step(60.0) for instance in instances] == [OK] * 2
        assert instances[0].outputs() == instances[1].outputs()
        assert host.ask("unload", fmu.number).status == OK  # before they are freed
        for instance in instances:
            instance.free()
