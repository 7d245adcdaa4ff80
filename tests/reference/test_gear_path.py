"""FZG test gears against tabulated values, and the path of contact against involutes drawn point by point."""

import math

import numpy as np
import pytest
from closed_forms import slide_to_roll
from comparison import approx

from contact_core.reference import hertz_line
from system_models.machines.gear_pair.geometry import FZG_A, FZG_C, FZG_STAGES
from system_models.machines.gear_pair.path import radius, stations_of, steps, surface_speeds
from system_models.machines.gear_pair.sharing import Sharing, loads, mean_stiffness, pair_stiffness, single_stiffness

PAIRS = pytest.mark.parametrize("pair", [FZG_C, FZG_A])
PINION = 2170.0 * 2.0 * math.pi / 60.0  # rad/s: 8.3 m/s at the pitch circle


def test_the_mesh_of_type_c():
    assert math.degrees(FZG_C.working_pressure_angle) == approx(22.439, abs=5e-4)
    found = [FZG_C.base_radius_1, FZG_C.base_radius_2, FZG_C.line_length, FZG_C.base_pitch]
    assert found == approx([33.829e-3, 50.743e-3, 34.925e-3, 13.2846e-3], rel=2e-5)
    assert 0.5 * np.array([FZG_C.tip_diameter_1, FZG_C.tip_diameter_2]) == approx([41.225e-3, 59.175e-3], rel=2e-4)
    assert FZG_C.contact_ratio == approx(1.436, rel=2e-3)
    assert PINION * FZG_C.pitch_radius_1 == approx(8.32, abs=5e-3)


# position, radius [mm], slide-to-roll ratio, speeds [m/s]
TYPE_C = {
    "A": (4.482, 3.907, -1.276, 1.019, 4.612),
    "B": (10.276, 7.253, -0.461, 2.335, 3.734),
    "C": (13.970, 8.382, 0.0, 3.175, 3.175),
    "D": (17.767, 8.729, 0.433, 4.037, 2.599),
    "E": (23.561, 7.667, 1.027, 5.354, 1.722),
}


@pytest.mark.parametrize(
    ("point", "place"),
    [
        ("A", FZG_C.start),
        ("B", FZG_C.single_start),
        ("C", FZG_C.pitch_point),
        ("D", FZG_C.single_end),
        ("E", FZG_C.end),
    ],
)
def test_the_path_of_type_c_to_half_a_percent(point, place):
    position, curved, sliding, *speeds = TYPE_C[point]
    assert (1e3 * place, 1e3 * radius(FZG_C, place)) == approx((position, curved), rel=5e-3)
    assert slide_to_roll(FZG_C, place) == approx(sliding, rel=5e-3, abs=1e-12)
    assert surface_speeds(FZG_C, place, PINION, PINION / 1.5) == approx(speeds, rel=5e-3)


STAGES_C = [173, 353, 566, 743, 924, 1108, 1290, 1474, 1656, 1839, 2021, 2202, 2385, 2546]  # MPa
STAGES_B = [186, 379, 608, 798, 993, 1191, 1387, 1584, 1780, 1977, 2173, 2368, 2564, 2737]


@pytest.mark.parametrize(
    ("place", "pressures"), [(FZG_C.pitch_point, STAGES_C), (FZG_C.single_start + 1e-9, STAGES_B)], ids=["C", "B"]
)
def test_the_pressures_of_all_load_stages(place, pressures):
    for torque, pressure in zip(FZG_STAGES[0.5], pressures, strict=True):
        force = float(loads(FZG_C, Sharing(), torque / FZG_C.base_radius_1, np.array(place)))
        contact = hertz_line(force, radius(FZG_C, place), FZG_C.face_width, FZG_C.reduced_modulus)
        assert 1e-6 * contact.pressure_max == approx(pressure, rel=5e-3)


def test_the_pressure_of_type_a_at_load_stage_12():
    """ISO 14635-1 prints 1841 MPa for the whole load at C, where in fact two pairs carry."""
    force = FZG_STAGES[0.5][11] / FZG_A.base_radius_1
    at_c = hertz_line(force, radius(FZG_A, FZG_A.pitch_point), FZG_A.face_width, FZG_A.reduced_modulus)
    assert 1e-6 * at_c.pressure_max == approx(1841.0, rel=2e-3)
    assert FZG_A.pitch_point < FZG_A.single_start
    halved = loads(FZG_A, Sharing(), force, np.array(FZG_A.pitch_point))
    assert halved == approx(0.5 * force, rel=1e-12)


