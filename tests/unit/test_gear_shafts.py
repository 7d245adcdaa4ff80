"""Both shafts of a gear pair against an integrator of differential equations, and in long steps."""

import math
from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import solve_ivp

from contact_core.errors import SceneError
from contact_core.scene.toml import build, unbuild
from system_models.machines.gear_pair.geometry import FZG_C
from system_models.machines.gear_pair.shafts import GearShafts
from system_models.machines.gear_pair.sharing import mean_stiffness

STIFFNESS = mean_stiffness(FZG_C) * FZG_C.face_width
SHAFTS = GearShafts(pair=FZG_C, inertia_1=0.01, inertia_2=0.03, stiffness=STIFFNESS, start_speed=200.0)
NOTHING = {
    "drive_torque": 0.0,
    "speed_drive": 0.0,
    "brake_torque": 0.0,
    "friction_torque_1": 0.0,
    "friction_torque_2": 0.0,
}
EVEN = NOTHING | {"drive_torque": 100.0, "brake_torque": 150.0}
R1, R2 = FZG_C.base_radius_1, FZG_C.base_radius_2


def quasi_static(shafts, inputs, speed=0.0):
    """Torque of the pinion at which both shafts, turning together, gain speed alike; for the whole as one inertia."""
    ratio = shafts.pair.ratio
    drive = inputs["drive_torque"] + inputs["friction_torque_1"] - shafts.coupling * speed
    brake = inputs["brake_torque"] - inputs["friction_torque_2"] + shafts.drag * speed / ratio
    gain = (drive - brake / ratio) / (shafts.inertia_1 + shafts.inertia_2 / ratio**2)
    return drive - shafts.inertia_1 * gain


def torque(shafts, state):
    return shafts.outputs(state, NOTHING)["mesh_torque"]


