"""The mesh as a component: what it makes of the stations' friction and heat."""

import math
from dataclasses import fields, replace
from itertools import pairwise

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad

from contact_core.errors import SceneError
from contact_core.scene.toml import build, unbuild
from system_models.machines.gear_pair.geometry import FZG_A, FZG_C
from system_models.machines.gear_pair.mesh import GearMesh
from system_models.machines.gear_pair.path import stations_of, steps, surface_speeds
from system_models.machines.gear_pair.sharing import Sharing, loads
from system_models.machines.gear_pair.textbook import ohlendorf
from system_models.parts.part import indexed

PINION, TORQUE, MU = 227.24, 135.3, 0.05
ELASTIC = Sharing("elastic")


def loss_factor(pair, sharing):
    """1/p_b integral of share times sliding over speed along the line of action, between the steps of the load."""

    def part(place):
        u1, u2 = surface_speeds(pair, place, 1.0, 1.0 / pair.ratio)
        return float(loads(pair, sharing, 1.0, np.array(place))) * abs(u1 - u2) / pair.base_radius_1

    return sum(quad(part, *ends, epsrel=1e-12)[0] for ends in pairwise(steps(pair))) / pair.base_pitch


def answered(mesh, torque=TORQUE, speed=PINION, **given):
    """Outputs for values of the contacts by name, one for each station; what is not given is zero."""
    inputs = {q.name: q.start for q in mesh.inputs} | {
        "torque": torque,
        "speed_1": speed,
        "speed_2": speed / mesh.pair.ratio,
    }
    for name, values in given.items():
        inputs |= {indexed(name, k): float(value) for k, value in enumerate(values, 1)}
    return mesh.outputs(mesh.initial(inputs), inputs)


def row(mesh, answer, name):
    return np.array([answer[indexed(name, k)] for k in range(1, mesh.stations + 1)])


def rubbed(mesh, mu=MU, **given):
    """Outputs for contacts with a constant coefficient of friction."""
    free = answered(mesh, **given)
    load, u1, u2 = (row(mesh, free, name) for name in ("load", "speed_1", "speed_2"))
    force = -mu * load * np.sign(u1 - u2)
    return answered(mesh, friction_force=force, power_loss=-force * (u1 - u2), **given)


@pytest.mark.parametrize("count", [4, 21, 40])
@pytest.mark.parametrize("pair", [FZG_C, FZG_A])
def test_a_constant_coefficient_of_friction_loses_power_times_loss_factor_exactly(pair, count):
    mesh = GearMesh(pair=pair, stations=count)
    found, power = rubbed(mesh), TORQUE * PINION
    factor = loss_factor(pair, Sharing())
    assert found["power_loss"] == approx(power * factor * MU, rel=1e-9)
    assert found["loss_factor"] == approx(factor, rel=1e-9)
    assert found["friction_coefficient_mean"] == approx(MU, rel=1e-12)
    assert found["friction_coefficient"] == approx(MU * factor / ohlendorf(pair), rel=1e-9)


def test_under_elastic_sharing_the_loss_converges_with_the_square_of_the_stretches():
    exact = loss_factor(FZG_C, ELASTIC)
    counts = (21, 42, 84, 168)
    errors = [
        abs(rubbed(GearMesh(pair=FZG_C, load_sharing=ELASTIC, stations=n))["loss_factor"] - exact) for n in counts
    ]
    assert errors[0] < 3e-3 * exact
    assert -np.polyfit(np.log(counts), np.log(errors), 1)[0] > 1.8


