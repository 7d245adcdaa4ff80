from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from contact_core import OperatingPoint, OperatingPointError, Scene, SceneError
from contact_core.laws.tribofilm import LAWS
from contact_core.scene import tunables, with_values
from contact_core.scene.toml import read_table

GRID = {"film.points": "129", "film.domain": "0.5 mm"}


def refusal(**overrides: object) -> str:
    """The sentence with which case B is refused after some of its keys (__ for a dot) were changed."""
    changed = {key.replace("__", "."): value for key, value in overrides.items()}
    with pytest.raises(SceneError) as error:
        Scene.from_toml("mtm_zddp", GRID | changed)
    return str(error.value)


def test_an_unknown_key_is_refused_with_the_key_that_was_meant():
    sentence = refusal(geometry__track_lenght_1="60 mm")
    assert "[geometry] has no key 'track_lenght_1'" in sentence
    assert "Did you mean 'track_length_1'?" in sentence
    assert "radius_x" in sentence  # all choices are named


@pytest.mark.parametrize(
    ("key", "place"),
    [("load", "[operation]"), ("lubricant.viscosity_40", "[lubricant.viscosity]"), ("rq", "[surface_1]")],
)
def test_a_key_in_the_wrong_table_is_refused_with_its_own_one(key, place):
    assert f"has no key '{key.split('.')[-1]}'. It belongs to {place}" in refusal(**{key: "1 N"})


def test_an_unknown_table_is_refused_with_the_table_that_was_meant():
    sentence = refusal(lubricants__set="azam_oil")
    assert "The scene has no key 'lubricants'. Did you mean 'lubricant'?" in sentence


def test_a_missing_table_is_named_by_its_keys():
    table = read_table("mtm_zddp")
    del table["geometry"]
    with pytest.raises(SceneError, match=r"These 3 values are missing: geometry\.radius_x \[m\] \(combined radius "):
        Scene.from_dict(table)


def test_a_missing_key_is_named_with_its_meaning_and_unit():
    table = read_table("mtm_zddp")
    del table["geometry"]["radius_x"]
    with pytest.raises(SceneError, match=r"'geometry.radius_x' is missing. Give it \[m\]: combined radius "):
        Scene.from_dict(table)


def test_a_wrong_unit_is_refused_with_the_right_one():
    sentence = refusal(geometry__radius_x="10 Pa")
    assert "geometry.radius_x = '10 Pa'" in sentence
    assert "convertible to m" in sentence


def test_a_missing_unit_is_refused_with_an_example():
    assert "operation.load = '50' has no unit. Write for example '1.0 N'." in refusal(operation__load="50")


def test_a_negative_load_is_refused_by_name():
    sentence = refusal(operation__load="-5 N")
    assert "operation.load = -5 N" in sentence
    assert "must be above 0" in sentence


@pytest.mark.parametrize("key", ["hardness", "film_hardness"])
def test_a_hardness_below_zero_is_refused_by_name(key):
    sentence = refusal(**{f"plasticity__{key}": "-6 GPa"})
    assert f"plasticity.{key} = -6e+09 Pa" in sentence
    assert "must be above 1e+06" in sentence


def test_a_hardness_below_the_hertz_pressure_is_refused_with_a_way_out():
    sentence = refusal(plasticity__hardness="1.1 GPa", plasticity__film_hardness="1 GPa")
    assert "1.15e+09 Pa" in sentence
    assert "Lower the load or raise the hardness." in sentence


def test_a_tribofilm_harder_than_its_solid_is_refused():
    sentence = refusal(plasticity__film_hardness="7 GPa")
    assert "plasticity.film_hardness = 7e+09 Pa is above plasticity.hardness" in sentence


@pytest.mark.parametrize("value", ["nan N", "inf N", float("nan")])
def test_a_load_that_is_not_finite_is_refused_by_name(value):
    sentence = refusal(operation__load=value)
    assert "operation.load" in sentence
    assert "not finite" in sentence


def test_roughness_below_one_node_per_correlation_length_is_refused_with_the_grid_it_needs():
    sentence = refusal(surface_2__correlation_length="3 um")
    assert "surface_2.correlation_length = 3e-06 m is 0.77 nodes of the grid" in sentence
    assert "film.points = 168 or more" in sentence
    Scene.from_toml("mtm_zddp", GRID | {"surface_2.correlation_length": "3 um", "film.points": "168"})


