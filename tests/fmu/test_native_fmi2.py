"""A native FMU by FMI 2.0 in a host in C: it answers mistakes as an isolated one, and its own rules."""

import math
import shutil
from collections.abc import Iterator
from pathlib import Path

import native_fmu
import pytest

from benchmarks.hosts.native_host import DISCARD, ERROR, NONE, OK, WARNING, Instance, NativeHost, plain_environment
from fmu_src.isolated.library import image
from tests.comparison import approx

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

HOT = 460.0  # K: the stand-in refuses it
HOTTEST = 450.0  # K: it does not refuse this
ODD = 99.0  # m/s: not a number comes out


@pytest.fixture(scope="module")
def native_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return native_fmu.unpacked(tmp_path_factory.mktemp("native2"), 2)


@pytest.fixture
def c_host(native_program: Path) -> Iterator[NativeHost]:
    with NativeHost(native_program, plain_environment()) as host:
        yield host


@pytest.fixture
def fresh(c_host: NativeHost, native_folder: Path) -> Instance:
    instance = c_host.load(native_folder).instance()
    assert instance.created.status == OK
    return instance


@pytest.fixture
def ready(fresh: Instance) -> Instance:
    assert fresh.initialise() == [OK, OK, OK]
    return fresh


def entries(instance: Instance) -> list[tuple[int, str, str]]:
    return [entry[1:] for entry in instance.log]


def mistakes(instance: Instance) -> list[object]:
    """Answers to calls that FMI does not allow, and to inputs and steps that cannot be used."""
    at = {name: v.valueReference for name, v in instance.fmu.variables.items()}
    found: list[object] = []

    def ask(command: str, *words: object) -> None:
        answer = instance.ask(command, *words)
        found.append((command, words, answer.status, instance.get("valid"), instance.get("time")))

    ask("step", 0.0, 1.0)
    ask("exit")
    ask("setup", math.nan)
    ask("setup", 0.0, 100.0)
    ask("enter")
    ask("setup", 0.0)
    ask("setr", at["load"], math.nan)
    ask("exit")
    ask("step", 0.0, 1.0)  # still without a load that can be used
    ask("setr", at["load"], 50.0)
    ask("step", 1.0, 1.0)
    ask("step", 3.0, 1.0)  # not where the last one ended
    ask("step", 2.0, 200.0)  # beyond the stop time
    ask("step", 2.0, -1.0)
    ask("step", 2.0, -1e-12)  # a host's rounding
    ask("step", 2.0, math.nan)
    ask("step", math.nan, 1.0)
    ask("setr", at["temperature"], 1000.0)
    ask("setr", at["load"], -3.0)
    ask("step", 2.0, 1.0)
    ask("setr", at["temperature"], 350.0)
    ask("setr", at["load"], 50.0)
    ask("step", 3.0, 1.0)
    ask("setr", at["friction_force"], 1.0)
    ask("setr", at["time"], 1.0)
    ask("setr", at["solids.reduced_modulus"], 1.0)
    ask("getr", 99999)
    ask("geti", at["load"])
    ask("save", 0)
    ask("step", 4.0, 1.0)
    ask("restore", 0)
    ask("step", 4.0, 1.0)
    ask("step", 5.0, 95.01)
    ask("step", 5.0 + 1e-8, 95.0005)  # likewise
    ask("step", 100.0005, 1e-4)
    ask("terminate")
    ask("step", 5.0, 1.0)
    ask("terminate")
    ask("restore", 0)
    ask("step", 4.0, 1.0)
    ask("freestate", 0)
    ask("restore", 0)
    ask("enter")
    ask("reset")
    ask("enter")
    ask("exit")
    ask("step", 5.0, 1.0)  # anywhere, as no start time was given
    ask("step", 0.0, 1.0)
    return found


def test_mistakes_are_answered_as_by_an_isolated_fmu(
    c_host: NativeHost, native_folder: Path, isolated_folder: Path
) -> None:
    native, isolated = (c_host.load(folder).instance(k) for k, folder in enumerate((native_folder, isolated_folder)))
    assert mistakes(native) == mistakes(isolated)
    notes = [[entry[:2] for entry in entries(instance) if entry[0] != OK] for instance in (native, isolated)]
    assert notes[0] == notes[1]
    texts = [[entry[2] for entry in entries(instance) if ") must be" in entry[2]] for instance in (native, isolated)]
    assert texts[0] == texts[1]
    assert len(texts[0]) == 4


def test_exactly_the_functions_of_fmi_are_exported(native_folder: Path) -> None:
    (library,) = (native_folder / "binaries" / "linux64").iterdir()
    exported = image.read(library.read_bytes()).exports
    assert len(exported) == 44
    assert all(name.startswith("fmi2") for name in exported)