@pytest.mark.parametrize("drags", [(0.0, 0.0), (0.5, 2.0)])
@pytest.mark.parametrize("damping", [0.02, 0.3, 1.5])
def test_a_step_is_that_of_the_equations_of_motion(damping, drags):
    shafts = replace(SHAFTS, damping_ratio=damping, coupling=drags[0], drag=drags[1])
    inputs = NOTHING | {
        "drive_torque": 80.0,
        "brake_torque": 190.0,
        "friction_torque_1": -2.0,
        "friction_torque_2": -3.0,
    }
    mass = 1.0 / (R1 * R1 / 0.01 + R2 * R2 / 0.03)

    def motion(time, angles_and_speeds):
        angle_1, angle_2, speed_1, speed_2 = angles_and_speeds
        force = STIFFNESS * (R1 * angle_1 - R2 * angle_2)
        force += 2.0 * damping * math.sqrt(STIFFNESS * mass) * (R1 * speed_1 - R2 * speed_2)
        return (
            speed_1,
            speed_2,
            (80.0 - 2.0 - drags[0] * speed_1 - R1 * force) / 0.01,
            (R2 * force - 190.0 - 3.0 - drags[1] * speed_2) / 0.03,
        )

    start = shafts.initial(EVEN)
    begin = (start[2] / R1, 0.0, *start[:2])
    step = 3e-3
    exact = solve_ivp(motion, (0.0, step), begin, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
    found = shafts.advance(start, inputs, step)
    assert found[:2] == approx(exact[2:], rel=1e-9)
    assert found[2] == approx(R1 * exact[0] - R2 * exact[1], rel=1e-6)


def test_steps_follow_one_another_without_error():
    inputs = EVEN | {"drive_torque": 180.0}
    whole = SHAFTS.advance(SHAFTS.initial(EVEN), inputs, 2e-3)
    halves = SHAFTS.initial(EVEN)
    for _ in range(20):
        halves = SHAFTS.advance(halves, inputs, 1e-4)
    assert halves == approx(whole, rel=1e-9)


@pytest.mark.parametrize("drags", [(0.0, 0.0), (0.5, 2.0)])
@pytest.mark.parametrize("step", [1e-4, 1e-3, 1e-2, 1.0, 60.0, 600.0])
def test_no_step_is_unstable(step, drags):
    shafts = replace(SHAFTS, coupling=drags[0], drag=drags[1])
    state = shafts.initial(EVEN)
    for k in range(50):
        state = shafts.advance(state, EVEN | {"drive_torque": 100.0 + 50.0 * (-1) ** k}, step)
        gain = 50.0 * step * (k + 1) / 0.01  # of the pinion alone
        assert abs(state[0]) <= 200.0 + gain
        assert abs(torque(shafts, state)) < 1000.0


@pytest.mark.parametrize("step", [0.02, 0.1, 1.0, 60.0, 600.0])
def test_long_steps_end_at_the_quasi_static_torque_without_a_trace_of_ringing(step):
    state = SHAFTS.initial(EVEN)
    for driven in (180.0, 20.0, 100.0, 300.0):
        inputs = EVEN | {"drive_torque": driven}
        state = SHAFTS.advance(state, inputs, step)
        assert torque(SHAFTS, state) == approx(quasi_static(SHAFTS, inputs), rel=1e-5)


def test_the_start_is_without_ringing():
    shafts = replace(SHAFTS, coupling=0.1, drag=0.2)
    inputs = EVEN | {"drive_torque": 180.0}
    state = shafts.initial(inputs)
    assert torque(shafts, state) == approx(quasi_static(shafts, inputs, 200.0), rel=1e-12)
    after = shafts.advance(state, inputs, 1e-4)
    assert torque(shafts, after) == approx(torque(shafts, state), rel=1e-4)
    assert state[0] == approx(1.5 * state[1], rel=1e-15)


def test_teeth_ring_at_their_frequency():
    shafts, state = replace(SHAFTS, damping_ratio=1e-4), SHAFTS.initial(EVEN)
    inputs = EVEN | {"drive_torque": 101.0}
    trace = []
    for _ in range(4096):
        state = shafts.advance(state, inputs, 1e-5)
        trace.append(torque(shafts, state))
    spectrum = np.abs(np.fft.rfft(np.array(trace) - np.mean(trace)))
    found = np.fft.rfftfreq(4096, 1e-5)[spectrum.argmax()]
    exact = math.sqrt(STIFFNESS * (R1 * R1 / 0.01 + R2 * R2 / 0.03)) / (2.0 * math.pi)
    assert found == approx(exact, abs=1.0 / (4096 * 1e-5))


def test_without_drag_the_torques_change_the_angular_momentum_and_nothing_else():
    inputs = EVEN | {"drive_torque": 130.0, "friction_torque_2": -5.0}
    state = SHAFTS.initial(EVEN)
    for step in (1e-4, 1.0, 600.0):
        after = SHAFTS.advance(state, inputs, step)
        gained = 0.01 * (after[0] - state[0]) / R1 + 0.03 * (after[1] - state[1]) / R2
        assert gained == approx(step * (130.0 / R1 - 155.0 / R2), rel=1e-8)
        state = after


def test_a_drive_whose_torque_falls_with_speed_settles_in_one_long_step():
    shafts = replace(SHAFTS, coupling=2.0)
    inputs = EVEN | {"drive_torque": 2.0 * 250.0 + 100.0}
    state = shafts.advance(shafts.initial(EVEN), inputs, 600.0)
    assert state[:2] == approx((250.0, 250.0 / 1.5), rel=1e-9)
    assert torque(shafts, state) == approx(100.0, rel=1e-9)


def test_power_in_is_power_out_and_what_friction_takes():
    inputs = NOTHING | {
        "drive_torque": 100.0,
        "brake_torque": 144.0,
        "friction_torque_1": -1.0,
        "friction_torque_2": -4.5,
    }
    state = SHAFTS.advance(SHAFTS.initial(inputs), inputs, 100.0)
    found = SHAFTS.outputs(state, inputs)
    assert found["mesh_torque"] == approx(99.0, rel=1e-9)  # 99 * 1.5 = 144 + 4.5: steady
    assert found["transmission_error"] == approx(99.0 / R1 / STIFFNESS, rel=1e-9)
    after = SHAFTS.advance(state, inputs, 100.0)
    assert after == approx(state, rel=1e-9)


def test_shafts_survive_their_own_table_and_refuse_gears_that_cannot_mesh():
    assert build(GearShafts, unbuild(SHAFTS), "") == SHAFTS
    with pytest.raises(SceneError, match="tip_diameter_1 = 67 mm"):
        replace(SHAFTS, pair=replace(FZG_C, tip_diameter_1=67e-3)).check()
