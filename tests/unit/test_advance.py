"""Evolution over time: bookkeeping of wear, tribofilm and cycles, memory, and what `advance` promises."""

import math
from dataclasses import asdict, fields, is_dataclass, replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap, settled
from comparison import approx

from contact_core import (
    ContactState,
    ConvergenceError,
    OperatingPoint,
    OperatingPointError,
    RangeFlag,
    advance,
    solve,
)
from contact_core.quantities import TABLE, value_out_of_range
from contact_core.scene import Case

BARE = CHEAP | {"tribofilm.model": "none"}
LONG_BLOCKS = {"control__change": "60 nm", "control__longest": "2 h"}


def run(scene, op, state, steps):
    found = []
    for dt in steps:
        state, outputs = advance(scene, op, state, dt)
        found.append(outputs)
    return state, found


def all_arrays(record):
    if isinstance(record, np.ndarray):
        yield record
    elif isinstance(record, tuple):
        for item in record:
            yield from all_arrays(item)
    elif is_dataclass(record):
        for f in fields(record):
            yield from all_arrays(getattr(record, f.name))


def finite(outputs):
    return all(math.isfinite(value) for value in asdict(outputs).values())


def raised(outputs):
    return RangeFlag(outputs.range_flags)


def test_the_state_given_stays_as_it_was_and_usable():
    scene, new, op = settled()
    blank = new.to_bytes()
    used, _ = advance(scene, op, new, 10.0)
    assert new.to_bytes() == blank
    before = used.to_bytes()
    onward, _ = advance(scene, op, used, 10.0)
    assert used.to_bytes() == before
    assert onward.to_bytes() != before
    arrays = list(all_arrays(onward))
    assert len(arrays) > 12
    assert not any(array.flags.writeable for array in arrays)


@pytest.mark.long
def test_the_same_call_gives_the_same_bits():
    scene, fresh, op = cheap()
    once, again = (advance(scene, op, fresh, 10.0) for _ in range(2))
    assert once[0].to_bytes() == again[0].to_bytes()
    assert once[1] == again[1]


def test_a_step_saved_restored_and_repeated_gives_the_same_bits():
    scene, new, op = settled()
    saved, _ = advance(scene, op, new, 10.0)
    data = saved.to_bytes()
    onward, outputs = advance(scene, replace(op, load=70.0), saved, 10.0)
    again, outputs_again = advance(scene, replace(op, load=70.0), ContactState.from_bytes(data, scene), 10.0)
    assert outputs == outputs_again
    assert onward.to_bytes() == again.to_bytes()


def test_what_another_state_did_in_between_leaves_no_trace():
    scene, saved, op = settled()
    expected, _ = advance(scene, op, saved, 20.0)
    other, other_fresh, other_op = cheap(surface_2__seed=9)
    for load in (10.0, 50.0):
        solve(other, replace(other_op, load=load), other_fresh)
    assert advance(scene, op, saved, 20.0)[0].to_bytes() == expected.to_bytes()


def test_no_time_changes_nothing_but_the_outputs():
    scene, first, op = settled()
    outputs = first.outputs
    second, again = advance(scene, op, first, 0.0)
    assert again == outputs
    assert second.to_bytes() == first.to_bytes()
    assert first.time == 0.0
    for body in first.bodies:
        assert not body.wear.any()
        assert not body.growth.any()
        assert body.cycles == 0.0
    assert outputs.friction_coefficient > 0.0
    assert outputs.wear_rate_1 > 0.0


@pytest.mark.long
def test_small_steps_and_one_large_step_end_alike():
    scene, new, op = settled()
    few, a = run(scene, op, new, [50.0])
    many, b = run(scene, op, new, [5.0] * 10)
    assert many.time == approx(few.time, rel=1e-12)
    last, same = b[-1], a[-1]
    for name in ("tribofilm_1", "tribofilm_2", "wear_volume_1", "wear_volume_2"):
        assert getattr(last, name) == approx(getattr(same, name), rel=0.02, abs=0.0), name
    for name in ("load_cycles_1", "load_cycles_2"):
        assert getattr(last, name) == approx(getattr(same, name), rel=1e-12), name


