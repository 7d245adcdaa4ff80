"""Numbers that look like mistakes are doubted, with the way out; those of the shipped scenes are not."""

from dataclasses import replace

import pytest

from contact_core import Scene, SceneError, shipped_scenes


@pytest.mark.parametrize("name", shipped_scenes())
def test_no_shipped_scene_is_doubted(name):
    assert Scene.from_toml(name).doubts() == []


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"surface_2.rq": "20 um"},
            ["surface_2 has an rms slope of 5", "correlation length of 8e-06 m", "right unit (nm, um)?"],
        ),
        (
            {"surface_2.rq": "0.1 mm"},
            ["surface_2 has 0.0001 m rms", "presses smooth bodies together by 2.3e-06 m only", "right unit (nm, um)?"],
        ),
        (
            {"operation.speed_2": "-0.0975 m/s"},
            ["speed_2 = -0.0975 m/s are against each other", "ratio is +8000 %", "0.0025 m/s draw oil in"],
        ),
        ({"operation.speed_2": "-0.1025 m/s"}, ["ratio is infinite"]),
        (
            {"operation.load": "0.1 N", "operation.speed_1": "90 m/s", "operation.speed_2": "90 m/s"},
            ["operation: the film of smooth bodies would be", "thick in a contact only", "in the right units?"],
        ),
        (  # thicker than an ellipse is long, thinner than it is wide
            {"operation.load": "0.1 N", "geometry.radius_y": "0.1 m", "film.width": "3 mm"}
            | {f"operation.speed_{i}": "3 m/s" for i in (1, 2)},
            ["would be 6.3e-05 m thick in a contact only 2.4e-05 m long"],
        ),
    ],
)
def test_a_likely_mistake_is_doubted_with_the_way_out(changes, said):
    doubts = " ".join(Scene.from_toml("mtm_zddp", changes).doubts())
    for words in said:
        assert words in doubts


def test_the_steps_of_a_duty_are_doubted_too():
    table = Scene.from_toml("mtm_zddp").to_dict()
    table["operation"]["steps"] = [{"time": "60 s", "speed_2": "-0.1 m/s"}]
    (doubt,) = Scene.from_dict(table).doubts()
    assert doubt.startswith("operation.steps[0]: speed_1 = 0.1025 m/s and speed_2 = -0.1 m/s")


@pytest.mark.parametrize("speed", ["0 m/s", "-0.03 m/s"])  # a body at rest; a cam's follower that turns back
def test_bodies_at_rest_and_slow_counter_motion_are_no_mistakes(speed):
    assert Scene.from_toml("mtm_zddp", {"operation.speed_2": speed}).doubts() == []


def test_a_refusal_that_follows_from_an_impossible_roughness_names_that_first():
    with pytest.raises(SceneError) as refusal:
        Scene.from_toml("mtm_zddp", {"surface_2.rq": "0.1 mm", "surface_2.correlation_length": "4 mm"})
    said = str(refusal.value)
    assert said.index("surface_2 has 0.0001 m rms") < said.index("too long for film.domain")


def test_points_that_are_given_are_doubted_in_place_of_the_scenes_and_the_first_of_many_is_told():
    scene = Scene.from_toml("mtm_zddp", {"operation.speed_2": "-0.1 m/s"})
    good, bad = (replace(scene.operation.point, speed_2=speed) for speed in (0.1, -0.11))
    assert scene.doubts([("row 1", good)]) == []
    (doubt,) = scene.doubts([("row 1", good), ("row 2", bad), ("row 3", replace(bad, load=2.0)), ("row 4", bad)])
    assert doubt.startswith("row 2: speed_1 = 0.1025 m/s and speed_2 = -0.11 m/s")
    assert doubt.endswith("of the same sign. 1 more are like it.")