def test_a_parameter_takes_its_own_value_only(fresh: Instance) -> None:
    (value,) = fresh.get("solids.reduced_modulus")
    assert fresh.set(solids__reduced_modulus=value) == [OK]
    assert fresh.set(solids__reduced_modulus=value * (1.0 + 1e-15)) == [OK]  # rounded by a host
    assert fresh.set(fidelity=1, seed=0, initial_state="") == [OK, OK, OK]
    assert fresh.log == []
    assert fresh.set(solids__reduced_modulus=value * 1.001) == [ERROR]
    assert fresh.set(fidelity=2, seed=1, initial_state="100%.state") == [ERROR] * 3
    assert all(entry[:2] == (ERROR, "logValidity") and "Build the FMU anew" in entry[2] for entry in entries(fresh))
    assert [entry[2].split(" is not")[0] for entry in entries(fresh)[1:]] == [
        "fidelity = 2",
        "seed = 1",
        "initial_state = '100%.state'",
    ]
    assert fresh.initialise() == [OK, OK, OK]
    assert fresh.set(fidelity=1, seed=0) == [ERROR, ERROR]  # fixed


def test_a_refused_step_leaves_state_and_outputs(ready: Instance) -> None:
    ready.step(1.0)
    kept = ready.outputs()
    assert ready.step(1.0, temperature=HOT) == WARNING
    assert entries(ready)[-1] == (
        WARNING,
        "logValidity",
        f"temperature = {HOT:g} K must be at most 450 K at 100 % load. Choose a lower one.",
    )
    assert ready.step(1.0, temperature=350.0, speed_1=ODD) == WARNING
    status, category, text = entries(ready)[-1]
    assert (status, category) == (WARNING, "logSolver")
    assert text.startswith("No finite h_c came out at load = 53.7, speed_1 = 99, ")
    assert ready.outputs() == kept | {"valid": 0}
    assert ready.get("time") == [3.0]


def test_a_contact_that_could_not_be_initialised_starts_with_the_first_usable_inputs(fresh: Instance) -> None:
    assert fresh.initialise(load=-1.0) == [OK, OK, OK, WARNING]
    assert fresh.get("valid") == [0]
    assert fresh.step(1.0) == WARNING
    assert fresh.get("fidelity_used") == [0]
    assert fresh.step(1.0, load=53.7) == OK
    assert fresh.get("fidelity_used") == [1]
    (film,) = fresh.get("tribofilm_1")
    assert film == approx(0.05)  # one step from fresh surfaces


def test_steps_go_on_being_refused_until_the_contact_can_be_initialised(fresh: Instance) -> None:
    assert fresh.initialise(load=0.0) == [OK, OK, OK, WARNING]
    assert fresh.step(1.0) == WARNING  # the stand-in refuses this load at the start only
    assert fresh.get("fidelity_used") == [0]
    assert fresh.step(1.0, load=50.0) == OK
    assert fresh.step(1.0, load=0.0) == OK


def test_inputs_that_fail_after_others_in_initialisation_mode_leave_no_state_of_those(fresh: Instance) -> None:
    assert [fresh.ask(*words).status for words in (("setup", 0.0), ("enter",))] == [OK, OK]
    fresh.set(load=600.0)
    assert fresh.get("load_cycles_1") == [1.0]
    fresh.set(load=-1.0)
    assert fresh.ask("exit").status == WARNING
    assert fresh.step(1.0, load=50.0, speed_1=0.1) == OK
    assert fresh.get("load_cycles_1") == [approx(1.0)]  # of the step alone


def test_range_flags_are_logged_when_they_appear(ready: Instance) -> None:
    for load in (2000.0, 3000.0, 50.0, 2000.0):
        ready.step(1.0, load=load)
    texts = [(status, category, text[:40]) for status, category, text in entries(ready)]
    appeared = [
        (OK, "logSolver", "range_flags: over a tenth of the block's"),
        (OK, "logValidity", "range_flags: outside the points to which"),
    ]
    assert texts == appeared * 2


def test_derivative_outputs_are_those_of_the_last_step(ready: Instance) -> None:
    assert ready.step(1.0, load=100.0) == OK
    (slope,) = ready.get("dfriction_dload")
    before = ready.get("friction_force")[0]
    assert slope == approx((before - 1e-3 * (353.15 - 300.0)) / 100.0)
    ready.set(load=70.0, speed_1=1.0)
    assert ready.get("dfriction_dload") == [slope]
    assert ready.step(1.0) == OK
    assert ready.get("dfriction_dload") != [slope]


