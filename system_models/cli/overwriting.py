"""The option --force, and files that are there already."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from contact_core.errors import ContactError


def add_force(
    parser: Any, text: str = "compute numbers that look like mistakes, and replace the result of another scene"
) -> None:
    parser.add_argument("--force", action="store_true", help=text)


def refuse_existing(paths: Iterable[Path], force: bool) -> None:
    """Raise ContactError if a file that would be written is there already, unless `force`d."""
    there = [path for path in paths if path.exists()]
    if there and not force:
        raise ContactError(f"'{there[0]}' is there already. Use another --out, or --force to replace it.")
