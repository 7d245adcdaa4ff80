"""The command `tribofmu`: its commands, each in a module of its own.

Exit codes: 0 done; 1 some rows of the result are invalid, some rule failed, or some steps have not converged or are
less accurate than asked; 2 refused or failed, with a sentence on stderr; 130 interrupted; 141 the reader of the output
has gone, as in `tribofmu list | head`.
"""

import argparse
import errno
import os
import re
import sys
from collections.abc import Sequence
from typing import NoReturn, Protocol

import contact_core
from contact_core.errors import ContactError, did_you_mean

from ..fmu.printable import printable
from . import (
    build,
    check,
    compare,
    cosim,
    docs,
    explain,
    fit,
    listing,
    log,
    new,
    report,
    run,
    stribeck,
    surface_file,
    surfaces,
    sweep,
    validate,
)
from . import map as mapping
from .pages import see


class Command(Protocol):
    """The module of a command."""

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Add the arguments of the command."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Carry out the command and return the exit code."""


# name: its module, and its line in the help
COMMANDS: dict[str, tuple[Command, str]] = {
    "list": (listing, "name the shipped scenes and machines"),
    "new": (new, "write a commented scene to start from"),
    "explain": (explain, "name the laws of a scene, the sources of its numbers, and what it leaves out"),
    "surfaces": (surfaces, "what a scene's grid shows of its surfaces"),
    "surface-file": (surface_file, "make a surface that an instrument has measured ready for a scene"),
    "run": (run, "run a scene's contact, or a machine, through its duty"),
    "report": (report, "show the results of a run as one HTML page"),
    "compare": (compare, "show runs beside each other, with their error bands, in a table and an HTML page"),
    "stribeck": (stribeck, "rub a scene's contact and measure its Stribeck curves"),
    "sweep": (sweep, "run a scene with many values of some of its keys"),
    "fit": (fit, "fit constants of a scene to measured films, friction or wear"),
    "log": (log, "make a duty and data to fit of a test rig's text log"),
    "map": (mapping, "make the map of a scene for film.correction = 'map', by solved contacts"),
    "build": (build, "build the FMU of a scene, for another tool"),
    "validate": (validate, "compare answers with measurements, published numbers and closed forms"),
    "check": (check, "give a verdict per rule on any FMU"),
    "cosim": (cosim, "simulate a system of FMUs"),
    "docs": (docs, "list the pages of the documentation, or show one"),
}

# why a system refuses to write: no room, or no right
_REFUSED = {
    errno.ENOSPC,
    errno.EDQUOT,
    errno.EFBIG,
    errno.EROFS,
    errno.EACCES,
    errno.EPERM,
    errno.EIO,
    errno.ENAMETOOLONG,
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    parser = parser_of_all()
    arguments, unknown = parser.parse_known_args(argv)
    if "command" not in arguments and not unknown:
        parser.print_help(sys.stderr)
        return 2
    if unknown:
        own = getattr(arguments, "own_parser", parser)
        options = [option.lstrip("-") for option in own._option_string_actions]
        like = did_you_mean(unknown[0].lstrip("-"), options).replace("'", "'--", 1)
        own.error(f"unrecognized arguments: {' '.join(unknown)}.{like}")
    try:
        code = int(arguments.command(arguments))
        sys.stdout.flush()  # here, so that a closed pipe is seen here and not at exit
        return code
    except ContactError as error:
        print(printable(f"tribofmu: {error}{see(error, arguments.command_name)}", kept="\n\t"), file=sys.stderr)
        return 2
    except KeyboardInterrupt as interrupt:
        print(f"tribofmu: Interrupted. {interrupt}".rstrip(), file=sys.stderr)
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # else the exit tries to write again
        return 141
    except OSError as error:
        if error.errno not in _REFUSED:
            raise
        named = f" for '{error.filename}'" if error.filename else ""
        print(
            f"tribofmu: The system refuses a file{named}: {error.strerror}. Make room, or choose another folder with "
            "--out. What has been written stays.",
            file=sys.stderr,
        )
        return 2


class _Parser(argparse.ArgumentParser):
    """Refuses a command that is not there with one like it."""

    def error(self, message: str) -> NoReturn:
        """End the program with a sentence on the arguments."""
        wrong = re.match(r"argument COMMAND: invalid choice: '(.*?)'", message)
        if wrong:
            message = f"there is no command '{wrong[1]}'.{did_you_mean(wrong[1], list(COMMANDS))} `tribofmu` lists them"
        super().error(message)


def parser_of_all() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="tribofmu",
        description="Contacts with mixed lubrication, tribofilm and wear: run them, build FMUs of them, check and "
        "couple any FMUs.",
        epilog="To start: `tribofmu run mtm_zddp`, or a scene of your own by `tribofmu new mine`; "
        "`tribofmu docs getting_started` explains both, `tribofmu COMMAND --help` a command.",
    )
    parser.add_argument("--version", action="version", version=f"tribofmu {contact_core.__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", parser_class=argparse.ArgumentParser)
    for name, (module, text) in COMMANDS.items():
        command = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
        module.add_arguments(command)
        command.set_defaults(command=module.run, command_name=name, own_parser=command)
    return parser


if __name__ == "__main__":
    sys.exit(main())
