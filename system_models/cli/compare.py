"""The command `tribofmu compare`: runs beside each other, as a table and as one HTML page."""

import argparse
from pathlib import Path

from .report import written


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "folders", metavar="DIR", nargs="+", type=Path, help="folders of the results of `tribofmu run`, 2 to 7"
    )
    parser.add_argument("--out", metavar="FILE.html", type=Path, help="the page (default: compare.html)")


def run(arguments: argparse.Namespace) -> int:
    """Print the table, write the page and return the exit code."""
    from ..html_report import compare

    runs = compare.open_runs(arguments.folders)
    print(*compare.lines(runs), sep="\n")
    written(arguments.out or Path("compare.html"), compare.page(runs))
    return 0
