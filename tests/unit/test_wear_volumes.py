"""Wear volumes are conserved: a body loses the depth over its track, the sum of its rates, and what Archard says."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from contact_core import advance, initial_state, run_cycle, track_of, uncertainty
from contact_core.deterministic.block import solve_block
from contact_core.deterministic.friction import sliding
from contact_core.deterministic.growth_and_wear import evolved
from contact_core.scene import Case
from contact_core.shapes import LineGeometry

FACE = 0.8e-3
BARE = {"tribofilm.model": "none"}
UNEQUAL = {"wear.sliding": "surface_speed", "wear.bare": "1e-7"}  # each body wears by its own speed
DRY = CHEAP | {"control.driver": "dry", "control.dry_instants": "2"}
LINE = DRY | {
    "geometry.model": "line",
    "geometry.face_width": "0.8 mm",
    "operation.load": "100 N",
    "film.width": "0.25 mm",  # the face is 3.2 times as long
}
ROLLER = LINE | {
    "geometry.model": "roller",
    "geometry.profile.model": "logarithmic",
    "geometry.profile.depth": "0.5 um",
    "film.width": "0 m",
}
SHAPES = {"point": DRY, "line": LINE, "roller": ROLLER}
LEVELS = ("deterministic", "regression")
STEPS = (0.5, 4.0, 20.0)


def contact(shape, level, **more):
    scene, _, op = cheap(SHAPES[shape] | UNEQUAL, **more)
    scene = scene.at_level(level)
    return scene, initial_state(scene), replace(op, speed_1=0.3, speed_2=0.1)


def ran(scene, state, op, steps=STEPS):
    found = []
    for dt in steps:
        state, outputs = advance(scene, op, state, dt)
        found.append(outputs)
    return state, found


def of(outputs, name):
    return np.array([getattr(outputs, f"{name}_1"), getattr(outputs, f"{name}_2")])


def depth_times_area(scene, state):
    """Volumes [m3] of the depths on the patches, laid along the tracks and, of a line, along its face."""
    found = []
    for body, length in enumerate((scene.geometry.track_length_1, scene.geometry.track_length_2), 1):
        track = track_of(scene, state, body)
        rows = track.y.size * scene.film.spacing
        across = scene.geometry.face_width if isinstance(scene.geometry, LineGeometry) else rows
        found.append(float(track.wear.mean()) * across * length)
    return np.array(found)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("shape", SHAPES)
def test_volumes_are_the_sum_of_the_rates_and_the_depth_over_the_track_of_each_body(shape, level):
    scene, state, op = contact(shape, level)
    state, found = ran(scene, state, op)
    volumes = of(found[-1], "wear_volume")
    assert volumes == approx(sum(of(out, "wear_rate") * dt for out, dt in zip(found, STEPS, strict=True)), rel=1e-9)
    assert volumes[0] > 1.5 * volumes[1] > 0.0
    # tracks of the regression level are as wide as Hertz's contact, patches have whole rows of them
    width = 2.0 * scene.hertz(op.load).b
    near = 1e-9 if level == "deterministic" or shape == "line" else scene.film.spacing / width
    assert depth_times_area(scene, state) == approx(volumes, rel=near)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("speeds", [(0.3, 0.1), (0.3, -0.1), (0.0, 0.2), (0.2, 0.0)])
@pytest.mark.parametrize("shape", SHAPES)
def test_bare_bodies_lose_what_archard_says_of_the_load_on_their_solids(shape, speeds, level):
    """K W_c W u / H: each body by its own speed here, whatever the shape, the track, and who is at rest."""
    scene, state, op = contact(shape, level, tribofilm__model="none")
    op = replace(op, speed_1=speeds[0], speed_2=speeds[1])
    state, _ = advance(scene, op, state, 0.0)
    _, (found,) = ran(scene, state, op, [1e-3])
    solids = found.contact_load_ratio * op.load
    expected = scene.wear.bare * solids * np.abs(speeds) / scene.plasticity.hardness
    assert of(found, "wear_rate") == approx(expected, rel=1e-6)
    assert of(found, "wear_volume") == approx(1e-3 * expected, rel=1e-6)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_cycle_takes_the_volume_that_its_depths_have(shape):
    scene, state, op = contact(shape, "deterministic", film__tolerance="1e-2")
    times = np.linspace(0.0, 6e-5, 3)
    duty = lambda time: replace(op, load=op.load * (1.0 + 2e3 * time))  # noqa: E731
    state, moments = run_cycle(scene, state, duty, times, 1e3)
    worn = np.array([body.worn for body in state.bodies])
    assert depth_times_area(scene, state) == approx(worn, rel=1e-9)
    solids = [moment.outputs["contact_load_ratio"] * moment.op.load for moment in moments]
    slid = 1e3 * np.diff([moment.time for moment in moments]) @ solids[1:]
    expected = scene.wear.bare * slid * np.array([op.speed_1, op.speed_2]) / scene.plasticity.hardness
    assert worn == approx(expected, rel=1e-6)


@pytest.mark.parametrize("i", [0, 1])
def test_wear_under_a_film_that_grows_within_a_block_is_of_second_order_in_the_steps(i):
    """The integral of K(film) p v / H, the film by its closed form, with the solution of one block held."""
    scene, state, op = contact("point", "deterministic", tribofilm__supply_rate="1 m/s")
    case = Case(scene, op)
    body, law, wear, flash = solve_block(case, state).bodies[i], scene.tribofilm, scene.wear, 0.0
    span = 0.1 / body.exposure.max()
    nodes, weights = np.polynomial.legendre.leggauss(8)
    exact = np.zeros_like(body.wear)
    for time, weight in zip(0.5 * span * (1.0 + nodes), 0.5 * span * weights, strict=True):
        growth, removal = law.evolve(body.growth, body.removal, body.exposure * time, 0.0, op.bodies[i] + flash)
        cover = (growth - removal) / law.full_thickness
        exact += weight * wear.coefficient(cover, law.full_thickness) * body.pressure
    exact *= abs((op.speed_1, op.speed_2)[i]) / scene.plasticity.hardness
    off = []
    for count in (1, 2, 4):
        after = body
        for _ in range(count):
            after = evolved(case, case.sides[i], after, span / count, flash)
        off.append(abs(after.wear.sum() / exact.sum() - 1.0))
    assert off[0] < 0.02
    assert np.log2(np.divide(off[:-1], off[1:])) == approx([2.0, 2.0], abs=0.15)


def test_wear_under_a_growing_film_does_not_wait_for_fine_steps_at_the_regression_level():
    """Between bodies that roll against each other nothing but the film changes: solids carry all of the load."""
    volumes = []
    for change in ("10 nm", "0.3 nm"):
        scene, state, op = contact("point", "regression", control__change=change)
        _, (found,) = ran(scene, state, replace(op, speed_1=0.2, speed_2=-0.2), [300.0])
        assert found.tribofilm_1 > 40e-9
        volumes.append(of(found, "wear_volume"))
    assert volumes[0] == approx(volumes[1], rel=6e-3)


def test_rates_of_bodies_that_warm_up_are_those_of_the_whole_step():
    bulk = {
        f"heat.bulk.{name}_{i}": value
        for i in "12"
        for name, value in (("heat_capacity", "1 J/K"), ("conductance", "0.2 W/K"))
    }
    changes = DRY | UNEQUAL | bulk | {"heat.bulk.model": "lumped", "tribofilm.beyond_fit": "extrapolate"}
    for level in LEVELS:
        scene, state, op = cheap(changes)
        scene = scene.at_level(level)
        state, found = ran(scene, state, replace(op, speed_1=1.0, speed_2=0.4))
        assert found[-1].temperature_1 > op.temperature + 1.0
        for dt, then, now in zip(STEPS[1:], found[:-1], found[1:], strict=True):
            assert of(now, "wear_rate") * dt == approx(of(now, "wear_volume") - of(then, "wear_volume"), rel=1e-9)


@pytest.mark.parametrize("level", LEVELS)
def test_a_body_that_only_spins_wears_by_the_way_its_points_slide_under_hertzs_pressure(level):
    """The mean of r under that of a circle is 3 pi a / 16; a level that knows rows takes the mean of |x| on each."""
    smooth = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}
    scene, state, op = cheap(DRY | BARE | smooth, film__points=65)
    scene, op = scene.at_level(level), replace(op, speed_1=1e-6, speed_2=1e-6, spin=200.0)
    _, (found,) = ran(scene, state, op, [1e-3])
    assert found.contact_load_ratio > 0.98
    slide = 200.0 * 3.0 * np.pi / 16.0 * scene.hertz_at(op).a
    expected = scene.wear.bare * found.contact_load_ratio * op.load * slide / scene.plasticity.hardness
    assert of(found, "wear_rate") == approx([expected, expected], rel=0.04)


@pytest.mark.parametrize("spin", [100.0, -100.0])
@pytest.mark.parametrize("turned", [1.0, -1.0])
def test_each_side_of_a_spinning_track_wears_as_fast_as_friction_says_that_it_slides(spin, turned):
    smooth = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}
    scene, state, op = cheap(DRY | BARE | smooth, film__points=65)
    op = replace(op, speed_1=0.3 + turned * 0.006, speed_2=0.3, spin=spin)
    state, _ = advance(scene, op, state, 1e-3)
    grid = scene.grid(scene.rows)
    x, y = grid.x[None, :-1], grid.y[:, None]
    hertz = scene.hertz_at(op)
    pressure = np.sqrt(np.maximum(1.0 - (x / hertz.a) ** 2 - (y / hertz.b) ** 2, 0.0))
    expected = (pressure * sliding(op, grid)[0][:, :-1]).sum(axis=1)
    upper, lower = grid.y > 0.0, grid.y < 0.0
    share = expected[upper].sum() / expected[lower].sum()
    assert abs(np.log(share)) > 0.5  # one side slides much faster
    for body in state.bodies:
        worn = body.wear.mean(axis=1)
        assert worn[upper].sum() / worn[lower].sum() == approx(share, rel=0.05)
        assert worn / worn.sum() == approx(expected / expected.sum(), rel=0.1, abs=0.002)


def test_ten_times_the_wear_in_a_tenth_of_the_time_is_the_same_run():
    """Without a tribofilm nothing else has a time: depths, volumes, roughness and what is said of their errors."""
    found = []
    for faster in (1.0, 10.0):
        scene, state, op = cheap(DRY | BARE, wear__bare=1e-5 * faster, control__longest=f"{60.0 / faster} s")
        state, outputs = ran(scene, state, op, [90.0 / faster, 90.0 / faster])
        found.append((asdict(outputs[-1]), uncertainty(scene, state), [body.noise for body in state.bodies]))
    (one, widths, noise), (other, others, quick) = found
    for name in (
        "wear_volume_1",
        "wear_depth_2",
        "roughness_1",
        "roughness_2",
        "friction_force",
        "error_wear",
        "blocks_dry",
    ):
        assert other[name] == approx(one[name], rel=1e-6), name
    assert 10.0 * one["wear_rate_1"] == approx(other["wear_rate_1"], rel=1e-6)
    for name in ("wear_depth_1", "wear_depth_2", "roughness_1", "roughness_2"):
        assert others[name] == approx(widths[name], rel=1e-6), name
    assert quick == approx(noise, rel=1e-6)
    assert min(noise) > 0.0


@pytest.mark.long
def test_volumes_of_both_levels_differ_by_no_more_than_the_fast_one_says_and_by_more_than_a_tenth_of_it():
    """A minute on a grid beyond the fit, at two speeds."""
    scene, state, op = cheap(control__mixed_instants="4")
    ratios = []
    for speed in (0.05, 0.25):
        now = replace(op, speed_1=0.99 * speed, speed_2=1.01 * speed)
        solved, quick = (advance(scene.at_level(level), now, state, 60.0)[1] for level in LEVELS)
        ratios.append(np.abs(of(solved, "wear_volume") / of(quick, "wear_volume") - 1.0) / quick.error_wear)
    assert np.max(ratios) <= 1.0
    assert np.max(ratios) > 0.1
