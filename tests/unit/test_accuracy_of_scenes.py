"""`control.accuracy`: grid, tolerance, blocks and instants that a scene does not give are chosen for an accuracy."""

import re

import pytest

from contact_core import Scene, SceneError
from contact_core.scene.accuracy import POINTS

SCENES = ("azam_case_a", "mtm_zddp", "fzg_flank", "ball_209_inner")


def asked(scene, accuracy, **changes):
    return Scene.from_toml(
        scene, {"control.accuracy": accuracy} | {k.replace("__", "."): v for k, v in changes.items()}
    )


@pytest.mark.parametrize("scene", SCENES)
def test_a_smaller_error_takes_no_fewer_nodes_instants_and_blocks(scene):
    rough, fine = asked(scene, "20 %"), asked(scene, "5 %")
    assert rough.film.points <= fine.film.points in POINTS
    assert rough.control.change > fine.control.change
    assert rough.control.dry_instants <= fine.control.dry_instants
    assert rough.control.mixed_instants < fine.control.mixed_instants


def test_a_sharper_request_takes_a_finer_grid_somewhere():
    assert asked("mtm_zddp", "5 %").film.points > asked("mtm_zddp", "20 %").film.points


def test_dry_blocks_have_more_instants_where_less_error_is_asked_for_and_never_fewer_than_shipped():
    given = {"film.points": "129"}
    fine, rough = (Scene.from_toml("mtm_zddp", {"control.accuracy": a} | given) for a in ("2 %", "50 %"))
    assert fine.control.dry_instants > rough.control.dry_instants == Scene.from_toml("mtm_zddp").control.dry_instants


def test_what_is_given_beside_the_accuracy_stays():
    scene = asked("mtm_zddp", "5 %", film__points="33", control__change="7 nm", surface_1__correlation_length="16 um",
                  surface_2__correlation_length="16 um")  # fmt: skip
    assert (scene.film.points, scene.control.change) == (33, 7e-9)
    assert scene.film.domain == Scene.from_toml("mtm_zddp").film.domain
    assert scene.control.dry_instants == asked("mtm_zddp", "5 %").control.dry_instants


def test_a_scene_with_chosen_fields_is_the_same_from_its_table():
    scene = asked("azam_case_a", "10 %")
    assert Scene.from_dict(scene.to_dict()) == scene


def test_a_file_needs_no_grid_and_no_blocks_beside_an_accuracy():
    table = Scene.from_toml("mtm_zddp").to_dict()
    for part, names in (("film", ("points", "domain", "tolerance")), ("control", ("change",))):
        for name in names:
            del table[part][name]
    assert Scene.from_dict(table).film.tolerance == 3e-3
    table["control"]["accuracy"] = "10 %"
    scene = Scene.from_dict(table)
    assert scene.film.domain > 2.4 * scene.hertz(scene.operation.load).a
    assert scene.film.points in POINTS


def test_an_accuracy_that_no_grid_gives_is_refused_with_what_can_be_had():
    said = r"control\.accuracy = 0\.1 % cannot be had: .* by the grid alone is [\d.]+ %\. Give at least [\d.]+ %"
    with pytest.raises(SceneError, match=said):
        asked("mtm_zddp", "0.1 %")


def test_the_accuracy_that_a_refusal_names_can_be_had():
    with pytest.raises(SceneError) as refusal:
        asked("mtm_zddp", "0.1 %")
    least = float(re.search(r"at least ([\d.]+) %", str(refusal.value))[1])
    assert asked("mtm_zddp", f"{1.01 * least} %").film.points == POINTS[-1]


def test_the_regression_level_is_given_any_accuracy_and_chooses_no_grid_for_it():
    fine, rough = (asked("mtm_zddp", accuracy, film__model="regression") for accuracy in ("0.1 %", "20 %"))
    assert fine.film == rough.film
    own = asked("cam_tappet", "1 %", film__points="65")
    assert own.film.points == 65


def test_heavier_and_slower_steps_of_a_duty_count():
    slow = {"time": "60 s", "speed_1": "0.01 m/s", "speed_2": "0.01 m/s"}
    table = Scene.from_toml("azam_case_a", {"control.accuracy": "20 %"}).to_dict()
    del table["film"]["points"]
    alone = Scene.from_dict(table)
    table["operation"]["steps"] = [slow]
    assert Scene.from_dict(table).film.points > alone.film.points


@pytest.mark.parametrize("value", ["0 %", "120 %", "-5 %"])
def test_an_accuracy_out_of_range_is_refused(value):
    with pytest.raises(SceneError, match=r"control\.accuracy"):
        asked("mtm_zddp", value)
