"""What every long run says, of a contact or of coupled FMUs: how far it is, what it replaces, how to continue it."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from contact_core.errors import ContactError, StateError

from .alive import alive
from .console import note


def note_replaced(file: Path) -> None:
    """Say that the checkpoint of an unfinished run will be lost."""
    note(f"'{file}' of an unfinished run will be replaced; to continue from it, use --resume.")


@contextmanager
def shown(
    name: str, total: float, amount: str, unit: float = 1.0, since: float = 0.0
) -> Iterator[Callable[[float], None]]:
    """Show a progress bar with the log above it; give the function that takes the time reached [s].

    total, since [s]: end and beginning of what is left; unit [s] of the bar; amount: its numbers as `tqdm` formats
    them.
    """
    from tqdm import tqdm
    from tqdm.contrib.logging import logging_redirect_tqdm

    logging.basicConfig(format="%(message)s")
    bar = tqdm(
        total=total / unit,
        initial=since / unit,
        desc=name,
        bar_format=f"{{desc}} {{percentage:3.0f}} %|{{bar}}| {amount} [{{elapsed}}<{{remaining}}{{postfix}}]",
    )
    with bar, logging_redirect_tqdm(), alive(bar):
        yield lambda time: bar.update(time / unit - bar.n)


@contextmanager
def continued_by_resume(kept: Callable[[], Path | None]) -> Iterator[None]:
    """Add to an interrupt or an error how to continue from the checkpoint that `kept` returns, if there is one then."""
    try:
        yield
    except KeyboardInterrupt:
        raise KeyboardInterrupt(_how_to_continue(kept())) from None
    except StateError:
        raise
    except ContactError as error:
        raise ContactError(f"{error} {_how_to_continue(kept())}".rstrip()) from error


def _how_to_continue(file: Path | None) -> str:
    if file is None:
        return ""
    return f"What was computed is kept in '{file}': the same command with --resume continues from there."
