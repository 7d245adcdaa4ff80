"""The run as data: an xarray Dataset along `time` in seconds, a netCDF file and a CSV file."""

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
    try:
        with xr.open_dataset(folder / "result.nc", engine="h5netcdf") as dataset:
            same = _origin(scene, duty).items() <= dataset.attrs.items()
            return dataset.load() if same else None
    except (OSError, ValueError):  # none, or cut
        return None


def write(dataset: xr.Dataset, folder: Path) -> list[Path]:
    """Write `result.nc` and `result.csv` into an existing folder and return their paths."""
    netcdf, table = folder / "result.nc", folder / "result.csv"
    dataset.to_netcdf(netcdf, engine="h5netcdf")
    names = ["time", *map(str, dataset.data_vars)]
    with table.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(f"{name} [{dataset[name].attrs['units']}]" for name in names)
        writer.writerows(zip(*(dataset[name].values.tolist() for name in names), strict=True))
    return [netcdf, table]
