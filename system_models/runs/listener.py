"""What a run tells while it goes on."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_log = logging.getLogger(__name__)


class Listener:
    """Hears of a run: this one keeps notes in the log and is silent else; the command line prints."""

    resume = "the same call with resume=True"  # what continues an unfinished run
    anew = "resume=True"  # what is left out to compute it again

    def say(self, *lines: str) -> None:
        """Take lines of the result, as they come."""

    def note(self, sentence: str) -> None:
        """Take a sentence that is no result."""
        _log.info("%s", sentence)

    def warn(self, sentence: str) -> None:
        """Take a warning, such as one of a scene."""
        _log.warning("%s", sentence)

    @contextmanager
    def progress(
        self, name: str, total: float, amount: str, unit: float = 1.0, since: float = 0.0
    ) -> Iterator[Callable[[float], None]]:
        """Give the function that takes the time reached [s].

        total, since [s]: end and beginning of what is left; unit [s] and amount: how they are shown.
        """
        yield lambda time: None

    @contextmanager
    def counted(self, name: str, what: str) -> Iterator[Callable[[int, str], None]]:
        """Give the function that takes how many parts are done, and a text on the last one; `what` they are."""
        yield lambda count, text: None


QUIET = Listener()
