"""The command `tribofmu check`: a verdict per rule on an FMU."""

import argparse
from pathlib import Path

from contact_core.errors import ContactError

from ..fmu.printable import printable
from .console import add_settings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("fmu", metavar="FILE.fmu", type=Path)
    parser.add_argument("--deep", action="store_true", help="also run the FMU: replay, rollback, input range, ...")
    parser.add_argument(
        "--limit",
        metavar="S",
        type=float,
        default=120.0,
        help="with --deep: time limit of a call of the FMU in seconds (default: %(default)g)",
    )
    parser.add_argument(
        "--budget",
        metavar="S",
        type=float,
        default=20.0,
        help="with --deep: time limit of a rule in seconds, after which it ends with a note on its findings "
        "(default: %(default)g); the first run has no limit",
    )
    add_settings(
        parser,
        "with --deep: start values of the run, e.g. fidelity=2; by default an FMU runs at its cheapest level",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the verdicts and return the exit code."""
    from ..check import report
    from ..check.package import opened

    if arguments.settings and not arguments.deep:
        raise ContactError("--set gives start values of a run of the FMU: add --deep.")
    found = []
    with opened(arguments.fmu) as package:
        for finding in report.findings(package, arguments.deep, arguments.limit, arguments.budget, arguments.settings):
            print(printable(report.line(finding)), flush=True)
            found.append(finding)
    print(printable(f"{arguments.fmu}: {report.summary(found)}."))
    return report.exit_code(found)