def test_the_loss_is_the_mean_of_what_turning_gears_lose_at_every_moment():
    """Pairs of teeth that enter one after another, each with the power of its place, over many small turns."""
    mesh = GearMesh(pair=FZG_C, stations=200)

    def power(place):  # any law of friction
        u1, u2 = surface_speeds(FZG_C, place, PINION, PINION / 1.5)
        return 100.0 + 20.0 * np.abs(u1 - u2) ** 1.5

    turned = np.linspace(0.0, FZG_C.base_pitch, 5000, endpoint=False)
    momentary = np.zeros_like(turned)
    for behind in (0.0, 1.0):
        place = FZG_C.start + turned + behind * FZG_C.base_pitch
        momentary += np.where(place < FZG_C.end, power(place), 0.0)
    found = answered(mesh, power_loss=power(stations_of(FZG_C, 200).position))
    assert found["power_loss"] == approx(momentary.mean(), rel=1e-3)


def test_what_friction_and_rolling_take_from_both_shafts_is_the_loss():
    mesh, random = GearMesh(pair=FZG_A, load_sharing=ELASTIC), np.random.default_rng(1)
    free = answered(mesh)
    u1, u2 = row(mesh, free, "speed_1"), row(mesh, free, "speed_2")
    friction, rolling = random.normal(0.0, 50.0, 21), random.uniform(0.0, 3.0, 21)
    given = {"friction_force": friction, "rolling_resistance": rolling, "power_loss": -friction * (u1 - u2)}
    found = answered(mesh, **given)
    taken = -found["friction_torque_1"] * PINION - found["friction_torque_2"] * PINION / mesh.pair.ratio
    assert found["power_loss"] == approx(taken, rel=1e-12)
    assert found["power_rolling"] == approx(
        found["power_loss"] - answered(mesh, power_loss=given["power_loss"])["power_loss"]
    )
    assert found["power_rolling"] > 0.0


def test_friction_brakes_the_wheel_before_the_pitch_point_and_the_pinion_after_it():
    mesh = GearMesh(pair=FZG_C)
    found = rubbed(mesh)
    u1, u2 = row(mesh, found, "speed_1"), row(mesh, found, "speed_2")
    for before in (True, False):
        force = np.where((u1 < u2) == before, -MU * 1000.0 * np.sign(u1 - u2), 0.0)
        part = answered(mesh, friction_force=force)
        assert (part["friction_torque_1"] > 0.0) == before
        assert (part["friction_torque_2"] < 0.0) == before


def test_the_weights_are_the_pairs_in_contact_and_heat_is_weighted_alike():
    mesh = GearMesh(pair=FZG_C)
    assert sum(station.weight for station in mesh.contacts) == approx(FZG_C.contact_ratio, rel=1e-12)
    found = answered(mesh, heat_flow_1=np.full(21, 30.0), heat_flow_2=np.full(21, 20.0))
    assert found["heat_flow_1"] == approx(30.0 * FZG_C.contact_ratio)
    assert found["heat_flow_2"] == approx(20.0 * FZG_C.contact_ratio)


def test_a_flank_point_passes_its_station_once_a_turn():
    mesh = GearMesh(pair=FZG_C)
    found = answered(mesh)
    for k, station in enumerate(mesh.contacts, 1):
        turns = (
            found[indexed("speed_1", k)] / station.track_length_1,
            found[indexed("speed_2", k)] / station.track_length_2,
        )
        assert turns == approx((PINION / (2.0 * math.pi), PINION / (3.0 * math.pi)), rel=1e-12)


def test_stations_are_as_warm_as_both_gears_and_the_flash():
    mesh, flash = GearMesh(pair=FZG_C), np.zeros(21)
    flash[6] = 40.0
    found = answered(mesh, flash_temperature_rise=flash)
    assert found["flash_temperature_rise"] == 40.0
    assert found["contact_temperature[7]"] == approx(403.15)
    assert found["contact_temperature[8]"] == approx(363.15)


