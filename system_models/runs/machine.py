"""Runs a machine through its duty: its FMUs, simulated, checked, judged and written."""

import itertools
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from time import monotonic

import xarray as xr

from contact_core.errors import ContactError
from contact_core.scene import Assumed
from fmu_src.flavours import Flavour

from ..charts import files
from ..machines import assumed as assumed_of_machines
from ..machines import causes, corrected, coupling_error, reading, resolve, tables, trust
from ..machines import report as machine_report
from ..machines.assembly import Assembly
from ..machines.reading import Machine
from ..machines.registry import kinds
from ..master import System, simulate
from ..run import assumed as assumed_values
from ..run import cosim_report
from ..run.trust import wrapped
from ..store import results
from ..store.checkpoint import Checkpoint
from ..store.folders import made
from .job import EXIT_CODE, SHORTFALLS, Finished, carry_out
from .listener import QUIET, Listener

_DOUBLE_STEPS, _STATES = "double_steps", "states_solved_again"  # folders of unfinished checks


def run_machine(
    machine: Machine | str,
    folder: str | Path,
    changes: Mapping[str, str] | None = None,
    *,
    checks: bool = True,
    flavour: Flavour = "embedded",
    resume: bool = False,
    force: bool = False,
    listener: Listener = QUIET,
) -> Finished:
    """Run a machine through its duty; return the result, which is written to a folder.

    Parameters
    ----------
    machine : its record (`machines.reading.read`), the name of a shipped one, or the path of its file.
    changes : of dotted keys of a machine that is given by name.
    checks : simulate a second time with double steps, and solve some states of contacts again.
    flavour : of the FMUs of its contacts.
    resume : continue from a checkpoint in the folder, bit for bit; a finished run is returned as it is.
    force : replace the result of another machine.

    Raises ContactError for what cannot be run; what was computed is kept in the folder.
    """
    if isinstance(machine, str):
        machine = reading.read(machine, dict(changes or {}))
    elif changes:
        raise ContactError("changes are those of a machine that is given by its name. Give them to `reading.read`.")
    assembly, assumed = reading.assemble(machine), tables.scene_and_assumed(machine.table)[1]
    folder = made(Path(folder))
    listener.say(*wrapped(assembly.description), *trust.before(machine, assembly), "")
    with tempfile.TemporaryDirectory(prefix="tribofmu-") as files:
        system = assembly.system(Path(files), flavour, here=True)
        job = _Job(machine, assembly, system, folder, listener, resume)
        return job.run(assumed, checks, force)


def _took(begin: float) -> str:
    return f"This took {monotonic() - begin:.0f} s."


