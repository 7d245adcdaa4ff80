"""Motor, shaft, brake, spindle and load arm against closed forms and another integrator."""

import math
from itertools import pairwise

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import solve_ivp

from system_models.parts.brake import Brake
from system_models.parts.linear import advance
from system_models.parts.load_arm import LoadArm
from system_models.parts.shaft import Shaft
from system_models.parts.speed_source import SpeedSource
from system_models.parts.spindle import OppositeSpindle, Spindle


@pytest.mark.parametrize("rate", [0.0, 1e-6, 1.0, 1e4, 1e8])
@pytest.mark.parametrize("step", [1e-4, 1.0, 600.0])
def test_a_decay_and_its_integral_are_exact_however_stiff(rate, step):
    value, integral = advance(((-rate, 0.0), (1.0, 0.0)), ((1.0,), (0.0,)), (2.0, 0.5), (3.0,), step)
    x = rate * step
    mean = -math.expm1(-x) / x if x else 1.0  # of exp(-x) over the step
    assert value == approx(2.0 * math.exp(-x) + 3.0 * step * mean, rel=1e-13)
    second = (1.0 - mean) / rate * step if x > 1e-3 else step**2 * (0.5 - x / 6.0 + x**2 / 24.0)
    assert integral == approx(0.5 + 2.0 * step * mean + 3.0 * second, rel=1e-10)


def _torques(drive: float, resisting: float, speed_drive: float = 0.0) -> dict[str, float]:
    return {"torque_drive": drive, "torque_resisting": resisting, "speed_drive": speed_drive}


def test_a_shaft_runs_up_as_the_closed_form():
    shaft, torques = Shaft(inertia=0.5, damping=0.1), _torques(4.0, 1.5)
    speed, angle = shaft.advance((0.0, 0.0), torques, 8.0)
    final, tau = 2.5 / 0.1, 0.5 / 0.1
    assert speed == approx(final * -math.expm1(-8.0 / tau), rel=1e-13)
    assert angle == approx(final * (8.0 + tau * math.expm1(-8.0 / tau)), rel=1e-13)
    outputs = shaft.outputs((speed, angle), torques)
    assert outputs == {"speed": speed, "revolutions": angle / (2.0 * math.pi), "torque_coupling": 0.0}


def test_without_damping_a_step_changes_the_speed_by_the_impulse():
    torques = _torques(4.0, 1.5)
    assert Shaft(0.5).advance((10.0, 0.0), torques, 6.0) == approx((40.0, 150.0), rel=1e-14)


@pytest.mark.parametrize("damping", [0.0, 1e-9, 0.3])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_shaft_runs_down_and_stands(damping, sign):
    shaft, torques = Shaft(0.5, damping), _torques(sign * 0.5, sign * 2.0)
    speed, angle = shaft.advance((sign * 30.0, 0.0), torques, 600.0)
    assert speed == 0.0
    # without damping, the work of the net torque is the kinetic energy
    free = 0.5 * 0.5 * 30.0**2 / 1.5
    tau = 0.5 / damping if damping else 0.0
    damped = tau * 30.0 - 1.5 / damping * tau * math.log1p(damping * 30.0 / 1.5) if damping == 0.3 else free
    assert sign * angle == approx(damped, rel=1e-7)


@pytest.mark.parametrize("torque", [-2.0, -0.1, 0.0, 1.0, 2.0])
@pytest.mark.parametrize("resisting", [2.0, -2.0])
def test_a_standing_shaft_is_held_up_to_the_resisting_torque(torque, resisting):
    assert Shaft(0.5).advance((0.0, 7.0), _torques(torque, resisting), 60.0) == (0.0, 7.0)


def test_a_torque_that_hardly_differs_from_none_slows_a_shaft_by_its_damping():
    for torque in (1e-300, 5e-324, -5e-324):
        speed, _ = Shaft(inertia=0.5, damping=0.1).advance((20.0, 0.0), _torques(0.0, torque), 2.0)
        assert speed == approx(20.0 * math.exp(-0.4), rel=1e-12)


