"""Results as an xarray Dataset along `time` [s], as a netCDF file and as a CSV file."""

import csv
import re
import unicodedata
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from contact_core.quantities import ABSOLUTE, STATED

ERROR = "_error"  # after the name of an output: the half width of its error
ASSUMED = "_assumed"  # after the name of an output: its half width by what the scene assumes
NAME = "name_in_full"  # attribute of a variable in a file whose name netCDF cannot take
BAND = "_band"  # after the name of an output of an ensemble: the half width of its mean by the scatter of the members


_FOREIGN = re.compile(r"^[^\w\x80-\U0010ffff]|[\x00-\x1f\x7f/]|\s+$")
_LONGEST = 256  # bytes of a name in netCDF


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
        numbers = all(dataset.variables[key].dtype.kind in "fiu" for key in (name, source) if key in dataset)
        if stated and source in dataset and numbers and f"{name}{ERROR}" not in dataset.data_vars:
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


def read(file: Path) -> xr.Dataset:
    """Return what is in a netCDF file. Raises OSError or ValueError if there is none or it was cut."""
    with xr.open_dataset(file, engine="netcdf4", decode_times=False) as opened:
        dataset = opened.load()
    full = {str(name): dataset[name].attrs.pop(NAME) for name in dataset.variables if NAME in dataset[name].attrs}
    return _renamed(dataset, full)


def find(origin: Mapping[str, str], folder: Path) -> xr.Dataset | None:
    """Return the result in `folder` that has these attributes, if there is one."""
    try:
        dataset = read(folder / "result.nc")
    except (OSError, ValueError):  # none, or cut
        return None
    return dataset if origin.items() <= dataset.attrs.items() else None


def attributes_of(file: Path) -> dict[str, Any] | None:
    """Return the attributes of a result's netCDF file; None if there is none, or it was cut."""
    try:
        with netCDF4.Dataset(file) as opened:  # xarray would look at every variable, too
            return dict(vars(opened))
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

    A name that netCDF cannot take is replaced by a short one; the attribute NAME of the variable keeps the full name,
    and `read` gives it back. The CSV has a row for each point of the dataset's dimensions; variables that are constant
    along a dimension are repeated. `maps` go into the netCDF file only; `table` replaces the dataset in the CSV.
    """
    netcdf, text = folder / f"{name}.nc", folder / f"{name}.csv"
    rows = dataset if table is None else table
    unfinished = netcdf.with_suffix(".new")
    whole = dataset if maps is None else dataset.merge(maps, combine_attrs="override")
    _storable(whole).to_netcdf(unfinished, engine="netcdf4")
    unfinished.replace(netcdf)  # a kill leaves the old file or the new one
    write_csv(rows, text)
    return [netcdf, text]


def _storable(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with names that netCDF takes."""
    changed = {name: _short(name) for name in map(str, dataset.variables) if not _fits(name, name in dataset.coords)}
    found = _renamed(dataset, changed)
    for name, short in changed.items():
        found.variables[short].attrs[NAME] = name
    return found


def _renamed(dataset: xr.Dataset, names: Mapping[str, str]) -> xr.Dataset:
    """Return the dataset with other names, also where an attribute refers to them."""
    if not names:
        return dataset
    found = dataset.rename(names)
    for variable in found.variables.values():
        other = variable.attrs.get("ancillary_variables", "")
        if other in names:
            variable.attrs = variable.attrs | {"ancillary_variables": names[other]}
    return found


def _fits(name: str, coordinate: bool) -> bool:
    """Return True if netCDF takes a name as it is; xarray lists coordinates, with spaces between."""
    whole = len(name.encode()) <= _LONGEST and unicodedata.is_normalized("NFC", name)
    return whole and not _FOREIGN.search(name) and not (coordinate and " " in name)


def _short(name: str) -> str:
    """Return what a name begins with, in letters that fit, and a number that tells it from others."""
    return f"{re.sub(r'[^A-Za-z0-9_.]', '_', name)[:100].lstrip('.')}_{zlib.crc32(name.encode()):08x}"


def write_csv(rows: xr.Dataset, path: Path) -> Path:
    """Write a dataset as CSV, a row for each point of its dimensions, and return its path."""
    columns = {name: rows.variables[name].set_dims(dict(rows.sizes)) for name in (*rows.dims, *rows.data_vars)}
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(f"{name} [{column.attrs['units']}]" for name, column in columns.items())
        writer.writerows(zip(*(column.values.ravel().tolist() for column in columns.values()), strict=True))
    return path
