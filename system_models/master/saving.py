"""Contents of the checkpoint of a simulation: its identity, and the states of all FMUs and of the master as bytes.

The bytes are the length of a JSON header, the header, and the raw memory of what it refers to; nothing is executed.
"""

import hashlib
import json
import struct
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

import contact_core
from contact_core.errors import StateError

from ..fmu import messages
from ..fmu.errors import CouplingError
from ..fmu.instance import Instance
from ..store.checkpoint import Checkpoint, alone
from .system import Port, System


@contextmanager
def kept(
    folder: Path,
    system: System,
    outputs: Iterable[Port],
    settings: Mapping[str, Any],
    resume: bool,
    about: Mapping[str, str] | None = None,
) -> Iterator[Checkpoint]:
    """Hold the checkpoint of a simulation, in a folder of its own as long as it runs; `about`: texts for it.

    `saved` is the point from which it continues, if there is one and `resume` is set. Raises CouplingError if the
    simulation cannot be stored, and StateError if the folder is in use or holds another simulation.
    """
    check(system, outputs)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CouplingError(f"The folder '{folder}' cannot be made: {error.strerror}. Use another.") from None
    with alone(folder):
        run = identity(system, settings)
        yield Checkpoint.resume(folder, run, about) if resume else Checkpoint(folder, run, about)


def check(system: System, outputs: Iterable[Port]) -> None:
    """Raise CouplingError if a simulation of the system that records `outputs` cannot be stored."""
    for name, model in system.models.items():
        if not model.serialises:
            raise CouplingError(
                f"The FMU '{name}' cannot give its state as bytes (canSerializeFMUstate is false): no checkpoint can "
                "be made of a simulation with it. Simulate without a checkpoint, or export the FMU with its state."
            )
    for port in outputs:
        if port.kind == "string":
            raise CouplingError(
                f"'{port.name}' is text, which the rows of a checkpoint have no place for. "
                "Leave it out of the outputs, or simulate without a checkpoint."
            )


def check_taken(instances: Mapping[str, Instance], states: Mapping[str, bytes], time: float) -> None:
    """Raise StateError if an FMU has not taken its state of a checkpoint at `time` [s]."""
    for name, instance in instances.items():
        if instance.serialised() != states[name]:
            raise StateError(
                f"The FMU '{name}' does not take the state of the checkpoint at t = {time:g} s. {messages.cause(name)} "
                "Use the FMU that the checkpoint was made with, or start from the beginning."
            )


def identity(system: System, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return everything that decides a result, as JSON has it; settings are the arguments of `simulate`."""
    parts = {
        "versions": {"tribofmu": contact_core.__version__, "numpy": np.__version__},
        "sha256": {name: hashlib.sha256(model.path.read_bytes()).hexdigest() for name, model in system.models.items()},
        "connections": {c.target.name: [c.source.name, c.factor, c.offset] for c in system.connections},
        "parameters": system.parameters,
        "schedule": system.schedule,
        "events": [port.name for port in system.events],
        "bonds": [bond.name for bond in system.bonds],
        "derivatives": {f"{of} by {by}": port.name for (of, by), port in system.derivatives.items()},
        "settings": settings,
    }
    return dict(json.loads(json.dumps(parts)))


def pack(states: Mapping[str, bytes], master: Mapping[str, Any]) -> bytes:
    """Return the serialised states of the FMUs by name, and the master's: nested dicts, lists and tuples."""
    parts: list[bytes] = []
    header = json.dumps(_described({"states": states, "master": master}, parts)).encode()
    return b"".join([struct.pack("<Q", len(header)), header, *parts])


def unpack(data: bytes) -> tuple[dict[str, bytes], dict[str, Any]]:
    """Return the arguments of `pack`."""
    stream = BytesIO(data)
    (length,) = struct.unpack("<Q", stream.read(8))
    found = _restored(json.loads(stream.read(length)), stream)
    return found["states"], found["master"]


def _described(value: Any, parts: list[bytes]) -> Any:
    """Return `value` as JSON; raw memory goes to `parts`, and its size stands in its place."""
    if isinstance(value, np.ndarray):
        parts.append(value.tobytes())
        return {"array": [value.dtype.str, list(value.shape), value.nbytes]}
    if isinstance(value, bytes):
        parts.append(value)
        return {"bytes": len(value)}
    if isinstance(value, Mapping) and all(isinstance(name, str) for name in value):
        return {"dict": {name: _described(item, parts) for name, item in value.items()}}
    if isinstance(value, list):
        return [_described(item, parts) for item in value]
    if type(value) is tuple:
        return {"tuple": [_described(item, parts) for item in value]}
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise TypeError(f"{value!r} of type {type(value).__name__} cannot be stored.")


def _restored(value: Any, stream: BytesIO) -> Any:
    """Return the value of a description; its memory is the next in the stream."""
    if isinstance(value, list):
        return [_restored(item, stream) for item in value]
    if not isinstance(value, dict):
        return value
    ((kind, content),) = value.items()
    if kind == "bytes":
        return stream.read(content)
    if kind == "array":
        dtype, shape, size = content
        return np.frombuffer(bytearray(stream.read(size)), dtype).reshape(shape)
    if kind == "tuple":
        return tuple(_restored(item, stream) for item in content)
    return {name: _restored(item, stream) for name, item in content.items()}