def test_a_shaft_breaks_away_when_the_drive_is_stronger():
    torques = _torques(2.5, 2.0)
    assert Shaft(0.5).advance((0.0, 0.0), torques, 2.0) == approx((2.0, 2.0), rel=1e-13)


def test_a_drive_can_turn_a_shaft_round_within_a_step():
    torques = _torques(-3.0, 2.0)
    assert Shaft(0.5).advance((10.0, 0.0), torques, 3.0) == approx((-20.0, -15.0), rel=1e-13)


def test_a_torque_that_drives_a_turning_shaft_is_not_held_back():
    torques = _torques(0.0, -1.0)
    assert Shaft(0.5).advance((10.0, 0.0), torques, 3.0)[0] == approx(16.0, rel=1e-13)


@pytest.mark.parametrize("step", [0.01, 1.0, 600.0])
def test_a_coupling_brings_the_shaft_to_the_drives_speed_less_the_slip(step):
    shaft, inputs = Shaft(0.5, coupling=40.0), _torques(0.0, 6.0, 100.0)
    speed, angle = shaft.advance((20.0, 0.0), inputs, step)
    final, decay = 100.0 - 6.0 / 40.0, math.exp(-step * 40.0 / 0.5)
    assert speed == approx(final + (20.0 - final) * decay, rel=1e-13)
    assert angle == approx(final * step + (20.0 - final) * (1.0 - decay) * 0.5 / 40.0, rel=1e-13)
    assert shaft.outputs((speed, angle), inputs)["torque_coupling"] == approx(40.0 * (100.0 - speed), rel=1e-13)


def test_a_shaft_that_its_coupling_brakes_turns_on_as_far_as_many_short_steps_say():
    """A drive at rest and a torque that holds: it comes to standstill within the step, and stays."""
    shaft, inputs = Shaft(0.5, damping=0.3, coupling=4.0), _torques(0.0, 6.0, 0.0)
    state = (30.0, 0.0)
    for _ in range(4000):
        state = shaft.advance(state, inputs, 1e-4)
    speed, angle = shaft.advance((30.0, 0.0), inputs, 0.4)
    assert speed == state[0] == 0.0
    assert angle == approx(state[1], rel=1e-9)


def test_a_coupling_slips_on_a_shaft_that_is_held():
    assert Shaft(0.5, coupling=4.0).advance((3.0, 0.0), _torques(0.0, 6.0, 1.4), 600.0)[0] == 0.0
    assert Shaft(0.5, coupling=4.0).advance((0.0, 0.0), _torques(0.0, 6.0, 1.6), 600.0)[0] == approx(0.1)


def test_a_speed_source_goes_up_and_down_its_ramp_and_gives_the_power_asked_for():
    source, up = SpeedSource(ramp=10.0), {"speed_setpoint": 50.0, "torque": 3.0}
    assert source.initial(up) == (50.0,)
    assert source.advance((0.0,), up, 2.0) == (20.0,)
    assert source.advance((0.0,), up, 5.5) == (50.0,)
    assert source.advance((0.0,), {"speed_setpoint": -50.0, "torque": 3.0}, 2.0) == (-20.0,)
    assert source.outputs((20.0,), up) == {"speed": 20.0, "power": 60.0}


def test_a_speed_source_says_when_it_arrives_and_that_it_does_not_when_it_is_called_elsewhere_before():
    source = SpeedSource(ramp=10.0)
    course = [(0.0, 0.0), (1.0, 50.0), (10.0, -20.0), (12.0, 20.0)]  # at 12 s it has come down to 30 rad/s
    told = [(0.0, 0.0), (1.0, 50.0), (6.0, 50.0), (10.0, -20.0), (12.0, 20.0), (13.0, 20.0)]
    assert source.with_arrivals(course) == told
    state, now = (0.0,), 0.0
    for (time, setpoint), (end, _) in pairwise([*told, (20.0, 0.0)]):
        state, now = source.advance(state, {"speed_setpoint": setpoint, "torque": 0.0}, end - time), end
    assert (state, now) == ((20.0,), 20.0)


