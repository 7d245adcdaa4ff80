"""What flows between the FMUs of a machine goes to the body that it belongs to; geometry that contacts are told."""

import math
from collections import Counter

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from system_models.machines import reading
from system_models.machines.assembly import Assembly
from system_models.machines.ball_bearing.geometry import BEARING_209
from system_models.machines.ball_bearing.part import BallBearing
from system_models.machines.gear_pair.mesh import GearMesh
from system_models.master import simulate
from system_models.parts.part import indexed
from system_models.parts.thermal import ThermalNetwork

MACHINES = ("mtm_rig", "bearing_209", "bearing_218", "gear_fzg_a", "cam_follower")
DUTY = "time [s],entrainment_speed [m/s],slide_roll_ratio [1]\n0,0.4,0.5\n4,0.4,0.5\n"


@pytest.fixture(scope="module", params=MACHINES)
def assembly(request: pytest.FixtureRequest) -> Assembly:
    return reading.assemble(reading.read(request.param))


def network(assembly: Assembly) -> tuple[str, ThermalNetwork]:
    ((name, part),) = [(name, part) for name, part in assembly.parts.items() if isinstance(part, ThermalNetwork)]
    return name, part


def following(assembly: Assembly, port: str) -> set[str]:
    """The inputs of the thermal network that an output reaches, through what components give at once."""
    found, front, (home, _) = set(), {port}, network(assembly)
    while front:
        targets = {target for source, target, *_ in assembly.connections if source in front}
        found |= {target.partition(".")[2] for target in targets if target.startswith(f"{home}.")}
        told = [target.partition(".") for target in targets if target.partition(".")[0] in assembly.parts]
        front = {
            f"{owner}.{q.name}"
            for owner, _, name in told
            if owner != home
            for q in assembly.parts[owner].responses
            if name in q.direct
        }
    return found


def test_heat_goes_to_the_body_whose_temperature_the_contact_feels(assembly: Assembly) -> None:
    """What a bearing's power leaves over, too, goes to the oil."""
    home, part = network(assembly)
    owner = {name: node.name for node in part.nodes for name in node.heats}
    temperature = {target: source for source, target, *_ in assembly.connections}
    for name in assembly.contacts:
        for body in (1, 2):
            felt = temperature.get(f"{name}.body_temperature_{body}", temperature[f"{name}.temperature"])
            nodes = {owner[heat] for heat in following(assembly, f"{name}.heat_flow_{body}")}
            assert f"{home}.temperature_{'oil' if nodes == {'oil'} else min(nodes - {'oil'})}" == felt
            assert len(nodes - {"oil"}) <= 1


def test_every_input_is_set_once_and_no_heat_or_force_of_a_contact_is_lost_or_told_twice(assembly: Assembly) -> None:
    targets = Counter(target for _, target, *_ in assembly.connections)
    assert max(targets.values()) == 1
    others = [(name, part) for name, part in assembly.parts.items() if name != network(assembly)[0]]
    ports = {f"{name}.{q.name}" for name, part in others for q in part.inputs}
    unset = ports - set(targets) - set(assembly.schedule)
    assert not [port for port in unset if any(key in port for key in ("heat_", "friction", "rolling", "flash"))]
    sources = Counter(source for source, *_ in assembly.connections)
    used = {1: ("heat_flow_1", "heat_flow_2"), 2: ()}
    if {"mesh", "bearing", "cam"} & set(assembly.parts):
        used[1] = (*used[1], "friction_force", "rolling_resistance")
    else:  # both bodies of the rig feel these
        used[2] = ("friction_force", "rolling_resistance")
    for count, keys in used.items():
        assert all(sources[f"{name}.{key}"] == count for name in assembly.contacts for key in keys)


