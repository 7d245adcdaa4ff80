import json
import math

import numpy as np
import pytest
from comparison import approx

from contact_core.errors import ContactError, SceneError
from contact_core.quantities import out_of_range
from contact_core.scene import units
from system_models.machines.ball_bearing.equilibrium import RingLoads, solve
from system_models.machines.ball_bearing.geometry import BEARING_209, BEARING_218, BallBearingGeometry
from system_models.machines.ball_bearing.part import BallBearing
from system_models.parts.part import indexed

RACES = ("inner", "outer")
PART = BallBearing(dimensions=BEARING_209)
LOADED = {"force_x": 400.0, "force_y": 5000.0, "force_z": -900.0, "moment_y": 3.0, "moment_z": 2.0, "speed": 300.0}


def inputs_of(part, **given):
    return {q.name: q.start for q in part.inputs} | given


def rubbing(part, friction=0.06, rolling=0.3, **given):
    """Inputs of contacts with Coulomb friction, at the loads and speeds that the bearing gives them."""
    inputs = inputs_of(part, **given)
    told = part.outputs(part.initial(inputs), inputs)
    for race in RACES:
        shape = part.dimensions.race(race)
        for k in range(1, part.levels + 1):
            load, u1, u2, spin = (told[indexed(f"{name}_{race}", k)] for name in ("load", "speed_1", "speed_2", "spin"))
            lever = shape.spin_lever * load ** (1 / 3)
            slide = math.hypot(u1 - u2, lever * spin)
            force = friction * load / slide if slide > 0.0 else 0.0
            inputs[indexed(f"friction_force_{race}", k)] = -force * (u1 - u2)
            inputs[indexed(f"spin_torque_{race}", k)] = -force * lever**2 * spin
            inputs[indexed(f"rolling_resistance_{race}", k)] = math.copysign(rolling, u1 + u2)
            heat = force * slide**2
            inputs[indexed(f"heat_flow_1_{race}", k)] = 0.4 * heat
            inputs[indexed(f"heat_flow_2_{race}", k)] = 0.6 * heat
    return inputs


def told_by(part, inputs):
    return part.outputs(part.initial(inputs), inputs)


def test_outputs_are_those_declared_in_order_and_finite():
    values = told_by(PART, rubbing(PART, **LOADED))
    assert list(values) == [q.name for q in PART.responses]
    assert all(math.isfinite(value) for value in values.values())
    for q in (*PART.inputs, *PART.responses):
        _, dimension = units.unit(q.unit)
        assert not q.display or units.unit(q.display)[1] == dimension
    assert not list(out_of_range(PART, ""))


def test_outputs_look_only_at_the_inputs_that_they_name():
    inputs = rubbing(PART, **LOADED)
    state = PART.initial(inputs)
    values, looked = PART.outputs(state, inputs), set()
    for changed in inputs:
        others = PART.outputs(state, inputs | {changed: 1.1 * inputs[changed] + 0.01})
        moved = {name for name in values if others[name] != values[name]}
        assert moved <= {q.name for q in PART.responses if changed in q.direct}
        looked |= {changed} if moved else set()
    assert looked == set(inputs)


def test_torque_times_speed_is_the_power_of_all_contacts():
    inputs = rubbing(PART, **LOADED)
    told = told_by(PART, inputs)
    power = 0.0
    for race in RACES:
        for k in range(1, PART.levels + 1):
            u1, u2, spin, count = (
                told[indexed(f"{name}_{race}", k)] for name in ("speed_1", "speed_2", "spin", "count")
            )
            force, torque, rolling = (
                inputs[indexed(f"{name}_{race}", k)] for name in ("friction_force", "spin_torque", "rolling_resistance")
            )
            power += count * (-force * (u1 - u2) - torque * spin + rolling * (u1 + u2))
    assert power > 1.0
    assert told["power_loss"] == approx(power, rel=1e-12)
    assert told["friction_torque"] * 300.0 == approx(power, rel=1e-12)
    heat = [told[f"heat_flow_{body}"] for body in ("balls", "inner", "outer", "oil")]
    assert sum(heat) == approx(power, rel=1e-12)
    assert min(heat) > 0.0
    assert heat[0] / (heat[1] + heat[2]) == approx(0.4 / 0.6, rel=1e-9)


