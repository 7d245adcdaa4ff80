"""The FMU's whole state: a frozen record as FMI's handle, and as bytes."""

import hashlib
import json
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

from contact_core.errors import StateError
from contact_core.scene import Scene
from contact_core.state import ContactState

from ..phases import Phase
from ..variables import Value

_MAGIC = b"tribofmu FMU 3\n"
_DIGEST = 16  # bytes
_LENGTHS = struct.Struct("<II")  # of the texts, of the numbers
_SIGNED = 32  # first bytes of a contact state: they hold the checksum of its rest

Values = tuple[Value, ...]
Scenes = tuple[Scene, ...]  # one contact at each of quantities.LEVELS


class Layout:
    """Storage layout of the values of an FMU's variables: 8 bytes each; texts in JSON."""

    def __init__(self, starts: Sequence[Value]) -> None:
        """Make the layout for values of these types."""
        self._types = tuple(map(type, starts))
        self.kinds = "".join(kind.__name__[0] for kind in self._types)
        self._texts = [k for k, kind in enumerate(self._types) if kind is str]
        self._row = struct.Struct(f"<{len(self._types)}d")

    def split(self, values: Values) -> tuple[tuple[Value, ...], bytes]:
        """Return the texts in `values`, and the numbers as bytes."""
        numbers = list(values)
        for k in self._texts:
            numbers[k] = 0.0
        return tuple([values[k] for k in self._texts]), self._row.pack(*numbers)

    def joined(self, texts: Sequence[str], numbers: bytes) -> Values:
        """Return the values from what `split` returned."""
        found = list(self._row.unpack(numbers))
        for k, text in zip(self._texts, texts, strict=True):
            found[k] = text
        return tuple([kind(value) for kind, value in zip(self._types, found, strict=True)])


@dataclass(frozen=True, eq=False)
class Snapshot:
    """The whole state of an FMU instance. It is never changed, so it needs no copy."""

    module: str  # fingerprint of the FMU it belongs to
    layout: Layout  # of `values`
    phase: Phase
    fault: str  # why the contact could not be set up, if `state` is None
    values: Values  # by value reference
    scenes: Scenes | None  # with the parameters of `values`
    state: ContactState | None

    @property
    def data(self) -> bytes:
        """The state as bytes: magic, digest, lengths of header and numbers, both, contact state. Reproducible."""
        return b"".join(self.parts)

    @cached_property
    def parts(self) -> list[bytes | memoryview]:
        """The buffers that `data` joins, without a copy of the contact's arrays: see ContactState.parts."""
        texts, numbers = self.layout.split(self.values)
        header = _header(self.module, self.phase, self.fault, self.layout.kinds, texts)
        contact = [b""] if self.state is None else self.state.parts()
        lengths = _LENGTHS.pack(len(header), len(numbers))
        digest = _digest(lengths, header, numbers, contact[0][:_SIGNED])
        return [b"".join([_MAGIC, digest, lengths, header, numbers, contact[0]]), *contact[1:]]

    @staticmethod
    def from_bytes(data: bytes, module: str, layout: Layout, rebuild: Callable[[Values], Scenes]) -> "Snapshot":
        """Restore the state that `data` has written, bit for bit; `rebuild` makes the scenes from the values.

        Raises StateError if damaged or of another FMU.
        """
        header, numbers, contact = _parts(data)
        owner, phase, fault, kinds, *texts = json.loads(header)
        check_owner(owner, module)
        if kinds != layout.kinds:
            raise StateError("The stored FMU state has other variables than this FMU. Give one that it has serialised.")
        values = layout.joined(texts, numbers)
        if not contact:
            return Snapshot(module, layout, Phase(phase), fault, values, None, None)
        scenes = rebuild(values)
        state = ContactState.from_bytes(contact, scenes[0])
        return Snapshot(module, layout, Phase(phase), fault, values, scenes, state)


def contact_state(data: bytes) -> bytes:
    """Return the contact state in a serialised FMU state, for `ContactState.from_bytes`; empty if there is none yet.

    Raises StateError if damaged or not an FMU's.
    """
    return _parts(data)[2]


def check_owner(owner: str, module: str) -> None:
    """Raise StateError if a state belongs to another FMU."""
    if owner != module:
        raise StateError("The FMU state belongs to another FMU. Use one that an FMU of the same scene has given.")


@lru_cache(maxsize=16)
def _header(module: str, phase: Phase, fault: str, kinds: str, texts: tuple[Value, ...]) -> bytes:
    """Return the header, cached: it stays the same from step to step."""
    return json.dumps([module, phase, fault, kinds, *texts]).encode()


def _parts(data: bytes) -> tuple[bytes, bytes, bytes]:
    """Return header, numbers and contact state; raise StateError if they are damaged or of another kind."""
    if data[: len(_MAGIC)] != _MAGIC:
        raise StateError(
            "The stored FMU state is not one that this version of tribofmu writes. Give one that this FMU has "
            "serialised."
        )
    at = len(_MAGIC) + _DIGEST
    start = at + _LENGTHS.size
    if len(data) >= start:
        lengths = data[at:start]
        texts, numbers = _LENGTHS.unpack(lengths)
        middle, end = start + texts, start + texts + numbers
        parts = data[start:middle], data[middle:end], data[end:]
        if len(data) >= end and data[len(_MAGIC) : at] == _digest(lengths, *parts[:2], parts[2][:_SIGNED]):
            return parts
    raise StateError("The stored FMU state is damaged: it was cut or changed. Use an earlier one.")


def _digest(*parts: bytes | memoryview) -> bytes:
    """Return the digest of all up to the contact state's own checksum, so that its megabytes are read only once."""
    return hashlib.blake2b(b"".join(parts), digest_size=_DIGEST).digest()
