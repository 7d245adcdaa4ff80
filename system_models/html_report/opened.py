"""A folder of results as a Run: finished, or as far as its checkpoint has come."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from contact_core.errors import ContactError
from contact_core.quantities import TABLE, Quantity
from contact_core.scene import Assumed, Scene

from ..machines.assembly import Assembly
from ..machines.causes import of_contacts, of_result
from ..machines.kind import Kind
from ..machines.reading import ATTRIBUTE as MACHINE
from ..machines.reading import assemble, from_attribute
from ..machines.registry import kinds
from ..master.recorder import STATISTICS
from ..run import assumed
from ..run.causes import ATTRIBUTE as ERRORS
from ..run.causes import Causes, at_point, by_cause
from ..run.contact import communication_points
from ..run.duty import Duty
from ..run.fields import Fields
from ..store import results
from ..store.checkpoint import Checkpoint
from ..sweep.members import ATTRIBUTE as ENSEMBLE
from ..sweep.members import FILE as MEMBERS

_CONTACT = "contact."  # before the variables of a contact's checkpoint
_OF_RUN = ("version", "duty", "fields")  # of its identity; the rest is the scene


@dataclass(frozen=True)
class Machine:
    """The machine of a run, made again."""

    kind: Kind
    assembly: Assembly


@dataclass(frozen=True)
class Run:
    """A run to be shown."""

    folder: Path
    dataset: xr.Dataset  # with maps, if there are any
    planned: float  # end of the run as it was asked for [s]
    finished: bool
    scene: Scene | None = None  # of a contact
    scene_table: Mapping[str, Any] = field(default_factory=dict)  # nested, as in its file
    machine: Machine | None = None
    causes: Mapping[str, Causes] = field(default_factory=dict)  # half widths of errors at the end, by contact as in
    # `contacts`, output and cause
    assumed: Sequence[Assumed] | None = None  # values left to defaults; None: the result does not say
    files: Mapping[str, str] = field(default_factory=dict)  # sha256 by name
    members: xr.Dataset | None = None  # of an ensemble of surfaces, whose mean `dataset` is
    notes: tuple[str, ...] = ()  # what could not be read, and what follows from it

    @property
    def title(self) -> str:
        return str(self.dataset.attrs.get("title") or self.folder.name)

    @property
    def reached(self) -> float:
        """Time reached [s]."""
        return float(self.dataset.variables["time"].values[-1])

    @property
    def of_contact(self) -> bool:
        return bool(self.scene_table)

    @property
    def contacts(self) -> tuple[str, ...]:
        """Names of the contacts; of one contact's run the empty name."""
        if self.of_contact:
            return ("",)
        names = [str(name).rpartition(".")[0] for name in self.dataset.data_vars if str(name).endswith(".h_c")]
        return tuple(sorted(names))

    def alone(self, contact: str) -> xr.Dataset:
        """Return what the result has of a contact, by the names that the run of a contact has."""
        own = {name: name.removeprefix(f"{contact}.") for name in map(str, self.dataset.variables)}
        own = {name: short for name, short in own.items() if not contact or short != name}
        return self.dataset[list(own)].rename(own) if contact else self.dataset

    def of(self, contact: str, quantity: str) -> str:
        return f"{contact}.{quantity}" if contact else quantity


def open_run(folder: Path) -> Run:
    """Return the run in a folder: that of its checkpoint if this is newer than its result, else of the result.

    Raises ContactError with a sentence if there is neither, or none that can be read.
    """
    result, checkpoint = folder / "result.nc", Checkpoint(folder, {}).file
    if checkpoint.exists() and (not result.exists() or result.stat().st_mtime < checkpoint.stat().st_mtime):
        run = _unfinished(folder)
        older = ("The folder also has an older result.nc, of another run or an earlier one; it is not shown.",)
        return replace(run, notes=(*run.notes, *(older if result.exists() else ())))
    if not result.exists():
        raise ContactError(
            f"'{folder}' has neither a result.nc nor a checkpoint. Give the folder of --out of `tribofmu run`, such as "
            "results/NAME."
        )
    return _finished(folder, result)


def _finished(folder: Path, result: Path) -> Run:
    try:
        dataset = results.read(result)
    except (OSError, ValueError) as error:
        raise ContactError(f"'{result}' cannot be read: {error}. Run it again.") from None
    if "time" not in dataset.dims or not dataset.sizes["time"]:
        raise ContactError(f"'{result}' has no rows along time, so it is not of `tribofmu run` or `tribofmu cosim`.")
    dataset = dataset.assign_attrs({name: _plain(value) for name, value in dataset.attrs.items()})
    files = {
        name.name: _sha256(name) for name in (result, folder / "resolved.nc", folder / "corrected.nc") if name.exists()
    }
    end = float(dataset.variables["time"].values[-1])
    run = Run(folder, dataset, end, True, files=files, assumed=assumed.stored(dataset.attrs))
    if ENSEMBLE in dataset.attrs:
        run = _with_members(run)
    if "scene_json" in dataset.attrs:
        found = {"": json.loads(dataset.attrs.get(ERRORS, "{}"))}
        return _with_scene(replace(run, causes=found), json.loads(dataset.attrs["scene_json"]))
    return _with_machine(run)


