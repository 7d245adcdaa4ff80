"""Results as data: an xarray Dataset, of a run along `time` in seconds, as a netCDF file and a CSV file."""

import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import contact_core
from contact_core.scene import Scene

from .duty import Duty


def to_dataset(
    times: Sequence[float],
    columns: Mapping[str, Sequence[Any]],
    units: Mapping[str, str],
    texts: Mapping[str, str],
) -> xr.Dataset:
    """Columns of values at `times` [s] as variables along `time`, with attributes `units` and `long_name`."""
    variables = {
        name: ("time", np.asarray(values), {"units": units[name] or "1", "long_name": texts[name]})
        for name, values in columns.items()
    }
    time = ("time", np.asarray(times, dtype=float), {"units": "s", "long_name": "test time"})
    return xr.Dataset(variables, coords={"time": time})


def with_scene(dataset: xr.Dataset, scene: Scene, duty: Duty) -> xr.Dataset:
    """The dataset with its origin in the attributes: Scene.from_dict makes the scene again from `scene_json`."""
    return dataset.assign_attrs(_origin(scene, duty))


def _origin(scene: Scene, duty: Duty) -> dict[str, str]:
    return {
        "title": scene.description,
        "scene": scene.name,
        "scene_json": json.dumps(scene.to_dict()),
        "duty": duty.fingerprint(),
        "tribofmu_version": contact_core.__version__,
    }


def find(folder: Path, scene: Scene, duty: Duty) -> xr.Dataset | None:
    """The result in `folder` of just this scene and duty, if there is one."""
    return find_by(_origin(scene, duty), folder)


def find_by(origin: Mapping[str, str], folder: Path) -> xr.Dataset | None:
    """The result in `folder` that has these attributes, if there is one."""
    try:
        with xr.open_dataset(folder / "result.nc", engine="h5netcdf") as dataset:
            same = origin.items() <= dataset.attrs.items()
            return dataset.load() if same else None
    except (OSError, ValueError):  # none, or cut
        return None


def write(dataset: xr.Dataset, folder: Path, name: str = "result") -> list[Path]:
    """Write `name`.nc and `name`.csv into an existing folder and return their paths.

    The CSV has a row for each point of the dataset's dimensions; what does not vary along one of them is repeated.
    """
    netcdf, table = folder / f"{name}.nc", folder / f"{name}.csv"
    unfinished = netcdf.with_suffix(".new")
    dataset.to_netcdf(unfinished, engine="h5netcdf")
    unfinished.replace(netcdf)  # a kill leaves the old file or the new one
    columns = xr.broadcast(*(dataset[column] for column in (*dataset.dims, *dataset.data_vars)))
    with table.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(f"{column.name} [{column.attrs['units']}]" for column in columns)
        writer.writerows(zip(*(column.values.ravel().tolist() for column in columns), strict=True))
    return [netcdf, table]
