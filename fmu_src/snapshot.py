"""The FMU's whole state: a frozen record as FMI's handle, and as bytes."""

import hashlib
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

_MAGIC = b"tribofmu FMU 2\n"
_DIGEST = 16  # bytes
_LENGTH = struct.Struct("<I")
_SIGNED = 32  # first bytes of a contact state: they hold the checksum of its rest

Values = tuple[Value, ...]
Scenes = tuple[Scene, ...]  # one contact at each of quantities.LEVELS


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
    values: Values  # by value reference
    scenes: Scenes | None  # with the parameters of `values`
    state: ContactState | None

    @property
    def data(self) -> bytes:
        """Magic, digest, length of a JSON header, header, contact state. The same state, the same bytes."""
        return b"".join(self.parts)

    @cached_property
    def parts(self) -> list[bytes | memoryview]:
        """What `data` joins, without a copy of the contact's arrays: see ContactState.parts."""
        header = json.dumps(
            {"module": self.module, "phase": self.phase, "fault": self.fault, "values": self.values}
        ).encode()
        contact = [] if self.state is None else self.state.parts()
        signed = bytes(contact[0][:_SIGNED]) if contact else b""
        return [b"".join([_MAGIC, _digest(header, signed), _LENGTH.pack(len(header)), header]), *contact]

    @staticmethod
    def from_bytes(data: bytes, module: str, starts: Values, rebuild: Callable[[Values], Scenes]) -> "Snapshot":
        """Restore what `data` wrote, bit for bit; `rebuild` makes the scenes from the values, which are like `starts`.

        Raises StateError if damaged or of another FMU.
        """
        if data[: len(_MAGIC)] != _MAGIC:
            raise StateError(
                "The stored FMU state is not one that this version of tribofmu writes. Give one that this FMU has "
                "serialised."
            )
        header, contact = _parts(data)
        try:
            table = json.loads(header)
            phase, fault, values = Phase(table["phase"]), str(table["fault"]), tuple(table["values"])
            owner = table["module"]
        except (ValueError, KeyError, TypeError, RecursionError) as error:
            raise StateError(f"The stored FMU state is damaged ({error}). Use an earlier one.") from None
        check_owner(owner, module)
        if [type(value) for value in values] != [type(start) for start in starts]:
            raise StateError("The stored FMU state has other variables than this FMU. Give one that it has serialised.")
        if not contact:
            return Snapshot(module, phase, fault, values, None, None)
        scenes = rebuild(values)
        return Snapshot(module, phase, fault, values, scenes, ContactState.from_bytes(contact, scenes[0]))


def check_owner(owner: str, module: str) -> None:
    """Raise StateError if the state of the FMU `owner` is to be that of another one."""
    if owner != module:
        raise StateError("The FMU state belongs to another FMU. Use one that an FMU of the same scene has given.")


def _parts(data: bytes) -> tuple[bytes, bytes]:
    """Header and contact state, if they are as they were written."""
    start = len(_MAGIC) + _DIGEST + _LENGTH.size
    if len(data) >= start:
        (length,) = _LENGTH.unpack_from(data, start - _LENGTH.size)
        header, contact = data[start : start + length], data[start + length :]
        if len(header) == length and data[len(_MAGIC) : start - _LENGTH.size] == _digest(header, contact[:_SIGNED]):
            return header, contact
    raise StateError("The stored FMU state is damaged: it was cut or changed. Use an earlier one.")


def _digest(header: bytes, signed: bytes) -> bytes:
    """Fingerprint of the header and of the checksum that covers the contact state: its megabytes are read once."""
    return hashlib.blake2b(_LENGTH.pack(len(header)) + header + signed, digest_size=_DIGEST).digest()
