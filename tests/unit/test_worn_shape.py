"""The regression level says when wear has changed the shape of the bodies, which it keeps."""

from dataclasses import replace

import pytest

from contact_core import Outputs, RangeFlag, Scene, advance, initial_state

AGES = 1e9  # s: the longest step


def worn(name: str, size: float) -> tuple[Scene, Outputs]:
    scene = Scene.from_toml(name).at_level("regression")
    return scene, advance(scene, scene.operation.point, initial_state(scene), size)[1]


@pytest.mark.parametrize("name", ["mtm_zddp", "pin_on_disc"])
def test_wear_as_deep_as_the_contact_is_wide_is_flagged_and_that_of_the_scene_is_not(name: str) -> None:
    scene, outputs = worn(name, AGES)
    assert max(outputs.wear_depth_1, outputs.wear_depth_2) > scene.hertz(scene.operation.load).a
    assert RangeFlag.WORN_SHAPE in RangeFlag(outputs.range_flags)
    scene, outputs = worn(name, scene.operation.duration)
    assert RangeFlag.WORN_SHAPE not in RangeFlag(outputs.range_flags)


def test_the_same_scar_matters_more_to_a_smaller_contact() -> None:
    """It is deep for the contact at a light load alone."""
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    point = scene.operation.point
    scar, size = 0.1 * scene.hertz(point.load).a, 3600.0
    new = initial_state(scene)
    while True:
        state, found = advance(scene, point, new, size)
        if 0.9 * scar < found.wear_depth_1 < scar:
            break
        size *= 0.95 * scar / found.wear_depth_1
    _, lighter = advance(scene, replace(point, load=0.2 * point.load), state, 0.0)
    assert RangeFlag.WORN_SHAPE not in RangeFlag(found.range_flags)
    assert RangeFlag.WORN_SHAPE in RangeFlag(lighter.range_flags)
