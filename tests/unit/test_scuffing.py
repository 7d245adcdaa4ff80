"""Risk of scuffing at both levels: the hottest spot, its ratio and its flag."""

import math
from dataclasses import asdict, replace

import numpy as np
import pytest
from comparison import approx

from contact_core import RangeFlag, Scene, SceneError, advance, initial_state, run_cycle, solve
from contact_core.deterministic.observed import observed
from contact_core.laws.scuffing import CriticalTemperature, NoScuffing
from contact_core.laws.temperatures import Temperatures
from contact_core.scene import Case, tunables

COARSE = {
    "film.points": "33",
    "film.floor": "10 nm",
    "surface_1.correlation_length": "50 um",
    "surface_2.correlation_length": "50 um",
    "heat.model": "field",
}
SLIDING = {"operation.speed_1": "2 m/s", "operation.speed_2": "0.5 m/s"}
LEVELS = ("regression", "deterministic")


def scene_of(level: str, **changes: str) -> Scene:
    return Scene.from_toml("mtm_zddp", COARSE | SLIDING | changes).at_level(level)


def told(scene: Scene):
    return advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]


def judged(scene: Scene, critical: float) -> Scene:
    return replace(scene, scuffing=CriticalTemperature(critical))


def test_the_ratio_is_one_at_the_critical_temperature_and_above_it_for_the_next_number():
    law = CriticalTemperature(425.15)
    for oil in (300.0, 363.15, 425.0, 425.15, 500.0):
        assert law.ratio(425.15, oil) == 1.0
        assert law.ratio(math.nextafter(425.15, 500.0), oil) > 1.0
        assert law.ratio(math.nextafter(425.15, 0.0), oil) < 1.0
    assert law.ratio(400.0, 375.0) == approx(25.0 / 50.15, rel=1e-15)


def test_a_contact_no_warmer_than_its_oil_has_no_risk_and_one_in_critical_oil_the_largest():
    law = CriticalTemperature(400.0)
    assert law.ratio(350.0, 350.0) == law.ratio(340.0, 350.0) == 0.0
    assert law.ratio(430.0, 420.0) == law.ratio(430.0, 400.0) == 1000.0
    assert law.ratio(390.0, 420.0) == 0.0  # bodies cooler than their oil
    assert NoScuffing().ratio(900.0, 300.0) == 0.0


def test_the_hottest_nodes_are_those_of_the_warmer_surface_at_each():
    first, second = np.zeros((3, 4)), np.full((3, 4), 5.0)
    first[1, 2], first[2, 3], second[0, 0] = 40.0, 20.0, 30.0
    warm = Temperatures(first, second, 0.0, 0.0, 0.0, 0.0, True)
    assert [warm.hottest(n) for n in (1, 2, 3, 4)] == approx([40.0, 35.0, 30.0, 23.75])
    assert warm.hottest(12) == warm.hottest(99) == approx((90.0 + 9 * 5.0) / 12)
    assert Temperatures(350.0, 360.0, 0.0, 0.0, 0.0, 0.0, True).hottest(7) == 360.0


@pytest.mark.parametrize("level", ["regression", pytest.param("deterministic", marks=pytest.mark.long)])
def test_the_flag_is_raised_exactly_where_the_contact_is_hotter_than_critical(level):
    scene = scene_of(level, **{"control.mixed_instants": "1"})  # of several, any one may be hotter than their mean
    without = told(scene)
    hottest = without.contact_temperature_max
    assert hottest > scene.operation.temperature + 10.0
    assert without.scuffing_ratio == 0.0
    at, above = told(judged(scene, hottest)), told(judged(scene, math.nextafter(hottest, 0.0)))
    assert (at.scuffing_ratio, at.range_flags) == (1.0, without.range_flags)
    assert above.scuffing_ratio > 1.0
    assert above.range_flags == without.range_flags | RangeFlag.SCUFFING
    new = {"scuffing_ratio", "range_flags"}
    rest = [{k: v for k, v in asdict(out).items() if k not in new} for out in (without, above)]
    assert rest[0] == rest[1]  # the law judges, and changes nothing


