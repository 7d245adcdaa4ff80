"""A C program under Wine as the host of FMUs. Wine has no Python: workers run outside, behind a relay."""

from __future__ import annotations

import contextlib
import os
import re
import select
import socket
import subprocess
import sys
import threading
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from shutil import which

import fmpy

from benchmarks.hosts import native_host
from benchmarks.hosts.native_host import Fmu, NativeHost, plain_environment

_HERE = Path(__file__).parent


def available() -> bool:
    return which("wine") is not None and find_spec("ziglang") is not None


def compiled(folder: Path) -> tuple[Path, Path]:
    """The host of c_host.c and the relay, as programs for Windows in `folder`."""
    zig = [sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu", "-std=gnu11", "-O2", "-g0", "-s"]
    headers = Path(fmpy.__file__).parent / "c-code"
    host = ["-w", "-I", _HERE / "windows", "-I", headers, native_host.SOURCE, "-o", folder / "c_host.exe"]
    relay = [_HERE / "windows" / "relay.c", "-lws2_32", "-o", folder / "relay.exe"]
    for arguments in (host, relay):
        subprocess.run([*zig, *map(str, arguments)], check=True)
    return folder / "c_host.exe", folder / "relay.exe"


def prefix(folder: Path) -> dict[str, str]:
    """Environment of a new Windows in `folder`."""
    environment = plain_environment() | {"WINEPREFIX": str(folder), "WINEDEBUG": "-all", "DISPLAY": ""}
    subprocess.run(["wine", "wineboot", "-i"], env=environment, check=True, capture_output=True)
    return environment


def windows_path(path: Path) -> str:
    return "Z:" + str(path).replace("/", "\\")


class Relay:
    """Workers for those who run relay.exe."""

    def __init__(self) -> None:
        self._lines, self._errors = (socket.create_server(("127.0.0.1", 0)) for _ in range(2))
        self.commands: list[str] = []
        self.workers: list[subprocess.Popen[bytes]] = []
        threading.Thread(target=self._serve, daemon=True).start()

    def environment(self, program: Path) -> dict[str, str]:
        return {
            "TRIBOFMU_PYTHON": windows_path(program),
            "RELAY_PORT": str(self._lines.getsockname()[1]),
            "RELAY_ERRORS": str(self._errors.getsockname()[1]),
        }

    def close(self) -> None:
        for listener in (self._lines, self._errors):
            listener.shutdown(socket.SHUT_RDWR)
            listener.close()

    def _serve(self) -> None:
        with contextlib.suppress(OSError):  # closed
            while True:
                line, _ = self._lines.accept()
                line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                command = b""
                while not command.endswith(b"\0"):
                    command += line.recv(4096)
                line.send(b"!")
                errors, _ = self._errors.accept()
                self.commands.append(command[:-1].decode())
                self._start(line, errors)

    def _start(self, line: socket.socket, errors: socket.socket) -> None:
        options, start = re.fullmatch(r'"[^"]+" (.*) "Z:([^"]+)" --pipe', self.commands[-1]).groups()
        worker = subprocess.Popen(
            [sys.executable, *options.split(), start.replace("\\", "/"), "--pipe"],
            stdin=line,
            stdout=line,
            stderr=errors,
            env=plain_environment(),
        )
        self.workers.append(worker)
        threading.Thread(target=_attend, args=(worker, line, errors), daemon=True).start()


def _attend(worker: subprocess.Popen[bytes], line: socket.socket, errors: socket.socket) -> None:
    """A worker ends with its relay, and the relay with its worker."""
    gone = select.poll()
    gone.register(line, select.POLLRDHUP)
    ended = os.pidfd_open(worker.pid)
    gone.register(ended, select.POLLIN)
    gone.poll()
    worker.kill()
    worker.wait()
    os.close(ended)
    for end in (errors, line):
        with contextlib.suppress(OSError):
            end.shutdown(socket.SHUT_RDWR)
        end.close()


class WineHost(NativeHost):
    """A host under Wine."""

    def __init__(self, program: Path, environment: Mapping[str, str]):
        self.process = subprocess.Popen(
            ["wine", str(program)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=dict(environment),
            text=True,
            encoding="utf-8",
        )
        self.code = None
        self._fmus = 0

    def load(self, folder: Path, uri: str | None = None, guid: str | None = None) -> Fmu:
        description = fmpy.read_model_description(str(folder), validate=False)
        fmi3 = description.fmiVersion.startswith("3")
        platform, nowhere = ("x86_64-windows", "C:\\nowhere\\") if fmi3 else ("win64", "file:///nowhere")
        library = folder / "binaries" / platform / f"{description.coSimulation.modelIdentifier}.dll"
        number, self._fmus = self._fmus, self._fmus + 1
        token = guid or description.guid
        loaded = self.ask("fmu", number, windows_path(library), uri or nowhere, token, *[3] * fmi3)
        return Fmu(self, number, loaded, {v.name: v for v in description.modelVariables})
