"""The coupling error: the change of the recorded outputs with steps of double size.

Of first order, as all machines are, the coarser simulation has twice the error. Three times the difference is stated,
as two step sizes do not show whether they are short enough, and no less than a jump of the output itself.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from contact_core.kernels.arrays import Array, Mask
from contact_core.quantities import CELSIUS

from ..run.cosim_report import recorded
from .assembly import Schedule

ATTRIBUTE = "error_coupling"  # of each Real output of a result, in the output's unit
_CHOOSING = ("tolerance", "horizon", "max_step", "controlled")  # settings that choose steps
_STATED = ".error_"  # in names of outputs: errors that a contact states
_SAFETY = 3.0  # of two grids: Roache, J. Fluids Eng. 116 (1994) 405; measured: benchmarks/machines/tolerance.py
_SHOWN = 5
_SMALL = 0.01  # of the nominal: smaller values count as zero
_FIRST = 3  # steps after a change of the duty or next to a jump of an output, where a difference is no error
_JUMP = 0.1  # of its largest value: an output that changes by more in a step is not resolved there
_ALONE = 3.0  # times the changes in the steps before and after: a smaller jump


def coarser(dataset: xr.Dataset, settings: Mapping[str, Any], schedule: Schedule) -> dict[str, Any]:
    """Return settings of the simulation with steps twice as large as those of a result."""
    times = dataset["time"].values[1:]
    points = [float(time) for part in np.split(times, _after_changes(times, schedule)) for time in _every_second(part)]
    return {key: value for key, value in settings.items() if key not in _CHOOSING} | {"points": points}


def _every_second(times: Array) -> Array:
    """Return the second, the fourth and so on, and the last."""
    return np.union1d(times[1::2], times[-1:])


def _after_changes(times: Array, schedule: Schedule) -> NDArray[np.int_]:
    """Return indices of the first times [s] after each change of the schedule."""
    changes = sorted({float(time) for steps in schedule.values() for time, _ in steps if time < times[-1]})
    return np.unique(np.searchsorted(times, changes, "right"))


def stated(dataset: xr.Dataset, coarse: xr.Dataset, schedule: Schedule) -> xr.Dataset:
    """Return the result with the error of each Real as its attribute.

    error_coupling = max(3 max |y(h) - y(2 h)|, largest isolated jump); jumps above 10 % of the largest value are
    excluded. The factor 3 is that for two grids: Roache 1994.
    """
    found = dataset.copy()
    own = np.isin(dataset["time"].values[1:], settled(dataset, schedule, 2 * _FIRST))
    for name, error in differences(dataset, coarse, settled(coarse, schedule)).items():
        found[name].attrs[ATTRIBUTE] = max(_SAFETY * error, _jump(dataset[name].values, own))
    return found


def _jump(values: Array, compared: Mask) -> float:
    """Return the largest isolated change of values in one of the steps that are `compared`.

    It is far larger than the changes beside it. Jumps that `differences` leaves out do not count.
    """
    change = np.abs(np.diff(values))
    beside = np.maximum(np.append(change[1:], 0.0), np.append(0.0, change[:-1]))
    alone = (change > _ALONE * beside) & (change <= _JUMP * np.abs(values).max(initial=0.0))
    return float(change[compared & alone].max(initial=0.0))


def differences(dataset: xr.Dataset, other: xr.Dataset, times: Array) -> dict[str, float]:
    """Return the largest difference of each Real between two results, in its unit.

    At those of some times [s] that lie three steps or more from its jumps.
    """
    found = {}
    for name in recorded(dataset):
        if dataset[name].dtype.kind != "f" or _STATED in name:
            continue
        one, two = (np.interp(times, each["time"].values, each[name].values) for each in (dataset, other))
        jumps = np.flatnonzero(np.abs(np.diff(one)) > _JUMP * np.abs(one).max(initial=0.0))
        near = jumps[:, None] + np.arange(1 - _FIRST, 1 + _FIRST)
        resolved = np.isin(np.arange(len(times)), near, invert=True)
        found[name] = float(np.abs(one - two)[resolved].max(initial=0.0))
    return found


def settled(dataset: xr.Dataset, schedule: Schedule, first: int = _FIRST) -> Array:
    """Return the times [s] of a result without the first ones after the start and after each change of the schedule."""
    times = dataset["time"].values[1:]
    return np.concatenate([part[first:] for part in np.split(times, _after_changes(times, schedule))])


def relative(dataset: xr.Dataset, nominals: Mapping[str, float]) -> dict[str, float]:
    """Return the stated errors, each over the largest value of its output; temperatures in degC.

    Where it is larger, a hundredth of the nominal takes the place of the largest value.
    """
    found = {}
    for name in recorded(dataset):
        values = dataset[name]
        if ATTRIBUTE not in values.attrs:
            continue
        shift = CELSIUS if values.attrs["units"] == "K" and "rise" not in name else 0.0
        largest = max(float(np.abs(values.values - shift).max()), _SMALL * nominals.get(name, 0.0))
        found[name] = values.attrs[ATTRIBUTE] / largest if largest else 0.0
    return found


def lines(dataset: xr.Dataset, nominals: Mapping[str, float]) -> list[str]:
    """Return the largest errors stated in a result, and the middle one."""
    found = relative(dataset, nominals)
    worst = sorted(found, key=lambda name: -found[name])[:_SHOWN]
    return [
        f"Error of the coupling, from steps of double size, relative to the output's largest value: "
        f"{100.0 * float(np.median([*found.values()])):.2g} % in the middle of {len(found)} outputs, at most",
        *(f"  {100.0 * found[name]:.2g} %  {name}" for name in worst),
    ]
