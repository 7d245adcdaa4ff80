"""A gear pair as a machine: what its contacts say adds up, flanks wear where they slide, duties and reports."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from comparison import approx
from numpy.typing import NDArray

from contact_core.errors import SceneError
from system_models.charts import files
from system_models.machines import reading
from system_models.machines.assembly import Assembly
from system_models.machines.gear_pair import pictures as gear_pair_pictures
from system_models.machines.gear_pair import report as gear_pair_report
from system_models.machines.gear_pair.mesh import GearMesh
from system_models.machines.gear_pair.rating import Rating
from system_models.machines.gear_pair.record import Record
from system_models.machines.gear_pair.safety import Safeties
from system_models.machines.gear_pair.textbook import ohlendorf
from system_models.master import simulate

STATIONS = 6
SMALL = {"simulate.max_step": '"20 s"', "gearbox.thermostats": "[]"}
CONSTANT = {"speed": "2250 rpm", "torque": "135.3 N m", "ambient": "25 degC"}
STAGES = {**CONSTANT, "duration": "4 min", "steps": [{"time": "2 min", "torque": "239.25 N m"}]}
Array = NDArray[np.float64]


def assembled(duty: dict[str, Any], folder: Path = Path(), stations: int = STATIONS) -> Assembly:
    machine = reading.read("gear_fzg_c", SMALL | {"mesh.stations": f"{stations}"})._replace(folder=folder)
    machine.table["duty"] = duty
    return reading.assemble(machine)


def run(assembly: Assembly, folder: Path) -> xr.Dataset:
    return simulate(assembly.system(folder), **assembly.settings, outputs=assembly.outputs())


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Record:
    assembly = assembled(STAGES)
    return Record(assembly, run(assembly, tmp_path_factory.mktemp("fmus")))


def worn(record: Record, body: int) -> Array:
    return record.along(f"wear_depth_{body}")[-1]


@pytest.mark.long
def test_all_contacts_and_components_use_their_inputs_in_every_row(record: Record) -> None:
    names = [*record.assembly.parts, *record.assembly.contacts]
    assert len(record.assembly.contacts) == STATIONS
    assert all(record.of(f"{name}.valid").all() for name in names)


def test_the_mean_friction_is_the_power_that_the_contacts_rub_away(record: Record) -> None:
    sliding = record.along("speed_1")[-1] - record.along("speed_2")[-1]
    rubbed = (record.weights * np.abs(record.along("friction_force")[-1] * sliding)).sum()
    power = record.of("shafts.mesh_torque")[-1] * record.of("shafts.speed_1")[-1]
    assert record.friction[-1] == approx(rubbed / power / ohlendorf(record.pair), rel=1e-4)


def test_the_loads_of_the_stations_carry_the_force_between_the_gears(record: Record) -> None:
    carried = (record.weights * record.along("load")[-1]).sum()
    force = record.of("shafts.mesh_torque")[-1] / record.pair.base_radius_1
    assert carried == approx(force, rel=5e-3)  # the midpoint rule of six stations


def test_all_lost_power_heats_the_gears_and_the_oil(record: Record) -> None:
    flows = [record.of(f"mesh.{name}") for name in ("heat_flow_1", "heat_flow_2", "power_rolling")]
    lost = record.of("mesh.power_loss")
    assert lost[-1] > 50.0
    np.testing.assert_allclose(sum(flows), lost, rtol=1e-6, atol=1e-6)


def test_the_energy_that_is_lost_is_in_the_gearbox_or_gone(record: Record) -> None:
    nodes = record.assembly.parts["gearbox"].nodes  # type: ignore[attr-defined]
    stored = sum(
        node.heat_capacity * (record.of(f"gearbox.temperature_{node.name}")[-1] - node.temperature) for node in nodes
    )
    found = stored + record.of("gearbox.energy_to_ambient")[-1]
    assert found == approx(np.trapezoid(record.of("mesh.power_loss"), record.time), rel=0.02)


def test_solids_carry_most_by_the_pitch_point_where_one_pair_carries_all_and_flanks_roll(record: Record) -> None:
    """So does the deterministic level: docs/measured/machines.md, its stations."""
    near = np.abs(record.positions - record.pair.pitch_point).argmin()
    for stage in record.stages:
        assert abs(record.along("contact_load_ratio")[stage.last].argmax() - near) <= 1


@pytest.mark.parametrize("body", [1, 2])
def test_flanks_wear_by_the_work_of_their_solids_spread_over_the_face_that_passes(record: Record, body: int) -> None:
    speeds = record.along("speed_1"), record.along("speed_2")
    rubbed = record.along("contact_load_ratio") * record.along("load") * np.abs(speeds[0] - speeds[1])
    volume = record.along(f"wear_volume_{body}")[-1]
    coefficient = volume / np.trapezoid(rubbed, record.time, axis=0)
    assert 1.0 < coefficient.max() / coefficient.min() < 1.5  # tribofilms halve it at most
    radius = record.positions if body == 1 else record.pair.line_length - record.positions
    np.testing.assert_allclose(worn(record, body) * 2.0 * np.pi * radius * record.pair.face_width, volume, rtol=1e-6)


def test_each_gear_wears_most_beside_the_other_at_its_root(record: Record) -> None:
    """Where its flank slides further on the other's; how much wears at all is decided by the film there."""
    first = worn(record, 1) / worn(record, 2)
    assert first.argmax() == 0
    assert first.argmin() == STATIONS - 1