def test_a_split_within_a_block_changes_nothing_but_round_off():
    scene, new, op = settled(control__change="100 nm")
    whole, _ = advance(scene, op, new, 1.0)
    split, _ = run(scene, op, new, [0.25] * 4)
    for one, other in zip(whole.bodies, split.bodies, strict=True):
        assert other.growth == approx(one.growth, rel=1e-12, abs=0.0)
        assert other.removal == approx(one.removal, rel=1e-12, abs=0.0)
        assert other.wear == approx(one.wear, rel=1e-3, abs=0.0)
    assert split.outputs.blocks_mixed == whole.outputs.blocks_mixed == 1.0


def test_wear_volume_is_the_integral_of_the_wear_rate():
    scene, state, op = settled()
    steps = (0.3, 1.0, 7.0, 30.0)
    state, found = run(scene, op, state, steps)
    for name in ("1", "2"):
        total = sum(getattr(outputs, f"wear_rate_{name}") * dt for outputs, dt in zip(found, steps, strict=True))
        assert getattr(found[-1], f"wear_volume_{name}") == approx(total, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("speed_1", "speed_2"), [(0.2475, 0.2525), (-0.3, -0.2)])
def test_archards_volume_is_met_by_both_moving_bodies(speed_1, speed_2):
    """dV/dt = K W_c W |u_s| / H, whoever wears and however often a point passes."""
    scene, state, op = cheap(BARE)
    _, outputs = advance(scene, replace(op, speed_1=speed_1, speed_2=speed_2), state, 0.0)
    law, solids = scene.wear, outputs.contact_load_ratio * op.load
    expected = law.bare * solids * abs(speed_1 - speed_2) / scene.plasticity.hardness
    assert outputs.wear_rate_1 == approx(expected, rel=1e-9, abs=0.0)
    assert outputs.wear_rate_2 == approx(expected, rel=1e-9, abs=0.0)


@pytest.mark.parametrize(
    ("speed_1", "speed_2"),
    [(0.0, 0.05), *(pytest.param(*each, marks=pytest.mark.long) for each in [(0.05, 0.0), (0.0, -0.05)])],
)
def test_archards_volume_is_met_by_a_resting_body_too(speed_1, speed_2):
    scene, state, op = cheap(BARE)
    state, _ = advance(scene, replace(op, speed_1=speed_1, speed_2=speed_2), state, 0.0)
    state, outputs = advance(scene, replace(op, speed_1=speed_1, speed_2=speed_2), state, 1e-3)
    expected = scene.wear.bare * outputs.contact_load_ratio * op.load * 0.05 / scene.plasticity.hardness
    assert outputs.wear_rate_1 == approx(expected, rel=1e-3, abs=0.0)
    assert outputs.wear_rate_2 == approx(expected, rel=1e-3, abs=0.0)
    resting = 0 if speed_1 == 0.0 else 1
    assert state.bodies[resting].cycles == 0.0
    assert state.bodies[resting].wear.max() > 10.0 * state.bodies[1 - resting].wear.max()  # always under load


def test_wear_depths_stand_as_the_load_cycles():
    """Without tribofilm a point loses the same in every pass: the shorter track wears deeper."""
    scene, state, op = cheap(BARE)
    _, outputs = advance(scene, op, state, 300.0)
    passes = outputs.load_cycles_1 / outputs.load_cycles_2
    per_pass = op.speed_2 / op.speed_1  # pressure times sliding distance of a pass: p |u_s| (length / u)
    assert outputs.wear_depth_1 / outputs.wear_depth_2 == approx(passes * per_pass, rel=0.02)
    assert passes == approx(28361.0 / 7419.0, rel=1e-3)


