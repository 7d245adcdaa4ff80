"""A worker at the end of two pipes, as the Windows library starts it: messages as in native/message.h."""

from __future__ import annotations

import math
import shutil
import struct
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fmu_host import unpacked

from contact_core import Scene
from fmu_src.isolated.message import Operation
from fmu_src.package.build import build
from fmu_src.runtime.resources import guid

pytestmark = pytest.mark.fmu

OK = 0


class PipeHost:
    """The library's side of the pipes."""

    def __init__(self, resources: Path):
        command = [sys.executable, "-I", "-X", "utf8", str(resources / "start.py"), "--pipe"]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0
        )

    def __enter__(self) -> PipeHost:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.communicate()

    def send(self, data: bytes) -> None:
        self.process.stdin.write(struct.pack("<Q", len(data)) + data)

    def receive(self) -> bytes:
        (size,) = struct.unpack("<Q", self._exactly(8))
        return self._exactly(size)

    def _exactly(self, size: int) -> bytes:
        data = b""
        while len(data) < size:
            more = self.process.stdout.read(size - len(data))
            assert more, self.process.stderr.read().decode()
            data += more
        return data

    def ask(self, operation: Operation, payload: bytes = b"", numbers: tuple[float, ...] = (0.0, 0.0, 0.0)) -> bytes:
        self.send(struct.pack("<IIQQQQ3d", operation, 0, 0, 0, 0, len(payload), *numbers) + payload)
        return self.receive()

    def end(self) -> tuple[int, str]:
        """Exit code and stderr, once the pipe to the worker is closed."""
        self.process.stdin.close()
        self.process.stdin = None
        _, errors = self.process.communicate(timeout=120)
        return self.process.returncode, errors.decode()


@pytest.fixture(scope="module")
def resources(scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pipe")
    return unpacked(build(scene, folder / "small.fmu", "isolated"), folder / "fmu") / "resources"


def edited(resources: Path, folder: Path, file: str, edit: Callable[[str], str]) -> Path:
    """The resources with one file changed."""
    copy = Path(shutil.copytree(resources, folder / "resources"))
    (path,) = copy.glob(file)
    path.write_text(edit(path.read_text()))
    return copy


def opened(host: PipeHost, scene: Scene) -> None:
    assert host.receive() == b"R"
    assert status(host.ask(Operation.OPEN, b"a\0" + guid(scene, "isolated").encode())) == OK


def status(answer: bytes) -> int:
    return struct.unpack_from("<I", answer)[0]


def test_it_is_ready_opens_steps_and_leaves_when_asked(resources: Path, scene: Scene) -> None:
    with PipeHost(resources) as host:
        opened(host, scene)
        assert status(host.ask(Operation.SETUP, numbers=(0.0, math.nan, math.nan))) == OK
        for operation in (Operation.ENTER, Operation.EXIT):
            assert status(host.ask(operation)) == OK
        answer = host.ask(Operation.STEP, numbers=(0.0, 1.0, 0.0))
        _, phase, outputs, _ = struct.unpack_from("<IIQQ", answer)
        assert (status(answer), phase) == (OK, 2)  # after initialisation
        assert outputs > 20
        host.send(struct.pack("<IIQQQQ3d", Operation.QUIT, 0, 0, 0, 0, 0, 0.0, 0.0, 0.0))
        assert host.end() == (0, "")


def test_what_the_model_prints_is_no_message(resources: Path, scene: Scene, tmp_path: Path) -> None:
    spoken = edited(
        resources, tmp_path, "mixed_contact_*.py", lambda text: f"print('said by the model', flush=True)\n{text}"
    )
    with PipeHost(spoken) as host:
        opened(host, scene)
        code, errors = host.end()
    assert code == 1
    assert "said by the model" in errors
    assert "EOFError: The host has closed the pipe." in errors


def test_a_missing_package_is_told_before_anything_else(resources: Path, tmp_path: Path) -> None:
    lacking = "no_such_package"
    foreign = edited(resources, tmp_path, "start.py", lambda text: text.replace("fmu_src.isolated.worker", lacking))
    with PipeHost(foreign) as host:
        assert host.receive().startswith(b"ENo module named 'no_such_package'")
        assert host.end() == (1, "")
