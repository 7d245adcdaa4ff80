"""What a run has seen: names and values with all their bits, as JSON can keep them."""

import base64
import hashlib
import zlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

KINDS = "fiub"  # of arrays
LONG = 1000  # characters of a text that is packed
FAILED = "failed"  # the name of what a run ended by, if it should not have
NOTE = "note: "  # begins the name of what is said, not compared


class Record:
    """Values of one run by their names: a `text`, which is `packed` if it is long, or an array with its `data`."""

    def __init__(self) -> None:
        self.values: dict[str, dict[str, Any]] = {}

    def put(self, name: str, value: Any) -> None:
        """Keep a number, array, text, digest of bytes, or all that a mapping, sequence or dataclass holds."""
        if isinstance(value, bytes | memoryview):
            value = f"{len(value)} bytes, sha256 {hashlib.sha256(value).hexdigest()}"
        if value is None or isinstance(value, str):
            self._text(name, str(value))
        elif isinstance(value, np.ndarray) and value.dtype.kind not in KINDS:
            self._text(name, "\n".join(map(str, value.ravel().tolist())))
        elif isinstance(value, int) and not isinstance(value, bool):  # an IntFlag, too
            self._text(name, str(int(value)))
        elif isinstance(value, np.ndarray | np.generic | float | bool):
            self._array(name, np.asarray(value))
        elif is_dataclass(value):
            self.put(name, {f.name: getattr(value, f.name) for f in fields(value)})
        elif isinstance(value, Mapping):
            for key, part in value.items():
                self.put(f"{name}.{key}", part)
        elif isinstance(value, list | tuple):
            self.put(f"{name}.length", len(value))
            for i, part in enumerate(value):
                self.put(f"{name}[{i}]", part)
        else:
            raise TypeError(f"{name} is a {type(value).__name__}: that cannot be kept")

    def _array(self, name: str, value: np.ndarray) -> None:
        little = np.ascontiguousarray(value, value.dtype.newbyteorder("<"))
        self._keep(name, {"dtype": little.dtype.str, "shape": list(value.shape), "data": _packed(little.tobytes())})

    def _text(self, name: str, text: str) -> None:
        self._keep(name, {"text": text} if len(text) < LONG else {"packed": _packed(text.encode())})

    def _keep(self, name: str, value: dict[str, Any]) -> None:
        if name in self.values:
            raise ValueError(f"{name} comes twice in one run")
        self.values[name] = value


def array_of(value: Mapping[str, Any]) -> np.ndarray:
    """Return the array of a kept value."""
    return np.frombuffer(_unpacked(value["data"]), np.dtype(value["dtype"])).reshape(value["shape"])


def text_of(value: Mapping[str, Any]) -> str | None:
    """Return the text of a kept value, None if it is an array."""
    return _unpacked(value["packed"]).decode() if "packed" in value else value.get("text")


def _packed(data: bytes) -> str:
    return base64.b64encode(zlib.compress(data, 1)).decode()


def _unpacked(data: str) -> bytes:
    return zlib.decompress(base64.b64decode(data))