def test_two_hours_of_case_a_are_28361_and_7419_load_cycles():
    scene, state, op = cheap(**LONG_BLOCKS)
    state, outputs = advance(scene, op, state, 7200.0)
    assert round(outputs.load_cycles_1) == 28361
    assert round(outputs.load_cycles_2) == 7419
    assert state.time == approx(7200.0, rel=1e-12)
    assert finite(outputs)
    assert 20e-9 < outputs.tribofilm_1 < 120e-9
    assert outputs.coverage_1 > 0.8
    assert outputs.wear_volume_1 > 0.0


def test_friction_opposes_sliding_and_is_odd():
    scene, state, op = cheap(control__mixed_instants="32")
    ahead = advance(scene, replace(op, speed_1=0.2525, speed_2=0.2475), state, 0.0)[1]
    back = advance(scene, replace(op, speed_1=0.2475, speed_2=0.2525), state, 0.0)[1]
    assert ahead.friction_force < 0.0 < back.friction_force
    # the surfaces meet differently, and the rough one is slower than its oil or faster: the less sliding, the less so
    assert back.friction_force == approx(-ahead.friction_force, rel=0.05)
    for outputs, slide in ((ahead, 0.005), (back, -0.005)):
        assert outputs.power_loss == approx(-outputs.friction_force * slide, rel=1e-12)
        assert outputs.friction_coefficient == approx(abs(outputs.friction_force) / op.load, rel=1e-12)
        assert outputs.power_loss > 0.0
        assert 0.01 < outputs.friction_coefficient < 0.13


def test_tribofilm_stays_between_nothing_and_its_full_thickness():
    scene, state, op = settled(**LONG_BLOCKS, control__driver="dry")
    for dt in (1.0, 100.0, 3000.0, 20000.0):
        state, outputs = advance(scene, op, state, dt)
        for body in state.bodies:
            assert body.growth.min() >= 0.0
            assert (body.growth - body.removal).max() <= scene.tribofilm.full_thickness
        assert 0.0 <= outputs.tribofilm_1 <= scene.tribofilm.full_thickness
        assert 0.0 <= outputs.coverage_2 <= 1.0


def test_without_additive_no_growth_law_runs_and_no_array_changes():
    scene, state, op = cheap(BARE)
    onward, outputs = advance(scene, op, state, 100.0)
    for old, new in zip(state.bodies, onward.bodies, strict=True):
        assert new.growth is old.growth
        assert new.removal is old.removal
    assert outputs.tribofilm_1 == outputs.coverage_2 == outputs.tribofilm_roughness_1 == 0.0
    assert outputs.wear_volume_1 > 0.0


def test_without_wear_nothing_is_worn():
    scene, state, op = cheap(wear__model="none")
    state, outputs = advance(scene, op, state, 10.0)
    assert not state.bodies[0].wear.any()
    assert outputs.wear_rate_1 == outputs.wear_volume_2 == outputs.wear_depth_1 == 0.0
    assert outputs.tribofilm_1 > 0.0


def test_additive_lowers_wear():
    dry = {"control.driver": "dry"}
    runs = cheap(CHEAP | dry), cheap(BARE | dry)
    with_film, without = (advance(scene, op, state, 200.0)[1] for scene, state, op in runs)
    assert with_film.wear_rate_1 < 0.95 * without.wear_rate_1


def test_no_load_rests_the_surfaces_and_the_contact_comes_back():
    scene, state, op = settled()
    state, _ = advance(scene, op, state, 1.0)
    lifted, outputs = advance(scene, replace(op, load=0.0), state, 50.0)
    assert finite(outputs)
    assert outputs.friction_force == outputs.friction_coefficient == outputs.contact_load_ratio == 0.0
    assert outputs.wear_rate_1 == outputs.wear_rate_2 == outputs.pressure_max == 0.0
    assert RangeFlag.LAMBDA_CAPPED in raised(outputs)
    for old, new in zip(state.bodies, lifted.bodies, strict=True):
        assert (new.wear == old.wear).all()
        assert (new.growth == old.growth).all()
        assert new.cycles > old.cycles
    _, again = advance(scene, op, lifted, 1.0)
    assert again.contact_load_ratio > 0.0
    assert RangeFlag.LAMBDA_CAPPED not in raised(again)


