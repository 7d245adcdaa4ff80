"""The command `tribofmu compare`: runs beside each other, as a table and as one HTML page."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from .report import written


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "folders", metavar="DIR", nargs="+", type=Path, help="folders of the results of `tribofmu run`, 2 to 7"
    )
    parser.add_argument(
        "--out",
        metavar="FILE.html",
        type=Path,
        help="the page (default: beside the folder of the first run, named after all)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the table, write the page and return the exit code."""
    from ..html_report import compare

    runs = compare.open_runs(arguments.folders)
    print(*compare.lines(runs), sep="\n")
    written(arguments.out or _page_of(arguments.folders), compare.page(runs))
    return 0


def _page_of(folders: Sequence[Path]) -> Path:
    """Return the default page, such as results/compare_coarse_fine.html of results/coarse and results/fine."""
    whole = [folder.resolve() for folder in folders]
    beside = folders[0] / ".." if folders[0].name in ("", "..") else folders[0].parent
    return beside / f"compare_{'_'.join(folder.name for folder in whole)}.html"