@PAIRS
def test_profile_shifts_and_centre_distance_leave_no_backlash(pair):
    assert abs(pair.backlash) < 1e-7


@PAIRS
def test_speeds_are_those_of_turning_gears_across_the_common_tangent_of_both_base_circles(pair):
    """Pinion about (0, 0), counterclockwise, wheel about (a, 0), clockwise; velocities as cross products."""
    angle = pair.working_pressure_angle
    along, across = np.array([math.sin(angle), math.cos(angle)]), np.array([-math.cos(angle), math.sin(angle)])
    axis_1, axis_2 = np.zeros(2), np.array([pair.centre_distance, 0.0])
    foot_1 = -pair.base_radius_1 * across
    foot_2 = axis_2 + pair.base_radius_2 * across
    assert foot_2 - foot_1 == approx(pair.line_length * along, rel=1e-12)
    pitch_point = np.array([pair.pitch_radius_1, 0.0])
    assert (pitch_point - foot_1) @ along == approx(pair.pitch_point, rel=1e-12)
    for place in np.linspace(pair.start, pair.end, 5):
        point = foot_1 + place * along
        arm_1, arm_2 = point - axis_1, point - axis_2
        velocity_1 = PINION * np.array([-arm_1[1], arm_1[0]])
        velocity_2 = PINION / pair.ratio * np.array([arm_2[1], -arm_2[0]])
        assert velocity_1 @ along == approx(velocity_2 @ along, rel=1e-12)
        speeds = surface_speeds(pair, place, PINION, PINION / pair.ratio)
        assert (velocity_1 @ across, velocity_2 @ across) == approx(speeds, rel=1e-12)


@PAIRS
def test_the_radius_is_that_of_two_involutes_drawn_point_by_point(pair):
    for place in np.linspace(pair.start, pair.end, 5):
        curvature = 0.0
        reach = place, pair.line_length - place
        for base, length in zip((pair.base_radius_1, pair.base_radius_2), reach, strict=True):
            wound = length / base + 1e-3 * np.array([-1.0, 0.0, 1.0])
            x = base * (np.cos(wound) + wound * np.sin(wound))
            y = base * (np.sin(wound) - wound * np.cos(wound))
            slope, bend = np.array([x[2] - x[0], y[2] - y[0]]) / 2.0, np.array([x, y]) @ [1.0, -2.0, 1.0]
            curvature += (slope[0] * bend[1] - slope[1] * bend[0]) / np.hypot(*slope) ** 3
        assert 1.0 / curvature == approx(radius(pair, place), rel=1e-4)


@PAIRS
def test_stations_stand_in_the_middles_of_pieces_that_end_at_a_b_c_d_and_e(pair):
    found = stations_of(pair, 21)
    assert len(found.position) == 21
    ends = np.concatenate([[pair.start], pair.start + np.cumsum(found.stretch)])
    assert ends[-1] == approx(pair.end, rel=1e-12)
    assert found.position == approx(0.5 * (ends[1:] + ends[:-1]), rel=1e-12)
    for point in (pair.single_start, pair.pitch_point, pair.single_end):
        assert np.abs(ends - point).min() < 1e-12
        assert np.abs(steps(pair) - point).min() < 1e-12
    assert found.stretch.max() < 1.35 * found.stretch.min()


def test_the_stiffness_of_iso_6336():
    """By hand for type C: q' = 0.06339 mm um/N, C_B = 0.975, so c' = 0.8 * 0.975 / q'."""
    assert 1e-9 * single_stiffness(FZG_C) == approx(12.305, rel=1e-3)
    assert mean_stiffness(FZG_C) / single_stiffness(FZG_C) == approx(0.75 * 1.4375 + 0.25, rel=1e-4)
    amid = 0.5 * (FZG_C.start + FZG_C.end)
    shape = [pair_stiffness(FZG_C, place) / single_stiffness(FZG_C) for place in (FZG_C.start, amid, FZG_C.end)]
    assert shape == approx([0.55, 1.0, 0.55])