def test_a_run_may_begin_without_load():
    scene, state, op = cheap()
    state, outputs = advance(scene, replace(op, load=0.0), state, 10.0)
    assert finite(outputs)
    assert outputs.wear_volume_1 == 0.0
    assert outputs.suggested_step > 0.0
    assert advance(scene, op, state, 10.0)[1].wear_volume_1 > 0.0


def test_bodies_at_rest_neither_wear_nor_grow_a_film():
    scene, state, op = cheap()
    state, outputs = advance(scene, replace(op, speed_1=0.0, speed_2=0.0), state, 1000.0)
    assert finite(outputs)
    assert outputs.contact_load_ratio == approx(1.0, rel=1e-6)  # without the faintest asperities below the grid
    assert outputs.friction_force == outputs.power_loss == outputs.flash_temperature_rise == 0.0
    for body in state.bodies:
        assert not body.wear.any()
        assert not body.growth.any()
        assert body.cycles == 0.0


def test_pure_rolling_does_not_wear():
    scene, state, op = cheap()
    state, outputs = advance(scene, replace(op, speed_1=0.25, speed_2=0.25), state, 10.0)
    assert outputs.wear_volume_1 == outputs.friction_force == outputs.power_loss == 0.0
    assert outputs.load_cycles_1 > 0.0


def test_a_new_solution_follows_the_inputs_and_not_the_calls():
    scene, state, op = cheap(control__change="200 nm")
    state, first = advance(scene, op, state, 0.1)
    solved = first.blocks_mixed + first.blocks_dry
    for factor in (1.0, 1.01, 0.99):
        state, outputs = advance(scene, replace(op, load=factor * op.load), state, 0.1)
        assert outputs.blocks_mixed + outputs.blocks_dry == solved
    _, moved = advance(scene, replace(op, load=1.1 * op.load), state, 0.1)
    assert moved.blocks_mixed + moved.blocks_dry == solved + 1.0
    _, warmer = advance(scene, replace(op, temperature=op.temperature + 4.9), state, 0.1)
    assert warmer.blocks_mixed + warmer.blocks_dry == solved + 1.0


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        *((name, 1.05) for name in ("load", "speed_1", "speed_2", "spin", "radius_x", "radius_y")),
        *((name, 1.02) for name in ("temperature", "body_temperature_1", "body_temperature_2")),  # 7 K
    ],
)
def test_a_change_of_any_input_asks_for_a_new_solution(name, factor):
    scene, _, op = cheap(control__input_change=0.02, heat__bulk="inputs")
    warm, radius = op.temperature, scene.geometry.radius_x
    given = {"spin": 100.0, "body_temperature_1": warm, "body_temperature_2": warm, "radius_x": radius}
    op = replace(op, radius_y=radius, **given)
    if name == "temperature":  # bodies without an input have the oil's
        op = replace(op, body_temperature_1=None, body_temperature_2=None)
    case, other = (Case.bind(scene, replace(op, **{name: f * getattr(op, name)})) for f in (1.0, factor))
    assert other.differs_from(case.op)
    assert not case.differs_from(case.op)


def test_the_suggested_step_is_when_the_next_solution_is_due():
    scene, state, op = settled()
    state, outputs = advance(scene, op, state, 1.0)
    solved = outputs.blocks_mixed
    assert advance(scene, op, state, 0.85 * outputs.suggested_step)[1].blocks_mixed == solved
    assert advance(scene, op, state, 1.02 * outputs.suggested_step)[1].blocks_mixed == solved + 1.0


@pytest.mark.parametrize(
    ("name", "value"), [("load", -1.0), ("load", np.nan), ("speed_1", np.inf), ("temperature", 100.0)]
)
def test_an_input_that_cannot_be_used_is_refused_by_name_and_the_state_goes_on(name, value):
    scene, state, op = settled()
    state, _ = advance(scene, op, state, 5.0)
    before = state.to_bytes()
    with pytest.raises(OperatingPointError, match=rf"^{name} = "):
        advance(scene, replace(op, **{name: value}), state, 5.0)
    assert state.to_bytes() == before
    assert advance(scene, op, state, 5.0)[0].time == approx(10.0)


