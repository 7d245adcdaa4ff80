"""The process of one isolated FMU instance: messages of the host in, calls of the slave, answers out.

native/message.h says what the messages hold; change them together.
"""

import importlib.util
import inspect
import os
import struct
import sys
import traceback
from collections.abc import Callable, Sequence
from enum import IntEnum
from operator import itemgetter
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol

from pythonfmu import Fmi2Slave
from pythonfmu.enums import Fmi2Status

from contact_core.errors import ContactError, SceneError

from .snapshot import Phase
from .variables import Value

_REQUEST = struct.Struct("<IIQQQQ3d")
_ANSWER = struct.Struct("<IIQQ")
_ENTRY = struct.Struct("<IIII")
_RECORD = struct.Struct("<HHId")
_PART = struct.Struct("<Qq")
_COUNT = struct.Struct("<Q")

_OK, _ERROR = Fmi2Status.ok.value, Fmi2Status.error.value
_PHASES = {Phase.NEW: 0, Phase.UNSETTLED: 1, Phase.SETTLED: 1, Phase.STEPPING: 2}
_STEPPING = _PHASES[Phase.STEPPING]
_KINDS = ("Real", "Integer", "Boolean", "String")
_CAUSALITIES = ("input", "parameter", "tunable", "output", "direct")
_TYPES: tuple[type, ...] = (float, int, bool, str)

Buffer = bytes | memoryview


class Operation(IntEnum):
    """What the host can ask for."""

    OPEN = 1
    SETUP = 2
    ENTER = 3
    EXIT = 4
    STEP = 5
    LOOK = 6
    TERMINATE = 7
    RESET = 8
    SAVE = 9
    RESTORE = 10
    QUIT = 11


_TABLES = (Operation.OPEN, Operation.LOOK, Operation.RESET, Operation.RESTORE)  # return all values


class Channel(Protocol):
    """The way to the host and back."""

    def receive(self) -> bytes:
        """The host's next message; EOFError if there is no host any more."""

    def send(self, chunks: Sequence[Buffer]) -> None:
        """Answer it."""


def slave_class(resources: Path) -> type[Fmi2Slave]:
    """The slave of the script in `resources`: as for pythonfmu's binary, the deepest subclass of Fmi2Slave."""
    name = (resources / "slavemodule.txt").read_text("utf-8").strip()
    module = sys.modules.get(name) or _loaded(name, resources / f"{name}.py")
    found = [c for _, c in inspect.getmembers(module, inspect.isclass) if issubclass(c, Fmi2Slave)]
    return max(found, key=lambda c: len(c.mro()))


