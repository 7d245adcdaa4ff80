"""What a machine assumes, and what that is worth: intervals of its file and of its contacts' scene."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from contact_core import SceneError, advance, initial_state
from contact_core.scene.intervals import Interval, value_of
from system_models.machines import assumed, reading
from system_models.machines.files import shipped
from system_models.machines.registry import kinds
from system_models.parts.thermal import AMBIENT, ThermalNetwork
from system_models.run.grown import by_oil

QUICK = "mtm_rig"  # one contact


def machine(name, *keys, **intervals):
    read = reading.read(name)
    assembly = reading.assemble(read)
    chosen = [i for i in assembly.intervals if i.key in keys]
    chosen += [Interval(key, *ends) for key, ends in intervals.items()]
    return kinds()[read.kind], replace(assembly, intervals=tuple(chosen)), reading.duty_of(read)


@pytest.mark.parametrize("name", shipped())
def test_what_a_shipped_machine_assumes_of_heat_and_surfaces_has_an_interval_that_holds_it(name):
    assembly = reading.assemble(reading.read(name))
    keys = {each.key for each in assembly.intervals}
    network = next(name for name, part in assembly.parts.items() if isinstance(part, ThermalNetwork))
    assert {f"{network}.nodes.heat_capacity", f"{network}.links.conductance"} <= keys
    records = {"contact": next(iter(assembly.contacts.values())).scene, **assembly.parts}
    for interval in assembly.intervals:
        for least, most in assembly.ends(interval):
            for key, value in least.items():
                low, high = sorted((value, most[key]))
                assert low <= value_of(records, key)[0] <= high
                assert low < high


def test_a_key_through_a_list_is_that_of_each_item():
    _, assembly, _ = machine(QUICK, "bath.links.conductance")
    found = [key for least, _ in assembly.ends(assembly.intervals[0]) for key in least]
    links = assembly.parts["bath"].links
    assert found == [f"bath.links.{k}.conductance" for k in range(len(links))]
    changed = assembly.with_values({"bath.links.1.conductance": 7.0}).parts["bath"].links
    assert changed == (links[0], replace(links[1], conductance=7.0), *links[2:])


@pytest.mark.parametrize("key", ["bath.linkz.conductance", "bath.nodes.name", "nothing.at_all", "contact.load"])
def test_an_interval_of_no_number_is_refused_by_its_key(key, tmp_path):
    read = reading.read(QUICK)
    read.table["intervals"] = {key: ["-10 %", "+10 %"]}
    with pytest.raises(SceneError, match=r'intervals\."'):
        reading.assemble(read)


def test_a_value_that_is_set_has_no_interval_of_the_file_any_more():
    read = reading.read("bearing_209", {"contact.surface_1.rq": "30 nm"})
    keys = {each.key for each in reading.assemble(read).intervals}
    assert "contact.surface_1.rq" not in keys
    assert "contact.surface_2.rq" in keys


@pytest.mark.parametrize("name", ["bearing_209", "cam_follower"])
def test_all_heat_leaves_once_temperatures_have_settled(name):
    kind, assembly, duty = machine(name)
    time, signals = assumed._hardest(kind, assembly, duty)
    values, warm = assumed._State(kind, assembly, time, signals).settled({})
    network = next(each for each, part in assembly.parts.items() if isinstance(part, ThermalNetwork))
    part = assembly.parts[network]
    gone = sum(
        link.conductance * (warm[f"{network}.temperature_{link.first}"] - signals["ambient"])
        for link in part.links
        if link.second == AMBIENT
    )
    held = [each for each in part.thermostats]
    heaters = sum(each.gain * (signals["temperature"] - warm[f"{network}.temperature_{each.node}"]) for each in held)
    loss = values["bearing.power_loss" if name == "bearing_209" else "cam.power_loss"]
    assert gone == approx(loss + heaters, rel=0.01)


def test_conductances_are_worth_kelvins_and_what_only_delays_nothing():
    found = assumed.worth(*machine("bearing_209", "housing.links.conductance", "shaft.inertia"))
    torque, oil = found.halves["bearing.friction_torque"], found.halves["housing.temperature_oil"]
    assert 3.0 < oil.together < 30.0
    assert [*torque.parts] == [*oil.parts] == ["housing.links.conductance"]
    row = assumed.table(found)[1]
    assert row[0] == "housing.links.conductance"
    assert row[2].endswith(" %")


def test_the_state_with_most_work_is_one_of_the_run():
    kind, assembly, duty = machine("gear_fzg_c")
    short = replace(assembly, settings={**assembly.settings, "stop_time": 5.0 * 3600.0})
    assert [assumed._hardest(kind, each, duty)[0] for each in (assembly, short)] == [81.0 * 3600.0, 3600.0]


def test_half_widths_stand_beside_the_results_in_their_units():
    found = assumed.worth(
        *machine(QUICK, "contact.boundary_friction.bare", "contact.wear.bare", "bath.links.conductance")
    )
    names = (
        "contact.friction_coefficient",
        "contact.contact_load_ratio",
        "contact.wear_depth_1",
        "bath.temperature_oil",
    )
    values = np.array([0.0, 0.05, 0.1])
    rows = xr.Dataset({name: ("time", values, {"units": "1"}) for name in names})
    told = assumed.with_half_widths(rows, found)
    share = found.halves[names[0]].together / found.values[names[0]]
    assert np.allclose(told[f"{names[0]}_assumed"], share * values)
    assert np.allclose(told[f"{names[2]}_assumed"], 9.0 * values, rtol=0.1)
    assert len({*told[f"{names[3]}_assumed"].values.tolist()}) == 1
    assert assumed.with_half_widths(rows, None).identical(rows)


def test_a_tribofilm_at_a_large_lambda_says_that_oil_has_grown_it_and_its_error():
    kind, assembly, duty = machine("bearing_209")
    state = assumed._State(kind, assembly, *assumed._hardest(kind, assembly, duty))
    scene, op = state._contacts["inner_3"]
    op = replace(op, temperature=333.15, body_temperature_1=333.15, body_temperature_2=333.15)
    out = advance(scene, op, initial_state(scene), 600.0)[1]
    inputs = {name: value for name, value in vars(op).items() if value is not None}
    rows = xr.Dataset({name: ("time", [value]) for name, value in (vars(out) | inputs).items()})
    rows = rows.assign({f"tribofilm_{i}_error": rows[f"tribofilm_{i}"] * rows[f"error_tribofilm_{i}"] for i in (1, 2)})
    said = by_oil(scene, rows)
    assert "grown by the oil's shear stress" in said
    assert "not by contact" in said
    assert "+-" in said
    assert by_oil(scene, rows.assign(contact_load_ratio=("time", [0.2]))) == ""
