import math

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq

from system_models.machines.gear_pair.geometry import SpurGearPair
from system_models.machines.gear_pair.mesh import GearMesh
from system_models.machines.gear_pair.path import stations_of
from system_models.machines.gear_pair.sharing import Sharing, loads, pair_stiffness


def involute(angle):
    return math.tan(angle) - angle


@st.composite
def pairs(draw):
    """Gears without backlash, with addenda that give contact ratios from 1 to above 2."""
    z1, z2 = draw(st.integers(12, 60)), draw(st.integers(12, 200))
    module, angle = draw(st.floats(0.5e-3, 20e-3)), math.radians(draw(st.sampled_from([15.0, 20.0, 25.0])))
    x1 = draw(st.floats(0.0, 0.6))
    x2 = draw(st.floats(-0.4, x1))
    asked = involute(angle) + 2.0 * math.tan(angle) * (x1 + x2) / (z1 + z2)
    assume(asked > 1e-3)
    working = brentq(lambda a: involute(a) - asked, 0.05, 1.0, xtol=1e-14)
    distance = 0.5 * module * (z1 + z2) * math.cos(angle) / math.cos(working)
    tall = draw(st.floats(0.8, 1.35))
    pair = SpurGearPair(
        teeth_1=z1, teeth_2=z2, module=module, pressure_angle=angle, shift_1=x1, shift_2=x2,
        face_width=10.0 * module, centre_distance=distance,
        tip_diameter_1=module * (z1 + 2.0 * (tall + x1)), tip_diameter_2=module * (z2 + 2.0 * (tall + x2)),
    )  # fmt: skip
    assume(not list(pair.wrong()))
    return pair


@st.composite
def sharings(draw, pair):
    if draw(st.booleans()):
        return Sharing()
    path = pair.end - pair.start
    depths = [draw(st.sampled_from([0.0, 5e-6, 40e-6])) for _ in range(2)]
    lengths = [draw(st.floats(0.01, 0.6)) * path if depth else 0.0 for depth in depths]
    return Sharing("elastic", *depths, *lengths)


@given(st.data(), pairs(), st.floats(1e-3, 1e6))
def test_the_pairs_in_contact_carry_the_whole_force_at_every_turn(data, pair, force):
    sharing = data.draw(sharings(pair))
    turned = pair.start + pair.base_pitch * (np.arange(50) + 0.5) / 50
    at = turned[:, None] + pair.base_pitch * np.arange(4)
    found = loads(pair, sharing, force, at)
    assert (found >= 0.0).all()
    assert (found[at >= pair.end] == 0.0).all()
    np.testing.assert_allclose(found.sum(axis=1), force, rtol=1e-9)


@given(pairs(), st.integers(8, 60))
def test_stations_cover_the_path_and_none_lies_on_a_step_of_the_load(pair, count):
    found = stations_of(pair, count)
    assert len(found.position) == count
    assert (np.diff(found.position) > 0.0).all()
    np.testing.assert_allclose(found.stretch.sum(), pair.end - pair.start, rtol=1e-9)
    whole = np.array(
        [loads(pair, Sharing(), 1.0, found.position + part * found.stretch) for part in (-0.49, 0.0, 0.49)]
    )
    np.testing.assert_array_equal(whole, whole[1][None, :].repeat(3, axis=0))


@given(st.data(), pairs(), st.floats(10.0, 1e5))
def test_a_mesh_of_few_stations_has_the_loss_factor_of_many(data, pair, force):
    """Relief bends the load within stretches, more so under light loads; without it the sum is of second order."""
    sharing = data.draw(sharings(pair))
    few, many = (GearMesh(pair=pair, load_sharing=sharing, stations=count) for count in (41, 401))
    inputs = {q.name: q.start for q in many.inputs} | {"torque": force * pair.base_radius_1}
    found, exact = (mesh.outputs((), inputs)["loss_factor"] for mesh in (few, many))
    tolerance = 1e-9 if sharing.model == "rigid" else 2e-3 if sharing.relief_1 == sharing.relief_2 == 0.0 else 0.05
    assert abs(found - exact) < tolerance * exact


@given(pairs(), st.floats(1.0, 1e5))
def test_a_deeper_relief_never_loads_the_tip_more(pair, force):
    length = 0.2 * (pair.end - pair.start)
    tip = np.array([pair.end - 1e-6 * length])
    found = [
        float(loads(pair, Sharing("elastic", depth, 0.0, length, 0.0), force, tip)[0]) for depth in (1e-6, 5e-6, 50e-6)
    ]
    assert found == sorted(found, reverse=True)


@given(pairs(), st.floats(10.0, 1e5))
def test_relief_of_each_tip_works_from_its_own_end_of_the_path_over_its_own_length(pair, force):
    """Beside the deflection at which springs behind gaps carry the force, found by bisection."""
    path = pair.end - pair.start
    sharing = Sharing("elastic", 30e-6, 10e-6, 0.25 * path, 0.15 * path)
    for place in pair.start + path * np.linspace(0.02, 0.98, 25):
        there = place + pair.base_pitch * np.arange(-3, 4)
        there = there[(there >= pair.start) & (there < pair.end)]
        springs = pair.face_width * pair_stiffness(pair, there)
        at_pinion_tip = 30e-6 * np.clip(1.0 - (pair.end - there) / (0.25 * path), 0.0, None)
        at_wheel_tip = 10e-6 * np.clip(1.0 - (there - pair.start) / (0.15 * path), 0.0, None)
        carried = [
            lambda deflection, k=k, gap=gap: k * max(deflection - gap, 0.0)
            for k, gap in zip(springs, at_pinion_tip + at_wheel_tip, strict=True)
        ]
        most = force / springs.min() + 40e-6
        common = brentq(lambda deflection: sum(each(deflection) for each in carried) - force, 0.0, most, xtol=1e-18)  # noqa: B023
        own = int(np.abs(there - place).argmin())
        assert math.isclose(
            loads(pair, sharing, force, np.array([place]))[0], carried[own](common), rel_tol=1e-6, abs_tol=1e-6 * force
        )
