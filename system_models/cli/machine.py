"""Runs a machine: builds its FMUs, simulates and reports. Light to import."""

import argparse
import itertools
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from .console import note, output_folder, refuse_empty, tell_replaced
from .overwriting import refuse_existing
from .progress import counted, shown
from .scenes import ask_back, tell_assumed, tell_unreached

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import xarray as xr

    from contact_core.scene import Assumed
    from fmu_src.flavours import Flavour

    from ..machines.assembly import Assembly
    from ..machines.reading import Machine
    from ..master import System
    from ..store.checkpoint import Checkpoint


# keys that set the levels of contacts
_LEVEL, _CORRECTION, _DEEP = "contact.film.model", "contact.film.correction", "deterministic"

# keys of a machine that options stand for
_STAND_FOR = {
    "hours": "simulate.stop_time",
    "accuracy": "contact.control.accuracy",
    "grid": "contact.film.points",
    "duty": "duty.file",
}


_DOUBLE_STEPS, _STATES = "double_steps", "states_solved_again"  # folders of unfinished checks


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
    assumed = tables.scene_and_assumed(machine.table)[1]
    tell_assumed(assumed)
    tell_unreached([time for time, _ in reading.duty_of(machine).rows], assembly.settings["stop_time"])
    if arguments.ssp:
        refuse_existing([Path(arguments.ssp)], arguments.force)
        return _export(assembly, arguments.ssp, arguments.flavour or "isolated")
    folder = output_folder(arguments.out, machine.name)
    return _run_in(folder, assembly, machine, assumed, arguments)


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


def _run_in(
    folder: Path,
    assembly: "Assembly",
    machine: "Machine",
    assumed: "Sequence[Assumed]",
    arguments: argparse.Namespace,
) -> int:
    import tempfile

    from ..machines import trust as machine_trust
    from ..machines.reading import described
    from ..run import assumed as assumed_values
    from ..run import trust
    from .simulation import carry_out

    unchecked: bool = arguments.unchecked
    flavour: Flavour = arguments.flavour or "embedded"
    print(*trust.wrapped(assembly.description), *machine_trust.before(machine, assembly), "", sep="\n", flush=True)
    settings = {**assembly.settings, "outputs": assembly.outputs()}
    checks = "left out" if unchecked else "error_coupling, resolved.nc"
    about = {**described(machine), **assumed_values.attribute(assumed)}
    attributes = {"title": assembly.description, "machine": assembly.name, "checks": checks}
    with tempfile.TemporaryDirectory(prefix="tribofmu-") as files:
        system = assembly.system(Path(files), flavour, here=True)

        def report(dataset: "xr.Dataset", folder: Path) -> int:
            code = _report(dataset, folder, assembly, machine)
            return code if unchecked else _check(dataset, folder, assembly, system, code, arguments.resume)

        if not arguments.resume:
            _forget_checks(folder)
        return carry_out(
            system, settings, assembly.name, folder, arguments.resume, arguments.force, report, about, **attributes
        )


def _report(dataset: "xr.Dataset", folder: Path, assembly: "Assembly", machine: "Machine") -> int:
    """Print and write the result; return the exit code."""
    from ..machines import assumed, causes, trust
    from ..machines import report as machine_report
    from ..machines.reading import duty_of
    from ..machines.registry import kinds
    from ..run import cosim_report
    from ..store import results
    from .simulation import EXIT_CODE

    described = kinds()[machine.kind]
    worth = assumed.worth(described, assembly, duty_of(machine))
    dataset = assumed.with_half_widths(results.with_half_widths(dataset), worth)
    print(*described.lines(assembly, dataset), "", *trust.after(described, assembly, dataset), "", sep="\n")
    print(*assumed.lines(assembly, dataset, worth), "", sep="\n")
    print(*machine_report.lines(assembly, dataset), "", *cosim_report.closing_lines(dataset), "", sep="\n")
    code = 1 if cosim_report.unreliable_steps(dataset) or machine_report.invalid_rows(assembly, dataset) else 0
    dataset = dataset.assign_attrs(causes.attribute(assembly, dataset, folder) | assumed.attribute(worth))
    written = results.write(dataset.assign_attrs({EXIT_CODE: code}), folder)
    print(f"Written: {', '.join(map(str, [*written, *described.pictures(assembly, dataset, folder)]))}", flush=True)
    return code


def _check(dataset: "xr.Dataset", folder: Path, assembly: "Assembly", system: "System", code: int, resume: bool) -> int:
    """Simulate with double steps and solve states again; write both findings.

    Return the exit code, which has been `code` so far. With `resume` go on from what an interrupted check has kept.
    """
    from ..machines import corrected, coupling_error, resolve
    from ..master import simulate
    from ..store import results
    from .simulation import EXIT_CODE

    begin = monotonic()
    settings = coupling_error.coarser(dataset, assembly.settings, assembly.schedule)
    with shown(f"{assembly.name}, double steps", settings["stop_time"], "{n:.4g}/{total:.4g} s") as progress:
        coarse = simulate(
            system,
            **settings,
            outputs=assembly.outputs(),
            checkpoint=folder / _DOUBLE_STEPS,
            resume=resume,
            progress=progress,
        )
    dataset = coupling_error.stated(dataset, coarse, assembly.schedule)
    print("", *coupling_error.lines(dataset, assembly.nominals()), sep="\n")
    print(f"This took {monotonic() - begin:.0f} s.", "", sep="\n", flush=True)
    begin = monotonic()
    tried = itertools.count(1)
    store = _store_of_states(folder, dataset, resume)
    with counted(assembly.name, "states solved again") as show:
        states = resolve.resolve(
            assembly, dataset, lambda done: show(next(tried), f"{assembly.name}, {done}"), store=store
        )
    better = corrected.corrected(assembly, dataset, states)
    print(
        *resolve.lines(states),
        *corrected.lines(assembly, dataset, better, states),
        f"This took {monotonic() - begin:.0f} s.",
        sep="\n",
    )
    wrong = [state for state in states if state.solved and not state.valid]
    if wrong:
        count = f"{len(wrong)} of {len(states)} states"
        note(f"The errors of the regression level do not cover its deviation in {count}: see 'NO'.")
        code = 1
    found = (resolve.to_dataset(states), "resolved"), (results.with_half_widths(better), "corrected")
    print(f"Written: {', '.join(str(results.write(each, folder, name)[0]) for each, name in found)}")
    results.write(resolve.marked(dataset, states).assign_attrs({EXIT_CODE: code}), folder)
    _forget_checks(folder)
    return code


def _store_of_states(folder: Path, dataset: "xr.Dataset", resume: bool) -> "Checkpoint":
    """Return what keeps the states of this simulation that are solved again."""
    from ..store.checkpoint import Checkpoint

    run = {"simulation": dataset.attrs["simulation_json"]}
    own = output_folder(str(folder / _STATES), "")
    return Checkpoint.resume(own, run) if resume else Checkpoint(own, run)


def _forget_checks(folder: Path) -> None:
    """Remove what is kept of unfinished checks."""
    from ..store.checkpoint import Checkpoint

    for own in (folder / _DOUBLE_STEPS, folder / _STATES):
        if own.is_dir():
            Checkpoint(own, {}).remove()
            with suppress(OSError):  # a file of somebody else
                own.rmdir()