@pytest.mark.parametrize("level", LEVELS)
def test_without_flash_temperatures_the_bulk_temperature_is_judged_and_the_scene_says_so(level):
    given = {"heat.model": "none", "heat.bulk": "inputs", "tribofilm.beyond_fit": "extrapolate"}
    bodies = {"operation.body_temperature_1": "90 degC", "operation.body_temperature_2": "140 degC"}
    scene = judged(scene_of(level, **given, **bodies), 400.0)
    out = told(scene)
    assert out.contact_temperature_max == 413.15
    oil = scene.operation.temperature
    assert out.scuffing_ratio == approx((413.15 - oil) / (400.0 - oil), rel=1e-12)
    assert RangeFlag.SCUFFING in RangeFlag(out.range_flags)
    assert any("scuffing_ratio" in text for text in scene.warnings())
    assert not any("scuffing" in text for text in judged(scene_of(level), 400.0).warnings())


@pytest.mark.parametrize("level", LEVELS)
def test_an_unloaded_contact_is_as_warm_as_its_bodies(level):
    scene = judged(scene_of(level), 500.0)
    out = advance(scene, replace(scene.operation.point, load=0.0), initial_state(scene), 0.0)[1]
    assert (out.contact_temperature_max, out.scuffing_ratio) == (scene.operation.temperature, 0.0)


def test_one_hot_instant_of_many_raises_the_flag_of_a_cycle():
    scene = scene_of("deterministic", **{"surface_1.rq": "0 m", "surface_2.rq": "0 m"})
    point = scene.operation.point
    calm = replace(point, speed_1=1.25, speed_2=1.25)

    def duty(time: float):
        return point if time > 3.5e-4 else calm

    state, times = initial_state(scene), [1e-4 * k for k in range(5)]
    temperatures = [m.outputs["contact_temperature_max"] for m in run_cycle(scene, state, duty, times)[1]]
    hot, before = temperatures[-1], max(temperatures[:-1])
    assert hot > before + 5.0
    for critical, flagged in ((hot + 0.1, False), (0.5 * (hot + before), True)):
        after, _ = run_cycle(judged(scene, critical), state, duty, times)
        assert (RangeFlag.SCUFFING in RangeFlag(after.outputs.range_flags)) is flagged
        assert after.outputs.scuffing_ratio < 1.0  # the mean over the cycle


def test_a_scene_names_the_critical_temperature_in_its_unit_or_by_a_set():
    scene = Scene.from_toml("mtm_zddp", {"scuffing.model": "critical_temperature", "scuffing.temperature": "150 degC"})
    assert scene.scuffing == CriticalTemperature(423.15)
    assert "scuffing.temperature" in tunables(scene)
    assert Scene.from_dict(scene.to_dict()).scuffing == scene.scuffing
    clp = Scene.from_toml("mtm_zddp", {"scuffing.set": "gear_oil_clp"}).scuffing
    assert clp.temperature == approx(273.15 + 80.0 + 2.25 * 10.0**-0.05 * 12.0**2, abs=0.5)  # ISO/TR 13989-1, (99)
    with pytest.raises(SceneError, match=r"scuffing\.temperature = 2000 K .* must be .* at most 1500"):
        Scene.from_toml("mtm_zddp", {"scuffing.model": "critical_temperature", "scuffing.temperature": "2000 K"})


@pytest.mark.parametrize(
    ("name", "speeds", "changes"),
    [
        ("mtm_zddp", (3.0, 1.0), {"surface_1.rq": "5 nm", "surface_2.rq": "20 nm"}),
        ("mtm_zddp", (1.5, 0.3), {"operation.load": "20 N"}),
        ("ball_209_inner", (2.0, 1.0), {}),
        ("fzg_flank", (1.0, 0.5), {}),
        ("fzg_flank", (10.0, 6.0), {}),
        ("fzg_flank", (4.0, 2.0), {f"surface_{i}.{k}": "0 m" for i in (1, 2) for k in ("rq", "microroughness.rms")}),
    ],
)
def test_the_regression_level_states_the_largest_rise_of_the_deterministic_one_within_its_spread(name, speeds, changes):
    scene = Scene.from_toml(name, {"heat.model": "field", "film.points": "65", "film.model": "deterministic"} | changes)
    op = replace(scene.operation.point, speed_1=speeds[0], speed_2=speeds[1])
    found = observed(Case.bind(scene, op, None), solve(scene, op, initial_state(scene)))
    quick = scene.at_level("regression")
    out = advance(quick, op, initial_state(quick), 0.0)[1]
    rises = found["contact_temperature_max"] - op.temperature, out.contact_temperature_max - op.temperature
    print(f"{name} {speeds}: deterministic {rises[0]:.1f} K, regression {rises[1]:.1f} K")
    assert rises[1] > 5.0
    assert abs(math.log(rises[0] / rises[1])) < math.log(1.6)  # docs/physics.md
