"""Progress of a long step: listeners are called with what it is doing. No result depends on it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Listener = Callable[[str, int, int], None]  # task in words, number of the present item, number of items

ALGORITHM = "algorithm"  # task of trying algorithms in turn at an instant

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
