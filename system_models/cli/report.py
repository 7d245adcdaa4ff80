"""The command `tribofmu report`: a folder of results as one HTML page."""

import argparse
from pathlib import Path

from contact_core.errors import ContactError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "folder", metavar="DIR", type=Path, help="folder of the results of `tribofmu run`, such as results/mtm_zddp"
    )
    parser.add_argument("--out", metavar="FILE.html", type=Path, help="the page (default: report.html in DIR)")


def run(arguments: argparse.Namespace) -> int:
    """Write the page and return the exit code."""
    from ..html_report.opened import open_run
    from ..html_report.page import page

    written(arguments.out or arguments.folder / "report.html", page(open_run(arguments.folder)))
    return 0


def written(path: Path, text: str) -> None:
    """Write a page, say so. Raises ContactError if it cannot be written."""
    try:
        path.write_text(text, "utf-8")
    except OSError as error:
        raise ContactError(f"'{path}' cannot be written: {error.strerror}. Use another --out.") from None
    print(f"Written: {path} ({path.stat().st_size / 1e6:.1f} MB). It needs no other file and no network.")
