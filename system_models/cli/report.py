"""The command `tribofmu report`: a folder of results as one HTML page."""

import argparse
import html
import re
from pathlib import Path

from contact_core.errors import ContactError

from .console import note

_MADE = "Made by tribofmu."  # in the foot of a page


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "folder", metavar="DIR", type=Path, help="folder of the results of `tribofmu run`, such as results/mtm_zddp"
    )
    parser.add_argument("--out", metavar="FILE.html", type=Path, help="the page (default: report.html in DIR)")


def run(arguments: argparse.Namespace) -> int:
    """Write the page and return the exit code."""
    from ..html_report.opened import open_run
    from ..html_report.page import page

    note(f"Reading '{arguments.folder}'; that of a machine may take half a minute.")
    written(arguments.out or arguments.folder / "report.html", page(open_run(arguments.folder)))
    return 0


def written(path: Path, text: str) -> None:
    """Write a page, say so. Raises ContactError if it cannot be written, or another file would be lost."""
    try:
        if path.exists() and path.read_text("utf-8", errors="replace") != text:
            _ask_before(path, text)
        path.write_text(text, "utf-8")
    except OSError as error:
        raise ContactError(f"'{path}' cannot be written: {error.strerror}. Use another --out.") from None
    print(f"Written: {path} ({path.stat().st_size / 1e6:.1f} MB). It needs no other file and no network.")


def _ask_before(path: Path, text: str) -> None:
    """Say what page is replaced. Raises ContactError for a file that is no page of this command."""
    before = path.read_text("utf-8", errors="replace")
    if _MADE not in before:
        raise ContactError(f"'{path}' is there already, and no page of tribofmu. Use another --out.")
    if _title(before) != _title(text):
        note(f"'{path}', the page '{_title(before)}', is replaced.")


def _title(page: str) -> str:
    found = re.search(r"<title>(.*?)</title>", page, re.DOTALL)
    return html.unescape(found[1]) if found else ""
