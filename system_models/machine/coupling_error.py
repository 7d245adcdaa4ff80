"""The error of the coupling: what a finer simulation of the same machine changes in what is recorded.

Steps of half the size, and half the tolerance: of first order, as all machines are, the finer one has half the error.
Hence the error of the coarser one is twice their difference.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..cosim_report import recorded
from .assembly import Schedule

_ZERO = 273.15  # K: temperatures are read in degC
_FINER = ("tolerance", "max_step", "step_size")
_STATED = ".error_"  # what a contact says of its own errors
_TOLD = 5
_SMALL = 0.01  # of the nominal: what stays below is nothing
_SETTLED = 3.0  # steps after a change of the duty: where a jump lies in its step is no error


def finer(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of a simulation with half the error."""
    return {**settings, **{key: 0.5 * settings[key] for key in _FINER if settings.get(key)}}


def errors(
    coarse: xr.Dataset, fine: xr.Dataset, schedule: Schedule, nominals: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Largest error of each Real of `coarse`, over its largest value or, if that is more, a hundredth of its nominal.

    schedule: that of the machine; the first steps after a change of it are left out.
    """
    rows = settled(coarse, schedule)
    times, found = coarse["time"].values, {}
    for name in recorded(coarse):
        values = coarse[name]
        if values.dtype.kind != "f" or not rows.any() or _STATED in name:
            continue
        shift = _ZERO if values.attrs["units"] == "K" and "rise" not in name else 0.0
        better = np.interp(times, fine["time"].values, fine[name].values)
        largest = max(float(np.abs(values.values - shift).max()), _SMALL * (nominals or {}).get(name, 0.0))
        change = float(np.abs(values.values - better)[rows].max())
        found[name] = 2.0 * change / largest if largest else 0.0
    return found


def settled(dataset: xr.Dataset, schedule: Schedule) -> NDArray[np.bool_]:
    """Which rows are some steps of their size later than the last change of the schedule, or the start."""
    times, sizes = dataset["time"].values, dataset["master.step_size"].values
    changes = np.array(sorted({0.0, *(float(time) for steps in schedule.values() for time, _ in steps)}))
    last = changes[np.maximum(np.searchsorted(changes, times) - 1, 0)]
    return np.asarray(times - last > _SETTLED * sizes)


def lines(found: Mapping[str, float]) -> list[str]:
    """The largest errors, and the middle one."""
    worst = sorted(found, key=lambda name: -found[name])[:_TOLD]
    return [
        f"Error by the communication steps, some steps after changes of the duty, over the output's largest value: "
        f"{100.0 * float(np.median([*found.values()])):.2g} % in the middle of {len(found)} outputs, at most",
        *(f"  {100.0 * found[name]:.2g} %  {name}" for name in worst),
    ]
