"""The listener of the command line: results on stdout, notes and bars on stderr."""

import sys

from ..runs.listener import Listener
from .console import note
from .progress import counted, shown


class Console(Listener):
    """Prints what runs tell."""

    resume, anew = "the same command with --resume", "--resume"
    progress, counted = staticmethod(shown), staticmethod(counted)

    def say(self, *lines: str) -> None:
        """Print lines of the result."""
        print(*lines, sep="\n", flush=True)

    def note(self, sentence: str) -> None:
        note(sentence)

    def warn(self, sentence: str) -> None:
        """Print a warning on stderr."""
        print(f"tribofmu: warning: {sentence}", file=sys.stderr)


CONSOLE = Console()
