"""The regression level: friction without jumps, derivatives that are its own, means that patches give and take."""

import math
from dataclasses import asdict, fields, replace

import numpy as np
import pytest
from cheap_scene import cheap
from comparison import HARD, approx
from scipy.stats import norm

from contact_core import (
    ContactState,
    OperatingPoint,
    OperatingPointError,
    RangeFlag,
    Scene,
    SceneError,
    advance,
    initial_state,
    solve,
    track_of,
)
from contact_core.laws.heat import TemperatureField
from contact_core.laws.rheology import Eyring, Newtonian
from contact_core.quantities import OF_CALLER, OUTPUTS
from contact_core.reference import SmoothContact, nijenbanning_venner_moes
from contact_core.regression.surfaces import tribofilms_of
from contact_core.state import Mean
from contact_core.surfaces.patches import surface_now, track_rows
from contact_core.surfaces.roughness import rms_roughness
from contact_core.surfaces.track_means import folded, means_of

FAST = {"film.model": "regression"}
SMOOTH = FAST | {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"} | HARD
OF_STRESS = (
    "von_mises", "near_surface", "dang_van", "crossland", "damage", "micropitted", "error_damage"
)  # fmt: skip
DERIVATIVES = {"speed_1": 1e-6, "speed_2": 1e-6, "load": 1e-5, "temperature": 1e-5}  # step of the test, relative


def fast(changes=FAST, **more):
    return cheap(changes, **more)


def point(op, entrainment, sliding, **changes):
    return replace(op, speed_1=entrainment + 0.5 * sliding, speed_2=entrainment - 0.5 * sliding, **changes)


def with_oil(scene, rheology):
    return replace(scene, lubricant=replace(scene.lubricant, rheology=rheology))


def now(scene, op, state):
    return advance(scene, op, state, 0.0)[1]


def assert_total(scene, state, op):
    """Derivatives of friction are those of the whole step, by differences from outside."""
    entrainment, sliding = op.entrainment_speed, op.sliding_speed
    found = now(scene, op, state)
    for name, relative in DERIVATIVES.items():
        scale = min(abs(entrainment), abs(sliding)) if name.startswith("speed") else getattr(op, name)
        step = relative * scale
        up, down = (
            now(scene, replace(op, **{name: getattr(op, name) + sign * step}), state).friction_force
            for sign in (1.0, -1.0)
        )
        expected = (up - down) / (2.0 * step)
        size = max(
            abs(expected), 1e-3 * abs(found.friction_force) / getattr(op, name) if name == "temperature" else 0.0
        )
        assert getattr(found, f"dfriction_d{name}") == approx(expected, abs=1e-3 * size), name


@pytest.mark.parametrize("radii", [(5e-3, 5e-3), (8e-3, 20e-3)])
def test_derivatives_are_total_at_any_radii(radii):
    scene, state, op = fast(FAST | {"heat.inlet_shear": "gupta"})
    assert_total(scene, state, replace(op, radius_x=radii[0], radius_y=radii[1]))


@pytest.fixture(scope="module")
def grown():
    """A scene, a state with half an hour's tribofilm and wear, and its operating point."""
    scene, state, op = fast()
    return scene, advance(scene, op, state, 1800.0)[0], op


@pytest.mark.parametrize("srr", [0.02, pytest.param(-2.0, marks=pytest.mark.long)])
def test_friction_has_no_jump_over_six_decades_of_speed(grown, srr):
    scene, state, op = grown

    def friction(count):
        speeds = np.geomspace(1e-5, 10.0, count)
        return np.array([now(scene, point(op, u, srr * u), state).friction_coefficient for u in speeds])

    coarse, fine = (np.abs(np.diff(friction(count))).max() for count in (251, 1001))
    assert 0.0 < coarse < 1e-2
    assert fine < 0.3 * coarse  # a jump would stay as it is, a slope becomes a quarter


@pytest.mark.parametrize("entrainment", [0.0, 0.25])
def test_friction_goes_through_zero_sliding_without_a_jump_and_is_odd(grown, entrainment):
    scene, state, op = grown
    slides = np.linspace(-3e-6, 3e-6, 601)
    force = np.array([now(scene, point(op, entrainment, u), state).friction_force for u in slides])
    assert force[300] == 0.0
    assert force == approx(-force[::-1], rel=1e-12)
    assert np.all(np.diff(force) < 0.0)
    assert np.abs(np.diff(force)).max() < 0.02 * force[0]


@pytest.mark.parametrize("sliding", [5e-3, pytest.param(1.0, marks=pytest.mark.long)])
def test_friction_goes_through_reversed_entrainment_without_a_jump_and_is_even(grown, sliding):
    scene, state, op = grown
    speeds = np.concatenate([-np.geomspace(1e-2, 1e-12, 800), [0.0], np.geomspace(1e-12, 1e-2, 800)])
    force = np.array([now(scene, point(op, u, sliding), state).friction_force for u in speeds])
    assert force == approx(force[::-1], rel=1e-12)
    assert np.abs(np.diff(force)).max() < 2e-3 * abs(force[800])
    assert abs(force[0]) < 0.99 * abs(force[800])


@pytest.mark.parametrize("entrainment", [1e-4, 0.02, 0.25, 1.0, -3.0])
@pytest.mark.parametrize("sliding", [1e-7, -5e-3, 0.4])
@pytest.mark.parametrize("rheology", [Newtonian(), Eyring(5e6, 0.047)], ids=lambda law: law.name)
def test_derivatives_are_total(grown, entrainment, sliding, rheology):
    scene, state, op = grown
    scene = with_oil(scene, rheology)
    op = point(op, entrainment, sliding, load=60.0)
    assert_total(scene, state, op)


@pytest.mark.parametrize("entrainment", [0.02, 0.25, 3.0])
@pytest.mark.parametrize("sliding", [-5e-3, 0.4])
def test_derivatives_are_total_with_shear_heating_in_the_inlet(grown, entrainment, sliding):
    scene, state, op = grown
    op = point(op, entrainment, sliding, load=60.0)
    scene = replace(scene, heat=replace(scene.heat, inlet_shear="gupta"))
    assert_total(scene, state, op)


@pytest.mark.parametrize("entrainment", [0.02, 0.25, 3.0])
def test_derivatives_are_total_where_the_oil_warms_itself(grown, entrainment):
    scene, state, op = grown
    steel = [getattr(scene.heat, name) for name in ("conductivity_1", "conductivity_2")]
    steel += [getattr(scene.heat, name) for name in ("diffusivity_1", "diffusivity_2")]
    scene, op = replace(scene, heat=TemperatureField(*steel)), point(op, entrainment, 0.4, load=60.0)
    assert_total(scene, state, op)


def test_at_rest_the_solids_carry_all_and_friction_is_the_boundary_laws():
    scene, state, op = fast()
    found = now(scene, point(op, 0.0, 0.01), state)
    assert found.contact_load_ratio == approx(1.0, abs=1e-9)
    assert found.friction_coefficient == approx(scene.boundary_friction.bare, rel=1e-3)
    assert found.friction_force < 0.0  # body 1 is the faster one


def test_a_thick_film_carries_all_and_its_friction_is_the_oils():
    scene, state, op = fast(SMOOTH)
    scene, op = with_oil(scene, Newtonian()), point(op, 5.0, 1e-9, load=2.0)
    found = now(scene, op, state)
    oil, hertz, shape = scene.lubricant, scene.hertz(op.load), scene.geometry
    smooth = SmoothContact.of(
        op.load, 5.0, oil.viscosity, op.temperature, shape.radius_x, shape.radius_y, scene.solids.reduced_modulus
    )
    formula, sharing = nijenbanning_venner_moes(smooth), scene.film.sharing
    film = sharing.film_factor * formula / oil.density(hertz.pressure_mean)
    spread = 1.0 + sharing.oil_spread * formula * shape.radius_x / hertz.a**2  # of the load, over Hertz's area
    r = (np.arange(20_000) + 0.5) / 20_000
    shear = oil.viscosity(hertz.pressure_max / spread * np.sqrt(1.0 - r**2), op.temperature) * 1e-9 / found.h_c
    assert spread > 1.01
    assert found.contact_load_ratio < 1e-18  # an exponential, never quite zero
    assert found.h_c == approx(film, rel=5e-3)  # the floor, a hundredth of it, adds a little
    kept = hertz.area * spread  # all of it: nothing is rough
    assert found.friction_force == approx(-kept * float((2.0 * r * shear).mean()), rel=1e-6)


def test_oil_between_smooth_bodies_rubs_as_the_solved_film():
    settings = SMOOTH | {"heat": "none", "lubricant.set": "m100", "film.points": "65"}
    settings |= {"tribofilm": "none", "wear": "none", "film.model": "deterministic"}
    scene = Scene.from_toml("mtm_zddp", settings)
    op = point(replace(scene.operation.point, temperature=333.15), 2.0, 0.1)
    solved, mean = (now(each, op, initial_state(each)) for each in (scene, scene.at_level("regression")))
    assert mean.friction_coefficient == approx(solved.friction_coefficient, rel=0.04)


def test_pressure_is_the_evener_the_flatter_the_roughness_is_pressed():
    sharing = Scene.from_toml("mtm_zddp", FAST).film.sharing
    kept = [float(sharing.kept(s)) for s in (0.0, 0.45, 1.0, 3.0, math.inf)]
    assert kept == sorted(kept) and kept[1] == approx(sharing.oil_kept, rel=1e-12) and kept[-1] == 1.0


def test_limited_oil_between_smooth_bodies_carries_its_coefficient_times_the_load_it_bears():
    scene, state, op = fast(SMOOTH)
    found = now(scene, point(op, 0.5, 5.0), state)
    limit = scene.lubricant.rheology.limiting_coefficient
    assert found.friction_coefficient == approx(limit, rel=1e-2)
    assert found.friction_coefficient <= limit * (1.0 + 1e-3)


def test_friction_lies_between_the_solids_and_the_solids_with_oil_at_its_limit(grown):
    scene, state, op = grown
    random = np.random.Generator(np.random.Philox(5))
    limit = scene.lubricant.rheology.limiting_coefficient
    shares = []
    for u, srr, load in random.random((60, 3)).tolist():
        speed = 10.0 ** (4.6 * u - 3.0)
        at = point(op, speed, speed * 10.0 ** (-2.0 * srr), load=20.0 + 60.0 * load)
        found = now(scene, at, state)
        oil = (1.0 - found.contact_load_ratio) * at.load * limit
        assert 0.0 < -found.friction_fluid <= oil * (1.0 + 1e-2)
        assert found.friction_force == found.friction_solid + found.friction_fluid
        assert found.power_loss == approx(-found.friction_force * at.sliding_speed)
        assert found.heat_flow_1 + found.heat_flow_2 == found.power_loss
        shares.append(found.contact_load_ratio)
    assert min(shares) < 0.1
    assert max(shares) > 0.8


def test_a_body_at_rest_wears_the_same_volume_on_a_short_track():
    scene, state, op = fast(tribofilm__model="none")
    state, found = advance(scene, replace(op, speed_1=0.2, speed_2=0.0), state, 1.0)
    assert found.wear_volume_1 == approx(found.wear_volume_2, rel=1e-12)
    assert found.load_cycles_2 == 0.0
    longer = scene.geometry.track_length_1 / scene.film.domain
    assert found.wear_depth_2 == approx(longer * found.wear_depth_1, rel=1e-12)


def test_wear_is_archards_for_the_load_on_the_solids():
    scene, state, op = fast(tribofilm__model="none")
    state, found = advance(scene, op, state, 1e-3)
    force = found.contact_load_ratio * op.load
    expected = scene.wear.bare * force * abs(op.sliding_speed) / scene.plasticity.hardness
    assert 0.0 < found.contact_load_ratio < 1.0
    assert found.wear_rate_1 == approx(expected, rel=1e-9)
    assert found.wear_volume_2 == approx(1e-3 * expected, rel=1e-9)


def test_new_bodies_grow_by_their_mean_exposure():
    """However it is spread over the track: a film much thinner than a full one does not yet slow its growth."""
    scene, state, op = fast()
    state, found = advance(scene, op, state, 1e-3)
    law = scene.tribofilm
    rate = law.full_thickness * law.rate(op.temperature + found.flash_temperature_rise) / law.contact_share
    for length, mean in zip(scene.track_lengths, state.means, strict=True):
        touched = found.contact_area_ratio * 0.5 * np.pi * scene.hertz(op.load).a / length
        assert mean.growth == approx(1e-3 * rate * touched, rel=1e-4)


def test_the_rubbed_ball_grows_the_laws_film_and_the_disc_what_its_rubbed_part_does(grown):
    scene, state, op = grown
    law, ball, disc = scene.tribofilm, *state.means
    touched = state.outputs.contact_area_ratio * 0.5 * np.pi * scene.hertz(op.load).a / scene.track_lengths[0]
    hot = op.temperature + state.outputs.flash_temperature_rise
    exposed = np.array([law.rate(hot) * touched / law.contact_share * state.time])
    growth, removal = law.evolve(np.zeros(1), np.zeros(1), exposed, np.zeros(1), hot)
    assert ball.coverage > 0.9
    assert ball.growth == approx(growth[0], rel=0.07)
    assert ball.removal == approx(removal[0], rel=0.15)
    assert 0.25 < disc.coverage < 0.6  # of a mean exposure of 0.2: its points are not rubbed all or nothing
    assert disc.growth < disc.coverage * law.full_thickness


def test_asperities_on_the_grid_alone_rub_all_or_nothing():
    scene, state, op = fast(HARD | FAST)
    state, found = advance(scene, op, state, 1800.0)
    exposed = scene.film.sharing.exposed(found.contact_area_ratio, rougher=True)
    assert state.means[1].coverage == approx(exposed, rel=0.05)  # of the largest area so far


def test_time_may_be_cut_anywhere():
    scene, state, op = fast()
    whole, _ = advance(scene, op, state, 3600.0)
    for _ in range(360):
        state, _ = advance(scene, op, state, 10.0)
    for once, often in zip(whole.means, state.means, strict=True):
        assert asdict(often) == approx(asdict(once), rel=0.03)  # a step has the coverage of its beginning


def test_without_load_nothing_rubs_and_nothing_is_infinite(grown):
    scene, state, op = grown
    after, found = advance(scene, replace(op, load=0.0), state, 60.0)
    assert all(math.isfinite(value) for value in asdict(found).values())
    assert found.friction_force == found.contact_load_ratio == found.wear_rate_1 == 0.0
    assert RangeFlag.LAMBDA_CAPPED in RangeFlag(found.range_flags)
    assert [mean.growth for mean in after.means] == [mean.growth for mean in state.means]


def test_friction_has_no_jump_where_smooth_bodies_lose_their_film():
    scene, state, op = fast(SMOOTH)

    def friction(count):
        speeds = np.geomspace(1e-4, 10.0, count)
        return np.array([now(scene, point(op, u, 0.05 * u), state).friction_coefficient for u in speeds])

    coarse, fine = (np.abs(np.diff(friction(count))).max() for count in (151, 601))
    assert 0.0 < coarse < 1e-2
    assert fine < 0.3 * coarse


def test_the_film_has_no_seam_between_rough_bodies_and_smooth_ones():
    films = []
    for rq in ("0 nm", "1e-6 nm", "0.9 nm"):
        scene, state, op = fast(SMOOTH | {"surface_1.rq": rq, "surface_2.rq": rq})
        films.append(now(scene, point(op, 6.0, 0.3), state).h_c)
    assert films == approx([films[0]] * 3, rel=1e-4)


def test_no_film_is_thicker_than_a_hundredth_of_the_radius(grown):
    scene, state, op = grown
    found = now(scene, point(op, 0.25, 0.005, load=1e-7), state)
    assert found.h_c <= 0.011 * scene.geometry.radius_x


@pytest.mark.parametrize("model", ["point", "line"])
def test_the_solids_carry_no_more_than_their_hardness_on_the_real_contact(model):
    geometry = {"geometry.model": "line", "geometry.face_width": "1 mm"} if model == "line" else {}
    hardness = {"plasticity.hardness": "1.4 GPa", "plasticity.film_hardness": "1.4 GPa"}
    pressures = []
    for rq in ("5 nm", "50 nm", "600 nm"):
        scene, state, op = fast(FAST | HARD | hardness | geometry | {"surface_2.rq": rq})
        for share in (1e-3, 0.1, 0.9):
            load = share * (1.4e9 / scene.unit_hertz_at(op).pressure_max) ** (2.0 if model == "line" else 3.0)
            at = replace(op, load=load, speed_1=1e-9, speed_2=0.0)
            found = now(scene, at, state)
            solids = found.contact_load_ratio * load
            pressures.append(solids / (found.contact_area_ratio * scene.hertz_at(at).area) / 1.4e9)
    assert max(pressures) == approx(1.0, rel=1e-9)  # reached, and by none exceeded
    assert min(pressures) < 0.5


def test_a_load_above_the_hardness_is_refused(grown):
    scene, state, op = grown
    with pytest.raises(OperatingPointError, match=r"load = .* N presses smooth bodies .* above plasticity\.hardness"):
        advance(scene, replace(op, load=1e5), state, 1.0)


@pytest.mark.parametrize(
    "name",
    ["gosvami", *(pytest.param(n, marks=pytest.mark.long) for n in ("zhang_spikes_80c_ethylhexyl", "combined_80c"))],
)
def test_films_that_feel_local_stresses_are_told_within_a_factor_of_four(name):
    scene, state, op = cheap(tribofilm__set=name, operation__temperature="80 degC")
    op = replace(op, temperature=353.15)
    _, slow = advance(scene, op, state, 60.0)
    _, quick = advance(scene.at_level("regression"), op, state, 60.0)
    for one, other in ((slow.tribofilm_1, quick.tribofilm_1), (slow.tribofilm_2, quick.tribofilm_2)):
        assert 0.25 < other / one < 4.0
    assert quick.error_tribofilm_1 == quick.error_tribofilm_2 == 1.0


def test_edges_lose_more_tribofilm_at_this_level_too():
    films = []
    for weight in (0.0, 20.0):
        changes = {"tribofilm.set": "gosvami", "tribofilm.edge_weight": str(weight), "operation.temperature": "80 degC"}
        scene, state, op = fast(FAST | changes)
        films.append(advance(scene, replace(op, temperature=353.15), state, 1800.0)[1].tribofilm_1)
    assert films[1] < 0.95 * films[0]


def test_oil_that_thins_has_a_thinner_film_where_the_flow_is_local():
    carreau = {
        "lubricant.rheology.model": "carreau",
        "lubricant.rheology.critical_stress": "0.01 MPa",
        "lubricant.rheology.exponent": "0.6",
    }
    scene, state, op = fast(FAST | carreau)
    local, _, _ = fast(FAST | carreau | {"lubricant.flow": "local"})
    at = point(op, 5.0, 1.0)
    assert now(local, at, state).h_c < 0.95 * now(scene, at, state).h_c
    eyring = fast(lubricant__flow="local")[0]
    assert any("carreau" in sentence for sentence in eyring.warnings())


def test_warm_bodies_do_not_care_how_the_time_is_cut():
    changes = {
        "heat.bulk.model": "lumped",
        "heat.bulk.heat_capacity_1": "1 J/K",
        "heat.bulk.heat_capacity_2": "1 J/K",
        "heat.bulk.conductance_1": "0.5 W/K",
        "heat.bulk.conductance_2": "0.2 W/K",
        "tribofilm.beyond_fit": "extrapolate",
    }
    scene, state, op = fast(FAST | changes)
    at, once, often = point(op, 1.0, 1.0), state, state
    once, found = advance(scene, at, once, 60.0)
    for _ in range(6):
        often, last = advance(scene, at, often, 10.0)
    assert found.temperature_2 == approx(last.temperature_2, abs=0.2)
    assert found.temperature_2 > op.temperature + 1.0
    assert found.wear_depth_2 == approx(last.wear_depth_2, rel=0.02)


@pytest.mark.parametrize("load", [1e-12, 1e-3, 1e3])
@pytest.mark.parametrize(("entrainment", "sliding"), [(0.0, 0.0), (0.0, 20.0), (99.0, 1e-3), (1e-9, 1e-9)])
def test_extremes_stay_finite(grown, load, entrainment, sliding):
    scene, state, op = grown
    after, found = advance(scene, point(op, entrainment, sliding, load=load), state, 1.0)
    assert all(math.isfinite(value) for value in asdict(found).values())
    assert all(math.isfinite(value) for mean in after.means for value in asdict(mean).values())
    assert 0.0 <= found.contact_load_ratio <= 1.0


def test_an_input_that_cannot_be_used_is_refused(grown):
    scene, state, op = grown
    with pytest.raises(OperatingPointError, match="load"):
        advance(scene, replace(op, load=-1.0), state, 1.0)
    with pytest.raises(OperatingPointError, match="temperature"):
        advance(scene, replace(op, temperature=420.0), state, 1.0)


def test_beyond_the_fit_a_flag_is_raised(grown):
    scene, state, op = grown
    assert RangeFlag.OUTSIDE_FIT not in RangeFlag(now(scene, op, state).range_flags)
    steep, fresh, _ = fast(surface_2__rq="1.27 um")  # ten times as rough: pressed flat by too little of its height
    assert RangeFlag.OUTSIDE_FIT in RangeFlag(now(steep, op, fresh).range_flags)
    slow = point(op, 1e-6, 0.0)  # of hardly any film
    assert RangeFlag.OUTSIDE_FIT in RangeFlag(now(scene, slow, state).range_flags)


@pytest.mark.parametrize("resting", ["speed_1", "speed_2"])
def test_a_body_at_rest_under_a_moving_one_lies_beyond_the_fit(grown, resting):
    scene, state, op = grown
    creeping, still = (now(scene, replace(op, **{resting: speed}), state) for speed in (1e-6, 0.0))
    assert RangeFlag.OUTSIDE_FIT not in RangeFlag(creeping.range_flags)
    assert RangeFlag.OUTSIDE_FIT in RangeFlag(still.range_flags)
    assert still.error_friction > 1.5 * creeping.error_friction


def test_only_what_the_level_can_tell_is_told(grown):
    scene, state, op = grown
    found = asdict(advance(scene, op, state, 1.0)[1])
    assert all(found[q.name] == 0 for q in OUTPUTS if scene.film.name not in q.levels)
    silent = {q.name for q in OUTPUTS if scene.film.name in q.levels and not found.get(q.name)}
    below = {q.name for q in OUTPUTS if q.name.startswith(OF_STRESS)}  # nobody asks for it
    assert silent == OF_CALLER | {"range_flags", "spin_torque", "oxide_1", "oxide_2", "scuffing_ratio"} | below


# levels


def test_a_scene_changes_its_level_and_keeps_its_grid():
    scene = Scene.from_toml("mtm_zddp", {"film.points": "101", "film.domain": "0.6 mm", "film.floor": "2 nm"})
    quick = scene.at_level("regression")
    assert (quick.film.name, quick.film.points, quick.film.domain, quick.film.floor) == ("regression", 101, 6e-4, 2e-9)
    assert quick.digest() == scene.digest()
    assert quick.at_level("deterministic") == scene
    assert quick.at_level("regression") is quick
    with pytest.raises(SceneError, match="Did you mean 'regression'"):
        scene.at_level("regresion")


def test_a_new_model_keeps_the_keys_it_has_in_common_with_the_old_one():
    scene = Scene.from_toml("azam_case_a", {"film.model": "regression"})
    assert scene == Scene.from_toml("azam_case_a").at_level("regression")
    assert Scene.from_dict(scene.to_dict()) == scene
    scene = Scene.from_toml("azam_case_a", {"film.points": "101", "film.model": "regression", "film.floor": "2 nm"})
    assert (scene.film.points, scene.film.floor) == (101, 2e-9)


def test_the_fields_of_this_level_are_refused(grown):
    scene, state, op = grown
    with pytest.raises(SceneError, match="at_level"):
        solve(scene, op, state)


@pytest.fixture(scope="module")
def deterministic():
    """A cheap scene and its state after a minute of the deterministic level."""
    scene, state, op = cheap()
    return scene, advance(scene, op, state, 60.0)[0], op


def patches(state):
    return {(i, name): getattr(body, name) for i, body in enumerate(state.bodies) for name in body.ARRAYS}


def test_a_change_of_level_and_back_changes_nothing(deterministic):
    scene, state, op = deterministic
    quick, _ = advance(scene.at_level("regression"), op, state, 0.0)
    assert quick.means == means_of(scene, state)
    assert max(mean.growth for mean in quick.means) > 1e-9
    back = folded(scene, quick)
    assert back.means is None
    assert back.bodies == state.bodies  # the very same
    assert back == replace(state, solved_for=None, outputs=back.outputs)


def test_means_have_the_mean_and_the_rms_of_the_tribofilm_on_the_patches(deterministic):
    scene, state, _ = deterministic
    for mean, body in zip(means_of(scene, state), state.bodies, strict=True):
        growth = body.growth[track_rows(scene, state.rows)]
        found = tribofilms_of((replace(mean, removal=0.0),) * 2)[0]
        assert mean.growth == approx(growth.mean(), rel=1e-12)
        assert found.roughness == approx(growth.std(), rel=1e-9)


def test_both_levels_see_the_same_roughness_of_the_same_worn_and_pressed_surfaces():
    scene, state, op = cheap(control__driver="dry", tribofilm__model="none", plasticity__hardness="3 GPa")
    state, found = advance(scene, op, state, 60.0)
    assert min(body.plastic.max() for body in state.bodies) > 1e-9
    quick = now(scene.at_level("regression"), op, state)
    for name in ("wear_depth_1", "wear_volume_2", "load_cycles_1", "load_cycles_2"):
        assert getattr(quick, name) == approx(getattr(found, name), rel=1e-9), name
    for i, surface in enumerate((scene.surface_1, scene.surface_2)):  # of a patch beside its own new roughness
        new = surface_now(scene, initial_state(scene).bodies[i], i)
        sampled = rms_roughness(new.roughness, new.middle)
        pair = [getattr(outputs, f"roughness_{i + 1}") for outputs in (quick, found)]
        assert pair[0] / surface.rms == approx(pair[1] / sampled, rel=1e-9)
        assert abs(pair[0] / surface.rms - 1.0) > 1e-5


@pytest.mark.parametrize("share", [0.05, 0.3, 0.7])
def test_a_film_on_the_highest_points_makes_a_gaussian_surface_as_rough_as_the_level_says(share):
    heights = norm.ppf((np.arange(100_000) + 0.5) / 100_000)
    film = 0.3 * (heights > norm.ppf(1.0 - share))
    mean = Mean(0.3 * share, 0.0, share, 0.0, 1.0, 0.0, 0.0)
    found = tribofilms_of((mean, mean))[1]
    assert found.thickness == approx(0.3)
    assert found.roughness == approx(film.std(), rel=1e-3)
    assert found.both == approx((heights + film).std(), rel=0.01)


def test_patches_wait_while_means_run(deterministic):
    scene, state, op = deterministic
    quick, _ = advance(scene.at_level("regression"), op, state, 600.0)
    assert quick.bodies is state.bodies
    assert quick.means[0].worn > state.bodies[0].worn


def test_patches_get_what_means_have_gained(deterministic):
    scene, state, op = deterministic
    quick, _ = advance(scene.at_level("regression"), op, state, 600.0)
    back = folded(scene, quick)
    for then, now_, mean, mean_then in zip(state.bodies, back.bodies, quick.means, means_of(scene, state), strict=True):
        assert now_.worn == mean.worn
        assert now_.cycles == mean.cycles
        assert mean.wear > mean_then.wear
        assert np.all(now_.wear >= then.wear)
        gained = float((now_.wear - then.wear).sum()) * scene.film.spacing**2
        length = scene.geometry.track_length_1 if now_ is back.bodies[0] else scene.geometry.track_length_2
        # a patch's rows within the track are as wide as that to half a row on either side
        assert gained * length / scene.film.domain == approx(mean.worn - then.worn, rel=0.06)
        assert 0.0 <= now_.growth.min() <= now_.growth.max() <= scene.tribofilm.full_thickness
    found = means_of(scene, back)
    for mean, again in zip(quick.means, found, strict=True):
        for name in ("growth", "removal", "wear", "worn", "cycles"):
            assert getattr(again, name) == approx(getattr(mean, name), rel=1e-12), name
        assert again.coverage == approx(mean.coverage, abs=0.03)  # beside it, there is a little tribofilm


def test_fresh_patches_get_their_film_on_the_highest_points():
    scene, state, op = fast()
    quick, _ = advance(scene, op, state, 600.0)
    disc = track_of(scene, quick, 2)
    assert (disc.tribofilm > 0.0).mean() > 0.01
    inside = np.abs(disc.y) < scene.hertz(op.load).b
    heights, film = disc.new[inside], disc.tribofilm[inside]
    assert heights[film > 0.0].min() >= heights[film == 0.0].max()


def test_a_run_goes_on_at_the_deterministic_level(deterministic):
    scene, state, op = deterministic
    quick, _ = advance(scene.at_level("regression"), op, state, 600.0)
    onward, found = advance(scene, op, quick, 10.0)
    assert onward.means is None
    assert onward.time == approx(670.0)
    assert found.wear_volume_1 > quick.outputs.wear_volume_1
    assert found.blocks_dry + found.blocks_mixed > state.outputs.blocks_dry + state.outputs.blocks_mixed


def test_a_saved_state_of_means_goes_on_bit_for_bit(grown):
    scene, state, op = grown
    data = state.to_bytes()
    again = ContactState.from_bytes(data, scene)
    assert again.to_bytes() == data
    one, other = (advance(scene, replace(op, load=50.0), start, 30.0) for start in (state, again))
    assert one[1] == other[1]
    assert one[0].to_bytes() == other[0].to_bytes()
    assert state.to_bytes() == data
    assert {f.name for f in fields(OperatingPoint)} >= set(DERIVATIVES)


def test_elliptical_contacts_have_the_formulas_film():
    scene, state, op = fast(SMOOTH, geometry__radius_y="30 mm", film__domain="1 mm")
    op = point(op, 5.0, 0.1)  # a film beside which the least roughness is nothing
    oil, shape = scene.lubricant, scene.geometry
    smooth = SmoothContact.of(
        op.load, op.entrainment_speed, oil.viscosity, op.temperature, 0.01, shape.radius_y, scene.solids.reduced_modulus
    )
    factor = scene.film.sharing.film_factor / oil.density(scene.hertz(op.load).pressure_mean)
    film = factor * nijenbanning_venner_moes(smooth)
    assert now(scene, op, initial_state(scene)).h_c == approx(film, rel=5e-3)  # the floor adds a little
    assert now(scene, op, state).h_c != approx(
        factor * nijenbanning_venner_moes(replace(smooth, radius_y=0.01)), rel=0.01
    )


@pytest.mark.parametrize(("one", "two"), [(0.0, 0.3), (0.3, 0.0), (3.0, 1.0), (-0.1, 0.08)])
@pytest.mark.parametrize("name", ["speed_1", "speed_2"])
@pytest.mark.parametrize("changes", [{}, {"heat.inlet_shear": "gupta"}, {"heat.bulk": "inputs"}], ids=str)
def test_derivatives_are_total_where_the_oil_warms_itself_whoever_is_at_rest(one, two, name, changes):
    scene, state, op = fast(FAST | {"heat.model": "field", "tribofilm.model": "none"} | changes)
    op = replace(op, speed_1=one, speed_2=two, spin=50.0, body_temperature_1=380.0, body_temperature_2=365.0)

    def force(speed):
        return now(scene, replace(op, **{name: speed}), state).friction_force

    speed, step = getattr(op, name), 1e-5
    expected = (force(speed + step) - force(speed - step)) / (2.0 * step)
    assert getattr(now(scene, op, state), f"dfriction_d{name}") == approx(expected, rel=1e-3)


def test_whole_numbers_are_numbers():
    scene, state, op = fast(FAST | {"heat.model": "field"})
    assert now(scene, replace(op, speed_1=1, speed_2=2), state) == now(
        scene, replace(op, speed_1=1.0, speed_2=2.0), state
    )


@pytest.mark.parametrize("speed", [3.0, 30.0])
@pytest.mark.parametrize(("model", "power"), [("newtonian", 1.0), ("carreau", 0.5)])
def test_oil_without_a_limit_finds_the_temperature_that_it_makes_of_itself(speed, model, power):
    oil = {"lubricant.rheology.model": model, "lubricant.rheology.limiting_coefficient": "0"}
    if model == "carreau":
        oil |= {"lubricant.rheology.critical_stress": "5 MPa", "lubricant.rheology.exponent": str(power)}
    scene, state, op = fast(SMOOTH | oil | {"heat.model": "field"})
    slower, found = (now(scene, replace(op, speed_1=u, speed_2=0.0), state) for u in (0.5 * speed, speed))
    assert found.flash_temperature_rise > 0.8 * slower.flash_temperature_rise > 1.0
    assert 0.3 < found.friction_coefficient / slower.friction_coefficient < 1.0


def test_long_steps_keep_a_tribofilm_at_its_balance_where_more_of_it_grows_less():
    """Growth that fades as the film spreads is stiff: in 5 min it would go past the balance and back, by 2 %."""
    scene = Scene.from_toml(
        "fzg_flank",
        {
            **FAST,
            "tribofilm.set": "zhang_spikes_80c_ethylhexyl",
            "tribofilm.supply_rate": "1 m/s",
            "surface_1.rq": "0.4 um",
        },
    )
    scene = replace(scene, surface_2=replace(scene.surface_2, rq=0.4e-6))
    op = replace(scene.operation.point, load=1256.0, speed_1=4.6, speed_2=2.6, temperature=362.6)
    films = {}
    for step, count in ((300.0, 60), (20.0, 900)):
        state, found = initial_state(scene), []
        for _ in range(count):
            state, outputs = advance(scene, op, state, step)
            found.append(outputs.tribofilm_1)
        films[step] = np.array(found)
    settled = films[300.0][30:]
    assert settled.mean() > 100e-9
    assert np.abs(np.diff(settled)).max() < 1e-3 * settled.mean()
    assert settled == approx(films[20.0][464::15][: len(settled)], rel=3e-3)


@pytest.mark.parametrize("name", ["mtm_zddp", "fzg_flank", "ball_209_inner"])
@pytest.mark.parametrize(
    "inputs",
    [
        {"load": 5e-324},
        {"load": 1e-310},
        {"speed_1": 5e-324, "speed_2": 0.0},
        {"speed_1": 5e-324, "speed_2": 5e-324},
        {"load": 5e-324, "speed_1": 5e-324, "speed_2": -5e-324},
    ],
)
def test_the_smallest_inputs_that_there_are_divide_by_no_zero(name: str, inputs: dict[str, float]) -> None:
    scene = Scene.from_toml(name).at_level("regression")
    _, found = advance(scene, replace(scene.operation.point, **inputs), initial_state(scene), 1.0)
    assert all(math.isfinite(value) for value in vars(found).values())
    assert abs(found.friction_force) < 1e-300
