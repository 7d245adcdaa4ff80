"""The scenes of the joint reading of the thesis say every convention, keep the contact, and bear out its claims."""

from functools import cache

import pytest
from comparison import approx

from contact_core import Outputs, Scene, advance, initial_state
from contact_core.scene.toml import flat, read_table

PAIRS = (("azam_case_a", "azam_case_a_thesis"), ("mtm_zddp", "mtm_zddp_thesis"))
CONVENTIONS = {
    "tribofilm.dose": "contact_length",
    "plasticity.indentation": "total",
    "wear.sliding": "surface_speed",
    "film.criterion": "split",
    "film.flux": "upwind",
    "film.floor": "1 nm",
    "control.driver": "mixed",
}


@pytest.mark.parametrize("name", [name for _, name in PAIRS])
def test_a_scene_of_the_thesis_says_its_conventions_and_leaves_none_to_a_default(name):
    said = flat(read_table(name))
    assert {key: said.get(key) for key in CONVENTIONS} == CONVENTIONS
    assert {key for key in said if "microroughness" in key} == set()


@pytest.mark.parametrize("name", [name for _, name in PAIRS])
def test_the_roughness_of_a_scene_of_the_thesis_is_white_on_its_grid(name):
    scene = Scene.from_toml(name)
    lengths = [surface.correlation_length for surface in (scene.surface_1, scene.surface_2)]
    assert lengths == approx([scene.film.spacing] * 2, rel=1e-12)


@pytest.mark.parametrize(("shipped", "name"), PAIRS)
def test_a_scene_of_the_thesis_has_the_contact_of_the_shipped_one(shipped, name):
    ours, theirs = Scene.from_toml(shipped), Scene.from_toml(name)
    for part in ("geometry", "solids", "lubricant", "operation", "boundary_friction", "heat"):
        assert getattr(theirs, part) == getattr(ours, part)
    for body in ("surface_1", "surface_2"):
        assert (getattr(theirs, body).rq, getattr(theirs, body).seed) == (
            getattr(ours, body).rq,
            getattr(ours, body).seed,
        )
    assert (theirs.wear.bare, theirs.wear.film) == (ours.wear.bare, ours.wear.film)
    assert theirs.tribofilm.full_thickness == ours.tribofilm.full_thickness


@cache
def first_minutes(srr: float) -> list[Outputs]:
    """Case A at a slide-to-roll ratio: outputs at the start and after 1 to 3 min, on 33 nodes, white on them.

    A block samples one pass: the film of neighbouring instants scatters by more than what it rises by.
    """
    coarse = {
        "film.points": "33",
        "control.mixed_instants": "32",
        "surface_1.correlation_length": "15.625 um",
        "surface_2.correlation_length": "15.625 um",
    }
    speeds = {f"operation.speed_{i}": f"{0.25 * (1.0 + sign * srr / 2.0)} m/s" for i, sign in ((1, 1.0), (2, -1.0))}
    scene = Scene.from_toml("azam_case_a_thesis", coarse | speeds)
    state, out = advance(scene, scene.operation.point, initial_state(scene), 0.0)
    rows = [out]
    for _ in range(3):
        state, out = advance(scene, scene.operation.point, state, 60.0)
        rows.append(out)
    return rows


@pytest.mark.long
def test_the_film_covers_the_ball_at_once_and_ever_more_of_the_disc():
    """Figures 5-7 to 5-9: the clock's cover of the disc stands still from the first minutes on."""
    ball, disc = ([getattr(out, f"coverage_{i}") for out in first_minutes(-0.02)[1:]] for i in (1, 2))
    films = [out.tribofilm_2 for out in first_minutes(-0.02)]
    assert min(ball) >= 0.95
    assert disc == sorted(disc)
    assert disc[-1] - disc[0] > 0.01
    assert disc[-1] < 0.95
    assert films == sorted(films)


def test_the_central_film_rises_with_the_tribofilm():
    """Figures 6-4 and 6-5: a hump in the first minutes."""
    start, *later = first_minutes(-0.02)
    assert max(out.h_c for out in later) > 1.02 * start.h_c
    assert max(out.lambda_ratio for out in later) > 1.02 * start.lambda_ratio


def test_the_ball_wears_almost_four_times_as_deep_as_the_disc():
    """Figures 7-3 and 7-4: the ratio of the track lengths."""
    out = first_minutes(-0.02)[-1]
    assert out.wear_depth_1 / out.wear_depth_2 == approx(3.8, rel=0.15)


@pytest.mark.long
def test_each_body_wears_more_the_faster_it_moves():
    """Figures 7-4, 7-5 and 7-8, by 10 % either way; wear by |u1 - u2| would be the same at both."""
    slow, fast = first_minutes(-0.1)[-1], first_minutes(0.1)[-1]
    assert fast.wear_depth_1 > 1.05 * slow.wear_depth_1
    assert slow.wear_depth_2 > 1.05 * fast.wear_depth_2
