"""The errors of the outputs of a machine's contacts at the end of its run, apart by their causes."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from contact_core.quantities import STATED, UNSOLVED
from fmu_src.runtime.snapshot import contact_state

from ..master.saving import unpack
from ..run.causes import Causes, by_cause, of_state
from ..store.checkpoint import Checkpoint
from ..store.results import ERROR
from .assembly import Assembly

ATTRIBUTE = "contact_errors_json"  # of a machine's result: half widths by contact, output and cause
_CURVES = "curves"  # the only cause of errors of levels without solutions


def of_contacts(assembly: Assembly, dataset: xr.Dataset, checkpoint: Checkpoint | None) -> dict[str, Causes]:
    """Return the errors at the end of a run by contact; of solved contacts if the checkpoint is of that time."""
    found: dict[str, Causes] = {
        name: _by_curves(dataset, name) for name in assembly.contacts if not _solved(assembly, name)
    }
    saved = checkpoint.saved if checkpoint else None
    if len(found) < len(assembly.contacts) and saved and saved.time == float(dataset["time"].values[-1]):
        states, _ = unpack(saved.state)
        for name, contact in assembly.contacts.items():
            if _solved(assembly, name):
                found[name] = by_cause(of_state(contact.own_scene, contact_state(states[name])))
    return found


def attribute(assembly: Assembly, dataset: xr.Dataset, folder: Path) -> dict[str, str]:
    """Return the errors of solved contacts as an attribute of the result, from the checkpoint in its folder.

    Of the other contacts the result itself has them.
    """
    if not any(_solved(assembly, name) for name in assembly.contacts):
        return {}
    read = Checkpoint.read(folder)
    found = of_contacts(assembly, dataset, read[0] if read else None)
    return {ATTRIBUTE: json.dumps({name: each for name, each in found.items() if _solved(assembly, name)})}


def of_result(assembly: Assembly, dataset: xr.Dataset) -> dict[str, Causes]:
    """Return the errors at the end of a finished run by contact; results of older versions lack those solved."""
    solved: Mapping[str, Any] = json.loads(dataset.attrs.get(ATTRIBUTE, "{}"))
    return {**of_contacts(assembly, dataset, None), **solved}


def _solved(assembly: Assembly, name: str) -> bool:
    """Return True for a contact at a level that solves contacts, whose errors have several causes."""
    return assembly.contacts[name].own_scene.film.fidelity not in UNSOLVED


def _by_curves(dataset: xr.Dataset, contact: str) -> Causes:
    """Return the errors that a contact states in the last row, all by the fitted curves."""
    names = [name for name in STATED if f"{contact}.{name}{ERROR}" in dataset.coords]
    halves = {name: float(dataset.coords[f"{contact}.{name}{ERROR}"].values[-1]) for name in names}
    return {name: {_CURVES: half} for name, half in halves.items() if half > 0.0}