@pytest.mark.parametrize("dt", [-1.0, np.nan, np.inf])
def test_a_step_that_cannot_be_used_is_refused(dt):
    scene, state, op = cheap()
    with pytest.raises(OperatingPointError, match=r"dt = .* s must be at least 0 and at most 1e\+09 s"):
        advance(scene, op, state, dt)


def test_flags_tell_what_is_uncertain():
    scene, state, op = settled()
    plain = raised(state.outputs)
    assert RangeFlag.INLET_UNRESOLVED in plain
    assert not plain & (
        RangeFlag.TRIBOFILM_TEMPERATURE | RangeFlag.FEW_NODES | RangeFlag.LAMBDA_CAPPED | RangeFlag.DOMAIN_EDGE
    )
    hardy, *_ = cheap(tribofilm__beyond_fit="extrapolate")
    cold = raised(advance(hardy, replace(op, temperature=op.temperature - 6.0), state, 0.0)[1])
    assert RangeFlag.TRIBOFILM_TEMPERATURE in cold
    light = raised(advance(scene, replace(op, load=1.0), state, 0.0)[1])
    assert RangeFlag.FEW_NODES in light
    heavy = raised(advance(scene, replace(op, load=400.0), state, 0.0)[1])
    assert RangeFlag.DOMAIN_EDGE in heavy
    fast = raised(advance(scene, replace(op, speed_1=39.6, speed_2=40.4), state, 0.0)[1])
    assert RangeFlag.INLET_UNRESOLVED not in fast


def test_smooth_bodies_have_a_capped_lambda():
    scene, state, op = cheap(BARE, surface_1__rq="0 nm", surface_2__rq="0 nm", wear__model="none")
    _, outputs = advance(scene, op, state, 0.0)
    assert RangeFlag.LAMBDA_CAPPED in raised(outputs)
    assert outputs.lambda_ratio == 1e3
    assert outputs.roughness_1 == outputs.roughness_raw_2 == 0.0


def test_solutions_cut_short_are_flagged():
    scene, state, op = cheap(film__iterations=2, film__tolerance="1e-8")
    _, outputs = advance(scene, op, state, 0.0)
    assert RangeFlag.NOT_CONVERGED in raised(outputs)
    assert finite(outputs)


def test_each_body_keeps_its_own_surface():
    scene, state, op = settled()
    state, outputs = advance(scene, op, state, 100.0)
    one, two = state.bodies
    assert not np.array_equal(one.wear, two.wear)
    assert not np.array_equal(one.growth, two.growth)
    assert outputs.coverage_1 > outputs.coverage_2  # the smooth ball's points meet all asperities of the disc


def test_friction_falls_with_entrainment_from_boundary_to_full_film():
    found = []
    for speed in (1e-4, 0.25, 20.0):
        scene, state, op = cheap()
        found.append(advance(scene, replace(op, speed_1=0.99 * speed, speed_2=1.01 * speed), state, 0.0)[1])
    shares = [outputs.contact_load_ratio for outputs in found]
    frictions = [outputs.friction_coefficient for outputs in found]
    assert shares[0] > 0.98
    assert shares[2] < 0.05
    assert shares[0] > shares[1] > shares[2]
    law = scene.boundary_friction
    assert frictions[0] == approx(law.bare * np.tanh(2e-6 / law.slip_speed), rel=0.05)
    assert frictions[0] > frictions[1] > frictions[2]


def test_bulk_temperatures_are_the_oils():
    scene, state, op = settled()
    outputs = advance(scene, replace(op, temperature=362.0), state, 1.0)[1]
    assert outputs.temperature_1 == outputs.temperature_2 == 362.0