def test_each_place_of_the_flanks_has_its_own_film_and_tribofilm(record: Record) -> None:
    for quantity in ("h_c", "tribofilm_1", "tribofilm_2"):
        values = np.sort(record.along(quantity)[-1])
        assert values[0] > 0.0
        assert (np.diff(values) / values[:-1]).min() > 1e-6, quantity


def test_stages_are_the_stretches_of_the_duty(record: Record) -> None:
    assert [(stage.start, stage.end) for stage in record.stages] == [(0.0, 120.0), (120.0, 240.0)]
    assert [stage.torque for stage in record.stages] == approx([135.3, 239.25])
    reached = [record.of("shafts.mesh_torque")[stage.last] for stage in record.stages]
    assert reached == approx([135.3, 239.25], rel=0.01)


def test_pressures_at_the_pitch_point_are_those_of_the_load_stages(record: Record) -> None:
    """As tabulated for type C: 1108 MPa at 135.3 N m, 1474 MPa at 239.25 N m."""
    found = [1e-6 * record.pressure_at_pitch_point(torque) for torque in (135.3, 239.25)]
    assert found == approx([1108.0, 1474.0], rel=1e-3)


def test_the_report_has_a_row_for_each_stage_and_four_pictures(record: Record, tmp_path: Path, drawn: bool) -> None:
    lines = gear_pair_report.lines(record.assembly, record.dataset)
    table = lines[2 : lines.index("")]
    assert [line.split()[0] for line in table] == ["6", "8"]  # load stages with these torques
    written = files.write(gear_pair_pictures.sheets(record.assembly, record.dataset), tmp_path)
    assert [path.name for path in written] == ["overview.png", "path.png", "time.png", "safety.png"]
    assert all(path.stat().st_size > (20_000 if drawn else 0) for path in written)


def test_the_run_and_the_standard_have_safety_factors_of_their_own(record: Record) -> None:
    """By the run: film over Ra of the flanks as they are, and the hottest contact."""
    found, row = Safeties(record), record.stages[-1].last
    ra = np.sqrt(2.0 / np.pi) * 0.5 * (record.along("roughness_1")[row] + record.along("roughness_2")[row])
    pits = found.micropitting(row)
    assert pits.own == approx((record.along("h_c")[row] / ra).min())
    assert pits.own_safety == approx(pits.own / (1.4 * found.own_failing))
    assert pits.safety == approx(found.films(row).ratio.min() / (1.4 * found.failing))
    scuffs = found.scuffing(row)
    assert scuffs.own == approx(max(record.of(f"mesh.contact_temperature[{k}]")[row] for k in range(1, 1 + STATIONS)))
    oil = record.of("gearbox.temperature_oil")[row]
    assert scuffs.own_safety == approx((scuffs.flash.limit - oil) / (scuffs.own - oil))
    assert found.classes() is None  # 135.3 N m is no load stage of the micropitting test


def test_oils_that_fail_the_micropitting_test_late_bear_thinner_films_by_both(record: Record) -> None:
    limits = []
    for stage in (6, 8, 10):
        oil = replace(record.assembly, reported={"rating": Rating(micropitting_stage=stage)})
        found = Safeties(Record(oil, record.dataset))
        limits.append((found.failing, found.own_failing))
    assert limits == sorted(limits, reverse=True)
    assert all(0.02 < standard < own < 3.0 for standard, own in limits)


