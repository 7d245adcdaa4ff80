"""A host in C runs every flavour: many instances, several contacts and threads, states, reasons."""

import pytest
from fmu_host import unpacked

from benchmarks.hosts.native_host import NONE, OK, WARNING, NativeHost

OUTPUTS = ("friction_force", "h_c", "wear_volume_1")
IN_A_NAME = {"embedded": " ", "isolated": " #ü+(@%20"}  # characters that the folder of an FMU may have


@pytest.fixture
def c_host(native_program, native_environment):
    host = NativeHost(native_program, native_environment)
    yield host
    host.close()


@pytest.fixture
def instance(c_host, quick_folder):
    """An instance after its first step."""
    instance = c_host.load(quick_folder).instance()
    assert instance.initialise() == [OK] * 3
    assert instance.step(60.0) == OK
    return instance


def after_two_steps(instance):
    assert [instance.step(30.0, load=45.0), instance.step(90.0)] == [OK, OK]
    return instance.outputs()


def test_fifty_instances_live_at_once(c_host, quick_folder):
    fmu = c_host.load(quick_folder)
    instances = [fmu.instance(k) for k in range(50)]
    for k, instance in enumerate(instances):
        assert instance.initialise(load=40.0 + k) == [OK] * 4
    assert {instance.step(60.0) for instance in instances} == {OK}
    assert len({instance.get("friction_force")[0] for instance in instances}) == 50


def test_two_contacts_in_a_host_in_c_keep_to_themselves(c_host, flavoured_folder, quick_folder):
    fmus = [c_host.load(flavoured_folder), c_host.load(quick_folder)]
    instances = [fmu.instance(k) for k, fmu in enumerate(fmus)]
    for instance in instances:
        instance.initialise()
        assert instance.step(60.0) == OK
    assert instances[0].get("friction_force") != instances[1].get("friction_force")
    assert "h_min" not in fmus[1].variables
    assert instances[0].get("h_min")[0] > 0.0


def test_eight_threads_give_the_bits_of_one(c_host, quick_folder):
    fmu = c_host.load(quick_folder)
    alone = fmu.instance()
    alone.initialise()
    assert [alone.step(60.0) for _ in range(3)] == [OK] * 3
    crowd = range(1, 9)
    steps = [("step", 60.0 * n, 60.0) for n in range(3)]
    calls = [("instantiate", 0, 1), ("setup", 0.0), ("enter",), ("exit",), *steps]
    for command, *words in calls:
        assert c_host.together((command, k, *words) for k in crowd).status == OK
    references = [fmu.variables[name].valueReference for name in OUTPUTS]
    assert {tuple(c_host.ask("getr", k, *references).reals) for k in crowd} == {tuple(alone.get(*OUTPUTS))}


def test_the_folder_may_have_odd_characters(c_host, flavour, quick_file, tmp_path):
    instance = c_host.load(unpacked(quick_file, tmp_path / f"a{IN_A_NAME[flavour]}b")).instance()
    assert instance.created.status == OK


def test_every_log_entry_has_a_category(c_host, quick_folder):
    """A host may take it for a string without looking."""
    instance = c_host.load(quick_folder).instance()
    instance.initialise()
    instance.step(60.0, load=-1.0)
    assert {category for _, _, category, _ in instance.log} == {"logValidity"}
    assert instance.log[-1][1] == WARNING


def test_the_reason_of_a_failed_instantiation_reaches_the_log(c_host, quick_file, tmp_path):
    folder = unpacked(quick_file, tmp_path / "copy")
    (folder / "resources" / "versions.json").write_text('{"contact_core": "0.0.1"}')
    created = c_host.load(folder).instance().created
    assert created.status == NONE
    assert any("0.0.1" in text for *_, text in created.log)


def test_a_state_replays_bit_for_bit_as_often_as_asked(instance):
    assert instance.ask("save", 0).status == OK
    first = after_two_steps(instance)
    for _ in range(2):
        assert instance.ask("restore", 0).status == OK
        assert after_two_steps(instance) == first
    assert instance.ask("freestate", 0).status == OK
    assert first["valid"]


def test_a_host_started_later_continues_bit_for_bit(
    instance, native_program, native_environment, quick_folder, tmp_path
):
    file = tmp_path / "fmu.state"
    assert [instance.ask("save", 0).status, instance.ask("serialize", 0, file).status] == [OK, OK]
    later = NativeHost(native_program, native_environment)
    fresh = later.load(quick_folder).instance()
    assert [fresh.ask("deserialize", 0, file).status, fresh.ask("restore", 0).status] == [OK, OK]
    continued = after_two_steps(fresh)
    later.close()
    assert continued == after_two_steps(instance)


def test_a_run_after_a_reset_is_the_first_run(instance):
    first = instance.outputs()
    assert [instance.ask("terminate").status, instance.ask("reset").status] == [OK, OK]
    instance.initialise()
    instance.step(60.0)
    assert instance.outputs() == first
