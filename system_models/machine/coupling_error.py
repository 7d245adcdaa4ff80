"""The error of the coupling: what a coarser simulation of the same machine changes in what is recorded.

Steps of double size, to four times the tolerance: of first order, as all machines are, the coarser simulation has twice
the error. Hence the difference is the error of the finer one.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..cosim_report import recorded
from .assembly import Assembly, Schedule

ATTRIBUTE = "error_coupling"  # of each Real output of a result, in the output's unit
_FACTORS = {"tolerance": 4.0, "max_step": 2.0, "step_size": 2.0}
_ZERO = 273.15  # K: temperatures are read in degC
_STATED = ".error_"  # what a contact says of its own errors
_TOLD = 5
_SMALL = 0.01  # of the nominal: what stays below is nothing
_SETTLED = 3.0  # steps after a change of the duty: where a jump lies in its step is no error


def coarser(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of a simulation with twice the error."""
    return {key: _FACTORS.get(key, 1.0) * value if key in _FACTORS else value for key, value in settings.items()}


def stated(dataset: xr.Dataset, coarse: xr.Dataset, assembly: Assembly) -> xr.Dataset:
    """The result with the error of each Real as its attribute."""
    found = dataset.copy()
    for name, error in errors(dataset, coarse, assembly.schedule).items():
        found[name].attrs[ATTRIBUTE] = error
    return found


def errors(dataset: xr.Dataset, coarse: xr.Dataset, schedule: Schedule) -> dict[str, float]:
    """Largest error of each Real of `dataset`, in its unit, by a coarser simulation of it.

    schedule: that of the machine; the first steps after a change of it are left out.
    """
    rows = settled(coarse, schedule)
    names = [name for name in recorded(dataset) if dataset[name].dtype.kind == "f" and _STATED not in name]
    return {name: _difference(coarse[name], dataset[name], rows) for name in names}


def _difference(coarse: xr.DataArray, fine: xr.DataArray, rows: NDArray[np.bool_]) -> float:
    between = np.interp(coarse["time"].values, fine["time"].values, fine.values)
    return float(np.abs(coarse.values - between)[rows].max(initial=0.0))


def settled(dataset: xr.Dataset, schedule: Schedule) -> NDArray[np.bool_]:
    """Which rows are some steps of their size later than the last change of the schedule, or the start."""
    times, sizes = dataset["time"].values, dataset["master.step_size"].values
    changes = np.array(sorted({0.0, *(float(time) for steps in schedule.values() for time, _ in steps)}))
    last = changes[np.maximum(np.searchsorted(changes, times) - 1, 0)]
    return np.asarray(times - last > _SETTLED * sizes)


def relative(dataset: xr.Dataset, nominals: Mapping[str, float]) -> dict[str, float]:
    """The errors stated in a result, each over the largest value of its output or, if that is more, a hundredth of its
    nominal; temperatures in degC.
    """
    found = {}
    for name in recorded(dataset):
        values = dataset[name]
        if ATTRIBUTE not in values.attrs:
            continue
        shift = _ZERO if values.attrs["units"] == "K" and "rise" not in name else 0.0
        largest = max(float(np.abs(values.values - shift).max()), _SMALL * nominals.get(name, 0.0))
        found[name] = values.attrs[ATTRIBUTE] / largest if largest else 0.0
    return found


def lines(dataset: xr.Dataset, nominals: Mapping[str, float]) -> list[str]:
    """The largest errors stated in a result, and the middle one."""
    found = relative(dataset, nominals)
    worst = sorted(found, key=lambda name: -found[name])[:_TOLD]
    return [
        f"Error of the coupling, from steps of double size, relative to the output's largest value: "
        f"{100.0 * float(np.median([*found.values()])):.2g} % in the middle of {len(found)} outputs, at most",
        *(f"  {100.0 * found[name]:.2g} %  {name}" for name in worst),
    ]