def test_directional_derivatives_of_friction_are_the_contacts_own_and_others_differences(ready: Instance) -> None:
    ready.step(1.0)
    at = {name: v.valueReference for name, v in ready.fmu.variables.items()}

    def slope(output: str, by: str) -> float:
        answer = ready.ask("derivative", at[output], at[by])
        assert answer.status == OK
        return answer.reals[0]

    for name in ("load", "speed_1", "speed_2", "temperature"):
        assert [slope("friction_force", name)] == ready.get(f"dfriction_d{name}")
    film, h_c, load, radius = (ready.get(name)[0] for name in ("tribofilm_1", "h_c", "load", "radius_x"))
    assert slope("h_c", "load") == approx(h_c / load, rel=1e-8)
    assert slope("h_c", "radius_x") == approx(0.5 * h_c / radius, rel=1e-8)
    assert slope("h_c", "speed_1") == 0.0
    assert slope("friction_force", "spin") == 0.0
    ready.set(load=0.0)  # at its bound: one-sided
    assert slope("h_c", "load") == approx(math.sqrt(radius) / (1.0 + film), rel=1e-8)
    ready.set(temperature=HOTTEST)  # the equations refuse what is above
    assert slope("h_c", "load") == approx(math.sqrt(radius) / (1.0 + film), rel=1e-8)
    assert slope("h_c", "temperature") == 0.0


@pytest.mark.parametrize(
    ("output", "by", "inputs", "status"),
    [
        ("load", "load", {}, ERROR),
        ("valid", "load", {}, ERROR),
        ("dfriction_dload", "load", {}, ERROR),
        ("friction_force", "h_c", {}, ERROR),
        ("friction_force", "load", {"load": -1.0}, DISCARD),
        ("friction_force", "load", {"temperature": HOT}, DISCARD),
        ("h_c", "radius_x", {"speed_1": ODD}, DISCARD),
    ],
)
def test_derivatives_that_do_not_exist_are_refused_and_change_nothing(
    ready: Instance, output: str, by: str, inputs: dict[str, float], status: int
) -> None:
    kept = ready.outputs()
    ready.set(**inputs)
    at = {name: v.valueReference for name, v in ready.fmu.variables.items()}
    answer = ready.ask("derivative", at[output], at[by])
    assert (answer.status, answer.reals, len(ready.log)) == (status, [0.0], 1)
    assert ready.outputs() == kept


def test_a_stored_state_restores_every_bit_in_another_process(
    c_host: NativeHost, native_program: Path, native_folder: Path, ready: Instance, tmp_path: Path
) -> None:
    ready.step(1.0, load=80.0)
    assert [ready.ask(*words).status for words in (("save", 0), ("serialize", 0, tmp_path / "state"))] == [OK, OK]
    expected = (ready.outputs(), ready.step(1.0), ready.outputs())
    with NativeHost(native_program, plain_environment()) as other_host:
        other = other_host.load(native_folder).instance()
        assert [other.ask(*words).status for words in (("deserialize", 0, tmp_path / "state"), ("restore", 0))] == [
            OK,
            OK,
        ]
        assert (other.outputs(), other.step(1.0), other.outputs()) == expected


def test_every_damaged_byte_of_a_stored_state_is_found(ready: Instance, tmp_path: Path) -> None:
    ready.step(1.0)
    ready.ask("save", 0)
    ready.ask("serialize", 0, tmp_path / "state")
    data = (tmp_path / "state").read_bytes()
    damaged = [data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :] for at in range(len(data))]
    damaged += [b"", data[:-1], data + b"\0", data[8:]]
    for wrong in damaged:
        (tmp_path / "wrong").write_bytes(wrong)
        assert ready.ask("deserialize", 1, tmp_path / "wrong").status == ERROR
    assert len(ready.log) == len(damaged)
    assert {category for _, category, _ in entries(ready)} == {"logValidity"}


def test_more_states_than_an_instance_has_room_for_are_kept(ready: Instance) -> None:
    loads = [10.0 * k for k in range(1, 31)]
    for k, load in enumerate(loads):
        ready.set(load=load)
        assert ready.ask("save", k).status == OK
    for k in (7, 8, 0, 29, 15):  # some of them within the instance
        assert ready.ask("restore", k).status == OK
        assert ready.get("load") == [loads[k]]
        assert ready.ask("freestate", k).status == OK
        assert ready.ask("restore", k).status == ERROR
    ready.free()


def test_another_guid_is_refused(c_host: NativeHost, native_folder: Path) -> None:
    instance = c_host.load(native_folder, guid="other").instance()
    assert instance.created.status == NONE
    assert entries(instance)[0][:2] == (ERROR, "logStatusError")
    assert "the host loads other" in entries(instance)[0][2]
