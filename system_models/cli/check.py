"""The command `tribofmu check`: a verdict per rule on an FMU."""

import argparse
from pathlib import Path

from contact_core.errors import ContactError

from .console import add_settings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("fmu", metavar="FILE.fmu", type=Path)
    parser.add_argument("--deep", action="store_true", help="run it, too: replay, rollback, range of the inputs, ...")
    parser.add_argument(
        "--limit",
        metavar="S",
        type=float,
        default=120.0,
        help="with --deep: seconds after which a call of the FMU is not waited for any more (default: %(default)g)",
    )
    parser.add_argument(
        "--budget",
        metavar="S",
        type=float,
        default=20.0,
        help="with --deep: seconds after which a rule is left with a note on what it has found (default: %(default)g); "
        "the first run may take as long as it needs",
    )
    add_settings(
        parser,
        "with --deep: start values of the run, e.g. fidelity=2; without, an FMU of several levels runs at its cheapest",
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
            print(report.line(finding), flush=True)
            found.append(finding)
    print(f"{arguments.fmu}: {report.summary(found)}.")
    return report.exit_code(found)
