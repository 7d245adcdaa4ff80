"""What a finish such as "ground" gives a surface, and the measured surfaces that ship."""

import math
from importlib import resources

import numpy as np
import pytest
from comparison import approx

from contact_core import Measured, Scene, SceneError, advance, initial_state
from contact_core.scene.finishes import FILE, ends_of_finish, finishes
from contact_core.scene.origins import comments_of, origins
from contact_core.scene.toml import read_table
from contact_core.scene.units import parse
from system_models.run import trust
from system_models.run.duty import Duty

FACTS = {
    "geometry": {"radius_x": "10 mm"},
    "solids": {"set": "steel"},
    "lubricant": {
        "base": "pao",
        "viscosity": {"viscosity_40": "31 mm2/s", "viscosity_100": "5.9 mm2/s", "density": "827 kg/m3"},
    },
    "operation": {"load": "50 N", "speed_1": "0.125 m/s", "speed_2": "0.075 m/s", "temperature": "100 degC"},
}

SMOOTH = {"surface_1": {"rq": "0 nm"}, "surface_2": {"rq": "0 nm"}}
HAND = (("10 nm", "2 nm"), ("25 nm", "5 nm"))


def scene(first, second) -> Scene:
    return Scene.from_dict(FACTS | {"surface_1": first, "surface_2": second})


def before(found: Scene) -> str:
    return " ".join(" ".join(trust.before(found, Duty.of_scene(found))).split())


@pytest.mark.parametrize("name", finishes())
def test_a_finish_gives_roughness_length_and_microroughness_with_intervals(name):
    found, own = scene({"finish": name.upper()}, {"rq": "0 nm"}), read_table(FILE, "finish")[name]
    surface, intervals = found.surface_1, {each.key: each for each in found.intervals}
    assert surface.rq == approx(parse(own["rq"], "m", ""), rel=1e-9)
    assert surface.microroughness.rms == approx(parse(own["microroughness"]["rms"], "m", ""), rel=0.01)
    assert found.warnings() == []  # no wave counts twice
    for key in ("rq", "correlation_length", "microroughness.rms"):
        least, most = (end[f"surface_1.{key}"] for end in intervals[f"surface_1.{key}"].ends(found))
        assert 0.0 < least < most
    for key, ends in own["intervals"].items():
        if key != "correlation_length":  # the grid, and 40 Rq, may lengthen it
            given = [end[f"surface_1.{key}"] for end in intervals[f"surface_1.{key}"].ends(found)]
            assert given == approx([parse(e, "m", "") for e in ends], rel=0.02)
    assert set(ends_of_finish(name)) == {"rq", "correlation_length", "microroughness.rms"}


def test_what_a_scene_gives_itself_wins_and_microroughness_goes_with_its_rq():
    usual = scene({"finish": "ground"}, {"rq": "0 nm"}).surface_1
    rougher = scene({"finish": "ground", "rq": "0.4 um"}, {"rq": "0 nm"})
    assert rougher.surface_1.rq == approx(0.4e-6, rel=1e-12)
    assert rougher.surface_1.microroughness.rms == approx(2.0 * usual.microroughness.rms, rel=0.01)
    assert "surface_1.rq" not in {each.key for each in rougher.intervals}
    own = scene({"finish": "ground", "microroughness": {"rms": "7 nm", "longest": "3 um"}}, {"rq": "0 nm"}).surface_1
    assert (own.microroughness.rms, own.microroughness.longest) == approx((7e-9, 3e-6), rel=1e-12)
    lengthened = scene({"finish": "ground", "lay": "along"}, {"rq": "0 nm"}).surface_1
    assert lengthened.correlation_length > 3.0 * lengthened.correlation_length_across


@pytest.mark.parametrize(
    ("surface", "said"),
    [
        ({"finish": "grund"}, ["surface_1.finish", "There is no finish 'grund'", "Did you mean 'ground'?", "hobbed"]),
        ({"finish": "ground", "lay": "alnog"}, ["surface_1.lay = 'alnog'", "along", "across"]),
        ({"rq": "10 nm", "lay": "along"}, ["surface_1.lay", "surface_1.finish"]),
        ({}, ["surface_1.rq", "surface_1.finish, such as 'ground'"]),
    ],
)
def test_a_finish_that_is_none_is_refused_with_those_that_are(surface, said):
    with pytest.raises(SceneError) as refused:
        scene(surface, {"rq": "0 nm"})
    for part in said:
        assert part in str(refused.value)


@pytest.mark.parametrize("name", ["nu206_raceway", "nu206_roller"])
def test_measured_bearing_surfaces_are_sets(name):
    """Rq of the waves of 8 um to 0.8 mm: 0.08 to 0.1 um, of the whole traces 0.13."""
    surface = scene({"set": name}, {"set": name}).surface_2
    assert 0.07e-6 < surface.rms < 0.11e-6
    trace = resources.files("contact_core") / "data" / "surfaces" / f"{name}.csv"
    heights = np.loadtxt(trace.read_text("utf-8").splitlines()) * 1e-6
    assert surface.rms == approx(float(heights.std()), rel=1e-6)
    assert "MIT" in trace.read_text("utf-8")


def test_a_scene_that_leaves_roughness_below_the_grid_out_says_what_that_is_worth_before_its_run():
    bare = scene({"rq": "10 nm"}, {"rq": "25 nm"})
    said = before(bare)
    assert "Roughness: surface_1 and surface_2 give none below the grid" in said
    without, most = (float(word) for word in said.partition("friction ")[2].split()[0:3:2])
    assert most > 1.5 * without > 0.0
    assert "finish = 'ground'" in said
    assert "Roughness:" not in before(scene({"rq": "10 nm", "finish": "polished"}, {"rq": "25 nm", "finish": "lapped"}))
    fast = FACTS | {"operation": FACTS["operation"] | {"speed_1": "30 m/s", "speed_2": "30 m/s"}}
    assert "Roughness:" not in before(
        Scene.from_dict(fast | {"surface_1": {"rq": "5 nm"}, "surface_2": {"rq": "5 nm"}})
    )


