"""The command `tribofmu run`: a scene's contact, or a machine, through its duty."""

import argparse
from pathlib import Path

from contact_core.errors import ContactError, did_you_mean
from contact_core.scene.toml import file_like, shipped_scenes
from fmu_src.flavours import FLAVOURS

from ..machines import files
from . import contact, ensemble, machine
from .scenes import add_scene, members


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_scene(parser, "scene or machine")
    parser.add_argument(
        "--resume",
        action="store_true",
        help="continue from the checkpoint that a killed, interrupted or failed run has left in DIR, to the same "
        "result, bit for bit; start from the beginning if there is none. Without --resume a run starts from the "
        "beginning and replaces the checkpoint.",
    )
    parser.add_argument(
        "--hours",
        metavar="H",
        help=(
            "duration of the test in hours: replaces operation.duration, of a machine simulate.stop_time; "
            'for a short run of a scene use --set operation.duration="60 s"'
        ),
    )
    parser.add_argument(
        "--duty", metavar="FILE.csv", help="CSV of the duty: replaces operation.file, of a machine duty.file"
    )
    parser.add_argument(
        "--fields",
        metavar="N",
        help="keep maps and profiles of a scene's contact at N times of the run, from its start to its end: pressure, "
        "gap, tribofilm, wear and plastic depth, in result.nc, with the picture track.png",
    )
    parser.add_argument(
        "--unchecked",
        action="store_true",
        help="leave out the checks of a machine's result: a simulation with double steps, and states solved again",
    )
    parser.add_argument(
        "--strict",
        action="store_true",
        help="exit code 1, and not 0 with a warning, if a machine's stated error does not cover a state solved again",
    )
    parser.add_argument(
        "--flavour",
        choices=FLAVOURS,
        help="FMUs of a machine: 'native' ones are C, built when it starts, and fast, of contacts at a level without "
        "a solver; default: 'embedded', in an exported file 'isolated'",
    )
    parser.add_argument(
        "--processes", metavar="N", type=int, help="processes for the members of an ensemble of surfaces (default: 1)"
    )
    parser.add_argument("--ssp", metavar="FILE.ssp", help="export a machine as SSP 1.0, do not run it")


def run(arguments: argparse.Namespace) -> int:
    """Run what the command line names and return the exit code."""
    if files.is_machine(arguments.scene):
        if arguments.fields is not None:
            raise ContactError(
                f"--fields keeps maps of the one contact of a scene, and '{arguments.scene}' is a machine. Leave it "
                "out, or run a scene of one of its contacts."
            )
        _refuse_processes(arguments, "a machine")
        return machine.run(arguments)
    _check_name(arguments.scene)
    if arguments.flavour is not None:
        raise ContactError(
            f"--flavour is that of the FMUs of a machine, and '{arguments.scene}' is a scene, which runs without one. "
            "Leave it out, or build its FMU with `tribofmu build`."
        )
    if arguments.ssp is not None:
        raise ContactError(f"'{arguments.scene}' is one contact, not a machine. Export it with `tribofmu build`.")
    found = members(arguments)
    if found is not None:
        return ensemble.run(arguments, found)
    _refuse_processes(arguments, "one contact")
    return contact.run(arguments)


def _refuse_processes(arguments: argparse.Namespace, what: str) -> None:
    """Raise ContactError if --processes is given for something that is no ensemble."""
    if arguments.processes is not None:
        raise ContactError(
            f"--processes is for the members of an ensemble (surface_2.files), and '{arguments.scene}' is {what}. "
            "Leave it out."
        )


def _check_name(name: str) -> None:
    """Raise ContactError if nothing that is shipped is called so, and it is no file."""
    shipped = [*shipped_scenes(), *files.shipped()]
    if not name.endswith(".toml") and name not in shipped:
        like = did_you_mean(name, shipped) or file_like(Path(f"{name}.toml"))
        raise ContactError(
            f"There is no scene or machine '{name}'.{like} Shipped are {', '.join(shipped)}; or give the path of a "
            ".toml file."
        )
