"""Connections to inputs that are set when their values change: integers, booleans, texts, and Reals set at events."""

from typing import Any

from ..fmu.errors import CouplingError
from .running import Running
from .system import Connection

_MOST_PASSES = 20  # until the values at a communication point come to rest


class PassedOn:
    """The last values of such connections, by which it is seen that they change."""

    def __init__(self, connections: list[Connection]) -> None:
        self.connections = connections
        self.values: list[Any] = [None] * len(connections)

    def settle(self, fmus: Running) -> None:
        """Set the inputs until nothing changes any more."""
        if not self.connections:
            return
        for _ in range(_MOST_PASSES):
            changed = set()
            for n, connection in enumerate(self.connections):
                value = fmus.get(connection.source)
                if value != self.values[n]:
                    fmus.set(connection.target.name, connection.result(value))
                    self.values[n] = value
                    changed.add(connection.target.model.name)
            for name in changed:
                fmus.read(fmus.instances[name])
            if not changed:
                return
        raise CouplingError(
            f"Discrete values change again and again at {fmus.time:g} s: "
            f"{', '.join(sorted(connection.source.name for connection in self.connections))}. Break their loop."
        )