def test_a_smooth_surface_needs_no_grid():
    Scene.from_toml("mtm_zddp", GRID | {"surface_2.correlation_length": "3 um", "surface_2.rq": "0 nm"})


def test_a_domain_smaller_than_the_contact_is_refused_with_the_size_it_needs():
    sentence = refusal(film__domain="0.3 mm")
    assert "film.domain = 0.0003 m is too small" in sentence
    assert "Use at least 0.00043 m." in sentence
    Scene.from_toml("mtm_zddp", {"film.domain": "0.43 mm"})


def test_the_largest_load_of_the_duty_must_fit_too():
    assert "at 5000 N" in refusal(operation__largest_load="5 kN")
    table = read_table("mtm_zddp")
    table["operation"]["steps"] = [{"time": "1 s", "load": "10 N"}, {"time": "2 s", "load": "5 kN"}]
    with pytest.raises(SceneError, match="at 5000 N"):
        Scene.from_dict(table)


@pytest.mark.parametrize("body", [1, 2])
def test_a_track_shorter_than_the_grid_is_refused_of_either_body(body):
    sentence = refusal(**{f"geometry__track_length_{body}": "0.4 mm"})
    assert f"geometry.track_length_{body} = 0.0004 m is shorter than film.domain = 0.0005 m" in sentence


def test_an_unknown_model_is_refused_with_the_choices():
    sentence = refusal(tribofilm__model="ghanbarzade")
    assert "[tribofilm] has no model 'ghanbarzade'. Did you mean 'ghanbarzadeh'?" in sentence
    assert f"Known are {', '.join(law.name for law in LAWS)}." in sentence


def test_a_law_without_a_model_is_refused_with_the_choices():
    table = read_table("mtm_zddp")
    del table["wear"]["model"]
    with pytest.raises(SceneError, match=r"\[wear\] needs a 'model'. Known are none, archard."):
        Scene.from_dict(table)


def test_a_key_of_another_model_is_refused():
    assert "[tribofilm] has no key 'full_thickness'" in refusal(
        tribofilm__model="none", tribofilm__full_thickness="100 nm"
    )


def test_an_unknown_named_set_is_refused_with_the_choices():
    sentence = refusal(tribofilm__set="zddp_95c")
    assert "[tribofilm] has no set 'zddp_95c'" in sentence
    assert "zddp_90c, zddp_80c" in sentence


def test_a_set_for_a_table_that_has_none_is_refused():
    assert "[wear] has no named sets" in refusal(wear__set="steel")


@pytest.mark.parametrize(("value", "reason"), [("129.5", "whole number"), ("8", "at least 17"), (True, "not a number")])
def test_a_wrong_number_of_points_is_refused_by_name(value, reason):
    sentence = refusal(film__points=value)
    assert "film.points" in sentence
    assert reason in sentence


def test_a_word_that_is_not_a_choice_is_refused_with_the_choices():
    assert "film.fft = 'numpy' is not one of pyfftw, scipy." in refusal(film__fft="numpy")


def test_text_must_be_text():
    assert "tribofilm.dose = 3 must be text in quotes." in refusal(tribofilm__dose=3)


@pytest.mark.parametrize("value", ["fast", 3, [1, 2]])
def test_a_value_in_place_of_a_table_is_refused(value):
    table = read_table("mtm_zddp")
    table["operation"] = value
    with pytest.raises(SceneError, match=r"\[operation\] must be a table"):
        Scene.from_dict(table)


def test_a_key_below_a_value_cannot_be_set():
    assert "'operation.load.value' cannot be set: 'load' is a value" in refusal(operation__load__value="1 N")


def test_everything_out_of_range_is_said_at_once():
    sentence = refusal(operation__load="-5 N", plasticity__hardness="-6 GPa")
    assert "operation.load" in sentence
    assert "plasticity.hardness" in sentence


def test_an_unknown_scene_is_refused_with_the_shipped_ones():
    with pytest.raises(SceneError) as error:
        Scene.from_toml("mtm_zdpp")
    said = str(error.value)
    assert "no scene 'mtm_zdpp'. Did you mean 'mtm_zddp'? Shipped are azam_case_a, azam_case_a_thesis, ball_" in said


def test_a_missing_file_is_named(tmp_path: Path):
    with pytest.raises(SceneError, match=r"absent\.toml' cannot be read: No such file"):
        Scene.from_toml(tmp_path / "absent.toml")


