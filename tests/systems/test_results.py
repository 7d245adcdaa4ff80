import csv
import json
from pathlib import Path

import numpy as np
import xarray as xr

import contact_core
from contact_core import Scene
from contact_core.quantities import TABLE
from system_models.run import origin
from system_models.run.duty import Duty
from system_models.store import results


def test_variables_have_the_names_units_and_texts_of_the_quantity_table(dataset: xr.Dataset) -> None:
    assert set(dataset.data_vars) == set(TABLE)
    for name, quantity in TABLE.items():
        assert dataset[name].dims == ("time",)
        assert dataset[name].attrs["units"] == (quantity.unit or "1"), name
        assert dataset[name].attrs["long_name"].startswith(quantity.text), name


def test_time_is_a_coordinate_in_seconds(dataset: xr.Dataset) -> None:
    assert dataset["time"].attrs["units"] == "s"
    assert dataset["time"].dtype == np.float64
    assert dataset["time"].values[-1] == 72.0


def test_the_attributes_make_the_scene_again(dataset: xr.Dataset, scene: Scene, duty: Duty) -> None:
    attributes = origin.with_scene(dataset, scene, duty).attrs
    assert Scene.from_dict(json.loads(attributes["scene_json"])) == scene
    assert attributes["scene"] == "mtm_zddp"
    assert attributes["tribofmu_version"] == contact_core.__version__


def test_netcdf_gives_back_what_was_written(dataset: xr.Dataset, scene: Scene, duty: Duty, tmp_path: Path) -> None:
    described = origin.with_scene(dataset, scene, duty)
    binary, _ = results.write(described, tmp_path)
    with xr.open_dataset(binary) as read:
        xr.testing.assert_identical(read.load(), described)
    xr.testing.assert_identical(results.read(binary), described)


def test_csv_names_units_and_keeps_every_digit(dataset: xr.Dataset, tmp_path: Path) -> None:
    _, table = results.write(dataset, tmp_path)
    with table.open(newline="") as file:
        header, *rows = csv.reader(file)
    assert header[:3] == ["time [s]", "load [N]", "speed_1 [m/s]"]
    column = header.index("wear_volume_1 [m3]")
    assert [float(row[column]) for row in rows] == dataset["wear_volume_1"].values.tolist()
    assert {row[header.index("valid [1]")] for row in rows} == {"True"}


def test_the_same_run_writes_the_same_bytes(dataset: xr.Dataset, scene: Scene, duty: Duty, tmp_path: Path) -> None:
    described, folders = origin.with_scene(dataset, scene, duty), (tmp_path / "a", tmp_path / "b")
    written = []
    for folder in folders:
        folder.mkdir()
        written.append([path.read_bytes() for path in results.write(described, folder)])
    assert written[0] == written[1]
