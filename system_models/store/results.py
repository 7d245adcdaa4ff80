"""Results as an xarray Dataset along `time` [s], as a netCDF file and as a CSV file."""

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from contact_core.quantities import ABSOLUTE, STATED

from . import netcdf

ERROR = "_error"  # after the name of an output: the half width of its error
BAND = "_band"  # after the name of an output of an ensemble: the half width of its mean by the scatter of the members


def to_dataset(
    times: ArrayLike,
    columns: Mapping[str, ArrayLike],
    units: Mapping[str, str],
    texts: Mapping[str, str],
) -> xr.Dataset:
    """Return columns of values at `times` [s] as variables along `time`, with attributes `units` and `long_name`."""
    variables = {
        name: ("time", np.asarray(values), {"units": units[name] or "1", "long_name": texts[name]})
        for name, values in columns.items()
    }
    time = ("time", np.asarray(times, dtype=float), {"units": "s", "long_name": "test time"})
    return with_half_widths(xr.Dataset(variables, coords={"time": time}))


def with_half_widths(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with the half width of each output's stated error as a coordinate, in the output's unit.

    That of `h_c` is `h_c_error`, that of `mesh.h_c` is `mesh.h_c_error`; the attribute `ancillary_variables` of the
    output names it (CF conventions, 3.4).
    """
    halves: dict[str, tuple[Any, ...]] = {}  # assigned at once: xarray copies all variables each time
    for name in dataset.data_vars:
        variable = dataset.variables[name]
        prefix, output = str(name).rpartition(".")[::2]
        stated = STATED.get(output, "")
        source = f"{prefix}.{stated}" if prefix else stated
        if stated and source in dataset:
            half = dataset.variables[source].values * (1.0 if stated in ABSOLUTE else np.abs(variable.values))
            text = f"half width (95 %) of the error of {name}"
            attributes = {"units": variable.attrs.get("units", "1"), "long_name": text}
            halves[str(name)] = (variable.dims, half, attributes)
    found = dataset.assign_coords({f"{name}{ERROR}": half for name, half in halves.items()})
    for name in halves:
        found.variables[name].attrs["ancillary_variables"] = f"{name}{ERROR}"
    return found


def half_width(dataset: xr.Dataset, name: str) -> np.ndarray | None:
    """Return the half width of an output by its stated error and, of an ensemble, by the scatter of the members.

    In the output's unit, along its dimensions; None where neither is known.
    """
    found = [
        np.asarray(dataset.variables[key].values, dtype=float)
        for key in (f"{name}{ERROR}", f"{name}{BAND}")
        if key in dataset.variables
    ]
    return (found[0] if len(found) == 1 else np.hypot(*found)) if found else None


def find(origin: Mapping[str, str], folder: Path) -> xr.Dataset | None:
    """Return the result in `folder` that has these attributes, if there is one."""
    try:
        dataset = netcdf.load(folder / "result.nc")
    except (OSError, ValueError):  # none, or cut
        return None
    return dataset if origin.items() <= dataset.attrs.items() else None


def attributes_of(file: Path) -> dict[str, Any] | None:
    """Return the attributes of a result's netCDF file; None if there is none, or it was cut."""
    try:
        return netcdf.attributes(file)
    except (OSError, ValueError):
        return None


def write(
    dataset: xr.Dataset,
    folder: Path,
    name: str = "result",
    maps: xr.Dataset | None = None,
    table: xr.Dataset | None = None,
) -> list[Path]:
    """Write `name`.nc and `name`.csv into an existing folder and return their paths.

    The CSV has a row for each point of the dataset's dimensions; variables constant along one of them are repeated.
    `maps` go into the netCDF only; `table` replaces the dataset in the CSV.
    """
    binary, text = folder / f"{name}.nc", folder / f"{name}.csv"
    rows = dataset if table is None else table
    unfinished = binary.with_suffix(".new")
    whole = dataset if maps is None else dataset.merge(maps, combine_attrs="override")
    netcdf.save(whole, unfinished)
    unfinished.replace(binary)  # a kill leaves the old file or the new one
    write_csv(rows, text)
    return [binary, text]


def write_csv(rows: xr.Dataset, path: Path) -> Path:
    """Write a dataset as CSV, a row for each point of its dimensions, and return its path."""
    columns = {name: rows.variables[name].set_dims(dict(rows.sizes)) for name in (*rows.dims, *rows.data_vars)}
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(f"{name} [{column.attrs['units']}]" for name, column in columns.items())
        writer.writerows(zip(*(column.values.ravel().tolist() for column in columns.values()), strict=True))
    return path