@pytest.mark.parametrize("speeds", [("1.25 m/s", "0.75 m/s"), ("0.125 m/s", "0.075 m/s")])
def test_what_roughness_below_the_grid_may_be_worth_holds_what_finishes_give(speeds):
    operation = FACTS["operation"] | dict(zip(("speed_1", "speed_2"), speeds, strict=True))
    table = FACTS | {"operation": operation, "film": {"model": "regression"}}
    bare = Scene.from_dict(table | {"surface_1": {"rq": "20 nm"}, "surface_2": {"rq": "0.1 um"}})
    without, most = (float(word) for word in before(bare).partition("friction ")[2].split()[0:3:2])
    for name in ("ground", "honed", "lapped", "superfinished"):
        surfaces = {"surface_1": {"rq": "20 nm", "finish": "polished"}, "surface_2": {"rq": "0.1 um", "finish": name}}
        found = Scene.from_dict(table | surfaces)
        friction = advance(found, found.operation.point, initial_state(found), 0.0)[1].friction_coefficient
        assert without < friction <= most


def test_no_finish_is_asked_for_where_none_may_be_and_no_worth_is_told_that_is_not_known(tmp_path):
    heights = tmp_path / "heights.npy"
    np.save(heights, 1e-8 * np.random.default_rng(1).standard_normal((64, 64)))
    measured = {"heights": {"file": str(heights), "spacing": "8 um", "unit": "m"}}
    said = before(scene({"finish": "polished"}, measured))
    assert "Roughness: surface_2 gives none below the grid" in said and "the most that is usual" not in said
    lumped = FACTS | {"film": {"criterion": "lumped"}, "surface_1": {"rq": "10 nm"}, "surface_2": {"rq": "25 nm"}}
    assert "Roughness:" not in before(Scene.from_dict(lumped))


def test_the_crown_of_a_measured_roller_is_straight_in_the_middle_and_as_deep_at_its_ends_as_it_says():
    drop = Measured(ends=12e-6).drop(np.array([0.0, 1.5e-3, 5e-3]), 10e-3)
    assert drop[:2] == approx([0.0, 0.0], abs=1e-12)
    assert drop[2] == approx(12e-6, rel=1e-6)
    assert math.isinf(Measured().drop(np.array([5.1e-3]), 10e-3)[0])


def test_the_crown_is_that_of_the_measured_roller():
    at = np.array([0.0, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
    found = np.array([0.0, 0.002, 0.02, 0.057, 0.134, 0.257, 0.411, 0.65, 1.0])  # NU206-RE-1, even about the middle
    assert Measured().drop(0.5 * at * 9.4e-3, 9.4e-3) / 11.3e-6 == approx(found, abs=0.03)


def test_a_finish_is_as_good_as_microroughness_by_hand():
    by_hand = [{"rq": rq, "microroughness": {"rms": rms, "longest": "4 um"}} for rq, rms in HAND]
    assert (
        scene(*by_hand).surface_2.microroughness
        == scene(*({"rq": rq, "finish": "polished"} for rq, _ in HAND)).surface_2.microroughness
    )


def test_a_smooth_body_has_no_roughness_below_the_grid_by_its_finish():
    assert scene({"finish": "polished", "rq": "0 nm"}, {"rq": "0 nm"}).surface_1.microroughness is None


def test_what_has_no_effect_beside_a_set_is_refused():
    with pytest.raises(SceneError, match=r"surface_1\.finish has no effect beside set = 'nu206_roller'"):
        scene({"finish": "ground", "set": "nu206_roller"}, {"rq": "0 nm"})
    with pytest.raises(SceneError, match=r"lubricant\.base = 'pag' has no effect beside set = 'minr'"):
        Scene.from_dict({**FACTS, **SMOOTH, "lubricant": {"base": "pag", "set": "minr"}})


def test_beside_a_short_correlation_length_no_wave_counts_twice():
    short = scene({"finish": "polished", "correlation_length": "3 um"}, {"rq": "0 nm"}).surface_1
    usual = scene({"finish": "polished"}, {"rq": "0 nm"}).surface_1.microroughness
    longest = short.microroughness.longest
    assert longest == approx(0.99 * 2.0 * math.pi / 9.0 * 3e-6, rel=3e-3)
    assert short.microroughness.rms == approx(usual.rms * math.sqrt(longest / 4e-6), rel=5e-3)
    assert not any("twice" in said for said in short.warnings(1e-9))  # on the finest of grids


def test_a_setting_of_finish_replaces_what_the_scene_gives_and_is_told_with_its_source():
    settings = {"surface_2.finish": "lapped", "surface_2.rq": "50 nm"}
    found = Scene.from_toml("mtm_zddp", settings)
    assert (found.surface_2.rq, found.surface_2.correlation_length) == approx((50e-9, 8e-6), rel=1e-12)
    assert found.surface_2.microroughness.rms == approx(10e-9, rel=1e-12)
    origin = origins("mtm_zddp", found.to_dict(), settings)["surface_2.microroughness.rms"]
    assert origin.set_name == "lapped, finishes.toml" and origin.word == "assumed"


def test_every_value_of_a_finish_has_a_source_or_is_assumed():
    remarks = comments_of(FILE.read_text("utf-8")).by_key
    keys = ("rq", "correlation_length", "lay", "microroughness")
    assert [f"{name}.{key}" for name in finishes() for key in keys if f"{name}.{key}" not in remarks] == []
