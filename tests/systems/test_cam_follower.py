"""A cam and its follower as a machine: contacts, energy, report and pictures."""

from typing import Any

import numpy as np
import pytest
from comparison import approx

from system_models.charts import files
from system_models.machines import reading
from system_models.machines.cam_follower import pictures, report
from system_models.machines.cam_follower.record import Record
from system_models.master import simulate

STATIONS = 5
SMALL = {"cam.stations": f"{STATIONS}", "duty.duration": '"60 s"', "simulate.max_step": '"5 s"'}


def assembled(**changes: str) -> Any:
    return reading.assemble(reading.read("cam_follower", SMALL | changes))


def at(speed: str) -> dict[str, str]:
    return {"duty.speed": f'"{speed}"', "shaft.initial_speed": f'"{speed}"', "duty.duration": '"0.05 s"'}


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Record:
    assembly = assembled()
    folder = tmp_path_factory.mktemp("cam")
    return Record(assembly, simulate(assembly.system(folder), **assembly.settings, outputs=assembly.outputs()))


def test_all_contacts_use_their_inputs_in_every_row(record: Record) -> None:
    assert record.names == [*(f"angle_{k:02d}" for k in range(1, STATIONS + 1)), "base_circle"]
    assert all(record.of(f"{name}.valid").all() for name in (*record.names, "cam"))


def test_contacts_get_load_speeds_and_radius_of_their_stations(record: Record) -> None:
    speed = record.of("shaft.speed")[-1]
    for k, station in enumerate(record.cam.contacts):
        assert record.along("radius_x")[-1, k] == approx(station.radius_x)
        assert record.along("speed_1")[-1, k] == approx(speed * station.radius_x, rel=1e-4)
        assert record.along("speed_2")[-1, k] == approx(speed * station.lift_second, rel=1e-4)
    assert record.along("load")[-1, -1] == approx(800.0)


def test_what_the_drive_gives_is_what_the_contacts_lose(record: Record) -> None:
    sliding = record.along("speed_1")[-1] - record.along("speed_2")[-1]
    rolling = record.along("speed_1")[-1] + record.along("speed_2")[-1]
    lost = -record.along("friction_force")[-1] * sliding + record.along("rolling_resistance")[-1] * rolling
    assert record.of("cam.power_loss")[-1] == approx((record.weights * lost).sum(), rel=1e-3)
    assert record.of("drive.power")[-1] == approx(record.of("cam.power_loss")[-1], rel=0.02)


def test_solids_bear_least_where_the_entrainment_is_largest(record: Record) -> None:
    entrainment = np.abs(record.along("speed_1")[-1] + record.along("speed_2")[-1])
    share = record.along("contact_load_ratio")[-1]
    assert share[entrainment.argmax()] == share.min()
    assert share.min() < share.max()


def test_the_energy_is_closed(record: Record) -> None:
    found = record.energies()
    left = found["friction"] + found["thermostats"] - found["stored"] - found["to the surroundings"]
    assert abs(left) < 0.03 * found["friction"]


@pytest.mark.usefixtures("drawn")
def test_the_report_has_a_row_for_each_station_and_pictures(record: Record, tmp_path: Any) -> None:
    lines = report.lines(record.assembly, record.dataset)
    assert sum(line.split()[:1] == ["base"] for line in lines) == 1
    assert len([line for line in lines if line and line.split()[0].lstrip("-").replace(".", "").isdigit()]) == STATIONS
    assert not any("LEAVE" in line for line in lines)
    written = files.write(pictures.sheets(record.assembly, record.dataset), tmp_path)
    assert [path.name for path in written] == ["overview.png", "time.png"]


def test_a_cam_that_is_too_fast_is_warned_about(tmp_path: Any) -> None:
    assembly = assembled(**at("5500 rpm"), **{"cam.mass": '"1 kg"'})
    found = simulate(assembly.system(tmp_path), **assembly.settings, outputs=assembly.outputs())
    assert any("LEAVE the cam" in line for line in report.lines(assembly, found))


def test_a_standing_cam_loses_nothing(tmp_path: Any) -> None:
    assembly = assembled(**at("0 rpm"))
    found = simulate(assembly.system(tmp_path), **assembly.settings, outputs=assembly.outputs())
    record = Record(assembly, found)
    assert np.abs(record.of("cam.power_loss")).max() == 0.0
    assert report.lines(assembly, found)