class _Job:
    """A machine with its FMUs, and where its result goes."""

    def __init__(
        self, machine: Machine, assembly: Assembly, system: System, folder: Path, listener: Listener, resume: bool
    ) -> None:
        self.machine, self.assembly, self.system = machine, assembly, system
        self.folder, self.listener, self.resume = folder, listener, resume

    def run(self, assumed: Sequence[Assumed], checks: bool, force: bool) -> Finished:
        """Simulate, report and check."""
        assembly, listener = self.assembly, self.listener
        if not self.resume:
            self._forget_checks()

        def report(dataset: xr.Dataset, folder: Path) -> Finished:
            done = self.report(dataset)
            return self.check(done) if checks else done

        return carry_out(
            self.system,
            {**assembly.settings, "outputs": assembly.outputs()},
            assembly.name,
            self.folder,
            report,
            resume=self.resume,
            force=force,
            about={**reading.described(self.machine), **assumed_values.attribute(assumed)},
            attributes={
                "title": assembly.description,
                "machine": assembly.name,
                "checks": "error_coupling, resolved.nc" if checks else "left out",
            },
            listener=listener,
        )

    def report(self, dataset: xr.Dataset) -> Finished:
        """Say and write the result."""
        assembly, say = self.assembly, self.listener.say
        kind = kinds()[self.machine.kind]
        worth = assumed_of_machines.worth(kind, assembly, reading.duty_of(self.machine))
        dataset = assumed_of_machines.with_half_widths(results.with_half_widths(dataset), worth)
        say(*kind.lines(assembly, dataset), "", *trust.after(kind, assembly, dataset), "")
        say(*assumed_of_machines.lines(assembly, dataset, worth), "")
        say(*machine_report.lines(assembly, dataset), "", *cosim_report.closing_lines(dataset), "")
        wrong = cosim_report.unreliable_steps(dataset) or machine_report.invalid_rows(assembly, dataset)
        found = causes.attribute(assembly, dataset, self.folder) | assumed_of_machines.attribute(worth)
        dataset = dataset.assign_attrs(found)
        written = results.write(dataset.assign_attrs({EXIT_CODE: int(bool(wrong))}), self.folder)
        written = [*written, *files.write(kind.pictures(assembly, dataset), self.folder)]
        say(f"Written: {', '.join(map(str, written))}")
        return Finished(dataset, self.folder, not wrong, tuple(map(Path, written)))

    def check(self, done: Finished) -> Finished:
        """Simulate with double steps and solve states again; say and write both findings."""
        assembly, listener = self.assembly, self.listener
        begin, tried = monotonic(), itertools.count(1)
        dataset = coupling_error.stated(done.dataset, self._with_double_steps(done.dataset), assembly.schedule)
        listener.say("", *coupling_error.lines(dataset, assembly.nominals()), _took(begin), "")
        begin = monotonic()
        store = self._store_of_states(dataset)
        with listener.counted(assembly.name, "states solved again") as show:
            states = resolve.resolve(
                assembly, dataset, lambda text: show(next(tried), f"{assembly.name}, {text}"), store=store
            )
        better = corrected.corrected(assembly, dataset, states)
        listener.say(*resolve.lines(states), *corrected.lines(assembly, dataset, better, states), _took(begin))
        shortfalls = tuple(text for state in states if state.solved for text in state.shortfalls)
        for text in shortfalls:
            listener.warn(text)
        checks = {"resolved": resolve.to_dataset(states), "corrected": results.with_half_widths(better)}
        written = [Path(results.write(each, self.folder, name)[0]) for name, each in checks.items()]
        listener.say(f"Written: {', '.join(map(str, written))}")
        dataset = resolve.marked(dataset, states)
        dataset = dataset.assign_attrs({EXIT_CODE: int(not done.reliable), SHORTFALLS: "\n".join(shortfalls)})
        results.write(dataset, self.folder)
        self._forget_checks()
        written = [*done.written, *written]
        return replace(done, dataset=dataset, shortfalls=shortfalls, written=tuple(written), checks=checks)

    def _with_double_steps(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the simulation with every second of its communication points."""
        assembly = self.assembly
        settings = coupling_error.coarser(dataset, assembly.settings, assembly.schedule)
        bar = self.listener.progress(f"{assembly.name}, double steps", settings["stop_time"], "{n:.4g}/{total:.4g} s")
        with bar as progress:
            return simulate(
                self.system,
                **settings,
                outputs=assembly.outputs(),
                checkpoint=self.folder / _DOUBLE_STEPS,
                resume=self.resume,
                progress=progress,
            )

    def _store_of_states(self, dataset: xr.Dataset) -> Checkpoint:
        """Return what keeps the states of this simulation that are solved again."""
        run = {"simulation": dataset.attrs["simulation_json"]}
        own = made(self.folder / _STATES)
        return Checkpoint.resume(own, run) if self.resume else Checkpoint(own, run)

    def _forget_checks(self) -> None:
        """Remove what is kept of unfinished checks."""
        for own in (self.folder / _DOUBLE_STEPS, self.folder / _STATES):
            if own.is_dir():
                Checkpoint(own, {}).remove()
                with suppress(OSError):  # a file of somebody else
                    own.rmdir()