def test_a_point_of_a_flank_is_met_once_a_turn_and_is_as_curved_as_its_involute() -> None:
    """Surface speed over track is turns a second; the track is a circle with the radius of the involute there."""
    assembly = reading.assemble(reading.read("gear_fzg_c"))
    mesh, turns = assembly.parts["mesh"], (30.0, 20.0)
    assert isinstance(mesh, GearMesh)
    given = {q.name: q.start for q in mesh.inputs} | {"torque": 100.0}
    told = mesh.outputs((), given | {f"speed_{i}": 2.0 * math.pi * n for i, n in enumerate(turns, 1)})
    for k, contact in enumerate(assembly.contacts.values(), 1):
        ways = [float(contact.parameters[f"geometry.track_length_{i}"]) for i in (1, 2)]
        assert [told[indexed(f"speed_{i}", k)] / way for i, way in enumerate(ways, 1)] == approx(turns)
        curvature = sum(2.0 * math.pi / way for way in ways)
        assert float(contact.parameters["radius_x"]) == approx(1.0 / curvature)
        assert contact.parameters["solids.reduced_modulus"] == approx(206e9 / (1.0 - 0.3**2))
        assert contact.parameters["geometry.face_width"] == approx(14e-3)


def test_points_of_balls_and_rings_are_met_as_often_as_bearings_turn() -> None:
    """All classes together: a point of the inner ring by every ball that touches, one of the outer ring by all."""
    assembly = reading.assemble(reading.read("bearing_209"))
    bearing, count = assembly.parts["bearing"], BEARING_209.balls
    assert isinstance(bearing, BallBearing)
    loads = {key.partition(".")[2]: course[0][1] for key, course in assembly.schedule.items() if "bearing.force" in key}
    given = {q.name: q.start for q in bearing.inputs} | loads | {"speed": 2.0 * math.pi}  # one turn a second
    told = bearing.outputs(bearing.initial(given), given)
    cage = told["cage_speed"] / (2.0 * math.pi)
    met = {"outer": [], "inner": []}
    for race, rates in met.items():
        for k in range(1, bearing.levels + 1):
            way = float(assembly.contacts[f"{race}_{k}"].parameters["geometry.track_length_2"])
            rates.append(told[indexed(f"speed_2_{race}", k)] / way)
    assert met["outer"] == approx([count * cage] * bearing.levels, rel=0.02)
    touching = sum(told[indexed("load_ball_inner", j)] > 0.0 for j in range(1, count + 1))
    assert sum(met["inner"]) <= touching * (1.0 - cage) * 1.02
    assert sum(met["inner"]) > 0.5 * touching * (1.0 - cage)
    ball = float(assembly.contacts["outer_1"].parameters["geometry.track_length_1"])
    assert ball == approx(math.pi * BEARING_209.ball_diameter * count / told["count_outer[1]"], rel=0.02)


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    folder = tmp_path_factory.mktemp("rig")
    (folder / "duty.csv").write_text(DUTY)
    machine = reading.read("mtm_rig", {"simulate.tolerance": "1e-3"})
    machine.table["duty"] |= {"file": str(folder / "duty.csv")}
    assembly = reading.assemble(machine)
    return simulate(assembly.system(folder), **assembly.settings, outputs=assembly.outputs())


def test_the_contact_of_a_rig_slides_and_rolls_as_its_duty_asks(rig: xr.Dataset) -> None:
    u1, u2 = (float(rig[f"contact.speed_{i}"][-1]) for i in (1, 2))
    assert 0.5 * (u1 + u2) == approx(0.4, rel=1e-3)
    assert 2.0 * (u1 - u2) / (u1 + u2) == approx(0.5, rel=1e-2)


def test_motors_of_a_rig_give_what_its_contact_takes(rig: xr.Dataset) -> None:
    """In the first step: later friction falls from step to step, and the motors feel it a step late."""
    first = rig.isel(time=1)
    given = sum(float(first[f"{name}.power"]) for name in ("ball", "disc"))
    rolled = float(first["contact.rolling_resistance"] * (first["contact.speed_1"] + first["contact.speed_2"]))
    assert rolled > 2e-4 * given  # ten times what may be missing
    assert given == approx(float(first["contact.power_loss"]) + rolled, rel=2e-5)


def test_all_that_a_contact_of_a_rig_rubs_away_is_in_its_bath(rig: xr.Dataset) -> None:
    capacity = {"oil": 80.0, "pot": 400.0}
    kept = sum(
        c * float(rig[f"bath.temperature_{name}"][-1] - rig[f"bath.temperature_{name}"][0])
        for name, c in capacity.items()
    )
    rubbed = float(np.trapezoid(rig["contact.power_loss"].values, rig["time"].values))
    assert rubbed > 0.1
    heated = float(rig["bath.heater_energy_oil"][-1] - rig["bath.energy_to_ambient"][-1])
    assert kept - heated == approx(rubbed, rel=0.05)