def test_a_brake_rises_to_its_setpoint_and_opposes_the_motion():
    brake = Brake(rise_time=0.5, standstill_speed=0.1)
    state = brake.advance((2.0,), {"torque_setpoint": 10.0, "speed": 0.0}, 1.0)
    assert state[0] == approx(10.0 - 8.0 * math.exp(-2.0), rel=1e-14)
    for speed, share in ((100.0, 1.0), (-100.0, -1.0), (0.0, 0.0), (0.05, math.tanh(0.5))):
        outputs = brake.outputs(state, {"torque_setpoint": 10.0, "speed": speed})
        assert outputs["torque"] == approx(state[0] * share, rel=1e-14)
        assert outputs["power"] == approx(outputs["torque"] * speed, rel=1e-14)
        assert outputs["power"] >= 0.0


SPINDLE = Spindle(radius=0.0095, inertia=2e-4, bandwidth=40.0)


def _inputs(setpoint: float, force: float = 0.0, rolling: float = 0.0) -> dict[str, float]:
    return {"surface_speed_setpoint": setpoint, "friction_force": force, "rolling_resistance": rolling}


def test_a_spindle_follows_its_setpoint_at_its_bandwidth():
    state = SPINDLE.advance(SPINDLE.initial(_inputs(0.0)), _inputs(2.0), 0.03)
    speed = SPINDLE.outputs(state, _inputs(2.0))["surface_speed"]
    assert speed == approx(2.0 * -math.expm1(-40.0 * 0.03), rel=1e-12)


def test_a_force_moves_a_spindle_by_the_impulse_and_not_for_long():
    state = SPINDLE.initial(_inputs(2.0))
    for time in (0.01, 1 / 40.0, 0.2, 60.0):
        after = SPINDLE.advance(state, _inputs(2.0, -5.0), time)
        change = -5.0 * 0.0095**2 / 2e-4 * time * math.exp(-40.0 * time)
        assert SPINDLE.outputs(after, _inputs(2.0, -5.0))["surface_speed"] == approx(2.0 + change, rel=1e-12)


def test_a_settled_spindle_stays_and_its_motor_overcomes_both_resistances():
    inputs = _inputs(2.0, -5.0, 0.4)
    state = SPINDLE.initial(inputs)
    assert SPINDLE.advance(state, inputs, 30.0) == approx(state, rel=1e-12)
    outputs = SPINDLE.outputs(state, inputs)
    assert outputs["torque"] == approx(5.4 * 0.0095, rel=1e-10)
    assert outputs["power"] == approx(5.4 * 2.0, rel=1e-10)


def test_body_2_of_a_contact_feels_the_opposite_friction_and_the_same_resistance_to_rolling():
    second = OppositeSpindle(radius=0.0095, inertia=2e-4, bandwidth=40.0)
    state = SPINDLE.initial(_inputs(2.0))
    assert second.advance(state, _inputs(2.0, 5.0, 0.4), 0.02) == SPINDLE.advance(state, _inputs(2.0, -5.0, 0.4), 0.02)


@pytest.mark.parametrize("damping", [0.0, 0.2, 1.0, 8.0])
def test_a_load_arm_answers_as_a_mass_on_a_spring(damping):
    arm = LoadArm(natural_frequency=15.0, damping_ratio=damping, dead_weight=40.0)

    def motion(_: float, y: np.ndarray) -> list[float]:
        return [y[1], 15.0**2 * (30.0 - y[0]) - 2.0 * damping * 15.0 * y[1]]

    reference = solve_ivp(motion, (0.0, 0.4), [10.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-12).y[0, -1]
    state = arm.advance(arm.initial({"load_setpoint": 10.0}), {"load_setpoint": 30.0}, 0.4)
    assert arm.outputs(state, {})["load"] == approx(40.0 + reference, rel=1e-9)


def test_a_load_arm_lifts_off_rather_than_pull():
    arm = LoadArm(natural_frequency=15.0, damping_ratio=0.0)
    state = arm.advance((50.0, 0.0), {"load_setpoint": 0.0}, math.pi / 15.0)
    assert state[0] == approx(-50.0, rel=1e-9)
    assert arm.outputs(state, {})["load"] == 0.0
