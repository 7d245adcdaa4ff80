"""The command `tribofmu log`: a test rig's text log becomes a duty and data to fit."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError
from contact_core.scene import units

from .console import note, output_folder
from .overwriting import add_force, refuse_existing

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..instruments.log_file import Log
    from ..instruments.log_tables import Row


def add_arguments(parser: argparse.ArgumentParser) -> None:
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
        help="body that a positive slide-to-roll ratio makes the faster one; of ball on disc 1 is the ball "
        "(default: as ball and disc speeds of the log say, else 1)",
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
        kind = f", {step.kind}" if step.kind else ""
        print(f"  {number}  {step.title or 'without a title'}{kind}: {len(step.rows)} rows")
    print("Taken:", *log.taken(), sep="\n  ")
    if log.left_out:
        print("Left out:", *log.left_out, sep="\n  ")
    for sentence in log.outside:
        note(sentence)
    _tell_rows(log, arguments.step, rows)
    sliding = [step for step in log.steps if step.has("srr") or step.has("sliding_speed")]
    if moving := [step for step in sliding if not log_tables.of_pin(step)]:
        print(_faster(arguments.faster, [log_tables.faster_of(step) for step in moving]))
    if len(moving) < len(sliding):
        print("Body 1 is the pin, which stands still.")
    duty, data = log_tables.duty(rows), log_tables.data(rows)
    if not duty and not data:
        raise ContactError(f"'{log.name}' has neither a duty nor anything measured in the columns that are taken.")
    folder = output_folder(str(given.parent), "")
    tables = {folder / f"{given.name}_{kind}.csv": table for kind, table in (("duty", duty), ("data", data)) if table}
    refuse_existing(tables, arguments.force)
    written = [log_tables.write(table, path) for path, table in tables.items()]
    if not duty:
        note(f"No duty: {log_tables.no_duty(rows)}.")
    tests = {tuple(row.inputs.items()) for row in rows if row.measured}
    if data and len(tests) > 1:
        note(
            f"The data have {len(tests)} sets of inputs; `tribofmu fit` takes each for a test of its own, which began "
            "with new surfaces at time 0. Choose steps by --step if they are of one test."
        )
    print(f"Written: {', '.join(map(str, written))}")
    return 0


def _tell_rows(log: "Log", chosen: "Sequence[int]", rows: "Sequence[Row]") -> None:
    """Say on stderr how many rows of the steps are left out, because an input is missing or cannot be."""
    steps = [log.steps[number - 1] for number in chosen] if chosen else log.steps
    left = sum(len(step.rows) for step in steps) - len(rows)
    if left:
        note(f"Rows without a time, load, speed or temperature that the contact takes are left out: {left}.")


def _faster(given: int | None, told: list[int]) -> str:
    """Return a sentence on the body that a positive slide-to-roll ratio makes the faster one."""
    bodies = sorted({body or 1 for body in told})
    if given:
        return f"A positive slide-to-roll ratio makes body {given} the faster one (--faster)."
    if not any(told):
        return "A positive slide-to-roll ratio is taken to make body 1 the faster one: the log does not say (--faster)."
    words = f"body {bodies[0]}" if len(bodies) == 1 else "in some steps body 1, in others body 2"
    return f"A positive slide-to-roll ratio makes {words} the faster one, as ball and disc speeds of the log say."
