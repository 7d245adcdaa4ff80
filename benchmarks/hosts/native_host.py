"""A C program as the host of FMUs: compiled once, controlled line by line (c_host.c lists the commands)."""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
import sysconfig
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import fmpy

from benchmarks.hosts.processes import marked, without_children

_numbers = itertools.count()

OK, WARNING, DISCARD, ERROR, FATAL = range(5)  # fmi2Status
NONE = -1  # no library, function or instance
SOURCE = Path(__file__).with_name("c_host.c")
LETTER = {"Real": "r", "Integer": "i", "Boolean": "b", "String": "s", "Float64": "r", "Int32": "i"}


def compiled(folder: Path) -> Path:
    """The program, compiled into `folder` by gcc."""
    program = folder / "c_host"
    headers = Path(fmpy.__file__).parent / "c-code"
    options = [
        "-std=c11",
        "-D_XOPEN_SOURCE=700",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-Wno-unused-parameter",
        "-O2",
        "-pthread",
    ]
    subprocess.run(["gcc", *options, "-I", str(headers), str(SOURCE), "-ldl", "-o", str(program)], check=True)
    return program


def plain_environment() -> dict[str, str]:
    """Environment without settings of Python except the interpreter of workers."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "LD_", "VIRTUAL_ENV"))}
    return kept | {"TRIBOFMU_PYTHON": sys.executable}


def embedding_environment() -> dict[str, str] | None:
    """Environment in which a host without Python can load pythonfmu's binary; None if there is no shared libpython."""
    variables = sysconfig.get_config_vars()
    library = Path(variables["LIBDIR"], variables["INSTSONAME"])
    if not variables["Py_ENABLE_SHARED"] or not library.exists():
        return None
    return plain_environment() | {
        "LD_PRELOAD": str(library),
        "PYTHONHOME": sys.base_prefix,
        "PYTHONPATH": os.pathsep.join(sys.path),
    }


@dataclass
class Answer:
    """Answer of the host to one command."""

    status: int
    values: list[str] = field(default_factory=list)
    log: list[tuple[int, int, str, str]] = field(default_factory=list)  # instance, status, category, message

    @property
    def reals(self) -> list[float]:
        return [float.fromhex(value) for value in self.values]


class HostDiedError(Exception):
    """The host ended before it had answered; `code` is its exit code (negative: the signal)."""

    def __init__(self, command: str, code: int):
        super().__init__(f"The host ended with {code} at {command!r}.")
        self.code = code


