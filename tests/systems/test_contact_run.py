import logging
import sys
import tempfile
import zipfile
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from comparison import approx
from fmpy.fmi1 import FMICallException

from contact_core import ContactError, OperatingPoint, Scene, advance, initial_state
from contact_core.quantities import OF_CALLER
from fmu_src.flavours import Version
from fmu_src.package.build import build
from system_models.fmu.fmi2 import Fmi2Instance
from system_models.run.contact import communication_points, run
from system_models.run.duty import Duty

POINT = OperatingPoint(load=50.0, speed_1=0.1, speed_2=0.09, temperature=353.15)


def duty_at(*times: float) -> Duty:
    return Duty(times, (POINT,) * len(times))


def test_rows_come_at_intervals_at_changes_and_at_the_end() -> None:
    assert communication_points(duty_at(0.0, 30.0, 50.0), 100.0, 40.0) == [0.0, 30.0, 40.0, 50.0, 80.0, 100.0]
    near = duty_at(0.0, 1e-17, 30.0, 30.000000000000004, 99.99999999999999)
    assert communication_points(near, 100.0, 1e9) == [0.0, 30.0, 100.0]


def test_the_last_step_is_shortened_to_the_duration() -> None:
    assert communication_points(duty_at(0.0), 70.0, 30.0) == [0.0, 30.0, 60.0, 70.0]


def test_an_interval_above_the_duration_gives_one_step() -> None:
    assert communication_points(duty_at(0.0), 70.0, 1e3) == [0.0, 70.0]


def test_changes_after_the_end_are_left_out() -> None:
    assert communication_points(duty_at(0.0, 70.0, 80.0), 70.0, 35.0) == [0.0, 35.0, 70.0]


def test_a_multiple_of_the_interval_that_misses_a_change_by_rounding_makes_no_step_of_its_own() -> None:
    assert 3 * 0.1 != 0.3
    assert communication_points(duty_at(0.0, 0.3), 0.5, 0.1) == [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]


@pytest.mark.parametrize(("duration", "interval"), [(0.0, 1.0), (10.0, 0.0), (float("nan"), 1.0), (1e4, 1e-6)])
def test_a_duration_that_cannot_be_cut_is_refused(duration: float, interval: float) -> None:
    with pytest.raises(ContactError, match="cannot be cut into intervals"):
        communication_points(duty_at(0.0), duration, interval)


def test_the_first_row_is_the_contact_after_initialisation(dataset: xr.Dataset) -> None:
    first = dataset.isel(time=0)
    assert first["time"] == 0.0
    assert first["load_cycles_1"] == first["wear_depth_1"] == first["tribofilm_1"] == 0.0
    assert first["friction_coefficient"] > 0.0
    assert first["h_c"] > 0.0


def test_the_duty_reaches_the_contact(dataset: xr.Dataset) -> None:
    assert dataset["time"].values.tolist() == [0.0, 30.0, 40.0, 60.0, 72.0]
    assert dataset["load"].values.tolist() == [53.7, 53.7, 53.7, 30.0, 30.0]
    assert dataset["temperature_1"].values.tolist() == [353.15] * 3 + [355.15] * 2


def test_radii_that_a_duty_leaves_open_are_the_scenes(dataset: xr.Dataset, scene: Scene) -> None:
    for name in ("radius_x", "radius_y"):
        assert dataset[name].values.tolist() == [getattr(scene.geometry, name)] * 5


def test_friction_coefficient_is_force_over_the_load_of_the_same_row(dataset: xr.Dataset) -> None:
    force, load = dataset["friction_force"].values, dataset["load"].values
    np.testing.assert_allclose(dataset["friction_coefficient"].values, abs(force) / load, rtol=1e-14)


def test_the_run_equals_the_core_bit_for_bit(dataset: xr.Dataset, scene: Scene, duty: Duty) -> None:
    state, out = advance(scene, duty.at(0.0), initial_state(scene), 0.0)
    rows = [out]
    for time, end in pairwise(dataset["time"].values):
        state, out = advance(scene, duty.at(time), state, end - time)
        rows.append(out)
    for name in ("friction_force", "h_c", "tribofilm_2", "wear_volume_1", "range_flags", "blocks_mixed"):
        assert dataset[name].values.tolist() == [getattr(row, name) for row in rows], name


