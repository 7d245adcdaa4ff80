"""Simulates a system with a checkpoint in the folder of its results, and hands the result to a report."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

from .console import note
from .overwriting import ask_before
from .progress import continued_by_resume, note_replaced, shown

if TYPE_CHECKING:
    import xarray as xr

    from ..master import System

EXIT_CODE = "exit_code"  # of the run, as an attribute of its result


def carry_out(
    system: "System",
    settings: Mapping[str, Any],
    name: str,
    folder: Path,
    resume: bool,
    force: bool,
    report: Callable[["xr.Dataset", Path], int],
    about: Mapping[str, str] | None = None,
    **attributes: str,
) -> int:
    """Simulate with a checkpoint in the folder and hand the result to `report`, whose exit code is returned.

    With `resume` continue from the checkpoint; if there is none, but the result of this simulation, keep that. The
    result of another system is replaced if `force`d. The settings are the arguments of `master.simulate`. `report`
    writes the result with its exit code as the attribute EXIT_CODE; `attributes` are others of it that distinguish it
    from results of another kind. `about` are attributes that do not, and that the checkpoint has, too.
    """
    _check(system, settings)
    origin = _origin(system, settings, name) | attributes
    checkpoint = _checkpoint(folder, system, settings, resume)
    continues = resume and checkpoint is not None and checkpoint.exists()
    if resume and not continues and (code := _finished(folder, origin)) is not None:
        return code
    if not continues:
        ask_before(folder, origin, force)
    begin = monotonic()
    dataset = _simulated(system, settings, name, checkpoint, continues, about or {})
    if not continues:
        dataset.attrs["wall_seconds"] = monotonic() - begin
    with continued_by_resume(lambda: checkpoint if _stamp(checkpoint) else None):
        code = report(dataset.assign_attrs(origin | dict(about or {})), folder)
    _remove_checkpoint(folder)
    return code


def _check(system: "System", settings: Mapping[str, Any]) -> None:
    """Refuse settings that make no sense before anything is shown or asked."""
    from ..master.settings import Settings

    Settings(**{name: value for name, value in settings.items() if name != "outputs"}).check(system)


def _origin(system: "System", settings: Mapping[str, Any], name: str) -> dict[str, str]:
    """Return the identity of the result, as attributes."""
    from ..master.saving import identity

    return {"title": name, "simulation_json": json.dumps(identity(system, settings))}


def _checkpoint(folder: Path, system: "System", settings: Mapping[str, Any], resume: bool) -> Path | None:
    """Return the file where the simulation stores the point it has reached, if its FMUs can be stored."""
    from ..master import CouplingError
    from ..master.saving import check
    from ..store.checkpoint import Checkpoint

    file = Checkpoint(folder, {}).file
    try:
        check(system, system.outputs(settings.get("outputs")))
    except CouplingError as error:
        if resume:
            raise
        note(f"There will be no checkpoint. {error}")
        return None
    if file.exists() and not resume:
        note_replaced(file)
    if file.exists() and resume:
        note(f"Continuing from '{file}'.")
    return file


def _finished(folder: Path, origin: Mapping[str, str]) -> int | None:
    """Return the exit code of this very simulation if its result is there already."""
    from ..store import results

    dataset = results.find(origin, folder)
    if dataset is None:
        note(f"There is no checkpoint in '{folder}': the simulation starts from the beginning.")
        return None
    note(f"This simulation is finished, its result is in '{folder}'. Leave out --resume to compute it again.")
    return int(dataset.attrs.get(EXIT_CODE, 0))


def _simulated(
    system: "System",
    settings: Mapping[str, Any],
    name: str,
    checkpoint: Path | None,
    resume: bool,
    about: Mapping[str, str],
) -> "xr.Dataset":
    """Simulate, with a progress bar in seconds; an early end says how to continue."""
    from ..master import simulate

    folder, before = checkpoint and checkpoint.parent, _stamp(checkpoint)

    def kept() -> Path | None:
        return None if _stamp(checkpoint) == before and not resume else checkpoint

    bar = shown(name, settings["stop_time"], "{n:.4g}/{total:.4g} s")
    with continued_by_resume(kept), bar as progress:
        return simulate(system, **settings, checkpoint=folder, resume=resume, about=about, progress=progress)


def _stamp(file: Path | None) -> int | None:
    """Return the time at which a file was written, if it is there."""
    return file.stat().st_mtime_ns if file is not None and file.exists() else None


def _remove_checkpoint(folder: Path) -> None:
    from ..store.checkpoint import Checkpoint

    Checkpoint(folder, {}).remove()
