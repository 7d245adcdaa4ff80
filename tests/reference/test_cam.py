"""A cam and its flat-faced follower, against their contour and the laws of motion."""

import math

import numpy as np
import pytest
from comparison import approx

from contact_core.errors import SceneError
from system_models.machines.cam_follower.part import CamFollower, contact_name
from system_models.machines.cam_follower.profile import CamProfile
from system_models.parts.part import indexed

LOBE = CamProfile(base_radius=18e-3, lift=8e-3, half_event=1.134)
CAM = CamFollower(lobe=LOBE, stations=15, preload=250.0, stiffness=40e3, mass=0.12)
SPEED, MU = 104.7, 0.08
ANGLES = np.linspace(-1.1, 1.1, 23)
ALL = np.append(np.linspace(-1.3, 1.3, 53), math.pi)  # event, base circle, and what lies between
STEP = 1e-5  # rad


def answered(cam=CAM, speed=SPEED, **given):
    """Outputs for values of the contacts by name, one for each station; what is not given is zero."""
    inputs = {q.name: 0.0 for q in cam.inputs} | {"speed": speed}
    for name, values in given.items():
        inputs |= {indexed(name, k): float(value) for k, value in enumerate(values, 1)}
    return cam.outputs((), inputs)


def row(answer, name, cam=CAM):
    return np.array([answer[indexed(name, k)] for k in range(1, cam.stations + 2)])


@pytest.mark.parametrize("powers", [(8, 16), (4, 5), (10, 20)])
def test_the_event_begins_and_ends_without_a_jump_of_speed_and_acceleration(powers):
    lobe = CamProfile(base_radius=0.1, lift=8e-3, half_event=1.134, power_p=powers[0], power_q=powers[1])
    ends = lobe.at(np.array([-1.134, -1.134 + 1e-9, 1.134 - 1e-9, 1.134, 2.0]))
    for values in ends:
        np.testing.assert_allclose(values, 0.0, atol=1e-7 * lobe.lift * powers[1] ** 2)
    assert lobe.at(np.zeros(1)).lift[0] == approx(lobe.lift)


def test_slope_and_curvature_are_the_derivatives_of_the_lift():
    low, mid, high = (LOBE.at(ANGLES + shift) for shift in (-STEP, 0.0, STEP))
    np.testing.assert_allclose(mid.slope, (high.lift - low.lift) / (2.0 * STEP), rtol=1e-6, atol=1e-10)
    np.testing.assert_allclose(mid.lift_second, (high.slope - low.slope) / (2.0 * STEP), rtol=1e-6, atol=1e-9)


def contour(lobe, angle):
    """Return the points [m] of the contour, in axes that turn with the cam, x through the nose."""
    found = lobe.at(angle)
    distance, along = lobe.base_radius + found.lift, found.slope
    cosine, sine = np.cos(angle), np.sin(angle)
    return distance * cosine - along * sine, distance * sine + along * cosine


def test_the_radius_of_curvature_is_that_of_the_contour():
    """Arc length over the turn of the tangent, by finite differences of the contour's points."""
    (x0, y0), (x1, y1) = contour(LOBE, ALL - STEP), contour(LOBE, ALL + STEP)
    np.testing.assert_allclose(np.hypot(x1 - x0, y1 - y0) / (2.0 * STEP), LOBE.radius(ALL), rtol=1e-6)
    # the tangent is the face of the follower, at right angles to the direction of the angle
    along = (x1 - x0) * np.cos(ALL) + (y1 - y0) * np.sin(ALL)
    np.testing.assert_allclose(along, 0.0, atol=1e-5 * 2.0 * STEP * LOBE.base_radius)


def test_no_other_point_of_the_cam_reaches_beyond_the_face_of_the_follower():
    x, y = contour(LOBE, np.linspace(-math.pi, math.pi, 3601))
    for angle in ALL:
        face = LOBE.base_radius + LOBE.at(np.array([angle])).lift[0]
        assert (x * math.cos(angle) + y * math.sin(angle)).max() <= face * (1.0 + 1e-12)


def test_surface_speeds_are_those_of_the_bodies_relative_to_the_moving_contact():
    """From positions: the contact moves along the face, the cam turns under it, the follower does not move along."""
    angles = np.array([station.angle for station in CAM.contacts[:-1]])
    contact = [LOBE.at(angles + shift).slope for shift in (-STEP, STEP)]  # beside the axis, along the face
    runs = SPEED * (contact[1] - contact[0]) / (2.0 * STEP)
    across = SPEED * (LOBE.base_radius + LOBE.at(angles).lift)  # of the cam's material there, along the face
    answer = answered()
    np.testing.assert_allclose(row(answer, "speed_1")[:-1], across + runs, rtol=1e-6)
    np.testing.assert_allclose(row(answer, "speed_2")[:-1], runs, rtol=1e-6)


def test_sliding_and_entrainment_are_those_of_the_textbook():
    answer, lift, bent = answered(), *(np.array([getattr(s, n) for s in CAM.contacts]) for n in ("lift", "lift_second"))
    u1, u2 = row(answer, "speed_1"), row(answer, "speed_2")
    np.testing.assert_allclose(u1 - u2, SPEED * (18e-3 + lift), rtol=1e-12)
    np.testing.assert_allclose(0.5 * (u1 + u2), 0.5 * SPEED * (18e-3 + lift + 2.0 * bent), rtol=1e-12)
    assert (u1[-1], u2[-1]) == approx((SPEED * 18e-3, 0.0))
    assert ((u1 + u2)[6:9] < 0.0).all(), "the nose is so sharp that the contact overtakes the cam"


