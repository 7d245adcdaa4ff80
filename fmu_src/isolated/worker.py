"""The process of one isolated FMU instance: messages of the host in, calls of the slave, answers out."""

import importlib.util
import inspect
import struct
import sys
import traceback
from collections.abc import Callable, Sequence
from operator import itemgetter
from pathlib import Path
from types import ModuleType
from typing import Any

from pythonfmu import Fmi2Slave
from pythonfmu.enums import Fmi2Status

from contact_core.errors import ContactError, SceneError

from ..phases import Phase
from ..variables import Value
from .channels import Channel
from .message import (
    ANSWER,
    COUNT,
    PART,
    RECORD,
    REQUEST,
    TYPES,
    WITH_TABLE,
    Buffer,
    Operation,
    identity,
    log_entry,
    padding,
    record,
    size_of,
)

_OK, _ERROR = Fmi2Status.ok.value, Fmi2Status.error.value
_PHASES = {Phase.NEW: 0, Phase.UNSETTLED: 1, Phase.SETTLED: 1, Phase.STEPPING: 2}
_STEPPING = _PHASES[Phase.STEPPING]


def slave_class(resources: Path) -> type[Fmi2Slave]:
    """Return the slave of the script in `resources`: like pythonfmu's binary, the deepest subclass of Fmi2Slave."""
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
    keep, sys.dont_write_bytecode = sys.dont_write_bytecode, True  # the folder of an FMU belongs to the host
    try:
        spec.loader.exec_module(module)
    finally:
        sys.dont_write_bytecode = keep
    return module


class Worker:
    """One slave and its saved states; serves the host until it quits."""

    def __init__(self, channel: Channel, resources: Path) -> None:
        self._channel = channel
        self._resources = resources
        self._arguments: dict[str, Any] = {}
        self._slave: Any = None
        self._entries: list[tuple[int, str, str]] = []  # log entries made without a slave
        self._saved: dict[int, Any] = {}
        self._before: list[Buffer] = []  # parts of the last saved state
        self._outputs = _picked([])
        self._row = ANSWER  # followed by the outputs

    def serve(self) -> None:
        """Answer messages until the host quits."""
        while self._answer(self._channel.receive()):
            pass

    def _answer(self, message: bytes) -> bool:
        operation, sets, forgotten, back, state, size, *numbers = REQUEST.unpack_from(message)
        if operation == Operation.QUIT:
            return False
        results: Sequence[Buffer] = ()
        try:
            if back:
                self._slave._set_fmu_state(self._saved[back])
            offset = REQUEST.size + 8 * forgotten
            if forgotten:
                for (number,) in COUNT.iter_unpack(message[REQUEST.size : offset]):
                    self._saved.pop(number, None)
            if sets:
                self._set(message, offset, sets)
            results = self._do(operation, state, numbers, message[len(message) - size :])
        except ContactError as error:
            self._fail(str(error))
        except BaseException:  # SystemExit and KeyboardInterrupt too: only the host ends a worker
            self._fail(traceback.format_exc())
        self._channel.send([*self._head(operation not in WITH_TABLE), *results])
        return True

    def _do(self, operation: int, state: int, numbers: Sequence[float], payload: bytes) -> Sequence[Buffer]:
        """Carry out an operation and return its results."""
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
        return self._table() if operation in WITH_TABLE else ()

    def _fail(self, reason: str) -> None:
        self._entries.append((_ERROR, "logStatusError", _escaped(reason)))

    def _head(self, outputs: bool) -> list[Buffer]:
        """Return status, log and, between steps, the outputs if asked for."""
        slave = self._slave
        phase = _PHASES[slave.phase] if slave is not None else 0
        values = self._outputs(self._values()) if phase == _STEPPING and outputs else ()
        entries, self._entries = self._entries, []
        if slave is not None and (queue := slave._get_log_queue()):
            entries += [(message.status.value, message.category, message.msg) for message in queue]
            queue.clear()
        status = max(entry[0] for entry in entries) if entries else _OK
        if values:
            return [self._row.pack(status, phase, len(values), len(entries), *values), *map(log_entry, entries)]
        return [ANSWER.pack(status, phase, 0, len(entries)), *map(log_entry, entries)]

    def _set(self, message: bytes, offset: int, count: int) -> None:
        """Set variables in the order in which the host has set them."""
        setters = (self._slave.set_real, self._slave.set_integer, self._slave.set_boolean, self._slave.set_string)
        references: list[int] = []
        values: list[Any] = []
        current = -1
        for _ in range(count):
            kind, _, reference, value = RECORD.unpack_from(message, offset)
            offset += RECORD.size
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
                values.append(TYPES[kind](value))
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
        self._row = struct.Struct(f"{ANSWER.format}{len(outputs)}d")

    def _save(self, number: int, known: bool) -> list[Buffer]:
        """Keep the state and return its parts; of parts that the host already has, only their position."""
        handle = self._slave._get_fmu_state()
        parts = self._slave.parts(handle)
        places = {identity(part): k for k, part in enumerate(self._before)} if known else {}
        same = [places.get(identity(part), -1) for part in parts]
        self._saved[number] = handle
        self._before = parts
        heads = [PART.pack(size_of(part), k) for part, k in zip(parts, same, strict=True)]
        new = [chunk for part, k in zip(parts, same, strict=True) if k < 0 for chunk in (part, padding(size_of(part)))]
        return [COUNT.pack(len(parts)), *heads, *new]

    def _values(self) -> Sequence[Value]:
        """Return all values. While stepping, outputs are brought up to date; before, the host asks for that (LOOK)."""
        if self._slave.phase is Phase.STEPPING:
            self._slave.refresh()
        return self._slave.values

    def _table(self) -> list[Buffer]:
        """Return kind, causality and value of every variable."""
        layout, values = self._slave.layout, self._values()
        return [COUNT.pack(len(layout)), *map(record, range(len(layout)), layout, values)]


def _picked(references: Sequence[int]) -> Callable[[Sequence[Value]], Sequence[Value]]:
    """Return a function that picks the values of ascending references; one slice if they have no gap."""
    if len(references) > 1 and references[-1] - references[0] >= len(references):
        return itemgetter(*references)
    first = references[0] if references else 0
    return itemgetter(slice(first, first + len(references)))


def _defined(value: float) -> float | None:
    return value if value == value else None


def _escaped(text: str) -> str:
    """Escape a text for hosts, which read messages as printf formats."""
    return text.replace("%", "%%")