def test_the_torque_resists_either_way_and_does_not_jump_where_the_shaft_turns():
    ahead, back = (told_by(PART, rubbing(PART, **LOADED | {"speed": speed})) for speed in (300.0, -300.0))
    assert back["friction_torque"] == approx(-ahead["friction_torque"], rel=1e-9)
    assert back["power_loss"] == approx(ahead["power_loss"], rel=1e-9)
    assert back["cage_speed"] == approx(-ahead["cage_speed"], rel=1e-12)
    torques = []
    for speed in np.geomspace(1e-6, 10.0, 40):
        inputs = rubbing(PART, friction=0.1, rolling=0.0, **LOADED | {"speed": float(speed)})
        torques.append(told_by(PART, inputs)["friction_torque"])
    # contacts with the friction that the bearing has at rest: one torque at all slow speeds
    assert torques == approx([torques[0]] * 40, rel=1e-4)
    at_rest = told_by(PART, inputs_of(PART, **LOADED | {"speed": 0.0}))
    assert at_rest["friction_torque"] == approx(torques[0], rel=1e-6)
    assert at_rest["power_loss"] == 0.0


def test_torque_of_a_slipping_speed_never_drives():
    """Friction that was told at another speed, even of the other sense, resists at the present one."""
    inputs = rubbing(PART, **LOADED)
    for speed in (-300.0, -1.0, 1e-9, 0.5, 600.0):
        assert told_by(PART, inputs | {"speed": speed})["power_loss"] >= 0.0


def test_advance_and_outputs_do_not_depend_on_the_state_but_for_rounding():
    inputs = rubbing(PART, **LOADED)
    near = PART.initial(inputs)
    far = PART.initial(inputs_of(PART, force_x=-2000.0, moment_z=20.0, speed=-900.0))
    for state in (near, far):
        after = PART.advance(state, inputs, 600.0)
        assert tuple(json.loads(json.dumps(after))) == after
        one, other = PART.outputs(after, inputs), PART.outputs(near, inputs)
        for q in PART.responses:
            if q.name != "residual":
                assert one[q.name] == approx(other[q.name], rel=1e-8, abs=1e-9 * q.nominal)


def test_an_unloaded_bearing_gives_contacts_that_can_be_solved():
    for part in (PART, BallBearing(dimensions=BEARING_218, levels=1)):
        for speed in (0.0, 1000.0):
            told = told_by(part, inputs_of(part, speed=speed))
            assert told["unconverged"] == 0.0
            for race in RACES:
                assert told[indexed(f"load_{race}", 1)] >= 0.0
                assert told[indexed(f"radius_x_{race}", 1)] > 1e-3


def test_loads_of_balls_and_the_largest_pressure_are_those_of_the_equilibrium():
    told, found = (
        told_by(PART, inputs_of(PART, **LOADED)),
        solve(BEARING_209, RingLoads(400.0, 5000.0, -900.0, 3.0, 2.0), 300.0),
    )
    for race, loads in (("inner", found.load_inner), ("outer", found.load_outer)):
        assert [told[indexed(f"load_ball_{race}", j)] for j in range(1, 10)] == approx(loads, abs=1e-8)
    assert told["load_max"] == approx(max(found.load_outer))
    assert told["pressure_max"] == approx(BEARING_209.inner.ellipse(found.load_inner.max()).pressure_max)
    assert told["contact_angle_inner"] == approx(np.abs(found.angle_inner[found.load_inner > 0.0]).max())


def test_contacts_are_designed_with_what_they_will_be_given():
    loads = RingLoads(400.0, 5000.0, -900.0, 3.0, 2.0)
    designs, told = PART.designs(loads, 300.0), told_by(PART, inputs_of(PART, **LOADED))
    assert [(d.race, d.level) for d in designs] == [(race, k) for race in RACES for k in (1, 2, 3)]
    for d in designs:
        for name in ("load", "speed_1", "speed_2", "radius_x"):
            assert getattr(d, name) == approx(told[indexed(f"{name}_{d.race}", d.level)], rel=1e-9)
        assert d.balls == approx(told[indexed(f"count_{d.race}", d.level)])
        assert d.radius_y == BEARING_209.race(d.race).radius_y
        assert 0.0 < d.track_length_1 < 1e3
        assert 0.0 < d.track_length_2 < 1e3


def test_a_force_out_of_range_is_told_with_its_limits():
    with pytest.raises(ContactError, match=r"force_y = 2e\+06 N must be from -1e\+06 to 1e\+06 N"):
        PART.initial(inputs_of(PART, force_y=2e6))
    with pytest.raises(ContactError, match=r"speed = nan rad/s"):
        PART.outputs(PART.initial(inputs_of(PART)), inputs_of(PART, speed=math.nan))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"contact_angle": 0.3}, "say the same twice"),
        ({"clearance": 2e-3}, "below twice the distance"),
        ({"balls": 17}, "do not fit"),
    ],
)
def test_dimensions_that_do_not_go_together_are_refused(changes, said):
    values = {f: getattr(BEARING_209, f) for f in BEARING_209.__dataclass_fields__} | changes
    with pytest.raises(SceneError, match=said):
        BallBearing(dimensions=BallBearingGeometry(**values)).check()
