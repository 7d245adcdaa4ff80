"""Runs a machine, or exports it, for `tribofmu run`. Light to import."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from .console import folder_of, note, refuse_empty, tell_replaced
from .overwriting import refuse_existing
from .scenes import ask_back, tell_assumed, tell_unreached

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fmu_src.flavours import Flavour

    from ..machines.assembly import Assembly


# keys that set the levels of contacts
_LEVEL, _CORRECTION, _DEEP = "contact.film.model", "contact.film.correction", "deterministic"

# keys of a machine that options stand for
_STAND_FOR = {
    "hours": "simulate.stop_time",
    "accuracy": "contact.control.accuracy",
    "grid": "contact.film.points",
    "duty": "duty.file",
}


def run(arguments: argparse.Namespace) -> int:
    """Carry out the command and return the exit code. Raises ContactError with a sentence if it cannot."""
    note(f"Loading '{arguments.scene}'; its report comes at the end.")
    from ..machines import plausibility, reading, tables

    changes, duty = _changes(arguments), Path(arguments.duty) if arguments.duty else None
    machine = reading.read(arguments.scene, changes, duty)
    assembly = reading.assemble(machine)
    if arguments.flavour == "native" and (level := _without_solver(assembly, changes)):
        machine = reading.read(arguments.scene, changes | level, duty)
        assembly = reading.assemble(machine)
    ask_back(plausibility.doubts(machine, assembly), arguments.force)
    tell_assumed(tables.scene_and_assumed(machine.table)[1])
    tell_unreached([time for time, _ in reading.duty_of(machine).rows], assembly.settings["stop_time"])
    if arguments.ssp:
        refuse_existing([Path(arguments.ssp)], arguments.force)
        return _export(assembly, arguments.ssp, arguments.flavour or "isolated")
    from ..runs import run_machine
    from .listener import CONSOLE

    done = run_machine(
        machine,
        folder_of(arguments.out, machine.name),
        checks=not arguments.unchecked,
        flavour=arguments.flavour or "embedded",
        resume=arguments.resume,
        force=arguments.force,
        listener=CONSOLE,
    )
    return done.exit_code or int(arguments.strict and bool(done.shortfalls))


def _changes(arguments: argparse.Namespace) -> dict[str, str]:
    refuse_empty(arguments)
    tell_replaced(arguments, _STAND_FOR)
    changes = dict(arguments.settings)
    if arguments.duty:
        changes.pop("duty.file", None)
    if arguments.hours:
        changes["simulate.stop_time"] = f"{arguments.hours} h"
    if arguments.accuracy:
        changes["contact.control.accuracy"] = arguments.accuracy
    if arguments.grid:
        changes["contact.film.points"] = arguments.grid
    return changes


def _without_solver(assembly: "Assembly", changes: "Mapping[str, str]") -> dict[str, str]:
    """Return the change to a level that native FMUs of the contacts can have; say so. None where one is set."""
    from fmu_src.native.level import other_level, unsolved

    if {_LEVEL, _CORRECTION, _DEEP} & changes.keys():
        return {}
    for name, contact in assembly.contacts.items():
        scene = contact.own_scene
        if (taken := unsolved(scene)) is not scene:
            note(f"{name}: {other_level(scene, taken)}")
            film = taken.to_dict()["film"]
            return {_LEVEL: film["model"], _CORRECTION: film["correction"], _DEEP: "[]"}
    return {}


def _export(assembly: "Assembly", path: str, flavour: "Flavour") -> int:
    import tempfile

    from ..machines.export import with_timetable
    from ..master import export_ssp

    with tempfile.TemporaryDirectory(prefix="tribofmu-") as folder:
        system = with_timetable(assembly).system(Path(folder), flavour)
        print(f"Written: {export_ssp(system, path, assembly.settings['stop_time'], assembly.settings['step_size'])}")
    return 0
