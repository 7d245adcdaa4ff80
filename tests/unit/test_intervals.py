"""Intervals of what a scene assumes, and what they are worth."""

from dataclasses import replace

import pytest
from comparison import approx

from contact_core import OperatingPoint, Scene, SceneError, advance, initial_state, shipped_scenes
from contact_core.assumed import OUTPUTS, assumed
from contact_core.scene.intervals import replaced, value_of
from contact_core.scene.origins import origins
from contact_core.scene.toml import flat, read_table

SHEET = {"viscosity_40": "31 mm2/s", "viscosity_100": "5.9 mm2/s", "density": "827 kg/m3"}
OP = {"load": "50 N", "speed_1": "0.125 m/s", "speed_2": "0.075 m/s", "temperature": "100 degC"}
FACTS = {  # what a user knows of a ball on a disc
    "geometry": {"radius_x": "9.525 mm"},
    "solids": {"set": "steel"},
    "surface_1": {"rq": "20 nm"},
    "surface_2": {"rq": "100 nm"},
    "lubricant": {"base": "pao", "viscosity": SHEET},
    "operation": OP,
}


def keys(scene):
    return {interval.key for interval in scene.intervals}


def answer(scene, op):
    return advance(scene, op, initial_state(scene), 0.0)[1]


@pytest.mark.parametrize("name", shipped_scenes())
def test_every_number_that_a_shipped_scene_or_its_sets_assume_has_an_interval(name):
    scene = Scene.from_toml(name)
    table = scene.to_dict()
    numbers = {key for key, value in flat(table).items() if not isinstance(value, list) and _is_number(value)}
    words = origins(name, table)
    assumed_keys = {key for key in numbers if words[key].word == "assumed"}
    assert assumed_keys - keys(scene) == set()
    assert len(assumed_keys) > 2


def _is_number(value):
    return not isinstance(value, str) or (bool(value) and (value[0].isdigit() or value[0] == "-"))


@pytest.mark.parametrize("name", shipped_scenes())
def test_intervals_hold_the_value_and_survive_a_scene_written_and_read(name):
    scene = Scene.from_toml(name)
    again = Scene.from_dict(scene.to_dict())
    assert again.intervals == scene.intervals
    for interval in scene.intervals:
        least, most = interval.ends(scene)
        assert least < most
        assert least <= value_of(scene, interval.key)[0] <= most, interval.key


def test_a_value_that_is_given_loses_the_interval_of_its_set_or_its_default():
    usual = keys(Scene.from_dict(FACTS))
    assert {"surface_2.microroughness.rms", "lubricant.viscosity.pressure_coefficient", "film.floor"} <= usual
    given = FACTS | {"film": {"floor": "0.5 nm"}, "lubricant": {"base": "pao", "viscosity": SHEET | {
        "pressure_coefficient": "13 GPa^-1"}}}  # fmt: skip
    assert usual - keys(Scene.from_dict(given)) == {"film.floor", "lubricant.viscosity.pressure_coefficient"}
    own = {"lubricant.rheology.eyring_stress": "6 MPa", "wear.bare": "1e-6"}
    assert keys(Scene.from_toml("mtm_zddp")) - keys(Scene.from_toml("mtm_zddp", own)) == set(own)
    no_heat = keys(Scene.from_toml("mtm_zddp")) - keys(Scene.from_toml("mtm_zddp", {"heat": "none"}))
    assert no_heat == {f"heat.{name}_{body}" for name in ("conductivity", "diffusivity") for body in (1, 2)}


@pytest.mark.parametrize(
    ("key", "ends", "said"),
    [
        ("surface_1.rqq", ["1 nm", "2 nm"], ['intervals."surface_1.rqq" is no number', "tribofmu explain"]),
        ("surface_1.rq", ["2 nm", "1 nm"], ["the least comes first", "Exchange"]),
        ("surface_1.rq", ["1 nm", "2 N"], ["intervals.\"surface_1.rq\" = '2 N'", "wrong unit"]),
        ("surface_1.rq", "1 nm", ["intervals.\"surface_1.rq\" = '1 nm'", "least and the largest"]),
    ],
)
def test_an_interval_that_cannot_be_is_refused_by_its_key(key, ends, said):
    with pytest.raises(SceneError) as refused:
        Scene.from_dict(FACTS | {"intervals": {key: ends}})
    for part in said:
        assert part in str(refused.value)


def test_the_worth_of_one_interval_is_what_the_regression_level_makes_of_its_ends():
    scene = Scene.from_dict(read_table("mtm_zddp") | {"intervals": {"boundary_friction.bare": ["-20 %", "+10 %"]}})
    scene = replace(scene, intervals=tuple(each for each in scene.intervals if each.key == "boundary_friction.bare"))
    op = scene.operation.point
    found = assumed(scene, op)
    here, less = (
        answer(replaced(scene.at_level("regression"), "boundary_friction.bare", value), op).friction_coefficient
        for value in (0.13, 0.8 * 0.13)
    )
    assert found["friction_coefficient"].together == approx(here - less, rel=1e-9)
    assert found["friction_coefficient"].parts.keys() == {"boundary_friction.bare"}
    assert found["h_c"].together == 0.0


def test_assumptions_add_as_if_they_were_independent():
    scene = Scene.from_toml("mtm_zddp")
    for each in assumed(scene, scene.operation.point).values():
        assert each.together**2 == approx(sum(half**2 for half in each.parts.values()), rel=1e-9)
        assert list(each.parts.values()) == sorted(each.parts.values(), reverse=True)
    assert set(assumed(scene, scene.operation.point)) == set(OUTPUTS)


@pytest.mark.parametrize("speed", [0.1, 0.005])
def test_the_band_of_a_scene_without_microroughness_holds_the_answer_with_a_finish(speed):
    """PAO 6, lambda below 1: the roughness below the grid decides, and the scene does not give it."""
    bare = Scene.from_dict(FACTS).at_level("regression")
    finish = {"surface_1": {"rms": "2 nm", "longest": "4 um"}, "surface_2": {"rms": "5 nm", "longest": "4 um"}}
    given = {body: FACTS[body] | {"microroughness": layer} for body, layer in finish.items()}
    finished = Scene.from_dict(FACTS | given).at_level("regression")
    op = OperatingPoint(50.0, 1.25 * speed, 0.75 * speed, 373.15)
    worth, here = assumed(bare, op)["friction_coefficient"], answer(bare, op).friction_coefficient
    off = abs(answer(finished, op).friction_coefficient - here)
    assert off <= worth.together
    assert off > 0.1 * worth.together
    assert "surface_2.microroughness.rms" in worth.parts
