"""Channels between the FMU's library and a worker: messages in, answers out."""

import os
from collections.abc import Sequence
from typing import Protocol

from .message import COUNT, Buffer, size_of


class Channel(Protocol):
    """Connection of a worker to its host."""

    def receive(self) -> bytes:
        """Return the host's next message. Raises EOFError if the host has gone."""

    def send(self, chunks: Sequence[Buffer]) -> None:
        """Answer the last message."""


class Pipe:
    """A channel of two file descriptors: the length of a message, then the message."""

    def __init__(self, incoming: int, outgoing: int) -> None:
        self._incoming = os.fdopen(incoming, "rb")
        self._outgoing = os.fdopen(outgoing, "wb")

    def receive(self) -> bytes:
        """Return the host's next message."""
        (size,) = COUNT.unpack(self._exactly(COUNT.size))
        return self._exactly(size)

    def _exactly(self, size: int) -> bytes:
        data = self._incoming.read(size)
        if len(data) < size:
            raise EOFError("The host has closed the pipe.")
        return data

    def send(self, chunks: Sequence[Buffer]) -> None:
        """Answer the last message."""
        self._outgoing.write(COUNT.pack(sum(map(size_of, chunks))))
        self._outgoing.writelines(chunks)
        self._outgoing.flush()
