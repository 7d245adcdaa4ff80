"""The command `tribofmu validate`: answers beside measurements, published numbers, closed forms and a thesis."""

import argparse
from typing import TYPE_CHECKING

from .console import output_folder
from .progress import counted, say

if TYPE_CHECKING:
    from ..validation.model import Outcome


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("names", metavar="NAME", nargs="*", help="comparisons to run (default: all, in minutes)")
    parser.add_argument("--list", dest="listed", action="store_true", help="name the comparisons and their sources")
    parser.add_argument("--out", metavar="DIR", help="folder of page and picture (default: results/validation)")


def run(arguments: argparse.Namespace) -> int:
    """Run, print and write the comparisons; return 1 if something disagrees without a known cause."""
    from ..validation import page, registry
    from ..validation.terminal import render, summary

    comparisons, names = registry.COMPARISONS, registry.chosen(arguments.names)
    if arguments.listed:
        for name in names:
            compared = comparisons[name]
            print(f"{name:14}  {compared.kind:20}  {compared.title}. {compared.source}")
        return 0
    folder = output_folder(arguments.out, "validation")
    outcomes: dict[str, Outcome] = {}
    with counted("validate", "comparisons", len(names)) as show:
        for name in names:
            show(len(outcomes), name)
            outcomes[name] = registry.outcome(name)
            say(render(name, comparisons[name], outcomes[name]) + "\n")
        show(len(outcomes), "validate")
    print(f"{summary(outcomes)}.")
    print(f"Written: {', '.join(map(str, page.write(comparisons, outcomes, folder)))}")
    return 1 if any(found.unexplained for found in outcomes.values()) else 0
