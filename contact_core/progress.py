"""What a long step is doing, told to those who wait. Without a listener nothing happens; no answer depends on it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Listener = Callable[[str, int, int], None]  # of what is being done, its number, and how many there are

ALGORITHM = "algorithm"  # of those that are tried in turn at an instant

_listeners: list[Listener] = []


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Call a listener whenever a step of this process goes on to its next part."""
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.remove(listener)


def tell(what: str, number: int, total: int) -> None:
    """Tell all listeners that part `number` of `total` begins, such as ("instant", 3, 35); of 0: that none does."""
    for listener in _listeners:
        listener(what, number, total)
