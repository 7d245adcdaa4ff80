"""The part of the report that all machines have: costs, contact solutions by level, invalid rows, stored heat."""

import json
from collections import Counter
from dataclasses import dataclass

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Array
from contact_core.quantities import LEVELS

from ..parts.thermal import ThermalNetwork
from ..run.cosim_report import aligned
from .assembly import Assembly


@dataclass(frozen=True)
class Recorded:
    """A machine's run beside its assembly; rows are those of `time`."""

    assembly: Assembly
    dataset: xr.Dataset

    @property
    def time(self) -> Array:
        """Time of the rows [s]."""
        return self.of("time")

    def of(self, name: str) -> Array:
        """Return a variable "part.output" by row."""
        return np.asarray(self.dataset.variables[name].values, dtype=np.float64)


def lines(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return a table of costs, and sentences."""
    ends = [*_stated(assembly, dataset), *_invalid(assembly, dataset)]
    return [*_costs(assembly, dataset), "", *_solutions(assembly, dataset), *ends]


def loss_error(assembly: Assembly, dataset: xr.Dataset) -> float:
    """Return the relative error of the energy that the contacts lose, by the errors of friction and rolling they state.

    As if all contacts were off the same way; NaN if they lose nothing.
    """
    found = _losses(assembly, dataset)
    erred = sum(float(losses @ dataset[error].values) for error, losses in found)
    total = sum(float(losses.sum()) for _, losses in found)
    return erred / total if total else float("nan")


def lost(assembly: Assembly, dataset: xr.Dataset) -> float:
    """Return the energy [J] that the contacts lose."""
    return sum(float(losses.sum()) for _, losses in _losses(assembly, dataset))


def _losses(assembly: Assembly, dataset: xr.Dataset) -> list[tuple[str, np.ndarray]]:
    """Return the energy [J] that each contact loses in each step by sliding and by rolling, for all that it represents.

    With the column of the error of either. Records without speeds, or from before rolling had an error, lack rolling.
    """
    found, steps = [], np.diff(dataset["time"].values, prepend=0.0)
    for name, contact in assembly.contacts.items():
        count = dataset[contact.count].values if contact.count else 1.0
        found.append((f"{name}.error_friction", np.abs(count * dataset[f"{name}.power_loss"].values) * steps))
        if {f"{name}.{each}" for each in ("error_rolling", "speed_1", "speed_2")} <= {*map(str, dataset)}:
            speeds = dataset[f"{name}.speed_1"].values + dataset[f"{name}.speed_2"].values
            rolled = dataset[f"{name}.rolling_resistance"].values * speeds
            found.append((f"{name}.error_rolling", np.abs(count * rolled) * steps))
    return found


def _stated(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return a sentence on the errors that the contacts state, beside those of the coupling."""
    error = loss_error(assembly, dataset)
    if np.isnan(error):
        return []
    return [
        f"Errors that the contacts state: {error:.1%} of the energy they lose by sliding and rolling, as if all were "
        "off the same way; the error of the coupling comes on top."
    ]


def invalid_rows(assembly: Assembly, dataset: xr.Dataset) -> int:
    """Return rows in which a contact or component could not use its inputs."""
    return int((~_valid(assembly, dataset)).sum())


def heat_stored(assembly: Assembly, dataset: xr.Dataset, network: str) -> float:
    """Return the heat [J] that a thermal network of the machine holds at the end more than at the start."""
    part = assembly.parts[network]
    assert isinstance(part, ThermalNetwork)
    return part.heat_stored([float(dataset[f"{network}.temperature_{node.name}"].values[-1]) for node in part.nodes])


def _valid(assembly: Assembly, dataset: xr.Dataset) -> np.ndarray:
    columns = [dataset[f"{name}.valid"].values for name in (*assembly.parts, *assembly.contacts)]
    return np.asarray(np.logical_and.reduce(columns))


def _costs(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return seconds of each component, of all contacts of a scene, and of the master."""
    cost = json.loads(dataset.attrs["cost"])
    groups: dict[str, list[str]] = {}
    for name in assembly.parts:
        groups[name] = [name]
    for name, contact in assembly.contacts.items():
        groups.setdefault(f"contacts, {contact.scene.name}", []).append(name)
    wall = dataset.attrs.get("wall_seconds")
    within = sum(entry["seconds"] for entry in cost.values())
    total = within if wall is None else wall
    rows = [["", "steps", "us per step", "s", "share"]]
    for title, names in groups.items():
        steps, seconds = (sum(cost[name][key] for name in names) for key in ("steps", "seconds"))
        heading = title if len(names) == 1 else f"{len(names)} {title}"
        rows.append(
            [heading, f"{steps:,}", f"{1e6 * seconds / max(steps, 1):.0f}", f"{seconds:.2f}", f"{seconds / total:.0%}"]
        )
    if wall is not None:
        rows.append(["master", "", "", f"{wall - within:.2f}", f"{1 - within / total:.0%}"])
    return aligned(rows, 1)


def _solutions(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return the number of contact solutions at each level, and their speed."""
    cost, counts = json.loads(dataset.attrs["cost"]), Counter[int]()
    for name in assembly.contacts:
        counts[int(dataset[f"{name}.fidelity_used"].values[-1])] += cost[name]["steps"]
    counted = ", ".join(f"{count:,} {LEVELS[level - 1]}" for level, count in sorted(counts.items()) if level)
    sentence = f"Contact solutions, with those of steps tried or repeated: {counted}."
    wall = dataset.attrs.get("wall_seconds")
    if wall is None:
        return [f"{sentence} The real-time factor of a resumed run is not known."]
    span = float(dataset["time"].values[-1])
    return [sentence, f"{span:g} s in {wall:.1f} s: {span / wall:,.0f} times as fast as the machine."]


def _invalid(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    count = invalid_rows(assembly, dataset)
    if not count:
        return []
    names = [n for n in (*assembly.parts, *assembly.contacts) if not dataset[f"{n}.valid"].values.all()]
    first = float(dataset["time"].values[np.flatnonzero(~_valid(assembly, dataset))[0]])
    return [
        f"WARNING: {count} rows are INVALID, the first at {first:g} s: {', '.join(names)} could not use the inputs and "
        f"stood still. {dataset.attrs.get('invalid_why', '')}".strip()
    ]
