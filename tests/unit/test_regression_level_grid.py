"""The grid of the patches is no input of the regression level: neither nodes nor domain change an output of it."""

from dataclasses import asdict, replace

import pytest
from comparison import approx

from contact_core import Scene, advance, initial_state
from contact_core.state import Mean

SCENES = ("azam_case_a", "mtm_zddp", "ball_209_inner", "fzg_flank", "cam_tappet")
GROWN = Mean(growth=40e-9, removal=2e-9, coverage=0.6, wear=5e-9, roughness=90e-9, worn=1e-15, cycles=1e4)
GRIDS = {
    "fewer nodes": lambda film: {"points": film.points // 2 + 1},
    "more nodes": lambda film: {"points": film.points + 32},
    "wider": lambda film: {"domain": 1.5 * film.domain},
}
ROUNDING, OF_DIFFERENCES = 1e-9, 1e-7  # the derivatives are differences over a millionth, errors know one of them


def outputs(scene, means, seconds):
    """All numbers of the level, after `seconds` on surfaces of the means; None: new ones."""
    state = initial_state(scene)
    state = state if means is None else replace(state, means=means)
    _, found = advance(scene, scene.operation.point, state, seconds)
    return asdict(found)


@pytest.mark.parametrize("means", [None, (GROWN, GROWN)], ids=["new", "under a tribofilm"])
@pytest.mark.parametrize("grid", GRIDS)
@pytest.mark.parametrize("name", SCENES)
def test_the_grid_changes_no_output(name, grid, means):
    shipped = Scene.from_toml(name, {"film.model": "regression"})
    other = replace(shipped, film=replace(shipped.film, **GRIDS[grid](shipped.film)))
    assert other.film != shipped.film
    for seconds in (0.0, 1800.0):
        expected, found = outputs(shipped, means, seconds), outputs(other, means, seconds)
        assert expected["friction_coefficient"] > 0.0
        for key, value in expected.items():
            rel = OF_DIFFERENCES if key.startswith(("dfriction", "error")) else ROUNDING
            assert found[key] == approx(value, rel=rel), key


def test_a_body_at_rest_has_its_means_over_the_patch():
    """Its track is as long as film.domain: the wear depth is the volume over that, friction and film are the same."""
    shipped = Scene.from_toml("mtm_zddp", {"film.model": "regression"})
    wider = replace(shipped, film=replace(shipped.film, domain=2.0 * shipped.film.domain))
    point = replace(shipped.operation.point, speed_1=0.0)
    one, two = (advance(scene, point, initial_state(scene), 0.0)[1] for scene in (shipped, wider))
    assert one.friction_coefficient == approx(two.friction_coefficient, rel=ROUNDING)
    one, two = (advance(scene, point, initial_state(scene), 1e-3)[1] for scene in (shipped, wider))
    assert one.wear_depth_1 == approx(2.0 * two.wear_depth_1, rel=1e-3)