class NativeHost:
    """A running host. Closing it ends its input, so that it leaves by itself; `code` is its exit code then."""

    def __init__(self, program: Path, environment: Mapping[str, str]):
        self._mark = f"TEST_HOST={os.getpid()}-{next(_numbers)}"
        name, _, value = self._mark.partition("=")
        self.process = subprocess.Popen(
            [str(program)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=dict(environment) | {name: value},
            text=True,
        )
        self.code: int | None = None
        self._fmus = 0

    def __enter__(self) -> NativeHost:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> int:
        self.process.stdin.close()
        self.code = self.process.wait()
        self.process.stdout.close()
        return self.code

    def supervisors(self) -> list[int]:
        """The processes that fork workers for this host: they inherit its environment, and are not its children."""
        return without_children(marked(self._mark.encode(), b"start.py"))

    def tell(self, *words: object) -> None:
        """Send a command without waiting for its answer."""
        self.process.stdin.write("\t".join(_text(word) for word in words) + "\n")
        self.process.stdin.flush()

    def answer(self, command: str = "") -> Answer:
        """The answer to the oldest command that has none."""
        answer = Answer(NONE)
        for line in self.process.stdout:
            kind, *rest = line.rstrip("\n").split("\t")
            if kind == "answer":
                answer.status = int(rest[0])
                return answer
            if kind == "log":
                answer.log.append((int(rest[0]), int(rest[1]), rest[2], _plain(rest[3])))
            else:
                answer.values = [_plain(value) for value in rest]
        raise HostDiedError(command, self.process.wait())

    def ask(self, *words: object) -> Answer:
        self.tell(*words)
        return self.answer(str(words[0]))

    def together(self, commands: Iterable[tuple[object, ...]]) -> Answer:
        """Commands without values, each in a thread of its own, all at once.

        The worst status, the whole log, and for each the place at which it ended.
        """
        listed = list(commands)
        for words in (("together", len(listed)), *listed):
            self.tell(*words)
        return self.answer("together")

    def load(self, folder: Path, uri: str | None = None, guid: str | None = None) -> Fmu:
        """The FMU unpacked in `folder`."""
        description = fmpy.read_model_description(str(folder), validate=False)
        identifier = description.coSimulation.modelIdentifier
        fmi3 = description.fmiVersion.startswith("3")
        library = folder / "binaries" / ("x86_64-linux" if fmi3 else "linux64") / f"{identifier}.so"
        number, self._fmus = self._fmus, self._fmus + 1
        resources = folder / "resources"
        place = f"{resources.absolute()}/" if fmi3 else resources.as_uri()
        loaded = self.ask("fmu", number, library, uri or place, guid or description.guid, *[3] * fmi3)
        return Fmu(self, number, loaded, {v.name: v for v in description.modelVariables})


@dataclass
class Fmu:
    """An FMU in a host, and the result of loading it."""

    host: NativeHost
    number: int
    loaded: Answer
    variables: Mapping[str, object]

    def instance(self, number: int = 0, logging: bool = True) -> Instance:
        answer = self.host.ask("instantiate", number, self.number, int(logging))
        return Instance(self, number, answer)


class Instance:
    """An instance of an FMU: variables by name, `__` for the dot, and every log entry."""

    def __init__(self, fmu: Fmu, number: int, created: Answer):
        self.fmu, self.number, self.created = fmu, number, created
        self.log = list(created.log)
        self.time = 0.0

    def ask(self, command: str, *words: object) -> Answer:
        answer = self.fmu.host.ask(command, self.number, *words)
        self.log += answer.log
        if answer.status in (OK, WARNING):
            self._keep_time(command, words)
        return answer

    def _keep_time(self, command: str, words: tuple[object, ...]) -> None:
        """Update the time after steps and restored states."""
        if command == "step":
            self.time = words[0] + words[1]
        elif command == "setup":
            self.time = words[0]
        elif command == "reset":
            self.time = 0.0
        elif command == "restore" and "time" in self.fmu.variables:
            (self.time,) = self.get("time")

    def initialise(self, **values: float | int | str) -> list[int]:
        """Status of the three calls, and of every set between them."""
        begun = [self.ask(*command).status for command in (("setup", 0.0), ("enter",))]
        return [*begun, *self.set(**values), self.ask("exit").status]

    def set(self, **values: float | int | str) -> list[int]:
        found = ((self.fmu.variables[name.replace("__", ".")], value) for name, value in values.items())
        return [self.ask(f"set{LETTER[v.type]}", v.valueReference, value).status for v, value in found]

    def get(self, *names: str) -> list[float | int | str]:
        """Values of variables of one type."""
        first = self.fmu.variables[names[0]].type
        references = [self.fmu.variables[name].valueReference for name in names]
        answer = self.ask(f"get{LETTER[first]}", *references)
        if LETTER[first] == "r":
            return answer.reals
        return answer.values if first == "String" else [int(value) for value in answer.values]

    def step(self, dt: float, **inputs: float) -> int:
        """Status of a step under new inputs; time advances."""
        self.set(**inputs)
        return self.ask("step", self.time, dt).status

    def outputs(self) -> dict[str, float | int | str]:
        found: dict[str, float | int | str] = {}
        for kind in LETTER:
            names = [n for n, v in self.fmu.variables.items() if (v.causality, v.type) == ("output", kind)]
            found |= dict(zip(names, self.get(*names), strict=True)) if names else {}
        return found

    def free(self) -> None:
        self.ask("free")


def _text(word: object) -> str:
    return word.hex() if isinstance(word, float) else str(word)


def _plain(text: str) -> str:
    parts = text.split("\\\\")
    for escape, character in (("\\n", "\n"), ("\\t", "\t"), ("\\r", "\r")):
        parts = [part.replace(escape, character) for part in parts]
    return "\\".join(parts)
