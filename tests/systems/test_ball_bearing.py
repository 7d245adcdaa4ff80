"""The ball bearing as a machine: closed loop with its heat, memory from start to start, and what its report shows."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from comparison import approx
from matplotlib.image import imread

from contact_core.errors import SceneError
from contact_core.reference import nijenbanning_venner_moes
from system_models.charts import files
from system_models.machines import reading, timeline
from system_models.machines.assembly import Assembly
from system_models.machines.ball_bearing import pictures as ball_bearing_pictures
from system_models.machines.ball_bearing import report as ball_bearing_report
from system_models.machines.ball_bearing.geometry import BEARING_209, BEARING_218, RaceName
from system_models.machines.ball_bearing.lives import RatedRun
from system_models.machines.ball_bearing.record import BearingRun
from system_models.machines.ball_bearing.textbook import CATALOGUE_209, CATALOGUE_218, catalogue_of
from system_models.master import simulate

Result = tuple[Assembly, xr.Dataset]
LIGHTER = 1 / 60  # heat capacities that many times smaller: minutes become seconds
MEMORYLESS = {"contact.tribofilm.model": "none", "contact.wear.bare": "0", "contact.wear.film": "0"}
COARSE = {"simulate.tolerance": "2e-2", "simulate.order": "0"}  # no speed is carried on to below 0 by long steps
CYCLE = "time [s],speed [rpm],load [N]\n0,0,800\n1,40,2000\n2,20,3000\n3,0,800\n4,0,800\n5,60,1500\n6,60,1500\n"


def run(folder: Path, machine: reading.Machine) -> Result:
    assembly = reading.assemble(machine)
    return assembly, simulate(assembly.system(folder), **assembly.settings, outputs=assembly.outputs())


def lighter(machine: reading.Machine) -> reading.Machine:
    for node in machine.table["housing"]["nodes"]:
        number, unit = node["heat_capacity"].split(" ", 1)
        node["heat_capacity"] = f"{LIGHTER * float(number)} {unit}"
    return machine


@pytest.fixture(scope="module")
def warm(tmp_path_factory: pytest.TempPathFactory) -> Result:
    changes = {"bearing.levels": "2", "duty.duration": "3 min", "simulate.max_step": "12 s"} | COARSE
    return run(tmp_path_factory.mktemp("warm"), lighter(reading.read("bearing_209", changes)))


def starting(folder: Path, changes: dict[str, str]) -> BearingRun:
    few = {"bearing.levels": "1", "duty.repeat": "3", "duty.speed": "40 rpm", "simulate.max_step": "2 s"} | COARSE
    return BearingRun(*run(folder, reading.read("bearing_209_start_stop", few | changes)))


@pytest.fixture(scope="module")
def starts(tmp_path_factory: pytest.TempPathFactory) -> BearingRun:
    return starting(tmp_path_factory.mktemp("starts"), {})


def test_a_cold_start_ends_where_heat_in_is_heat_out(warm: Result) -> None:
    _, dataset = warm
    last = dataset.isel(time=-1)
    loss, left = float(last["bearing.power_loss"]), float(last["housing.heat_to_ambient"])
    assert loss > 10.0
    assert left == approx(loss, rel=1e-3)
    by_ring = 0.25 * (last["housing.temperature_inner"] - 293.15) + 0.75 * (last["housing.temperature_outer"] - 293.15)
    assert float(by_ring) == approx(loss, rel=1e-3)


def test_the_motor_gives_what_the_bearing_loses(warm: Result) -> None:
    last = warm[1].isel(time=-1)
    slip = float(last["shaft.torque_coupling"]) * float(last["drive.speed"] - last["shaft.speed"])
    assert float(last["drive.power"]) == approx(float(last["bearing.power_loss"]) + slip, rel=1e-3)


def test_warm_oil_makes_the_torque_less(warm: Result) -> None:
    run = BearingRun(*warm)
    torque = run.of("bearing.friction_torque")
    assert torque[run.last] < 0.5 * torque.max()


def test_energy_is_conserved_but_for_the_steps(warm: Result) -> None:
    run = BearingRun(*warm)
    kept = run.heat_stored + float(run.of("housing.energy_to_ambient")[-1])
    assert kept == approx(run.heat_in, rel=2e-2)


def test_all_rows_are_valid_and_all_steps_made(warm: Result) -> None:
    assembly, dataset = warm
    assert all(dataset[f"{name}.valid"].values.all() for name in (*assembly.parts, *assembly.contacts))
    assert dataset.attrs["unconverged"] == dataset.attrs["below_min_step"] == 0


def test_the_causes_of_the_torque_are_all_of_it(warm: Result) -> None:
    run = BearingRun(*warm)
    total = sum(part[run.last] for part in run.torque.values())
    assert total == approx(run.of("bearing.friction_torque")[run.last], rel=1e-3)


def test_the_torque_is_of_the_size_that_skf_and_palmgren_have(warm: Result) -> None:
    run = BearingRun(*warm)
    own = run.of("bearing.friction_torque")[run.last]
    for model in (run.skf, run.palmgren):
        assert 0.4 < own / sum(part[run.last] for part in model.values()) < 2.5


def test_balls_of_the_load_zone_carry_the_load(warm: Result) -> None:
    run = BearingRun(*warm)
    azimuth, load = run.balls("inner", run.last)
    assert load @ np.cos(azimuth) == approx(2000.0, rel=1e-6)
    assert (np.diff(azimuth) > 0.0).all()


def test_a_balls_way_around_passes_the_balls(warm: Result) -> None:
    run = BearingRun(*warm)
    way = run.passage("outer", run.last)
    azimuth, load = run.balls("outer", run.last)
    there = np.interp(azimuth, way.azimuth, way.load)
    assert there == approx(load, abs=1e-3 * load.max())


@pytest.mark.parametrize("race", ["inner", "outer"])
def test_the_film_at_a_balls_load_grows_as_the_formula_says_and_not_toward_that_of_idle_balls(
    warm: Result, race: RaceName
) -> None:
    run = BearingRun(*warm)
    heaviest = next(which for which in reversed(run.classes) if which.race == race)
    most, film = (float(values[run.last]) for values in (run.given(heaviest, "load"), run.solved(heaviest, "h_c")))
    speed, warmth = (float(run.solved(heaviest, name)[run.last]) for name in ("speed_1", "body_temperature_1"))
    scene = warm[0].contacts[heaviest.contact].scene
    loads = most * np.array([1.0, 0.6, 0.3, 0.1])

    def smooth(load: float) -> float:
        oil = scene.lubricant.viscosity, warmth
        contact = scene.shape().smooth(load, speed, *oil, scene.solids.reduced_modulus)
        return nijenbanning_venner_moes(contact) / float(scene.lubricant.density(scene.hertz(load).pressure_mean))

    found = run.at_load(race, "h_c", run.last, loads) / film
    assert found == approx([smooth(load) / smooth(most) for load in loads], rel=0.05)
    assert found[0] == approx(1.0, rel=1e-6)
    assert (np.diff(found) > 0.02).all()
    ratio = run.at_load(race, "lambda_ratio", run.last, loads) / float(run.solved(heaviest, "lambda_ratio")[run.last])
    assert ratio == approx(found, rel=0.1)


def test_balls_without_load_and_at_rest_have_no_film_to_show(warm: Result, starts: BearingRun) -> None:
    run, loads = BearingRun(*warm), np.array([1000.0, 1.0])
    assert np.isnan(run.at_load("outer", "h_c", run.last, loads)).tolist() == [False, True]
    assert np.isnan(starts.at_load("outer", "h_c", 0, loads)).all()


def test_every_start_is_found(starts: BearingRun) -> None:
    assert len(starts.starts) == 3
    for rows in starts.starts:
        assert not starts.runs[rows[0]]
        assert starts.speed[rows[-1]] > 0.98 * 40.0 * math.pi / 30.0


def test_a_shaft_that_is_reversed_starts_again(starts: BearingRun) -> None:
    there, rest = int(starts.starts[0][-1]), int(starts.starts[1][0])
    speed = starts.dataset["shaft.speed"].copy()
    speed[there + 1 : rest] *= -1.0
    reversed_ = BearingRun(starts.assembly, starts.dataset.assign({"shaft.speed": speed}))
    assert len(reversed_.starts) == 4
    assert all(np.ptp(np.sign(speed.values[rows[starts.runs[rows]]])) == 0.0 for rows in reversed_.starts)


def test_peaks_of_starts_are_sizes_while_the_shaft_turns(starts: BearingRun) -> None:
    names = ("shaft.speed", "bearing.friction_torque")
    backward = BearingRun(starts.assembly, starts.dataset.assign({name: -starts.dataset[name] for name in names}))
    assert (starts.start_peaks > 0.0).all()
    assert backward.start_peaks == approx(starts.start_peaks)
    torque = starts.dataset["bearing.friction_torque"]
    stuck = starts.dataset.assign({torque.name: torque.where(starts.runs, 1e3)})
    assert BearingRun(starts.assembly, stuck).start_peaks == approx(starts.start_peaks)


def test_the_report_compares_starts_from_the_second_on(starts: BearingRun) -> None:
    said = "\n".join(ball_bearing_report.lines(starts.assembly, starts.dataset))
    second, last = 1e3 * starts.start_peaks[[1, -1]]
    assert (
        f"3 starts: largest friction torque while the shaft turns {second:.3g} N mm in the second, {last:.3g}" in said
    )


def test_the_table_tells_nothing_of_classes_without_balls_or_load(warm: Result) -> None:
    assembly, dataset = warm
    empty = {"bearing.count_inner[1]": 0.0, "bearing.load_outer[1]": 0.1}
    changed = dataset.assign({name: xr.full_like(dataset[name], value) for name, value in empty.items()})
    rows = {line.split()[0]: line.split() for line in ball_bearing_report.lines(assembly, changed) if "er_" in line}
    assert list(rows) == ["inner_2", "outer_1", "outer_2"]
    assert rows["outer_1"][3:8] == 5 * ["-"]
    assert "-" not in rows["outer_2"]


def test_the_next_start_has_the_film_and_wear_that_the_last_has_left(starts: BearingRun) -> None:
    film = np.array([starts.solved(starts.classes[0], "tribofilm_1")[rows[0]] for rows in starts.starts])
    wear = np.array([starts.solved(starts.classes[1], "wear_depth_2")[rows[0]] for rows in starts.starts])
    assert (np.diff(film) > 1e-9).all()
    assert (np.diff(wear) > 0.0).all()


@pytest.mark.long
def test_the_next_start_feels_what_the_last_has_left_more_than_the_steps(starts: BearingRun, tmp_path: Path) -> None:
    forgetful = starting(tmp_path / "none", MEMORYLESS)
    finer = starting(tmp_path / "fine", {"simulate.max_step": "1 s"})
    remembered, forgotten, fine = (each.of("bearing.friction_torque")[each.last] for each in (starts, forgetful, finer))
    assert abs(remembered - forgotten) > 10.0 * abs(remembered - fine)
    assert abs(remembered / forgotten - 1.0) > 1e-3  # oil carries most of the load of lapped bodies


@pytest.mark.parametrize("duty", ["cycle", "standstill"])
def test_the_report_takes_any_duty(duty: str, tmp_path: Path, drawn: bool) -> None:
    machine = reading.read("bearing_209", {"bearing.levels": "1"} | COARSE)
    if duty == "cycle":
        (tmp_path / "cycle.csv").write_text(CYCLE)
        machine.table["duty"] = timeline.with_file(machine.table["duty"], tmp_path / "cycle.csv")
    else:
        machine.table["duty"] = {"speed": "0 rpm", "load": "2 kN", "duration": "2 s"}
    assembly, dataset = run(tmp_path / "fmus", machine)
    said = "\n".join(ball_bearing_report.lines(assembly, dataset))
    assert "inner_1" in said
    assert ("2 starts" in said) == (duty == "cycle")
    assert ("does not turn" in said) == (duty == "standstill")
    paths = files.write(ball_bearing_pictures.sheets(assembly, dataset), tmp_path)
    assert [path.name for path in paths] == ["overview.png", "load_zone.png", "surfaces.png"]
    for path in paths if drawn and duty == "cycle" else ():
        picture: Any = imread(path)
        assert picture[..., :3].std() > 0.02


def test_the_report_says_that_the_heat_is_closed(warm: Result) -> None:
    said = "\n".join(ball_bearing_report.lines(*warm))
    assert "by SKF (rolling" in said
    assert "by Palmgren (by oil" in said
    assert "Cage: 120" in said


@pytest.mark.parametrize(("geometry", "known"), [(BEARING_209, CATALOGUE_209), (BEARING_218, CATALOGUE_218)])
def test_what_a_catalogue_would_have_is_near_it(geometry: Any, known: Any) -> None:
    found = catalogue_of(geometry)
    assert found.series == known.series
    assert found.bore == approx(known.bore, rel=5e-3)
    assert found.outside == approx(known.outside, rel=5e-3)
    assert found.static_rating == approx(known.static_rating, rel=0.2)


def test_the_tracks_are_those_at_the_row_of_the_duty_with_the_largest_force_and_at_its_moment() -> None:
    """That row is mostly axial: its radial load is less than that of the others."""
    heaviest = {"load": "0.5 kN", "axial_load": "3 kN", "moment": "20 N m"}
    lighter_row = {"load": "2 kN", "axial_load": "0.1 kN", "moment": "0 N m"}

    def contacts(*rows: dict[str, str]) -> list[tuple[str, dict[str, Any]]]:
        machine = reading.read("bearing_209", {"bearing.levels": "2"})
        steps = [{"time": f"{k} min"} | row for k, row in enumerate(rows[1:], 1)]
        machine.table["duty"] = {"duration": "9 min", "speed": "1500 rpm", "steps": steps} | rows[0]
        return [(name, dict(contact.parameters)) for name, contact in reading.assemble(machine).contacts.items()]

    alone = contacts(heaviest)
    assert contacts(lighter_row, heaviest, lighter_row) == contacts(heaviest, lighter_row) == alone
    for other in (lighter_row, heaviest | {"moment": "0 N m"}, heaviest | {"axial_load": "0 kN"}):
        assert contacts(other) != alone


def test_a_constant_load_and_speed_give_the_life_of_iso_281(warm: Result) -> None:
    rated = RatedRun(BearingRun(*warm))
    row, c = rated.run.last, rated.dynamic_rating
    hours = 1e6 * (c / 2000.0) ** 3 / (rated.run.speed[row] * 60.0 * 30.0 / math.pi)
    assert rated.hours(rated.basic, row) == approx(hours, rel=1e-12)
    # of 3 min the shaft stands for 1 s and gets to 3000 rpm in another 3 s
    assert hours < rated.hours_of_duty(rated.basic) < 1.03 * hours
    assert rated.consumed(rated.basic) == approx(180.0 / 3600.0 / rated.hours_of_duty(rated.basic), rel=1e-12)


def test_at_double_the_speed_the_hours_are_half(warm: Result) -> None:
    assembly, dataset = warm
    faster = dataset.copy()
    faster["shaft.speed"] = 2.0 * dataset["shaft.speed"]
    one, two = RatedRun(BearingRun(assembly, dataset)), RatedRun(BearingRun(assembly, faster))
    assert two.hours(two.reference, -1) == approx(0.5 * one.hours(one.reference, -1), rel=1e-12)
    assert two.hours_of_duty(two.reference) == approx(0.5 * one.hours_of_duty(one.reference), rel=1e-12)


def test_lives_by_load_distribution_friction_and_film_are_ordered(warm: Result) -> None:
    rated = RatedRun(BearingRun(*warm))
    row = rated.run.last
    assert rated.reference[row] < rated.basic[row]  # clearance: fewer balls carry
    assert 0.9 * rated.reference[row] < rated.stressed[row] < rated.reference[row]  # friction
    for kappa in (rated.kappa_of_viscosity, rated.kappa_of_film):
        assert rated.modified(kappa)[row] == approx(rated.life_factor(kappa)[row] * rated.reference[row])
    assert np.nanmax(rated.kappa_of_viscosity) > 1.5 * rated.kappa_of_viscosity[row]  # cold oil


def test_rows_without_load_take_no_life(warm: Result) -> None:
    assembly, dataset = warm
    idle = dataset.copy(deep=True)
    for name in [str(name) for name in idle.data_vars if "load_ball" in str(name)]:
        idle[name].values[: idle.sizes["time"] // 2] = 0.0
    one, two = RatedRun(BearingRun(assembly, dataset)), RatedRun(BearingRun(assembly, idle))
    for kappa in (one.kappa_of_viscosity, one.kappa_of_film):
        assert 0.0 < two.consumed(two.modified(kappa)) < one.consumed(one.modified(kappa))


def test_a_catalogue_rating_and_dirt_change_the_reported_life(warm: Result) -> None:
    _, dataset = warm
    changes = {"bearing.levels": "2", "rating.dynamic_rating": "35.1 kN", "rating.contamination": "0"}
    assembly = reading.assemble(reading.read("bearing_209", changes))
    rated, own = RatedRun(BearingRun(assembly, dataset)), RatedRun(BearingRun(*warm))
    assert rated.basic[-1] / own.basic[-1] == approx((35.1e3 / own.dynamic_rating) ** 3, rel=1e-9)
    assert rated.modified(rated.kappa_of_viscosity)[-1] == approx(0.1 * rated.reference[-1], rel=1e-9)
    text = "\n".join(ball_bearing_report.lines(assembly, dataset))
    assert "C_r = 35.1 kN of the file (by ISO 281 32.7 kN)" in text


def test_the_report_has_the_lives_of_both_standards(warm: Result) -> None:
    text = "\n".join(ball_bearing_report.lines(*warm))
    for name in ("L10 of ISO 281", "L10r of ISO 16281", "kappa by viscosity", "kappa = lambda^1.3", "stress integral"):
        assert name in text


def test_a_contamination_factor_above_one_is_refused_with_its_range() -> None:
    with pytest.raises(SceneError, match=r"rating\.contamination = 1\.5 .* at least 0 and at most 1"):
        reading.assemble(reading.read("bearing_209", {"rating.contamination": "1.5"}))
