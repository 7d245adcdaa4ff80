"""Bars that say how far a long command is."""

import logging
import sys
from bisect import bisect_right
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from .alive import alive

_LEAST_SHARE = 0.025  # of the work; with less in the later half of the time no time left is estimated
_APART = 1.01  # of two times that are kept: a run of any length keeps some hundreds


@contextmanager
def shown(
    name: str, total: float, amount: str, unit: float = 1.0, since: float = 0.0
) -> Iterator[Callable[[float], None]]:
    """Show a progress bar with the log above it; give the function that takes the time reached [s].

    total, since [s]: end and beginning of what is left; unit [s] of the bar; amount: its numbers as `tqdm` formats
    them.
    """
    text = f"{{desc}} {{percentage:3.0f}} %|{{bar}}| {amount} [{{elapsed}}<{{remaining}}{{postfix}}]"
    with _living(name, text, total=total / unit, initial=since / unit) as bar:
        yield lambda time: bar.update(time / unit - bar.n)


@contextmanager
def counted(name: str, what: str, total: int | None = None) -> Iterator[Callable[..., None]]:
    """Show how many parts of a long command are done, with the log above it; `what` they are, in the plural.

    Gives the function that takes their number, and another text in place of `name` if that changes.
    """
    share = "{desc} {percentage:3.0f} %|{bar}| {n}/{total} " if total else "{desc}: {n} "
    rest = "<{remaining}" if total else ""
    with _living(name, f"{share}{what} [{{elapsed}}{rest}{{postfix}}]", total=total) as bar:

        def show(count: int, text: str = name) -> None:
            bar.set_description_str(text, refresh=False)
            bar.update(count - bar.n)
            bar.refresh()

        yield show


def say(text: str) -> None:
    """Print a part of the result at once, above the bar that is shown."""
    from tqdm import tqdm

    tqdm.write(text, file=sys.stdout)
    sys.stdout.flush()


@contextmanager
def _living(name: str, text: str, **amounts: Any) -> Iterator[Any]:
    """Give a `tqdm` bar that moves while kernels compile and one solution takes long, with the log above it."""
    from tqdm import tqdm
    from tqdm.contrib.logging import logging_redirect_tqdm

    class Bar(tqdm):
        """Estimates the time left by a pace that few odd steps do not change."""

        pace = Pace(amounts.get("initial", 0.0), amounts["total"])

        @property
        def format_dict(self) -> dict[str, Any]:
            found: dict[str, Any] = super().format_dict
            return found | {"rate": self.pace.at(found["elapsed"], found["n"])}

    logging.basicConfig(format="%(message)s")
    with Bar(desc=name, bar_format=text, **amounts) as bar, logging_redirect_tqdm(), alive(bar):
        yield bar


class Pace:
    """How fast a command goes on: over the later half of its time so far, if that has brought enough of its work.

    The first steps may compile, load or be tiny, and after a change of the duty again; kept parts take no time at all.
    The newest step alone, or the mean of all, would be off by orders of magnitude.
    """

    def __init__(self, begin: float, total: float | None) -> None:
        self._least = _LEAST_SHARE * ((total or 0.0) - begin)
        self._times, self._done = [0.0], [begin]  # [s], and what was done then

    def at(self, elapsed: float, done: float) -> float:
        """Return what is done per second, of the latest progress at a time [s]; 0: not known yet."""
        if done > self._done[-1] and elapsed > _APART * self._times[-1]:
            self._times.append(elapsed)
            self._done.append(done)
        now = self._times[-1]
        middle = bisect_right(self._times, now / 2.0) - 1
        gain = self._done[-1] - self._done[middle]
        return gain / (now - self._times[middle]) if now and gain >= self._least else 0.0