@pytest.mark.parametrize("content", [b"[geometry\n", b"\xff\xfe"])
def test_a_file_that_is_not_toml_is_refused(tmp_path: Path, content: bytes):
    path = tmp_path / "broken.toml"
    path.write_bytes(content)
    with pytest.raises(SceneError, match=r"broken\.toml' is not valid TOML"):
        Scene.from_toml(path)


def test_values_beside_a_named_set_win():
    scene = Scene.from_toml("mtm_zddp", {"tribofilm.full_thickness": "150 nm"})
    assert scene.tribofilm.full_thickness == 150e-9
    assert scene.tribofilm.removal_thickness == 54.32e-9


def test_two_nodes_per_correlation_length_are_asked_for_by_a_warning():
    (warning,) = Scene.from_toml("mtm_zddp", GRID | {"surface_1.correlation_length": "5 um"}).warnings()
    assert "surface_1 has 1.28 nodes per correlation length" in warning


HOT = {"operation.temperature": "100 degC"}


def test_a_temperature_far_from_that_of_the_film_constants_is_refused_with_the_way_out():
    told = r"operation\.temperature = 373\.15 K is outside 348\.15 K to 358\.15 K"
    with pytest.raises(SceneError, match=told) as error:
        Scene.from_toml("mtm_zddp", HOT)
    assert "tribofilm.beyond_fit = 'extrapolate'" in str(error.value)


def test_the_temperature_of_a_step_is_checked_like_that_of_the_scene():
    table = Scene.from_toml("mtm_zddp").to_dict()
    table["operation"]["steps"] = [{"time": "60 s", "temperature": "100 degC"}]
    with pytest.raises(SceneError, match=r"operation\.steps\[0\]\.temperature = 373\.15 K"):
        Scene.from_dict(table)


def test_constants_taken_beyond_their_fit_give_a_warning():
    (warning,) = Scene.from_toml("mtm_zddp", HOT | {"tribofilm.beyond_fit": "extrapolate"}).warnings()
    assert "373.15 K" in warning
    assert not Scene.from_toml("mtm_zddp", HOT | {"tribofilm.model": "none"}).warnings()


def test_the_digest_follows_shape_surfaces_and_grid_only():
    scene = Scene.from_toml("mtm_zddp")
    other = [
        {"surface_1.seed": "7"},
        {"surface_2.rq": "50 nm"},
        {"geometry.radius_x": "10 mm"},
        {"film.points": "257"},
        {"film.domain": "0.6 mm"},
    ]
    digests = {Scene.from_toml("mtm_zddp", change).digest() for change in other} | {scene.digest()}
    assert len(digests) == len(other) + 1
    assert Scene.from_toml("mtm_zddp", {"wear.bare": "2e-5", "film.tolerance": "1e-3"}).digest() == scene.digest()


def test_tunables_are_the_numbers_that_shape_no_array():
    scene = Scene.from_toml("mtm_zddp")
    values = {name: value for name, (value, _) in tunables(scene).items()}
    assert values["geometry.track_length_1"] == scene.geometry.track_length_1
    assert values["lubricant.viscosity.viscosity"] == 0.004
    assert values["surface_1.seed"] == 1
    assert not {"film.points", "film.domain", "surface_1.correlation_length", "tribofilm.dose"} & set(values)
    assert not any(name.startswith("operation.") for name in values)


def test_radii_are_no_tunables_because_they_are_inputs():
    assert not {"geometry.radius_x", "geometry.radius_y"} & set(tunables(Scene.from_toml("mtm_zddp")))


def test_a_tunable_can_be_changed_and_the_rest_stays():
    scene = Scene.from_toml("mtm_zddp")
    changed = with_values(scene, {"wear.bare": 2e-5, "lubricant.rheology.eyring_stress": 7e6, "surface_1.seed": 5})
    given = {"wear.bare": "2e-5", "lubricant.rheology.eyring_stress": "7 MPa", "surface_1.seed": "5"}
    expected = Scene.from_toml("mtm_zddp", given)
    assert changed == replace(expected, intervals=scene.intervals)  # what is given is not assumed any more
    assert with_values(scene, {name: value for name, (value, _) in tunables(scene).items()}) == scene


def test_a_tunable_out_of_range_is_refused_by_name():
    with pytest.raises(SceneError, match=r"wear\.bare = nan .* must be finite"):
        with_values(Scene.from_toml("mtm_zddp"), {"wear.bare": float("nan")})