def _with_members(run: Run) -> Run:
    """Return the run of an ensemble with the results of its members, or with a note if they are not there."""
    file = run.folder / f"{MEMBERS}.nc"
    try:
        found = results.read(file)
    except (OSError, ValueError):
        note = (
            f"This is the mean of an ensemble of surfaces, but the results of its members, {file.name}, are not there."
        )
        return replace(run, notes=(*run.notes, note))
    note = "This is the mean of an ensemble of surfaces; the scene below is that of its first member."
    return replace(run, members=found, files={**run.files, file.name: _sha256(file)}, notes=(*run.notes, note))


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _with_scene(run: Run, table: dict[str, Any]) -> Run:
    """Return the run with its scene, or with a note if the scene cannot be made again."""
    try:
        return replace(run, scene=Scene.from_dict(table), scene_table=table)
    except ContactError as error:
        note = f"The scene cannot be made again, so its laws are named without their sources. {error}"
        return replace(run, scene_table=table, notes=(*run.notes, note))


def _with_machine(run: Run) -> Run:
    """Return the run with its machine, if it is of one and can be made again."""
    text = run.dataset.attrs.get(MACHINE)
    if text is None:
        return run
    try:
        machine = from_attribute(text)
        kind, assembly = kinds()[machine.kind], assemble(machine)
    except (ContactError, OSError, KeyError) as error:
        note = f"The machine cannot be made again, so its own tables are left out. {error}"
        return replace(run, notes=(*run.notes, note))
    return replace(run, machine=Machine(kind, assembly), causes=of_result(assembly, run.dataset))


def _unfinished(folder: Path) -> Run:
    read = Checkpoint.read(folder)
    assert read is not None and read[0].saved is not None  # the file is there, and `read` raises for a damaged one
    checkpoint, about = read
    if "settings" in about:
        return _unfinished_system(folder, checkpoint, about)
    table = {key: value for key, value in about.items() if key not in _OF_RUN}
    attributes = {
        "title": table["description"],
        "scene": table["name"],
        "scene_json": json.dumps(table),
        "duty": about["duty"],
        "tribofmu_version": about["version"],
    }
    run = _with_scene(Run(folder, xr.Dataset(), 0.0, False, assumed=assumed.stored(checkpoint.about)), table)
    dataset = _rows(checkpoint, _CONTACT).assign_attrs(attributes)
    if run.scene is None:
        return replace(run, dataset=dataset, planned=float(dataset.variables["time"].values[-1]))
    planned, found = run.scene.operation.duration, by_cause(at_point(run.scene, checkpoint))
    run = replace(run, dataset=dataset, planned=planned, causes={"": found})
    return _with_maps(run, checkpoint, about) if checkpoint.kept else run


def _with_maps(run: Run, checkpoint: Checkpoint, about: Mapping[str, Any]) -> Run:
    """Return an unfinished run with the maps kept so far; without the duty's file their times are not known."""
    assert run.scene is not None
    try:
        duty = Duty.of_scene(run.scene)
        known = duty.fingerprint() == about["duty"]
    except (ContactError, OSError):
        known = False
    if not known:
        note = "The maps kept so far are not shown: the file of the duty, which says their times, is not here."
        return replace(run, notes=(*run.notes, note))
    points = communication_points(duty, run.scene.operation.duration, run.scene.operation.interval)
    fields = Fields(run.scene, duty, points, int(about["fields"]))
    fields.kept = checkpoint.kept
    return replace(run, dataset=run.dataset.merge(fields.dataset(), combine_attrs="override"))


def _unfinished_system(folder: Path, checkpoint: Checkpoint, about: Mapping[str, Any]) -> Run:
    title = f"{folder.name}: unfinished simulation of a system"
    attributes = {"title": title, "simulation_json": json.dumps(about), **checkpoint.about}
    told = assumed.stored(checkpoint.about)
    run = Run(folder, xr.Dataset(attrs=attributes), float(about["settings"]["stop_time"]), False, assumed=told)
    run = _with_machine(replace(run, dataset=_rows(checkpoint, "").assign_attrs(attributes)))
    if run.machine is None:
        return run
    assembly = run.machine.assembly
    dataset = _rows(checkpoint, "", _quantities(assembly)).assign_attrs({**attributes, "title": assembly.description})
    return replace(run, dataset=dataset, causes=of_contacts(assembly, dataset, checkpoint))


def _quantities(assembly: Assembly) -> dict[str, Quantity]:
    """Return the outputs of a machine's parts by the names of its result."""
    return {f"{name}.{q.name}": q for name, part in assembly.parts.items() for q in part.responses}


def _rows(checkpoint: Checkpoint, prefix: str, quantities: Mapping[str, Quantity] | None = None) -> xr.Dataset:
    """Return the rows of a checkpoint; units are those of known quantities by name, of others they are not known.

    Of contacts they are always known.
    """
    assert checkpoint.saved is not None
    rows = checkpoint.saved.rows
    names = [name for name in rows.dtype.names or () if name != "time"]
    shown = {name: name.removeprefix(prefix) for name in names}
    given = quantities or {}
    known = {name: given.get(name) or TABLE.get(shown[name].rpartition(".")[2]) for name in names}
    said = {shown[name]: (quantity.unit, quantity.text) for name, quantity in known.items() if quantity} | STATISTICS
    return results.to_dataset(
        rows["time"],
        {shown[name]: rows[name] for name in names},
        {shown[name]: said.get(shown[name], ("SI", ""))[0] for name in names},
        {shown[name]: said.get(shown[name], ("", shown[name]))[1] for name in names},
    )