@pytest.mark.parametrize("sharing", [Sharing(), ELASTIC, Sharing("elastic", 20e-6, 10e-6, 3e-3, 2e-3)])
@pytest.mark.parametrize("torque", [0.0, 1e-9, -100.0, 1e7])
@pytest.mark.parametrize("speed", [0.0, -300.0, 1e5])
def test_all_outputs_are_finite_for_any_state(sharing, torque, speed):
    mesh = GearMesh(pair=FZG_C, load_sharing=sharing)
    found = rubbed(mesh, torque=torque, speed=speed)
    assert set(found) == {q.name for q in mesh.responses}
    assert all(math.isfinite(value) for value in found.values())
    assert found["power_loss"] >= 0.0
    assert (row(mesh, found, "load") >= 0.0).all()


def test_a_loss_over_next_to_no_power_is_no_coefficient_of_friction():
    for speed in (1e-300, 1e-20, -1e-12, 0.0):
        assert (
            answered(GearMesh(pair=FZG_C, stations=5), speed=speed, power_loss=[5.0] * 5)["friction_coefficient"] == 0.0
        )


def test_outputs_depend_on_no_inputs_but_those_they_name():
    mesh, random = GearMesh(pair=FZG_C, load_sharing=ELASTIC), np.random.default_rng(2)
    inputs = {q.name: float(random.uniform(1.0, 2.0)) for q in mesh.inputs}
    before = mesh.outputs((), inputs)
    for changed in inputs:
        after = mesh.outputs((), inputs | {changed: 3.0 * inputs[changed] + 100.0})
        moved = {name for name in after if after[name] != before[name]}
        assert moved <= {q.name for q in mesh.responses if changed in q.direct}, changed
        assert moved


def test_a_mesh_survives_its_own_table():
    mesh = GearMesh(pair=FZG_A, load_sharing=Sharing("elastic", 20e-6, 10e-6, 3e-3, 2e-3), stations=15)
    assert build(GearMesh, unbuild(mesh), "") == mesh


def test_no_number_of_a_mesh_can_be_changed_once_its_contacts_are_built():
    for record in (FZG_C, ELASTIC, GearMesh(pair=FZG_C)):
        assert all(f.metadata["shapes_arrays"] for f in fields(record) if f.metadata)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"centre_distance": 80e-3}, "centre_distance = 80 mm must be above the sum of the base radii"),
        ({"tip_diameter_1": 67e-3}, "tip_diameter_1 = 67 mm must be above the base diameter, 67.6579 mm"),
        ({"tip_diameter_2": 130e-3}, "tip_diameter_2 = 130 mm must be above"),
        ({"tip_diameter_1": 75e-3}, "contact ratio of"),
        ({"shift_2": 0.5}, "shift_1 + shift_2 = 0.6817 gives a backlash of -1.01e+03 um"),
    ],
)
def test_gears_that_cannot_mesh_are_refused(changes, words):
    with pytest.raises(SceneError) as caught:
        GearMesh(pair=replace(FZG_C, **changes)).check()
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("sharing", "words"),
    [
        (Sharing("rigid", 20e-6, 0.0, 3e-3), "relief_1 = 20 um does nothing to rigid teeth"),
        (Sharing("elastic", 0.0, 20e-6), "relief_2 = 20 um and relief_length_2 = 0 mm must both be above 0"),
        (Sharing("elastic", 20e-6, 0.0, 0.5), "relief_length_1 = 500 mm is above 19.1 mm"),
    ],
)
def test_relief_that_makes_no_sense_is_refused(sharing, words):
    with pytest.raises(SceneError) as caught:
        GearMesh(pair=FZG_C, load_sharing=sharing).check()
    assert words in str(caught.value)


def test_stiffness_beyond_the_standard_is_refused():
    swapped = replace(FZG_C, shift_1=FZG_C.shift_2, shift_2=FZG_C.shift_1)
    GearMesh(pair=swapped).check()
    with pytest.raises(SceneError, match="shift_1 = 0\\.1715 and shift_2 = 0\\.1817: ISO"):
        GearMesh(pair=swapped, load_sharing=ELASTIC).check()


def test_too_few_stations_are_refused():
    with pytest.raises(SceneError, match="stations = 3 must be at least 4"):
        GearMesh(pair=FZG_C, stations=3).check()
