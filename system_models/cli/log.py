"""The command `tribofmu log`: a test rig's text log becomes a duty and data to fit."""

import argparse
from pathlib import Path

from contact_core.errors import ContactError
from contact_core.scene import units

from .console import note, output_folder
from .overwriting import add_force, refuse_existing


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("file", metavar="FILE", help="text with headers, e.g. as exported by MTM and EHD rigs")
    parser.add_argument(
        "--column",
        metavar="HEADER=QUANTITY",
        nargs="+",
        action="extend",
        default=[],
        help="names a column, e.g. 'Speed (m/s)=rolling_speed', or 'Speed=rolling_speed [m/s]' where the header has no "
        "unit; 'Speed=' leaves it out",
    )
    parser.add_argument("--step", metavar="N", type=int, nargs="+", default=[], help="steps to take (default: all)")
    parser.add_argument(
        "--srr", metavar="RATIO", help="slide-to-roll ratio, of a log that does not say it, e.g. '0 %%'"
    )
    parser.add_argument(
        "--faster",
        type=int,
        choices=(1, 2),
        default=1,
        help="body that a positive slide-to-roll ratio makes the faster one; of ball on disc 1 is the ball "
        "(default: %(default)s)",
    )
    parser.add_argument("--out", metavar="NAME", help="writes NAME_duty.csv and NAME_data.csv (default: name of FILE)")
    add_force(parser, "replace files that are there already")


def run(arguments: argparse.Namespace) -> int:
    """Read the log, say what is taken and what is not, and write its tables; return 0."""
    from ..instruments import log_columns, log_file, log_tables

    given = Path(arguments.out or Path(arguments.file).stem)
    srr = None if arguments.srr is None else units.parse(arguments.srr, "", "--srr")
    log = log_file.read(Path(arguments.file), log_columns.named(arguments.column))
    rows = log_tables.rows_of(log, arguments.step, arguments.faster, srr)
    print(f"{log.name}: {len(log.steps)} steps")
    for number, step in enumerate(log.steps, 1):
        print(f"  {number}  {step.title or 'without a title'}: {len(step.rows)} rows")
    print("Taken:", *log.taken(), sep="\n  ")
    if log.left_out:
        print("Left out:", *log.left_out, sep="\n  ")
    duty, data = log_tables.duty(rows), log_tables.data(rows)
    if not duty and not data:
        raise ContactError(f"'{log.name}' has neither a duty nor anything measured in the columns that are taken.")
    folder = output_folder(str(given.parent), "")
    tables = {folder / f"{given.name}_{kind}.csv": table for kind, table in (("duty", duty), ("data", data)) if table}
    refuse_existing(tables, arguments.force)
    written = [log_tables.write(table, path) for path, table in tables.items()]
    if not duty:
        note("No duty: inputs change, but there is no column of time to say when.")
    tests = {tuple(row.inputs.items()) for row in rows if row.measured}
    if data and len(tests) > 1:
        note(
            f"The data have {len(tests)} sets of inputs; `tribofmu fit` takes each for a test of its own, which began "
            "with new surfaces at time 0. Choose steps by --step if they are of one test."
        )
    print(f"Written: {', '.join(map(str, written))}")
    return 0
