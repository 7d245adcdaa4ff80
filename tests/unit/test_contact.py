"""One instant: fluid and solids together, from dry to full film, and what `solve` promises about it."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import HARD, approx
from independent import judge

from contact_core import OperatingPoint, OperatingPointError, Scene, Transient, initial_state, solve

ROUGH = {  # 4 nodes per correlation length
    "film.points": "65",
    "surface_1.correlation_length": "31 um",
    "surface_2.correlation_length": "31 um",
    "film.tolerance": "1e-3",
    "film.iterations": "500",
}
AGES = 1e9  # s: a time step in which any squeeze film has settled
COARSE = ROUGH | {"film.points": "33"}


def rough(changes=ROUGH, **more):
    scene = Scene.from_toml(
        "azam_case_a", changes | {key.replace("__", "."): str(value) for key, value in more.items()}
    )
    return scene, initial_state(scene)


def at(scene, entrainment, slide_roll=-0.02, load=77.85):
    return OperatingPoint(
        load,
        entrainment * (1.0 + 0.5 * slide_roll),
        entrainment * (1.0 - 0.5 * slide_roll),
        scene.operation.temperature,
    )


def mean_gap(scene, fields):
    a = scene.hertz(77.85).a
    return fields.gap[np.hypot(fields.x[None, :], fields.y[:, None]) < 2.0 / 3.0 * a].mean()


def solid_share(fields):
    return fields.solid_pressure.sum() / fields.pressure.sum()


def distance(one, other):
    return np.abs(one.pressure - other.pressure).sum() / other.pressure.sum()


def marched(scene, state, op, steps=100):
    """Resting surfaces under moving oil, instant by instant from the full film of a much faster contact."""
    fields = solve(scene, at(scene, 20.0), state)
    assert solid_share(fields) < 1e-3
    for _ in range(steps):
        state = replace(state, film=fields.film)
        fields = solve(scene, op, state, Transient(2.0 * scene.film.spacing / op.entrainment_speed, 0, 60))
    return fields


@pytest.mark.parametrize(  # fitted flow holds a film at a hundredth of the speed
    ("flux", "speed"),
    [pytest.param("fitted", 0.005, marks=pytest.mark.long), ("fitted", 0.04), ("upwind", 0.25), ("upwind", 4.0)],
)
def test_fluid_and_solids_satisfy_the_equations_written_independently(flux, speed):
    scene, state = rough(ROUGH | HARD, film__flux=flux, film__tolerance=2e-4)
    op = at(scene, speed)
    fields = solve(scene, op, state)
    found = judge(scene, op, fields)
    assert fields.route == "mixed"
    assert 0.01 < solid_share(fields) < 0.6
    assert found.load == approx(0.0, abs=1e-4)
    assert found.film < 0.03
    assert found.cavity < 5e-3
    assert found.beneath < 5e-3
    assert found.complementarity < 0.2
    assert found.penetration < 0.5


@pytest.mark.parametrize("iterations", [5, 200])
def test_bounds_and_gap_hold_whether_it_converged_or_not(iterations):
    scene, state = rough(ROUGH | HARD, film__iterations=iterations, film__tolerance=1e-7)
    op = at(scene, 0.01)
    fields = solve(scene, op, state)
    found = judge(scene, op, fields)
    assert not fields.converged
    assert solid_share(fields) > 0.01
    assert found.load == approx(0.0, abs=1e-3)
    assert found.bounds <= 1e-12
    assert found.gap < 1e-6
    assert fields.solid_pressure.min() >= 0.0


def test_a_film_solution_cut_short_says_so():
    scene, state = rough(film__iterations=3)
    fields = solve(scene, at(scene, 1.0), state)
    assert not fields.converged
    assert fields.pressure_change > scene.film.tolerance or fields.route == "fallback"


@pytest.mark.parametrize("below", [{}, HARD], ids=["microroughness", "hard floor"])
@pytest.mark.parametrize("speed", [0.0, 1e-9, 1e-7])
def test_standing_still_is_the_dry_contact(speed, below):
    scene, state = rough(ROUGH | below)
    dry = solve(scene, at(scene, 0.25), state, dry=True)
    fields = solve(scene, at(scene, speed), state)
    assert distance(fields, dry) < 2e-4
    assert ((fields.pressure > 0.0) == (dry.pressure > 0.0))[dry.pressure > 1e-3 * dry.pressure.max()].all()
    assert solid_share(fields) > 0.9999
    if below:  # above the floor, asperities share the load with what little oil there is
        assert fields.film.solid[dry.pressure > 1e-3 * dry.pressure.max()].all()


def test_a_film_is_squeezed_out_until_the_contact_is_dry():
    scene, state = rough()
    dry = solve(scene, at(scene, 0.25), state, dry=True)
    fields = marched(scene, state, at(scene, 1e-6), 60)
    assert distance(fields, dry) < 0.005
    assert solid_share(fields) > 0.95


@pytest.mark.parametrize("speed", [pytest.param(0.25, marks=pytest.mark.long), 4.0])
def test_a_thick_film_settles_to_the_answer_that_a_dry_start_finds(speed):
    scene, state = rough()
    op = at(scene, speed)
    steady, late = solve(scene, op, state), marched(scene, state, op)
    assert mean_gap(scene, late) == approx(mean_gap(scene, steady), rel=0.025)
    assert distance(late, steady) < 0.01
    assert judge(scene, op, late).penetration < 0.5  # no asperity is left stuck in the other body
    assert solid_share(late) == approx(solid_share(steady), abs=0.03)


def test_ten_times_the_speed_lowers_the_solids_load_and_raises_the_film():
    scene, state = rough()
    found = [solve(scene, at(scene, speed), state) for speed in (0.004, 0.04, 0.4, 4.0)]
    shares = [solid_share(fields) for fields in found]
    films = [mean_gap(scene, fields) for fields in found]
    assert (np.diff(shares) < -0.02).all()
    assert (np.diff(films) > 0.02 * np.array(films[:-1])).all()
    assert all(fields.route == "mixed" for fields in found)


def test_high_speed_is_a_full_film():
    scene, state = rough()
    fields = solve(scene, at(scene, 40.0), state)
    assert fields.converged
    assert solid_share(fields) == 0.0
    assert not fields.film.solid.any()
    assert mean_gap(scene, fields) > 2.0 * fields.heights.std()


def test_the_film_of_rough_bodies_far_apart_is_that_of_smooth_ones():
    scene, state = rough()
    smooth, bare = rough(surface_1__rq="0 nm", surface_2__rq="0 nm")
    thick, reference = solve(scene, at(scene, 40.0), state), solve(smooth, at(smooth, 40.0), bare)
    assert mean_gap(scene, thick) == approx(mean_gap(smooth, reference), rel=0.1)


def mirrored(state):
    """The state of bodies that are mirror images in x."""

    def turned(body):
        change = {
            name: np.roll(getattr(body, name)[:, ::-1], 1, axis=1) for name in ("growth", "removal", "wear", "plastic")
        }
        return replace(body, **change)

    first, second = (turned(body) for body in state.bodies)
    return replace(state, bodies=(first, second))


def shaped(scene, state):
    """Smooth bodies that carry bumps and tribofilm, as wear of both signs, so that they can be mirrored and swapped."""
    random = np.random.Generator(np.random.Philox(8))
    shape = state.bodies[0].wear.shape
    blur = np.fft.rfft2(random.normal(size=(2, *shape)))
    ky, kx = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :]
    waves = np.fft.irfft2(blur * np.exp(-80.0 * (kx**2 + ky**2)), s=shape)
    waves *= np.array([20e-9, 60e-9])[:, None, None] / waves.std()
    grown = 50e-9 * random.random((2, *shape))
    first, second = (
        replace(body, wear=wear, growth=growth, removal=np.zeros(shape))
        for body, wear, growth in zip(state.bodies, waves, grown, strict=True)
    )
    return replace(state, bodies=(first, second))


def bodies_alone(**more):
    scene, state = rough(COARSE, surface_1__rq="0 nm", surface_2__rq="0 nm", **more)
    return scene, shaped(scene, state)


def test_reversal_is_the_mirror_image_to_the_last_bit():
    scene, state = bodies_alone()
    op = at(scene, 0.5, slide_roll=0.3)
    back = replace(op, speed_1=-op.speed_1, speed_2=-op.speed_2)
    ahead, reverse = solve(scene, op, state), solve(scene, back, mirrored(state))
    assert 0.0 < solid_share(ahead) < 1.0
    for name in ("pressure", "fluid_pressure", "solid_pressure", "gap", "overlap", "heights", "cover_1"):
        assert (getattr(reverse, name) == getattr(ahead, name)[:, ::-1]).all(), name
    assert (reverse.fluid_shear == -ahead.fluid_shear[:, ::-1]).all()
    assert (reverse.solid_shear == -ahead.solid_shear[:, ::-1]).all()
    assert reverse.iterations == ahead.iterations


def test_a_reversed_transient_is_the_mirror_image_too():
    scene, state = bodies_alone()
    op = at(scene, 0.5)
    back = replace(op, speed_1=-op.speed_1, speed_2=-op.speed_2)
    state_back = mirrored(state)
    state, state_back = (replace(s, film=solve(scene, o, s).film) for s, o in ((state, op), (state_back, back)))
    ahead = solve(scene, op, state, Transient(3e-5, 1, 60))
    reverse = solve(scene, back, state_back, Transient(3e-5, -1, 60))
    assert (reverse.gap == ahead.gap[:, ::-1]).all()
    assert (reverse.pressure == ahead.pressure[:, ::-1]).all()


def test_bodies_may_swap_their_roles():
    """Who is called body 1 changes the sign of sliding and nothing else."""
    scene, state = bodies_alone()
    op = at(scene, 0.5, slide_roll=0.3)
    swapped = replace(state, bodies=state.bodies[::-1])
    one = solve(scene, op, state)
    other = solve(scene, replace(op, speed_1=op.speed_2, speed_2=op.speed_1), swapped)
    assert other.pressure == approx(one.pressure, rel=1e-6, abs=1.0)
    assert other.gap == approx(one.gap, rel=1e-6)
    assert other.fluid_shear + other.solid_shear == approx(-(one.fluid_shear + one.solid_shear), rel=1e-6, abs=1.0)
    assert (other.cover_1 == one.cover_2).all()


def test_sliding_without_entrainment_is_dry_and_rubs():
    scene, state = rough(COARSE)
    op = OperatingPoint(77.85, 0.3, -0.3, 363.15)
    fields = solve(scene, op, state)
    assert fields.route == "dry"
    assert not fields.fluid_pressure.any()
    friction = fields.solid_shear.sum() * scene.film.spacing**2
    assert friction == approx(scene.boundary_friction.bare * 77.85, rel=1e-6)
    assert fields.temperatures.flash_rise > 0.0


def test_pure_rolling_makes_neither_shear_nor_flash():
    scene, state = rough(COARSE)
    fields = solve(scene, at(scene, 0.25, slide_roll=0.0), state)
    assert solid_share(fields) > 0.0
    assert not fields.fluid_shear.any()
    assert not fields.solid_shear.any()
    assert fields.temperatures.flash_rise == 0.0


def test_shear_is_odd_in_sliding():
    scene, state = rough(COARSE)
    ahead, back = (solve(scene, at(scene, 0.25, slide_roll=slip), state) for slip in (0.1, -0.1))
    assert (ahead.pressure == back.pressure).all()
    assert (ahead.fluid_shear == -back.fluid_shear).all()
    assert (ahead.solid_shear == -back.solid_shear).all()
    assert ahead.solid_shear.sum() > 0.0


def test_without_load_the_bodies_just_touch_and_nothing_presses():
    scene, state = rough(COARSE)
    fields = solve(scene, at(scene, 0.25, load=0.0), state)
    assert fields.route == "open"
    assert fields.converged
    for name in ("pressure", "fluid_pressure", "solid_pressure", "fluid_shear", "solid_shear", "overlap"):
        assert not getattr(fields, name).any(), name
    assert fields.gap.min() == approx(scene.film.floor, rel=1e-6)
    assert fields.temperatures.flash_rise == 0.0


def test_pressures_stay_below_the_hardness_of_film_and_solid():
    scene, state = bodies_alone(plasticity__hardness="1.5 GPa", plasticity__film_hardness="1.3 GPa")
    op = at(scene, 0.05)
    fields = solve(scene, op, state)
    limit = scene.plasticity.limit(fields.cover_1, fields.cover_2, 0.0, 1.0)
    assert limit.min() < 0.99 * scene.plasticity.hardness
    used = fields.pressure / limit
    assert used.max() == approx(1.0, abs=1e-12)
    assert fields.overlap.max() > 0.0
    assert not fields.overlap[used < 1.0 - 1e-12].any()
    assert fields.pressure.sum() * scene.film.spacing**2 == approx(op.load, rel=1e-3)


@pytest.mark.parametrize("load", [7.785, 38.0, 155.7])
def test_a_warm_start_bears_any_change_of_load(load):
    scene, state = rough(COARSE, film__domain="0.6 mm", operation__largest_load="160 N")
    state = replace(state, film=solve(scene, at(scene, 1.0), state).film)
    for dt in (3e-5, AGES):
        fields = solve(scene, at(scene, 1.0, load=load), state, Transient(dt, 1, 60))
        assert fields.pressure.sum() * scene.film.spacing**2 == approx(load, rel=1e-3)
        assert np.isfinite(fields.gap).all()


def test_solving_leaves_the_state_alone_and_repeats_to_the_last_bit():
    scene, state = rough(COARSE)
    state = replace(state, film=solve(scene, at(scene, 1.0), state).film)
    before = state.to_bytes()
    once, again = (solve(scene, at(scene, 0.9), state, Transient(3e-5, 1, 60)) for _ in range(2))
    assert state.to_bytes() == before
    assert once.pressure.tobytes() == again.pressure.tobytes()
    assert once.gap.tobytes() == again.gap.tobytes()


def test_both_transform_libraries_give_the_same_film():
    found = [rough(COARSE, film__fft=library) for library in ("pyfftw", "scipy")]
    one, other = (solve(scene, at(scene, 4.0), state) for scene, state in found)
    assert other.pressure == approx(one.pressure, rel=1e-5, abs=1e3)


@pytest.mark.parametrize(
    ("name", "value"), [("load", -1.0), ("speed_1", np.nan), ("speed_2", np.inf), ("temperature", 20.0)]
)
def test_an_operating_point_that_cannot_be_used_is_refused_by_name(name, value):
    scene, state = rough(COARSE)
    with pytest.raises(OperatingPointError, match=rf"^{name} = .* must be "):
        solve(scene, replace(scene.operation.point, **{name: value}), state)