def test_a_temperature_where_the_film_constants_do_not_hold_is_refused():
    scene, state, op = cheap()
    with pytest.raises(OperatingPointError, match=r"temperature = 373 K is outside"):
        advance(scene, replace(op, temperature=373.0), state, 1.0)


@pytest.mark.long
def test_a_change_of_direction_is_survived_with_finite_outputs():
    scene, state, op = cheap()
    for u in (0.25, 0.0, -0.01, 0.25):
        state, outputs = advance(scene, OperatingPoint(op.load, 0.99 * u, 1.01 * u, op.temperature), state, 2.0)
        assert finite(outputs)
        assert outputs.power_loss >= 0.0
    assert state.time == 8.0


@pytest.mark.parametrize(("load", "speed"), [("2 N", 5.0), ("0.5 N", 20.0), ("5 N", 10.0)])
def test_a_film_far_thicker_than_the_contact_is_deep_is_survived_and_said(load, speed):
    """Rigid, isoviscous regime: finite outputs that carry the load on the film, or a refusal that names the film."""
    smooth = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "lubricant.viscosity.viscosity": "40 mPa s"}
    scene, state, op = cheap(CHEAP | smooth | {"operation.load": load, "film.domain": "0.4 mm"})
    op = replace(op, speed_1=1.01 * speed, speed_2=0.99 * speed)
    try:
        _, outputs = advance(scene, op, state, 0.0)
    except ConvergenceError as error:
        assert "oil film of about" in str(error) and "film.domain" in str(error)
    else:
        assert finite(outputs)
        assert outputs.contact_load_ratio < 0.05


@pytest.mark.long
def test_nothing_grows_or_wears_in_pure_rolling():
    scene, state, op = cheap()
    state, outputs = advance(scene, replace(op, speed_1=0.1, speed_2=0.1), state, 600.0)
    assert outputs.contact_load_ratio > 0.0
    assert outputs.tribofilm_1 == outputs.tribofilm_2 == outputs.wear_volume_1 == outputs.wear_volume_2 == 0.0


@pytest.mark.parametrize(
    ("speed_2", "told"), [(0.095, False), (0.08, True), pytest.param(0.0, False, marks=pytest.mark.long)]
)
def test_a_body_too_slow_to_show_its_track_is_told(speed_2, told):
    scene, state, op = cheap()
    _, outputs = advance(scene, replace(op, speed_1=0.1, speed_2=speed_2), state, 0.0)
    assert bool(raised(outputs) & RangeFlag.SLOW_BODY) is told


def test_wear_is_archards_of_the_load_that_the_solids_carry():
    scene, state, op = cheap(BARE)
    _, outputs = advance(scene, op, state, 0.0)
    law, solids = scene.wear, outputs.contact_load_ratio * op.load
    assert 0.05 < outputs.contact_load_ratio < 0.95
    expected = law.bare * solids * abs(op.speed_1 - op.speed_2) / scene.plasticity.hardness
    assert outputs.wear_rate_1 == approx(expected, rel=1e-9, abs=0.0)


@pytest.mark.parametrize(  # that of a map: properties/test_map_random
    "level", ["deterministic", "regression", pytest.param("auto", marks=pytest.mark.long)]
)
def test_every_output_stays_within_its_declared_range_whichever_way_the_bodies_move(level):
    scene, fresh, op = cheap()
    scene, signs = scene.at_level(level), {}
    for one, two, spin in ((0.2, 0.1, 0.0), (-0.2, -0.1, 0.0), (0.1, 0.2, 50.0), (-0.1, -0.2, -50.0)):
        _, outputs = advance(scene, replace(op, speed_1=one, speed_2=two, spin=spin), fresh, 0.5)
        for name, value in asdict(outputs).items():
            assert list(value_out_of_range(TABLE[name], value)) == []
            signs.setdefault(name, set()).add(math.copysign(1.0, value) if value else 0.0)
    # the motions do reach both signs of what has two
    for name in ("friction_force", "rolling_resistance", "friction_solid", "friction_fluid", "dfriction_dload"):
        assert {-1.0, 1.0} <= signs[name]