@pytest.mark.parametrize("name", ["wear.bear", "film.points"])
def test_what_is_not_tunable_is_refused_by_name(name):
    with pytest.raises(SceneError, match=f"'{name}' is not a number that can be changed"):
        with_values(Scene.from_toml("mtm_zddp"), {name: 1.0})


def test_realisation_zero_is_the_scene_and_others_change_the_surfaces_only():
    scene = Scene.from_toml("mtm_zddp")
    assert scene.realisation(0) == scene
    other = scene.realisation(3)
    assert other.surface_1.seed != scene.surface_1.seed
    assert other.surface_2.seed != scene.surface_2.seed
    assert other == scene.realisation(3)
    back = {"surface_1.seed": scene.surface_1.seed, "surface_2.seed": scene.surface_2.seed}
    assert with_values(other, back) == scene


def test_no_two_realisations_nor_neighbouring_seeds_share_a_surface():
    scene = Scene.from_toml("mtm_zddp")
    for name in ("surface_1", "surface_2"):
        seeds = sorted(getattr(scene.realisation(number), name).seed for number in range(10_000))
        gaps = [late - early for early, late in pairwise([*seeds, seeds[0] + 2**31])]
        assert min(gaps) >= 100_000
    assert all(0 <= seed < 2**31 for seed in seeds)


@pytest.mark.parametrize("number", [1, 2, 9_999, 2**31 - 1])
def test_every_realisation_is_a_scene_that_passes_its_checks(number):
    assert Scene.from_toml("mtm_zddp").realisation(number).check() == []


@pytest.mark.parametrize("number", [-1, 2**31])
def test_a_realisation_out_of_range_is_refused(number):
    with pytest.raises(SceneError, match=rf"seed = {number} must be at least 0 and at most 2147483647"):
        Scene.from_toml("mtm_zddp").realisation(number)


@pytest.mark.parametrize(
    ("point", "named"),
    [
        (OperatingPoint(-1.0, 1.0, 1.0, 350.0), "load = -1 N"),
        (OperatingPoint(float("nan"), 1.0, 1.0, 350.0), "load = nan N"),
        (OperatingPoint(1.0, float("inf"), 1.0, 350.0), "speed_1 = inf m/s"),
        (OperatingPoint(1.0, 1.0, -1e4, 350.0), "speed_2 = -10000 m/s"),
        (OperatingPoint(1.0, 1.0, 1.0, 80.0), "temperature = 80 K"),
    ],
)
def test_an_impossible_operating_point_is_refused_by_name(point, named):
    with pytest.raises(OperatingPointError) as error:
        point.check()
    assert named in str(error.value)
    assert "must be" in str(error.value)


def test_zero_load_is_an_operating_point():
    OperatingPoint(0.0, 0.0, 0.0, 350.0).check()


def test_a_model_that_a_named_set_already_has_may_be_set_again():
    assert Scene.from_toml("mtm_zddp", {"tribofilm.model": "ghanbarzadeh"}) == Scene.from_toml("mtm_zddp")
    assert Scene.from_toml("mtm_zddp", {"heat.model": "none"}).heat.name == "none"


@pytest.mark.parametrize("name", ["", "../out", "two words"])
def test_a_name_that_no_file_can_have_is_refused(name):
    with pytest.raises(SceneError, match=r"name = .* must be letters, digits"):
        Scene.from_toml("mtm_zddp", {"name": name})


def test_a_correlation_length_too_long_for_the_domain_is_refused():
    with pytest.raises(SceneError, match=r"surface_1\.correlation_length = 0\.001 m is too long for film\.domain"):
        Scene.from_toml("mtm_zddp", {"surface_1.correlation_length": "1 mm"})


@pytest.mark.parametrize(("former", "correction"), [("auto", "blocks"), ("map", "map")])
def test_a_former_model_of_the_film_is_read_as_a_correction_with_a_note(
    former: str, correction: str, caplog: pytest.LogCaptureFixture
) -> None:
    asked = Scene.from_toml("mtm_zddp", {"film.model": former})
    table = asked.to_dict()
    table["film"] = {key: value for key, value in table["film"].items() if key != "correction"} | {"model": former}
    given = Scene.from_dict(table)
    assert asked == given == Scene.from_toml("mtm_zddp").at_level(asked.film.fidelity)
    assert asked == Scene.from_toml("mtm_zddp").at_level(correction)
    assert (asked.film.name, asked.to_dict()["film"]["correction"]) == ("regression", correction)
    assert caplog.text.count(f"film.model = '{former}' is film.model = 'regression' with film.correction") == 2