def _loaded(name: str, file: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    keep, sys.dont_write_bytecode = sys.dont_write_bytecode, True  # the FMU's folder is its host's
    try:
        spec.loader.exec_module(module)
    finally:
        sys.dont_write_bytecode = keep
    return module


class Worker:
    """One slave and its saved states, served until the host is done with it."""

    def __init__(self, channel: Channel, resources: Path) -> None:
        self._channel = channel
        self._resources = resources
        self._arguments: dict[str, Any] = {}
        self._slave: Any = None
        self._entries: list[tuple[int, str, str]] = []  # log that no slave can keep
        self._saved: dict[int, Any] = {}
        self._before: list[Buffer] = []  # parts of the state saved last
        self._outputs = _picked([])
        self._row = _ANSWER  # and the outputs

    def serve(self) -> None:
        """Answer until the host asks to quit."""
        while self._answer(self._channel.receive()):
            pass

    def _answer(self, message: bytes) -> bool:
        operation, sets, forgotten, back, state, size, *numbers = _REQUEST.unpack_from(message)
        if operation == Operation.QUIT:
            return False
        results: Sequence[Buffer] = ()
        try:
            if back:
                self._slave._set_fmu_state(self._saved[back])
            offset = _REQUEST.size + 8 * forgotten
            if forgotten:
                for (number,) in _COUNT.iter_unpack(message[_REQUEST.size : offset]):
                    self._saved.pop(number, None)
            if sets:
                self._set(message, offset, sets)
            results = self._do(operation, state, numbers, message[len(message) - size :])
        except ContactError as error:
            self._fail(str(error))
        except BaseException:  # also SystemExit and KeyboardInterrupt: only the host ends a worker
            self._fail(traceback.format_exc())
        self._channel.send([*self._head(operation not in _TABLES), *results])
        return True

    def _do(self, operation: int, state: int, numbers: Sequence[float], payload: bytes) -> Sequence[Buffer]:
        """What the operation returns."""
        slave = self._slave
        match operation:
            case Operation.STEP:
                if not slave.do_step(numbers[0], numbers[1]):
                    raise ContactError("The step was interrupted. Restore a saved state, or reset the FMU.")
            case Operation.SETUP:
                slave.setup_experiment(numbers[0], *map(_defined, numbers[1:]))
            case Operation.ENTER:
                slave.enter_initialization_mode()
            case Operation.EXIT:
                slave.exit_initialization_mode()
            case Operation.TERMINATE:
                slave.terminate()
            case Operation.SAVE:
                return self._save(state, known=bool(numbers[0]))
            case Operation.OPEN:
                self._open(payload)
            case Operation.RESET:
                self._instantiate()
            case Operation.LOOK:
                slave.refresh()
            case Operation.RESTORE:
                slave._set_fmu_state(self._saved[state] if state else slave._fmu_state_from_bytes(payload))
        return self._table() if operation in _TABLES else ()

    def _fail(self, reason: str) -> None:
        self._entries.append((_ERROR, "logStatusError", _escaped(reason)))

    def _head(self, outputs: bool) -> list[Buffer]:
        """Status, outputs if they stand until the next step and are asked for, and what was logged."""
        slave = self._slave
        phase = _PHASES[slave.phase] if slave is not None else 0
        values = self._outputs(self._values()) if phase == _STEPPING and outputs else ()
        entries, self._entries = self._entries, []
        if slave is not None and (queue := slave._get_log_queue()):
            entries += [(message.status.value, message.category, message.msg) for message in queue]
            queue.clear()
        status = max(entry[0] for entry in entries) if entries else _OK
        if values:
            return [self._row.pack(status, phase, len(values), len(entries), *values), *map(_entry, entries)]
        return [_ANSWER.pack(status, phase, 0, len(entries)), *map(_entry, entries)]

    def _set(self, message: bytes, offset: int, count: int) -> None:
        """Set what the host has set, in its order."""
        setters = (self._slave.set_real, self._slave.set_integer, self._slave.set_boolean, self._slave.set_string)
        references: list[int] = []
        values: list[Any] = []
        current = -1
        for _ in range(count):
            kind, _, reference, value = _RECORD.unpack_from(message, offset)
            offset += _RECORD.size
            if kind != current and references:
                setters[current](references, values)
                references, values = [], []
            current = kind
            references.append(reference)
            if kind == 3:
                length = int(value)
                values.append(message[offset : offset + length].decode("utf-8", "replace"))
                offset += length + -length % 8
            else:
                values.append(_TYPES[kind](value))
        setters[current](references, values)

    # operations

    def _open(self, payload: bytes) -> None:
        name, guid = (text.decode("utf-8", "replace") for text in payload.split(b"\0", 1))
        own = (self._resources / "guid.txt").read_text("utf-8")
        if guid != own:
            raise SceneError(
                f"The host asks for the FMU with guid {guid!r}, but this one has {own!r}: its modelDescription.xml and "
                "its resources do not belong together. Unpack the FMU again."
            )
        self._arguments = {"instance_name": name, "resources": str(self._resources), "visible": False}
        self._instantiate()

    def _instantiate(self) -> None:
        self._slave = slave = slave_class(self._resources)(**self._arguments)
        outputs = [vr for vr, (_, causality) in enumerate(slave.layout) if causality == "output"]
        self._outputs = _picked(outputs)
        self._row = struct.Struct(f"{_ANSWER.format}{len(outputs)}d")

    def _save(self, number: int, known: bool) -> list[Buffer]:
        """Keep the state; return its parts, of those that the host knows from the state saved before only the place."""
        handle = self._slave._get_fmu_state()
        parts = self._slave.parts(handle)
        places = {_identity(part): k for k, part in enumerate(self._before)} if known else {}
        same = [places.get(_identity(part), -1) for part in parts]
        self._saved[number] = handle
        self._before = parts
        heads = [_PART.pack(_size(part), k) for part, k in zip(parts, same, strict=True)]
        new = [chunk for part, k in zip(parts, same, strict=True) if k < 0 for chunk in (part, _padding(_size(part)))]
        return [_COUNT.pack(len(parts)), *heads, *new]

    def _values(self) -> Sequence[Value]:
        """Of every variable. Once it steps, outputs are those of the inputs; before, the host says when to look."""
        if self._slave.phase is Phase.STEPPING:
            self._slave.refresh()
        return self._slave.values

    def _table(self) -> list[Buffer]:
        """Every variable's kind, causality and value."""
        layout, values = self._slave.layout, self._values()
        return [_COUNT.pack(len(layout)), *map(_record, range(len(layout)), layout, values)]


def _picked(references: Sequence[int]) -> Callable[[Sequence[Value]], Sequence[Value]]:
    """Takes the values of these references, which rise, out of those of all; at once if there is no gap."""
    if len(references) > 1 and references[-1] - references[0] >= len(references):
        return itemgetter(*references)
    first = references[0] if references else 0
    return itemgetter(slice(first, first + len(references)))


def _defined(value: float) -> float | None:
    return value if value == value else None


def _escaped(text: str) -> str:
    """`text` as a printf format, which is how hosts read messages."""
    return text.replace("%", "%%")


def _padding(size: int) -> bytes:
    return bytes(-size % 8)


def _size(part: Buffer) -> int:
    return part.nbytes if isinstance(part, memoryview) else len(part)


def _identity(part: Buffer) -> tuple[int, int]:
    """What two parts have in common if they are the same unchangeable buffer."""
    return (id(part.obj), part.nbytes) if isinstance(part, memoryview) else (id(part), len(part))


def _entry(entry: tuple[int, str, str]) -> bytes:
    status, category, message = entry
    first, second = (text.encode("utf-8", "backslashreplace") + b"\0" for text in (category, message))
    texts = first + second
    return _ENTRY.pack(status, len(first), len(second), 0) + texts + _padding(len(texts))


def _record(reference: int, description: tuple[str, str], value: Value) -> bytes:
    kind, causality = _KINDS.index(description[0]), _CAUSALITIES.index(description[1])
    if isinstance(value, str):
        text = value.encode("utf-8", "backslashreplace")
        return _RECORD.pack(kind, causality, reference, len(text)) + text + _padding(len(text))
    return _RECORD.pack(kind, causality, reference, value)


class Pipe:
    """A channel of two descriptors: the length of a message, then the message."""

    def __init__(self, incoming: int, outgoing: int) -> None:
        self._incoming = os.fdopen(incoming, "rb")
        self._outgoing = os.fdopen(outgoing, "wb")

    def receive(self) -> bytes:
        """The host's next message."""
        (size,) = _COUNT.unpack(self._exactly(_COUNT.size))
        return self._exactly(size)

    def _exactly(self, size: int) -> bytes:
        data = self._incoming.read(size)
        if len(data) < size:
            raise EOFError("The host has closed the pipe.")
        return data

    def send(self, chunks: Sequence[Buffer]) -> None:
        """Answer it."""
        self._outgoing.write(_COUNT.pack(sum(map(_size, chunks))))
        self._outgoing.writelines(chunks)
        self._outgoing.flush()
