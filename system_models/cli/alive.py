"""Keeps a progress bar moving while nothing is finished: its clock, what is being solved, kernels that compile."""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic
from typing import Any

from contact_core.progress import ALGORITHM, listening

_EVERY, _EVERY_IN_A_FILE = 0.5, 60.0  # s between two times of drawing the bar: on a terminal, into a file
_SOON = 2.0  # s, before which no time is estimated
_COMPILING = "compiling kernels, once after installation: {} so far"


@contextmanager
def alive(bar: Any) -> Iterator[None]:
    """Draw a `tqdm` bar every half second with what is being done; into a file once a minute."""
    doing = _Doing()
    stop = threading.Event()
    every = _EVERY if sys.stderr.isatty() else _EVERY_IN_A_FILE

    def draw() -> None:
        while not stop.wait(every):
            doing.watch_compiler()
            bar.set_postfix_str(doing.text(), refresh=True)

    doing.watch_compiler()
    thread = threading.Thread(target=draw, daemon=True)
    thread.start()
    try:
        with listening(doing.told):
            yield
    finally:
        stop.set()
        thread.join()
        doing.forget_compiler()
        bar.set_postfix_str("", refresh=False)


class _Doing:
    """What is being done now."""

    def __init__(self) -> None:
        self._told = self._within = ""
        self._begin, self._first, self._done, self._left = 0.0, 0, 0, 0
        self._depth = self._compiled = 0
        self._since, self._compiling = 0.0, 0.0  # begin of the present kernel; s in this part so far
        self._listener: Any = None

    def told(self, what: str, number: int, total: int) -> None:
        """Take what the contact says, see `contact_core.progress`."""
        if what == ALGORITHM:  # within the part that was told before; the first one goes without saying
            self._within = f", {what} {number} of {total}" if number > 1 else ""
            return
        if not total:
            self._told, self._within, self._done = "", "", 0
            return
        if number == 1 or not self._told:
            self._begin, self._first, self._compiling = monotonic(), number, 0.0
        self._told, self._within = f"{what} {number} of {total}", ""
        self._done, self._left = number - self._first, total - number

    def text(self) -> str:
        """Return what is being done in a few words, and how long the parts that are left will take."""
        if self._depth:
            return _COMPILING.format(self._compiled)
        spent = monotonic() - self._begin - self._compiling  # which happens once
        if self._done < 1 or spent < _SOON:
            return (self._told + self._within).removeprefix(", ")
        left = spent / self._done * (self._left + 1)
        return f"{self._told}{self._within}, about {left:.0f} s left of them"

    def watch_compiler(self) -> None:
        """Listen to numba, once it is there: the regression level does without and need not load it."""
        if self._listener is not None or "numba.core.dispatcher" not in sys.modules:
            return
        from numba.core import event

        self._listener = _compiler_listener(self)
        event.register("numba:compile", self._listener)

    def forget_compiler(self) -> None:
        """Listen no longer."""
        if self._listener is not None:
            from numba.core import event

            event.unregister("numba:compile", self._listener)
            self._listener = None

    def begins(self) -> None:
        """Count a kernel that begins to compile; kernels compile those that they call."""
        if not self._depth:
            self._since = monotonic()
        self._depth += 1

    def ends(self) -> None:
        """Count a kernel that is compiled."""
        self._depth -= 1
        self._compiled += 1
        if not self._depth:
            self._compiling += monotonic() - max(self._since, self._begin)


def _compiler_listener(doing: _Doing) -> Any:
    """Return numba's listener; kernels that it finds in its cache raise no event."""
    from numba.core import event

    class Listener(event.Listener):
        def on_start(self, event: Any) -> None:
            doing.begins()

        def on_end(self, event: Any) -> None:
            doing.ends()

    return Listener()