def test_the_report_says_what_is_assumed_where_the_file_has_no_rating(record: Record) -> None:
    said = "\n".join(gear_pair_report.lines(record.assembly, record.dataset))
    assert "load stage 8 of FVA 54/7" in said
    assert "ASSUMED" not in said
    bare = replace(record.assembly, reported={})
    said = "\n".join(gear_pair_report.lines(bare, record.dataset))
    assert "ASSUMED, as the file has no table [rating]: micropitting_stage = 8, scuffing_stage = 10" in said


@pytest.mark.long
def test_the_report_gives_a_run_of_the_micropitting_test_its_class(tmp_path: Path) -> None:
    duty = {**CONSTANT, "torque": "28.79 N m", "duration": "40 s", "steps": [{"time": "20 s", "torque": "265 N m"}]}
    assembly = assembled(duty, stations=4)
    said = "\n".join(gear_pair_report.lines(assembly, run(assembly, tmp_path)))
    assert "Class of FVA 54/7 with these flanks: high by the standard" in said  # Ra of 0.32 um, not 0.5


@pytest.mark.long
def test_starts_and_stops_wear_the_flanks_anew_each_time(tmp_path: Path) -> None:
    duty = {**CONSTANT, "start_stop": {"signals": ["speed"], "run": "10 s", "standstill": "10 s"}, "repeat": 2}
    assembly = assembled(duty, stations=4)
    record = Record(assembly, run(assembly, tmp_path))
    assert len(record.stages) == 2
    depths = [record.along("wear_depth_1")[stage.last].max() for stage in record.stages]
    assert 0.0 < depths[0] < depths[1]
    assert np.isnan(record.friction[-1])  # standing still
    assert record.of("mesh.power_loss")[-1] == approx(0.0, abs=1.0)
    assert len(gear_pair_report.lines(record.assembly, record.dataset)) > 5
    assert len(gear_pair_pictures.sheets(record.assembly, record.dataset)["time"].charts) == 8


@pytest.mark.long
def test_a_duty_from_a_table_is_followed(tmp_path: Path) -> None:
    (tmp_path / "cycle.csv").write_text(
        "time [s],speed [rpm],torque [N m]\n0,1000,50\n20,2000,100\n40,1500,0\n60,1500,0\n"
    )
    assembly = assembled({"file": "cycle.csv", "ambient": "25 degC"}, tmp_path, 4)
    record = Record(assembly, run(assembly, tmp_path))
    reached = [
        (30.0 / np.pi * record.of("shafts.speed_1")[s.last], record.of("shafts.mesh_torque")[s.last])
        for s in record.stages
    ]
    assert reached == [approx((1000.0, 50.0), rel=0.02), approx((2000.0, 100.0), rel=0.02)]


def test_a_duty_without_load_is_told_so(tmp_path: Path) -> None:
    assembly = assembled({**CONSTANT, "torque": "0 N m", "duration": "10 s"}, stations=4)
    dataset = run(assembly, tmp_path)
    assert "no stretch" in gear_pair_report.lines(assembly, dataset)[0]
    assert len(files.figure(gear_pair_pictures.sheets(assembly, dataset)["overview"]).axes) == 8


@pytest.mark.parametrize(("name", "count", "last"), [("gear_fzg_a", 12, 534.5), ("gear_fzg_c", 7, 265.0)])
def test_shipped_gears_run_the_load_stages_of_their_tests(name: str, count: int, last: float) -> None:
    assembly = reading.assemble(reading.read(name))
    mesh = assembly.parts["mesh"]
    assert isinstance(mesh, GearMesh)
    torques = [torque / mesh.pair.ratio for _, torque in assembly.schedule["brake.torque_setpoint"] if torque]
    assert len(torques) == count
    assert torques[-1] == approx(last)
    assert len(assembly.contacts) == 21


def test_gears_start_at_the_speed_of_the_duty_and_not_so_far_from_it_that_teeth_break() -> None:
    slow = assembled(CONSTANT | {"duration": "1 min", "speed": "900 rpm"})
    assert slow.parts["shafts"].start_speed == approx(30.0 * np.pi)
    machine = reading.read("gear_fzg_c", {"shafts.start_speed": "10 rad/s"})
    with pytest.raises(SceneError, match=r"start_speed = 10 rad/s, but the duty begins at 235.619 rad/s: .* Leave"):
        reading.assemble(machine)
    near = reading.read("gear_fzg_c", {"shafts.start_speed": "2251 rpm"})
    assert reading.assemble(near).parts["shafts"].start_speed == approx(2251.0 / 30.0 * np.pi)
