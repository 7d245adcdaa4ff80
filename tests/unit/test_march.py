"""Marches: what moves, what is remembered, what opens, and what cycles and callers' steps make of it."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import HARD, approx

from contact_core import (
    OperatingPointError,
    Outputs,
    RangeFlag,
    Scene,
    advance,
    initial_state,
    march,
    parted,
    run_cycle,
)
from contact_core.deterministic.changing_inputs import _with_earlier_unconverged
from contact_core.state import ContactState
from contact_core.surfaces.patches import patch_nodes

SMOOTH = {"surface_1__rq": "0 m", "surface_2__rq": "0 m"}


def test_rough_bodies_move_by_at_most_a_node_and_by_their_speeds():
    scene, state, op = cheap()
    op = replace(op, speed_1=0.5, speed_2=0.3)
    time = 6.5 * scene.film.spacing / op.speed_1
    moments = list(march(scene, state, lambda time: op, [0.0, time]))
    assert len(moments) == 1 + 7
    for i, speed in enumerate((op.speed_1, op.speed_2)):
        nodes = [patch_nodes(scene, moment.state.bodies[i]) for moment in moments]
        assert set(np.diff(nodes)) <= {0, 1}
        assert moments[-1].state.bodies[i].offset == approx(speed * time, rel=1e-12)
    assert [moment.time for moment in moments] == approx(np.linspace(0.0, time, 8).tolist())


def test_smooth_bodies_go_by_the_times_asked_for_and_ramped_speeds_by_their_mean():
    scene, state, op = cheap(**SMOOTH)
    time = 20.0 * scene.film.spacing / op.speed_1
    moments = list(march(scene, state, lambda t: replace(op, speed_1=op.speed_1 * (1.0 + t / time)), [0.0, time]))
    assert len(moments) == 2
    assert moments[1].state.bodies[0].offset == approx((1.5 * op.speed_1 * time) % scene.film.domain)


def test_a_march_begins_with_the_film_of_the_state():
    scene, state, op = cheap(**SMOOTH)
    first = next(march(scene, state, lambda time: op, [0.0]))
    assert first.fields.route == "mixed"
    again = list(march(scene, first.state, lambda time: op, [0.0, 1e-5]))
    assert len(again) == 1
    assert again[0].outputs["h_c"] == approx(first.outputs["h_c"], rel=0.05)


def test_a_film_holds_bodies_that_come_to_rest_apart_for_a_while():
    scene, state, op = cheap(**SMOOTH)
    still = replace(op, speed_1=0.0, speed_2=0.0)
    fast = replace(op, speed_1=3.0, speed_2=3.0)
    times = np.linspace(0.0, 4e-5, 5)
    moments = list(march(scene, state, lambda time: still if time > 0.0 else fast, times))
    films = [moment.outputs["h_c"] for moment in moments]
    assert all(moment.fields.route == "mixed" for moment in moments)
    assert films[0] * 1.001 > films[1] > films[-1] > 0.3 * films[0]
    at_rest = next(march(scene, state, lambda time: still, [0.0]))  # without a film before
    assert at_rest.fields.route == "dry"


def test_bodies_that_fall_on_each_other_trap_oil_between_them():
    scene, state, op = cheap(**SMOOTH)
    op = replace(op, speed_1=0.0, speed_2=0.0)
    apart = parted(scene, op, state, 2e-6)
    *_, last = march(scene, apart, lambda time: op, np.linspace(0.0, 2e-4, 21))
    row = last.fields.gap[last.fields.gap.shape[0] // 2]
    inside = np.abs(last.fields.x) < scene.hertz_at(op).a
    assert last.fields.route == "mixed"
    assert row[row.size // 2] > 1.5 * row[inside].min()  # a dimple


def test_a_gap_in_which_the_bodies_would_touch_is_refused():
    scene, state, op = cheap()
    with pytest.raises(OperatingPointError, match="bodies touch at"):
        parted(scene, op, state, 0.0)


def test_no_load_opens_the_contact_and_the_next_one_begins_anew():
    scene, state, op = cheap(**SMOOTH)
    loads = [op.load, 0.0, op.load]
    moments = list(march(scene, state, lambda time: replace(op, load=loads[round(time / 1e-5)]), [0.0, 1e-5, 2e-5]))
    assert [moment.fields.route for moment in moments] == ["mixed", "open", "mixed"]
    assert moments[1].state.film is None
    assert moments[1].outputs["friction_force"] == 0.0
    assert moments[2].outputs["h_c"] == moments[0].outputs["h_c"]


def test_a_film_too_wide_for_the_grid_opens_the_contact_and_says_so():
    scene, state, op = cheap(**SMOOTH)
    light = replace(op, load=1e-3, speed_1=20.0, speed_2=20.0)
    moment = next(march(scene, state, lambda time: light, [0.0]))
    assert moment.fields.route == "open"
    assert not moment.fields.converged
    assert "enlarge the domain" in moment.fields.shortfall


@pytest.mark.parametrize("factor", [pytest.param(0.1, marks=pytest.mark.long), 10.0])
def test_a_jump_of_the_load_by_ten_is_followed(factor):
    scene, state, op = cheap(**SMOOTH, film__tolerance="1e-3", film__iterations=500)
    op = replace(op, load=15.0, speed_1=2.0, speed_2=2.0)
    duty = {0: op, 1: replace(op, load=factor * op.load)}
    first, second = march(scene, state, lambda time: duty[round(time / 2e-5)], [0.0, 2e-5])
    assert second.fields.converged, second.fields.shortfall
    assert second.fields.pressure.sum() * scene.film.spacing**2 == approx(factor * op.load, rel=2e-3)
    assert 0.3 * first.outputs["h_c"] < second.outputs["h_c"] < 1e-6  # oil of the wider gap is trapped


def test_times_and_orders_that_make_no_sense_are_refused():
    scene, state, op = cheap()
    for times in ([], [0.0, 0.0], [1.0, 0.0], [0.0, np.nan]):
        with pytest.raises(OperatingPointError, match="must increase"):
            next(march(scene, state, lambda time: op, times))
    with pytest.raises(OperatingPointError, match="order = 3"):
        next(march(scene, state, lambda time: op, [0.0], order=3))


def cycled(repeats):
    scene, state, op = cheap()
    duty = lambda time: replace(op, load=op.load * (1.0 + 0.5 * np.sin(time * 1e4)))  # noqa: E731
    return scene, *run_cycle(scene, state, duty, np.linspace(0.0, 3e-4, 7), repeats)


def test_wear_time_and_passes_of_a_cycle_are_in_proportion_to_its_repeats():
    (_, once, moments), (_, often, _) = cycled(1.0), cycled(1e4)
    assert once.time == approx(3e-4)
    assert often.time == approx(3.0)
    for one, many in zip(once.bodies, often.bodies, strict=True):
        assert one.wear.max() > 0.0
        assert many.wear == approx(1e4 * one.wear, rel=1e-12)
        assert many.worn == approx(1e4 * one.worn, rel=1e-12)
        assert many.cycles == approx(1e4 * one.cycles, rel=1e-12)
        assert many.growth.max() > 100.0 * one.growth.max() > 0.0
        assert many.offset == moments[-1].state.bodies[0].offset or many.offset == moments[-1].state.bodies[1].offset


def test_a_cycle_wears_off_what_its_solid_pressures_press():
    scene, after, moments = cycled(1.0)
    expected = np.zeros(2)
    law, hardness, cell = scene.wear, scene.plasticity.hardness, scene.film.spacing**2
    for early, late in pairwise(moments):
        solid = late.fields.solid_pressure[:, :-1].sum() * cell
        for i in (0, 1):
            speed = law.slide((late.op.speed_1, late.op.speed_2), i)
            bare = float(law.coefficient(np.zeros(1), 1e-7)[0])
            expected[i] += bare * speed * solid / hardness * (late.time - early.time)
    assert [body.worn for body in after.bodies] == approx(expected.tolist(), rel=1e-9)


def transient():
    more = {
        "control.inputs": "transient",
        "control.driver": "mixed",
        "film.tolerance": "1e-4",
        "film.iterations": "500",
    }
    scene, state, op = cheap(CHEAP | more, **SMOOTH)
    op = replace(op, load=10.0, speed_1=4.0, speed_2=3.8)
    return scene, advance(scene, op, state, 0.0)[0], op


def test_advance_follows_its_inputs_in_time_where_the_scene_asks_for_it():
    scene, state, op = transient()
    slower = replace(op, speed_1=1.5, speed_2=1.3)
    soon = advance(scene, slower, state, 2e-6)[1]
    settled = advance(scene, slower, state, 1.0)[1]
    quasi = replace(scene, control=replace(scene.control, inputs="quasi_steady"))
    steady = advance(quasi, slower, state, 2e-6)[1]
    assert soon.h_c > 1.5 * steady.h_c
    assert soon.h_c == approx(state.outputs.h_c, rel=0.1)
    assert settled.h_c == approx(steady.h_c, rel=0.05)


def test_its_steps_compose_and_go_back_bit_for_bit():
    scene, state, op = transient()
    slower = replace(op, speed_1=2.0, speed_2=1.9)

    def after(steps):
        now = state
        for _ in range(steps):
            now, out = advance(scene, slower, now, 2.4e-5 / steps)
        return now, out

    films = [after(steps)[1].h_c for steps in (4, 8, 16)]
    assert abs(films[2] - films[1]) < 0.7 * abs(films[1] - films[0]) < 0.02 * films[0]
    now, _ = after(2)
    stored = ContactState.from_bytes(now.to_bytes(), scene)
    assert now.settling > 0.0
    twice = [advance(scene, op, each, 1e-5)[0].to_bytes() for each in (now, stored)]
    assert twice[0] == twice[1]


def test_instants_that_have_not_converged_fade_by_half_with_each_that_has():
    told = [Outputs(unconverged=1.0), *[Outputs()] * 4]
    shares, flags, before = [], [], 0.0
    for outputs in told:
        after = _with_earlier_unconverged(outputs, before)
        before = after.unconverged
        shares.append(before)
        flags.append(bool(after.range_flags & RangeFlag.NOT_CONVERGED))
    assert shares == [0.5, 0.25, 0.125, 0.0625, 0.03125]
    assert flags == [True, True, True, False, False]  # above a tenth


def test_no_time_changes_nothing_while_the_film_follows():
    scene, state, op = transient()
    out = advance(scene, replace(op, load=2.0 * op.load), state, 0.0)[1]
    assert out.h_c == state.outputs.h_c


def test_reversal_goes_through_rest_without_losing_the_film():
    scene, state, op = cheap(**SMOOTH)
    speeds = dict(enumerate(np.linspace(3.0, -3.0, 13)))  # the middle one is zero
    duty = lambda time: replace(op, load=10.0, **dict.fromkeys(("speed_1", "speed_2"), speeds[round(time / 1e-5)]))  # noqa: E731
    moments = list(march(scene, state, duty, np.arange(13) * 1e-5))
    assert moments[6].op.entrainment_speed == 0.0
    assert {moment.fields.route for moment in moments} == {"mixed"}
    films = [moment.outputs["h_c"] for moment in moments]
    assert min(films) > 0.3 * films[0]
    assert np.abs(np.diff(films)).max() < 0.3 * films[0]


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_jump_of_the_radius_is_followed(factor):
    scene, state, op = cheap(**SMOOTH, film__tolerance="1e-3", film__iterations=500)
    op = replace(op, load=15.0, speed_1=2.0, speed_2=2.0)
    radii = [part * scene.radii(op)[0] for part in (1.0, 0.5 + 0.5 * factor, factor)]
    duty = [replace(op, radius_x=radius, radius_y=radius) for radius in radii]
    *_, last = march(scene, state, lambda time: duty[round(time / 1e-5)], [0.0, 1e-5, 2e-5])
    assert last.fields.converged, last.fields.shortfall
    assert last.outputs["pressure_max"] == approx(scene.hertz_at(duty[-1]).pressure_max, rel=0.05)


def test_a_film_that_clears_smooth_bodies_does_not_break_down_when_the_load_comes_back():
    changes = {"surface_1.rq": "0 m", "surface_2.rq": "0 m", "film.points": "33", "control.inputs": "transient"}
    scene = Scene.from_toml("ball_209_inner", changes)
    op = scene.operation.point
    state, _ = advance(scene, replace(op, load=0.0), initial_state(scene), 1e-4)
    _, outputs = advance(scene, op, state, 3e-5)
    _, steady = advance(scene, op, initial_state(scene), 0.0)
    assert outputs.contact_load_ratio == 0.0
    assert outputs.h_min == approx(steady.h_min, rel=0.1)


def test_a_cycle_counts_passes_and_warms_films_by_its_flash_and_its_outputs_are_means_over_time():
    """A load that rises in instants of unequal length."""
    scene, state, op = cheap(CHEAP | HARD | {"tribofilm.beyond_fit": "extrapolate", "tribofilm.dose": "clock"})
    op = replace(op, speed_1=2.0, speed_2=0.5)
    times = [0.0, 1e-6, 2e-6, 1e-5]
    after, moments = run_cycle(scene, state, lambda time: replace(op, load=op.load * (0.5 + 5e4 * time)), times, 1e7)
    period, law, body = times[-1], scene.tribofilm, after.bodies[0]
    lengths = scene.geometry.track_length_1, scene.geometry.track_length_2
    expected = [1e7 * period * speed / length for speed, length in zip((2.0, 0.5), lengths, strict=True)]
    assert [body.cycles for body in after.bodies] == approx(expected, rel=1e-9)
    parts = np.diff([moment.time for moment in moments]) / period
    for name in ("friction_force", "contact_load_ratio", "flash_temperature_rise"):
        mean = parts @ [moment.outputs[name] for moment in moments[1:]]
        assert getattr(after.outputs, name) == approx(mean, rel=1e-9), name
    assert after.outputs.flash_temperature_rise > 1.0
    flash = after.outputs.flash_temperature_rise
    cold, warm = (law.rate(op.temperature + part * flash) for part in (0.0, 3.0))
    grown = -np.log1p(-body.growth.max() / law.full_thickness) / (1e7 * period)
    removed = -np.log1p(-body.removal.max() / law.removal_thickness) / (1e7 * period)
    assert law.removal_rate * grown / removed == approx(law.rate(op.temperature + flash), rel=1e-6)
    assert cold < grown < warm


@pytest.mark.parametrize("flux", ["fitted", pytest.param("upwind", marks=pytest.mark.long)])
def test_solids_of_a_slower_rough_body_carry_about_as_much_as_those_of_a_faster_one(flux):
    """Oil that moved by more than a node in an instant halved their share, at any excess of its speed."""
    scene, state, op = cheap(surface_1__rq="0 nm", film__flux=flux)
    shares = []
    for speed in (0.248, 0.252):
        duty = replace(op, speed_1=0.5 - speed, speed_2=speed)
        moments = list(march(scene, state, lambda time, duty=duty: duty, [0.0, 2.0 * scene.film.domain / 0.25]))
        shares.append(np.mean([moment.outputs["contact_load_ratio"] for moment in moments[32:]]))
    assert shares[0] == approx(shares[1], rel=0.1)
