"""The FMU's whole state: a frozen record as FMI's handle, and as bytes."""

import json
import struct
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

from contact_core.errors import StateError
from contact_core.scene import Scene
from contact_core.state import ContactState

from .variables import Value

_MAGIC = b"tribofmu FMU 1\n"


class Phase(StrEnum):
    """Where in its life an FMU is."""

    NEW = "new"
    UNSETTLED = "unsettled"  # in initialisation mode, outputs older than what they depend on
    SETTLED = "settled"  # in initialisation mode, outputs right
    STEPPING = "stepping"


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Everything that can change the FMU's next answer. It is never changed, so it needs no copy."""

    module: str  # fingerprint of the FMU it belongs to
    phase: Phase
    fault: str  # why the contact could not be set up; for `state` None
    values: tuple[Value, ...]  # by value reference
    scene: Scene | None  # with the parameters of `values`
    state: ContactState | None

    @cached_property
    def data(self) -> bytes:
        """Magic, length of a JSON header, header, contact state. The same state, the same bytes."""
        header = json.dumps(
            {"module": self.module, "phase": self.phase, "fault": self.fault, "values": self.values}
        ).encode()
        contact = b"" if self.state is None else self.state.to_bytes()
        return b"".join([_MAGIC, struct.pack("<I", len(header)), header, contact])

    @staticmethod
    def from_bytes(data: bytes, rebuild: Callable[[tuple[Value, ...]], Scene]) -> "Snapshot":
        """Restore what `data` wrote, bit for bit; `rebuild` makes the scene from the values.

        Raises StateError if damaged or of another scene.
        """
        start = len(_MAGIC) + 4
        if data[: len(_MAGIC)] != _MAGIC:
            raise StateError("The stored FMU state is not one of tribofmu's. Give one that this FMU has serialised.")
        try:
            length = struct.unpack("<I", data[len(_MAGIC) : start])[0]
            header = json.loads(data[start : start + length])
            values, phase = tuple(header["values"]), Phase(header["phase"])
            module, fault = header["module"], header["fault"]
        except (ValueError, KeyError, TypeError, struct.error) as error:
            raise StateError(f"The stored FMU state is damaged ({error}). Use an earlier one.") from None
        contact = data[start + length :]
        if not contact:
            return Snapshot(module, phase, fault, values, None, None)
        scene = rebuild(values)
        return Snapshot(module, phase, fault, values, scene, ContactState.from_bytes(contact, scene))