def test_a_surface_point_of_the_cam_passes_once_in_a_turn():
    turns = SPEED / (2.0 * math.pi)
    for station, u1 in zip(CAM.contacts, row(answered(), "speed_1"), strict=True):
        assert u1 / CAM.track_lengths(station, 1e-4)[0] == approx(turns)
    weights = np.array([station.weight for station in CAM.contacts])
    assert (weights.sum(), weights[-1]) == approx((1.0, 1.0 - 1.134 / math.pi))


def test_the_load_moves_the_mass_against_the_spring():
    """Newton's law with the acceleration from the lift against time."""
    angles = np.array([station.angle for station in CAM.contacts[:-1]])
    low, mid, high = (LOBE.at(angles + shift).lift for shift in (-1e-4, 0.0, 1e-4))
    acceleration = SPEED**2 * (high - 2.0 * mid + low) / 1e-8
    load = row(answered(), "load")
    np.testing.assert_allclose(load[:-1] - 250.0 - 40e3 * mid, 0.12 * acceleration, rtol=1e-4)
    assert load[-1] == 250.0
    assert answered()["load_least"] == approx(load.min())


def test_a_follower_that_is_too_fast_for_its_spring_leaves_the_cam():
    """Where F_0 + k s = m w^2 |s''| comes first, which is beside the nose."""
    slowing = [station for station in CAM.contacts if station.lift_second < 0.0]
    limit = min(math.sqrt((250.0 + 40e3 * s.lift) / (-0.12 * s.lift_second)) for s in slowing)
    slow, fast = answered(speed=0.99 * limit), answered(speed=1.01 * limit)
    assert row(slow, "load").min() > 0.0
    assert row(fast, "load").min() == 0.0 > fast["load_least"]
    assert row(answered(speed=0.0), "load")[7] == approx(250.0 + 40e3 * 8e-3)


def test_the_torque_of_the_load_has_no_mean_over_a_turn():
    """What the spring and the mass take while the follower opens, they give back while it closes."""
    slope = np.array([station.slope for station in CAM.contacts])
    torque = row(answered(), "load") * slope
    assert abs(torque.sum()) <= 1e-12 * np.abs(torque).sum()


def test_friction_torque_times_speed_is_the_loss():
    free = answered()
    load, u1, u2 = (row(free, name) for name in ("load", "speed_1", "speed_2"))
    force, rolled = -MU * load * np.sign(u1 - u2), 1e-3 * load * np.sign(u1 + u2)
    answer = answered(friction_force=force, power_loss=-force * (u1 - u2), rolling_resistance=rolled)
    assert answer["friction_torque"] * SPEED == approx(answer["power_loss"])
    weights = np.array([station.weight for station in CAM.contacts])
    assert answer["power_loss"] - answer["power_rolling"] == approx(MU * (weights * load * (u1 - u2)).sum())
    assert answer["power_rolling"] == approx(1e-3 * (weights * load * abs(u1 + u2)).sum())


def test_heat_is_shared_out_by_the_time_of_the_stations():
    count = CAM.stations + 1
    answer = answered(heat_flow_1=[3.0] * count, heat_flow_2=[0.0] * CAM.stations + [1.0])
    assert answer["heat_flow_1"] == approx(3.0)
    assert answer["heat_flow_2"] == approx(1.0 - 1.134 / math.pi)


def test_means_converge_with_the_stations():
    """Mean of the load over a turn, against a fine sum."""
    angles = np.linspace(-1.134, 1.134, 200001)
    event = LOBE.at(angles)
    load = 250.0 + 40e3 * event.lift + 0.12 * SPEED**2 * event.lift_second
    exact = (np.trapezoid(load, angles) + 250.0 * (2.0 * math.pi - 2.268)) / (2.0 * math.pi)
    errors = []
    for count in (11, 21, 41):
        cam = CamFollower(lobe=LOBE, stations=count, preload=250.0, stiffness=40e3, mass=0.12)
        weights = np.array([station.weight for station in cam.contacts])
        errors.append(abs((weights * row(answered(cam), "load", cam)).sum() - exact))
    assert errors[2] < errors[1] < errors[0] < 0.01 * exact


def test_the_tracks_of_the_follower_are_the_travel_of_the_contact_along_its_face():
    """It runs to the largest slope and back, once on each side of the axis."""
    tracks = np.array([CAM.track_lengths(station, 0.0)[1] for station in CAM.contacts])
    weights = np.array([station.weight for station in CAM.contacts])
    reach = np.abs(LOBE.at(np.linspace(0.0, 1.134, 100001)).slope).max()
    assert (weights * tracks).sum() == approx(4.0 * reach, rel=1e-3)
    bent = np.array([abs(station.lift_second) for station in CAM.contacts])
    far = bent > 0.5 * bent.max()
    np.testing.assert_allclose(tracks[far], 2.0 * math.pi * bent[far], rtol=0.2)
    assert CAM.track_lengths(CAM.contacts[-1], 1e-3)[1] == 1e-3


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"base_radius": 10e-3}, "lobe.base_radius = 0.01 m leaves the cam hollow"),
        ({"power_p": 9, "power_q": 8}, "lobe.power_q = 8 must be above lobe.power_p = 9"),
    ],
)
def test_a_lobe_that_is_no_cam_is_refused(changes, said):
    lobe = CamProfile(**{"base_radius": 18e-3, "lift": 8e-3, "half_event": 1.134, **changes})
    with pytest.raises(SceneError, match=said):
        CamFollower(lobe=lobe, preload=250.0, stiffness=40e3, mass=0.12).check()


def test_contacts_are_called_by_their_stations():
    assert [contact_name(k, 2) for k in (1, 2, 3)] == ["angle_01", "angle_02", "base_circle"]
