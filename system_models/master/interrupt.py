"""Ctrl-C, kept back until a step has ended: within one it would reach an FMU, and the master might not learn of it."""

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

_SAID = b"\nStopping at the end of this step, which may take a while. Press Ctrl-C once more to stop at once.\n"


@contextmanager
def deferred() -> Iterator[Callable[[], None]]:
    """Defer Ctrl-C, and say so; the yielded function raises KeyboardInterrupt if it has been pressed.

    A second press acts at once.

    Only where Python's own handler is in place, in the main thread; elsewhere nothing changes.
    """
    ours = threading.current_thread() is threading.main_thread()
    if not ours or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield lambda: None
        return
    pressed = False

    def press(number: int, frame: Any) -> None:
        nonlocal pressed
        if pressed:
            signal.default_int_handler(number, frame)
        pressed = True
        os.write(2, _SAID)  # a handler must not wait for a stream that it may have interrupted

    def check() -> None:
        if pressed:
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, press)
    try:
        yield check
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
