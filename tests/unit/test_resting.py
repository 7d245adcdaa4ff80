"""A pin at rest on a moving disc: wear against Archard's volume and the scar of a ball in closed form, steps, cost."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import HARD, approx
from test_wear_volumes import LINE, ROLLER

from contact_core import RangeFlag, advance, track_of
from contact_core.kernels.dry import dry_solution
from contact_core.kernels.half_space import HalfSpace

SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"} | HARD
DRY = CHEAP | {"tribofilm.model": "none", "control.driver": "dry", "control.dry_instants": "1"}
PIN = DRY | SMOOTH | {"film.points": "53", "film.domain": "0.8 mm", "wear.bare": "1e-7"}
SPEED = 0.2


def slid(scene, state, op, steps, resting=0):
    speeds = {"speed_1": 0.0, "speed_2": SPEED} if resting == 0 else {"speed_1": SPEED, "speed_2": 0.0}
    for dt in steps:
        state, outputs = advance(scene, replace(op, **speeds), state, dt)
    return state, outputs


def blocks(outputs):
    return outputs.blocks_mixed + outputs.blocks_dry


def radius(scene, wear):
    """Radius [m] of a cap of the same volume and second moment as a scar: mean r^2 = a^2 / 3."""
    grid = scene.grid(wear.shape[0])
    square = grid.x[None, :-1] ** 2 + grid.y[:, None] ** 2
    return float(np.sqrt(3.0 * (wear * square).sum() / wear.sum()))


def volume_of_scar(a, scene, load):
    """Volume [m3] that an even pressure wears off a ball, up to a radius a of the scar.

    The cap pi a^4 / (4 R), less what the even pressure bends the scar below its edge: the mean deformation is
    16 p a / (3 pi E*), that at the edge 4 p a / (pi E*) (Johnson, Contact Mechanics, 1985, section 3.4), E* = E' / 2.
    """
    bent = (16.0 / 3.0 - 4.0) / np.pi * load * a / (0.5 * scene.solids.reduced_modulus)
    return 0.25 * np.pi * a**4 / scene.geometry.radius_x - bent


@pytest.mark.parametrize("resting", [0, pytest.param(1, marks=pytest.mark.long)])
def test_an_hour_wears_archards_volume_off_a_pin_and_the_scar_of_an_even_pressure(resting):
    scene, state, op = cheap(PIN)
    state, outputs = slid(scene, state, op, [3600.0], resting)
    volume = 1e-7 * op.load * SPEED * 3600.0 / scene.plasticity.hardness
    assert outputs.wear_volume_1 == approx(volume, rel=1e-9, abs=0.0)
    assert outputs.wear_volume_2 == approx(volume, rel=1e-9, abs=0.0)
    pin = state.bodies[resting]
    a = radius(scene, pin.wear)
    assert a > 1.9 * scene.hertz(op.load).a  # where the pressure has become even
    assert volume_of_scar(a, scene, op.load) == approx(volume, rel=0.02)
    middle = pin.wear > 0.3 * pin.wear.max()
    assert float(pin.pressure[middle].std()) < 0.05 * float(pin.pressure[middle].mean())
    assert blocks(outputs) < 60


@pytest.mark.parametrize(
    ("steps", "change"), [([60.0] * 20, "3 nm"), pytest.param([1200.0], "1 nm", marks=pytest.mark.long)]
)
def test_the_scar_depends_neither_on_the_callers_steps_nor_on_those_of_blocks(steps, change):
    scene, state, op = cheap(PIN)
    whole = slid(scene, state, op, [1200.0])[0].bodies[0].wear
    other, fresh, _ = cheap(PIN, control__change=change)
    found = slid(other, fresh, op, steps)[0].bodies[0].wear
    assert float(np.abs(found - whole).mean()) < 0.01 * float(whole.mean())
    assert float(np.abs(found - whole).max()) < 0.02 * float(whole.max())


def test_a_rough_disc_wears_a_pin_as_evenly_as_a_smooth_one():
    """A block meets a few places of the disc, and the pin all of them in every turn."""
    smooth, state, op = cheap(PIN)
    rough, fresh, _ = cheap(PIN, surface_2__rq="100 nm")
    even = slid(smooth, state, op, [600.0])[0].bodies[0].wear
    found = slid(rough, fresh, op, [600.0])[0].bodies[0].wear
    along = found - even
    along = along - along.mean(axis=1, keepdims=True)  # the disc's rows differ in the mean over the patch
    assert float(along.std()) < 10e-9


def test_the_roughness_of_a_pin_is_worn_off_in_its_scar():
    scene, state, op = cheap(PIN, surface_1__rq="50 nm", surface_1__correlation_length="50 um")
    even = slid(*cheap(PIN), [1200.0])[0].bodies[0].wear
    found = slid(scene, state, op, [1200.0])[0]
    track = track_of(scene, found, 1)
    inside = even > 0.5 * even.max()
    shape = even - (track.wear - track.new)  # what is left of the heights, free of the scar's shape
    assert float(track.new[inside].std()) > 30e-9
    assert float(shape[inside].std()) < 10e-9


@pytest.mark.long
def test_a_minute_of_a_lubricated_pin_asks_for_few_blocks_and_no_shorter_ones():
    scene, state, op = cheap()
    _, outputs = slid(scene, state, op, [60.0])
    assert blocks(outputs) < 40
    assert not RangeFlag(outputs.range_flags) & RangeFlag.STIFF_WEAR


def test_a_scar_that_outgrows_the_grid_is_flagged_and_asks_for_no_more_rows():
    scene, state, op = cheap(PIN, film__domain="0.5 mm", wear__bare="1e-5")
    state, outputs = slid(scene, state, op, [1.0])
    assert not RangeFlag(outputs.range_flags) & RangeFlag.DOMAIN_EDGE
    state, outputs = slid(scene, state, op, [60.0, 600.0])
    assert RangeFlag(outputs.range_flags) & RangeFlag.DOMAIN_EDGE
    assert state.rows <= 1.5 * scene.rows
    volume = 1e-5 * op.load * SPEED * 661.0 / scene.plasticity.hardness
    assert 0.9 * volume < outputs.wear_volume_1 < volume  # the last column, which carries none on a patch, has a part


def test_a_groove_of_earlier_motion_neither_flags_a_scar_at_rest_nor_keeps_it_from_more_rows():
    scene, state, op = cheap(
        PIN | {"film.points": "33", "film.domain": "0.65 mm", "geometry.radius_y": "16 mm", "wear.bare": "1e-6"},
        control__dry_instants=8,
    )
    state, _ = advance(scene, replace(op, speed_2=0.05), state, 60.0)
    assert state.bodies[0].wear[16].min() > 5e-9 and state.rows == scene.rows
    for _ in range(6):
        state, outputs = slid(scene, state, op, [30.0])
        assert not RangeFlag(outputs.range_flags) & RangeFlag.DOMAIN_EDGE
    assert state.rows > scene.rows


def test_a_scar_made_at_rest_is_flagged_while_its_body_moves():
    """The patch repeats it all along the track; the volume is that of the one scar."""
    scene, state, op = cheap(PIN, control__dry_instants=8)
    moved, outputs = advance(scene, replace(op, speed_2=0.05), state, 600.0)
    assert not RangeFlag(outputs.range_flags) & RangeFlag.DOMAIN_EDGE
    scarred, still = slid(scene, moved, op, [600.0])
    assert not RangeFlag(still.range_flags) & RangeFlag.DOMAIN_EDGE
    _, outputs = advance(scene, op, scarred, 1.0)
    assert RangeFlag(outputs.range_flags) & RangeFlag.DOMAIN_EDGE
    assert outputs.wear_volume_1 == approx(still.wear_volume_1, rel=1e-3)


@pytest.mark.parametrize("shape", [LINE, ROLLER], ids=["line", "roller"])
def test_archards_volume_is_met_by_bodies_at_rest_of_other_shapes(shape):
    scene, state, op = cheap(shape | {"tribofilm.model": "none", "wear.bare": "1e-8"})
    _, outputs = slid(scene, state, op, [600.0])
    volume = 1e-8 * op.load * SPEED * 600.0 / scene.plasticity.hardness
    assert outputs.wear_volume_1 == approx(volume, rel=1e-6, abs=0.0)
    assert blocks(outputs) < 60


def test_two_bodies_at_rest_wear_alike_under_spin():
    scene, state, op = cheap(DRY | SMOOTH)
    state, outputs = advance(scene, replace(op, speed_1=0.0, speed_2=0.0, spin=1.0), state, 60.0)
    assert outputs.wear_volume_1 == approx(outputs.wear_volume_2, rel=1e-9, abs=0.0)
    assert outputs.wear_volume_1 > 0.0
    assert state.bodies[0].wear == approx(state.bodies[1].wear, rel=1e-9, abs=1e-15)


def test_nodes_that_give_way_by_themselves_press_like_springs_beside_the_half_space():
    """In contact the gap is closed by both; stiff half spaces leave a mattress: p = (depth - gap) / soft."""
    n, soft = 65, 0.7
    x = np.linspace(-1.0, 1.0, n)
    gap = x[None, :] ** 2 + x[:, None] ** 2
    cap, load, start = np.full((n, n), 1e9), 200.0, np.ones((n, n))
    uneven = soft * (1.0 + 0.5 * x[None, :])
    half_space = HalfSpace(n, n, 0.02, "scipy")
    found = dry_solution(half_space, gap, cap, load, start, 1e-8, 2000, np.broadcast_to(uneven, (n, n)))
    left = gap + half_space.deform(found.pressure) + uneven * found.pressure + found.rigid
    touching = found.pressure > 0.0
    assert found.converged
    assert found.pressure.sum() == approx(load, rel=1e-9)
    assert float(np.abs(left[touching]).max()) < 1e-6
    assert float(left[~touching].min()) > -1e-9
    mattress = dry_solution(HalfSpace(n, n, 1e-9, "scipy"), gap, cap, load, start, 1e-8, 2000, np.full((n, n), soft))
    assert mattress.pressure == approx(np.maximum(-mattress.rigid - gap, 0.0) / soft, rel=1e-5, abs=1e-6)
