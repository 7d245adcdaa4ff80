"""Parts that the commands share: notes on stderr, the folder of the results, --set, and empty options."""

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path

from contact_core.errors import ContactError

from ..fmu.printable import printable
from ..store.folders import made


def note(sentence: str) -> None:
    """Print a sentence that is no result on stderr."""
    print(printable(f"tribofmu: note: {sentence}", kept="\n"), file=sys.stderr)


def refuse_empty(arguments: argparse.Namespace) -> None:
    """Raise ContactError for an option whose value is an empty text."""
    for option in ("hours", "grid", "accuracy", "duty", "out", "ssp", "fields"):
        if getattr(arguments, option, None) == "":
            raise ContactError(f"--{option} is empty. Give a value, or leave --{option} out.")


def add_settings(command: argparse.ArgumentParser, text: str) -> None:
    """Add the argument --set: pairs of key and value."""
    command.add_argument(
        "--set",
        dest="settings",
        metavar="KEY=VALUE",
        nargs="+",
        action="extend",
        default=[],
        type=_assignment,
        help=text,
    )


def tell_replaced(arguments: argparse.Namespace, keys: Mapping[str, str]) -> None:
    """Say on stderr where an option takes the place of a value that --set gives; `keys` are what options stand for."""
    settings = dict(arguments.settings)
    for option, key in keys.items():
        if getattr(arguments, option, None) and key in settings:
            note(f"--{option} stands for {key}: '{settings[key]}', which --set gives, is not used.")


def _assignment(text: str) -> tuple[str, str]:
    key, equals, value = text.partition("=")
    if not key or not equals:
        raise argparse.ArgumentTypeError(f"'{text}' is not KEY=VALUE, such as tribofilm.model=none")
    return key.strip(), value.strip()


def output_folder(out: str | None, name: str) -> Path:
    """Return the folder of --out, or results/NAME; it is made before the run, so that no result is lost."""
    return made(folder_of(out, name))


def folder_of(out: str | None, name: str) -> Path:
    return Path(out or Path("results") / name)