def test_a_contact_of_fmi_3_runs_to_the_same_rows(
    dataset: xr.Dataset, scene: Scene, duty: Duty, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)
    fmu = build(scene, tmp_path / "contact.fmu", "isolated", fmi=3)
    found = run(fmu, duty, scene.operation.duration, scene.operation.interval)
    for name in set(dataset) - OF_CALLER:
        assert found[name].identical(dataset[name]), name


@pytest.mark.long
@pytest.mark.usefixtures("unoptimised")
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_native_contact_runs_as_the_core_does(fine: Scene, duty: Duty, tmp_path: Path, fmi: Version) -> None:
    """Its rounding is its own, which differences of the film's formulas magnify in the derivatives."""
    quick = fine.at_level("regression")
    fmus = build(quick, tmp_path / "native.fmu", "native", fmi=fmi), build(quick, tmp_path / "python.fmu", "embedded")
    found, expected = (run(fmu, duty, quick.operation.duration, quick.operation.interval) for fmu in fmus)
    for name in set(expected) - OF_CALLER:
        assert found[name].values == approx(
            expected[name].values, rel=1e-6 if name.startswith("dfriction") else 1e-11
        ), name
        assert found[name].attrs["units"] == expected[name].attrs["units"]
        text = found[name].attrs["long_name"].replace(" (built in: no other value can be set)", "")
        assert text == expected[name].attrs["long_name"]


def test_progress_tells_the_time_of_every_step(fmu: Path) -> None:
    told: list[float] = []
    run(fmu, Duty.from_steps(POINT), 2.0, 1.0, told.append)
    assert told == [1.0, 2.0]


def test_an_invalid_step_is_recorded_and_warned_about(fmu: Path, caplog: pytest.LogCaptureFixture) -> None:
    impossible = OperatingPoint(load=-1.0, speed_1=0.1, speed_2=0.09, temperature=353.15)
    dataset = run(fmu, Duty((0.0, 2.0, 3.0), (POINT, impossible, POINT)), 4.0, 1.0)
    assert dataset["valid"].values.tolist() == [True, True, True, False, True]
    assert dataset["load"].values.tolist() == [50.0, 50.0, 50.0, -1.0, 50.0]
    held = dataset["friction_force"].values
    assert held[3] == held[2] != 0.0
    warnings = [record.getMessage() for record in caplog.records if record.levelno == logging.WARNING]
    assert "load = -1 N" in warnings[0]
    assert warnings[-1].startswith("1 of 5 rows are invalid, the first at 3 s")


def test_an_fmu_that_fails_is_freed_and_the_time_is_told(fmu: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    freed: list[bool] = []
    free = Fmi2Instance.free

    def fail(self: Fmi2Instance, time: float, step: float) -> float:
        raise FMICallException(function="fmi2DoStep", status=3)

    def note(self: Fmi2Instance) -> None:
        freed.append(True)
        free(self)

    monkeypatch.setattr(Fmi2Instance, "_do_step", fail)
    monkeypatch.setattr(Fmi2Instance, "free", note)
    with pytest.raises(ContactError, match=r"failed in the step from 0 s to 1 s: fmi2DoStep failed with status 3"):
        run(fmu, Duty.from_steps(POINT), 2.0, 1.0)
    assert freed == [True]


def test_an_fmu_that_is_no_contact_is_refused(fmu: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.fmu"
    with zipfile.ZipFile(fmu) as old, zipfile.ZipFile(other, "w") as new:
        for name in old.namelist():
            new.writestr(name, old.read(name).replace(b'name="load"', b'name="weight"'))
    with pytest.raises(ContactError, match=r"has no load\. Use one that `tribofmu build` has made"):
        run(other, Duty.from_steps(POINT), 2.0, 1.0)


def test_a_temporary_folder_that_the_binary_cannot_read_is_refused(
    fmu: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "a#b"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    with pytest.raises(ContactError, match=r"cannot be loaded from .*a#b.* Set TMPDIR"):
        run(fmu, Duty.from_steps(POINT), 2.0, 1.0)
