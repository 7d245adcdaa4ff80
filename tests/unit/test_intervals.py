"""Intervals of what a scene assumes, and what they are worth."""

import re
import tomllib
from dataclasses import replace
from importlib import resources

import pytest
from comparison import approx

from contact_core import OperatingPoint, Scene, SceneError, advance, initial_state, shipped_scenes
from contact_core.assumed import OUTPUTS, assumed
from contact_core.scene.intervals import replaced, value_of
from contact_core.scene.origins import Kind, Origin, comments_of, origins
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
    return {key for interval in scene.intervals for key in interval.keys}


def answer(scene, op):
    return advance(scene, op, initial_state(scene), 0.0)[1]


@pytest.mark.parametrize("name", shipped_scenes())
def test_every_number_that_a_shipped_scene_or_its_sets_assume_has_an_interval(name):
    assert without_interval(name) == set()


def without_interval(source):
    """Return the numbers of a scene that have neither a source nor an interval."""
    scene = Scene.from_toml(source)
    table = scene.to_dict()
    numbers = {key for key, value in flat(table).items() if not isinstance(value, list) and _is_number(value)}
    words = origins(source, table)
    return {key for key in numbers if words[key].word == "assumed"} - keys(scene)


SETS = ("lubricants", "solids", "tribofilms", "fatigue", "scuffing", "surfaces")
DATA = resources.files("contact_core") / "data"


@pytest.mark.parametrize("file", SETS)
def test_every_number_of_a_set_has_a_source_or_an_interval(file):
    assert of_sets_without((DATA / f"{file}.toml").read_text("utf-8")) == []


def of_sets_without(text):
    """Return the numbers of a file of sets that have neither a source nor an interval."""
    said, missing = comments_of(text), []
    for name, entry in tomllib.loads(text).items():
        stated = {key.strip() for several in flat(entry.get("intervals", {})) for key in several.split(",")}
        values = {key: table for key, table in entry.items() if key not in ("source", "intervals", "conditions")}
        for key, value in flat(values).items():
            of_table = said.source(f"{name}.{key}") or entry.get("source", "")
            if _is_number(value) and Origin(Kind.SET, said.remark(f"{name}.{key}"), of_table).word == "assumed":
                missing += [f"{name}.{key}"] if key not in stated else []
    return missing


def test_a_number_with_neither_source_nor_interval_is_found(tmp_path):
    text = (DATA / "scenes" / "pin_on_disc.toml").read_text("utf-8")
    bare = re.sub(r"^(\[geometry\]|radius_x = \S+ \S+).*$", r"\1", text, flags=re.M)
    (tmp_path / "bare.toml").write_text(bare, "utf-8")
    assert "geometry.radius_x" in without_interval(tmp_path / "bare.toml")
    oils = (DATA / "lubricants.toml").read_text("utf-8")
    assert of_sets_without(oils.replace('"lubricant.viscosity.bend_40" = ["-20 %", "+20 %"]\n', "")) == []
    assert of_sets_without(oils.replace('"lubricant.conductivity_bend" = ["-20 %", "+20 %"]\n', "")) != []
    assert of_sets_without(re.sub("^source = .*$", "", oils, flags=re.M)) != []


def _is_number(value):
    return not isinstance(value, str) or (bool(value) and (value[0].isdigit() or value[0] == "-"))


@pytest.mark.parametrize("name", shipped_scenes())
def test_intervals_hold_the_value_and_survive_a_scene_written_and_read(name):
    scene = Scene.from_toml(name)
    again = Scene.from_dict(scene.to_dict())
    assert again.intervals == scene.intervals
    for interval in scene.intervals:
        least, most = interval.ends(scene)
        for key in interval.keys:
            assert least[key] < most[key]
            assert least[key] <= value_of(scene, key)[0] <= most[key], key


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
        ("surface_1.rq", ["-1 nm", "2 nm"], ['intervals."surface_1.rq"', "surface_1.rq = -1e-09 m", "at least 0"]),
        ("surface_1.rq, surface_2.rq", [["1 nm", "2 nm"], ["9 nm"]], ["has 2 values", "an end of it 1"]),
        ("operation.load", ["40 N", "60 N"], ['intervals."operation.load"', "is given, not assumed", "sweep"]),
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


def test_keys_of_intervals_may_stand_in_tables():
    dotted = Scene.from_dict(FACTS | {"intervals": {"surface_1.rq": ["10 nm", "40 nm"]}})
    assert Scene.from_dict(FACTS | {"intervals": {"surface_1": {"rq": ["10 nm", "40 nm"]}}}) == dotted


def test_an_interval_that_does_not_hold_its_value_is_asked_back():
    (said,) = Scene.from_dict(FACTS | {"intervals": {"boundary_friction.bare": [0.2, 0.3]}}).doubts()
    for part in ("['0.2', '0.3']", "boundary_friction.bare = 0.13"):
        assert part in said
    assert all(Scene.from_toml(name).doubts() == [] for name in shipped_scenes())


def test_values_that_go_together_are_tried_together():
    """A prefactor with its barrier: of a film that was calibrated at 80 degC, little there and much elsewhere."""
    together = "tribofilm.activation_energy, tribofilm.prefactor"
    scene = Scene.from_toml("mtm_zddp", {"tribofilm.set": "gosvami"})
    (interval,) = (each for each in scene.intervals if each.key == together)
    op = scene.operation.point
    worth = {}
    for celsius in (60.0, 80.0):
        at = replace(op, temperature=celsius + 273.15)
        worth[celsius] = assumed(scene, at)["tribofilm"].parts[together]
        here, *ends = (growth(each, at) for each in (scene, *(with_end(scene, end) for end in interval.ends(scene))))
        assert worth[celsius] == approx(max(abs(end / here - 1.0) for end in ends), rel=1e-3)
    assert worth[60.0] > 0.3 > 0.01 > worth[80.0]
    given = Scene.from_toml("mtm_zddp", {"tribofilm.set": "gosvami", "tribofilm.prefactor": "1 m/s"})
    assert "tribofilm.activation_energy" not in keys(given)


def with_end(scene, end):
    for key, value in end.items():
        scene = replaced(scene, key, value)
    return scene


def growth(scene, op):
    scene = scene.at_level("regression")
    grown = advance(scene, op, initial_state(scene), 1e-3)[1]
    return grown.tribofilm_grown_1 + grown.tribofilm_grown_2
