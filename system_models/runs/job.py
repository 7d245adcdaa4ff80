"""A simulation with a checkpoint in the folder of its result."""

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic
from typing import Any

import xarray as xr

from contact_core.errors import ContactError, StateError
from contact_core.state import Error

from ..master import CouplingError, System, simulate
from ..master.saving import check, identity
from ..master.settings import Settings
from ..store import results
from ..store.checkpoint import Checkpoint
from .listener import QUIET, Listener
from .replacing import ask_before

EXIT_CODE, SHORTFALLS = "exit_code", "shortfalls"  # of the run, as attributes of its result


@dataclass(frozen=True)
class Finished:
    """A run that has come to its end, and its result in a folder.

    Attributes
    ----------
    dataset
        Outputs over time, as in result.nc.
    folder, written
        Folder of the result, and the files in it that this run wrote.
    reliable
        Every row is valid, and no check has failed.
    errors
        Of a contact: errors of the outputs at the end, by their causes.
    checks
        Of a machine: results of its checks, by the names of their files.

    """

    dataset: xr.Dataset
    folder: Path
    reliable: bool  # every row is valid
    written: tuple[Path, ...] = ()
    errors: Mapping[str, Error] = field(default_factory=dict)  # of a contact's outputs at the end, by their causes
    checks: Mapping[str, xr.Dataset] = field(default_factory=dict)  # of a machine, by the names of their files
    shortfalls: tuple[str, ...] = ()  # where a machine's stated error does not cover a state solved again, in words

    @property
    def exit_code(self) -> int:
        """Exit code of a command: 0 if the result is reliable, else 1."""
        return 0 if self.reliable else 1


Report = Callable[[xr.Dataset, Path], Finished]


def carry_out(
    system: System,
    settings: Mapping[str, Any],
    name: str,
    folder: Path,
    report: Report,
    *,
    resume: bool = False,
    force: bool = False,
    about: Mapping[str, str] | None = None,
    attributes: Mapping[str, str] | None = None,
    listener: Listener = QUIET,
) -> Finished:
    """Simulate with a checkpoint in the folder, and hand the result to `report`, which writes it.

    With `resume` continue from the checkpoint; if there is none, but the result of this simulation, return that. The
    result of another system is replaced if `force`d. The settings are the arguments of `master.simulate`. `report`
    writes the result with its exit code as the attribute EXIT_CODE; `attributes` are others of it that distinguish it
    from results of another kind. `about` are attributes that do not, and that the checkpoint has, too.
    """
    Settings(**{key: value for key, value in settings.items() if key != "outputs"}).check(system)
    origin = {"title": name, "simulation_json": json.dumps(identity(system, settings))} | dict(attributes or {})
    checkpoint = _checkpoint(folder, system, settings, resume, listener)
    continues = resume and checkpoint is not None and checkpoint.exists()
    if resume and not continues and (before := of_before(origin, folder, listener)) is not None:
        return before
    if not continues:
        ask_before(folder, origin, force, listener)
    begin = monotonic()
    dataset = _simulated(system, settings, name, checkpoint, continues, about or {}, listener)
    if not continues:
        dataset.attrs["wall_seconds"] = monotonic() - begin
    with continued_by_resume(lambda: checkpoint if _stamp(checkpoint) else None, listener):
        done = report(dataset.assign_attrs(origin | dict(about or {})), folder)
    Checkpoint(folder, {}).remove()
    return done


def _checkpoint(
    folder: Path, system: System, settings: Mapping[str, Any], resume: bool, listener: Listener
) -> Path | None:
    """Return the file where the simulation stores the point it has reached, if its FMUs can be stored."""
    file = Checkpoint(folder, {}).file
    try:
        check(system, system.outputs(settings.get("outputs")))
    except CouplingError as error:
        if resume:
            raise
        listener.note(f"There will be no checkpoint. {error}")
        return None
    if file.exists() and not resume:
        note_replaced(file, listener)
    if file.exists() and resume:
        listener.note(f"Continuing from '{file}'.")
    return file


def note_replaced(file: Path, listener: Listener) -> None:
    """Say that the checkpoint of an unfinished run will be lost."""
    listener.note(f"'{file}' of an unfinished run will be replaced; to continue from it, use {listener.anew}.")


def of_before(origin: Mapping[str, str], folder: Path, listener: Listener) -> Finished | None:
    """Return this very simulation if its result is there already."""
    dataset = finished(results.find(origin, folder), folder, listener)
    if dataset is None:
        return None
    shortfalls = tuple(dataset.attrs.get(SHORTFALLS, "").splitlines())
    return Finished(dataset, folder, reliable=not dataset.attrs.get(EXIT_CODE, 0), shortfalls=shortfalls)


def finished(dataset: xr.Dataset | None, folder: Path, listener: Listener) -> xr.Dataset | None:
    """Return the result of this very run where there is one, and say so."""
    if dataset is None:
        listener.note(f"There is no checkpoint in '{folder}': the run starts from the beginning.")
    else:
        there = f"This run is finished, its result is in '{folder}'."
        listener.note(f"{there} Leave out {listener.anew} to compute it again.")
    return dataset


def _simulated(
    system: System,
    settings: Mapping[str, Any],
    name: str,
    checkpoint: Path | None,
    resume: bool,
    about: Mapping[str, str],
    listener: Listener,
) -> xr.Dataset:
    """Simulate, with the progress in seconds; an early end says how to continue."""
    folder, before = checkpoint and checkpoint.parent, _stamp(checkpoint)

    def kept() -> Path | None:
        return None if _stamp(checkpoint) == before and not resume else checkpoint

    bar = listener.progress(name, settings["stop_time"], "{n:.4g}/{total:.4g} s")
    with continued_by_resume(kept, listener), bar as progress:
        return simulate(system, **settings, checkpoint=folder, resume=resume, about=about, progress=progress)


def _stamp(file: Path | None) -> int | None:
    """Return the time at which a file was written, if it is there."""
    return file.stat().st_mtime_ns if file is not None and file.exists() else None


@contextmanager
def continued_by_resume(kept: Callable[[], Path | None], listener: Listener) -> Iterator[None]:
    """Add to an interrupt or an error how to continue from the checkpoint that `kept` returns, if there is one then."""

    def how() -> str:
        file = kept()
        return "" if file is None else f"What was computed is kept in '{file}': {listener.resume} continues from there."

    try:
        yield
    except KeyboardInterrupt:
        raise KeyboardInterrupt(how()) from None
    except StateError:
        raise
    except ContactError as error:
        raise ContactError(f"{error} {how()}".rstrip()) from error
