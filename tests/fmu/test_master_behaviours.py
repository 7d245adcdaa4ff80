"""FMUs that do less than a master would like, or something else: the right result, or a refusal that says why."""

import json
import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from built import Built
from comparison import approx
from fmpy.fmi1 import FMICallException, fmi1Error
from fmpy.fmi3 import FMU3Slave

from benchmarks.models import build
from system_models.master import CouplingError, System, simulate


@pytest.fixture(scope="session")
def folder(built: Built) -> Path:
    return built.models


def alone(path: Path, **parameters: Any) -> System:
    """One FMU, called `a`, and nothing else."""
    return System({"a": path}, parameters={f"a.{name}": value for name, value in parameters.items()})


def oscillator(one: Path, two: Path) -> System:
    return System({"one": one, "two": two}, [("one.x", "two.x1"), ("one.v", "two.v1"), ("two.F", "one.F")])


def multiples(step: float, end: float) -> np.ndarray:
    return np.arange(round(end / step) + 1) * step


def last(result: xr.Dataset, name: str) -> Any:
    return result[name].values[-1]


# Steps that end early


def test_a_step_that_is_refused_is_made_in_halves(folder):
    result = simulate(alone(build("discard", folder), u=2.0, h_max=0.06), 1.0, 0.2, outputs=["a.y"])
    assert result["a.y"].values == approx(2.0 * result.time.values)
    assert result.time.values[:3] == approx([0.0, 0.05, 0.0875])  # a quarter of 0.2, of 0.15, ...
    assert result.attrs["stopped_early"] > 0
    for point in multiples(0.2, 1.0):  # the points of the undivided steps are still there
        assert np.abs(result.time.values - point).min() < 1e-12


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_step_that_ends_early_is_gone_on_from_there(folder, fmi):
    fmus = {
        "short": build("discard", folder, fmi=fmi, partial=True, start={"h_max": 0.06}),
        "mass": build("mass_1_force", folder, fmi=fmi),
    }
    result = simulate(System(fmus, parameters={"short.u": 2.0}), 0.4, 0.2, outputs=["short.y", "mass.x"])
    assert result["short.y"].values == approx(2.0 * result.time.values)
    assert result.time.values == approx([0.0, 0.06, 0.12, 0.18, 0.2, 0.26, 0.32, 0.38, 0.4])
    whole = simulate(alone(build("mass_1_force", folder, fmi=fmi)), 0.4, 0.2, outputs=["a.x"])
    assert last(result, "mass.x") == approx(last(whole, "a.x"), rel=1e-12)  # all others went back with it


def test_error_control_takes_the_steps_that_an_fmu_can_make(folder):
    fmus = {"short": build("discard", folder, start={"h_max": 0.01}), "mass": build("mass_1_displacement", folder)}
    system = System(fmus, [("short.y", "mass.x_other"), ("mass.v", "short.u")])
    result = simulate(system, 0.5, 0.1, order=1, tolerance=1e-2, outputs=["short.y", "mass.x"])
    assert last(result, "short.y") == approx(last(result, "mass.x") - 1.0, abs=0.03)  # both integrate mass.v
    assert result["master.step_size"].values.max() <= 0.01 * (1.0 + 1e-9)


def test_a_refused_step_of_an_fmu_that_cannot_go_back_is_an_error(folder):
    system = alone(build("discard", folder, rollback=False), h_max=0.1)
    with pytest.raises(CouplingError, match=r"'a' stopped at 0 s in a step to 0\.2 s.*canGetAndSetFMUstate"):
        simulate(system, 1.0, 0.2)
    assert last(simulate(system, 1.0, 0.1), "a.y") == 0.0  # as long as nothing is refused, nothing needs to go back


def test_an_fmu_that_refuses_every_step_is_an_error(folder):
    with pytest.raises(CouplingError, match=r"'a' refuses to step on from 0 s.*min_step"):
        simulate(alone(build("discard", folder), h_max=1e-6), 1.0, 0.2, min_step=1e-3)


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_fmu_that_ends_the_simulation_ends_it_with_what_there_is(folder, fmi):
    result = simulate(alone(build("terminator", folder, fmi=fmi), u=2.0, t_end=0.43), 1.0, 0.1, outputs=["a.y"])
    assert result.attrs["ended_by"] == "a"
    assert result.time.values == approx([*multiples(0.1, 0.4), 0.43])
    assert result["a.y"].values == approx(2.0 * result.time.values)


def test_an_end_at_a_communication_point_needs_no_way_back(folder):
    result = simulate(alone(build("terminator", folder, rollback=False), u=2.0), 1.0, 0.1, outputs=["a.y"])
    assert result.attrs["ended_by"] == "a"
    assert (last(result, "time"), last(result, "a.y")) == approx((0.5, 1.0))


@pytest.mark.parametrize(("fmi", "end"), [(2, 0.4), (3, 0.5)])  # FMI 3 is not allowed an early return then
def test_an_end_within_a_step_keeps_what_there_is_without_a_way_back(folder, fmi, end):
    fmus = {
        "end": build("terminator", folder, fmi=fmi, rollback=False, start={"t_end": 0.43, "u": 2.0}),
        "mass": build("mass_1_force", folder),
    }
    result = simulate(System(fmus), 1.0, 0.1, outputs=["end.y"])
    assert result.attrs["ended_by"] == "end"
    assert result.time.values == approx(multiples(0.1, end))
    assert last(result, "end.y") == approx(2.0 * end)


# Without a way back


def rigid_oscillator(folder: Path) -> System:
    return oscillator(build("mass_1_force", folder), build("mass_2_spring", folder, rollback=False))


@pytest.mark.parametrize(
    ("options", "why"),
    [({"iterate": "quasi_newton"}, "iterate = 'quasi_newton'"), ({"tolerance": 1e-3}, r"tolerance = 0\.001")],
)
def test_what_repeats_steps_is_refused_where_an_fmu_cannot_go_back(folder, options, why):
    with pytest.raises(CouplingError, match=f"{why} .*'two' cannot go back.*canGetAndSetFMUstate is false"):
        simulate(rigid_oscillator(folder), 1.0, 0.1, **options)


def test_events_are_refused_where_an_fmu_cannot_go_back(folder):
    system = System({"ball": build("bouncer", folder, rollback=False)}, events=["ball.bounces"])
    with pytest.raises(CouplingError, match=r"the event 'ball\.bounces' .*'ball' cannot go back"):
        simulate(system, 1.0, 0.1)


@pytest.mark.parametrize("algorithm", ["jacobi", "gauss_seidel"])
@pytest.mark.parametrize("fmi", [2, 3])
def test_plain_coupling_needs_no_way_back(folder, fmi, algorithm):
    with_state, without = (
        oscillator(build("mass_1_force", folder, fmi=fmi), build("mass_2_spring", folder, fmi=fmi, rollback=rollback))
        for rollback in (True, False)
    )
    results = [simulate(system, 1.0, 0.01, algorithm=algorithm, outputs=["one.x"]) for system in (with_state, without)]
    assert (results[0]["one.x"].values == results[1]["one.x"].values).all()


# Events


def bounce_times(height: float, restitution: float, end: float, g: float = 9.81) -> list[float]:
    first = math.sqrt(2.0 * height / g)
    times, flight = [first], 2.0 * restitution * first
    while times[-1] + flight < end:
        times.append(times[-1] + flight)
        flight *= restitution
    return times


def event_times(result: xr.Dataset, name: str) -> np.ndarray:
    """The communication points at which a variable has another value than at the one before."""
    return result.time.values[1:][np.diff(result[name].values) != 0]


def test_bounces_are_found_to_min_step(folder):
    system = System({"ball": build("bouncer", folder)}, events=["ball.bounces"])
    result = simulate(system, 2.0, 0.05, min_step=1e-7, outputs=["ball.bounces", "ball.h"])
    expected = bounce_times(1.0, 0.7, 2.0)
    found = event_times(result, "ball.bounces")
    assert len(expected) == 4
    assert len(found) == result.attrs["events"] == len(expected)
    assert ((found >= expected) & (found - expected <= 1e-7)).all()
    assert (np.diff(result["ball.bounces"].values) <= 1).all()


def test_an_event_is_not_stepped_over_by_error_control(folder):
    fmus = {"teeth": build("tooth", folder, start={"period": 0.0301}), "mass": build("mass_1_force", folder)}
    system = System(fmus | {"mm": build("millimetre", folder)}, [("mass.x", "mm.u")], events=["teeth.tooth"])
    result = simulate(system, 0.2, 0.05, tolerance=1e-3, min_step=1e-8, outputs=["teeth.tooth"])
    found, expected = event_times(result, "teeth.tooth"), 0.0301 * np.arange(1, 7)
    assert len(found) == 6
    assert found == approx(expected, abs=2e-8)


def test_a_change_of_sign_is_found(folder):
    system = System({"mass": build("mass_1_force", folder)}, parameters={"mass.d": 0.0}, events=["mass.x"])
    result = simulate(system, 2.0, 0.3, min_step=1e-9, outputs=["mass.x"])
    zeros = (np.arange(2) + 0.5) * math.pi / math.sqrt(10.0)  # x = cos(sqrt(k/m) t)
    behind = result.time.values[1:][np.diff(np.sign(result["mass.x"].values)) != 0]
    assert result.attrs["events"] == 2
    assert behind == approx(zeros, abs=2e-9)


def test_an_fmu_that_announces_its_events_is_met_there(folder):
    fmus = {"early": build("early", folder, fmi=3, start={"period": 0.26}), "mass": build("mass_1_force", folder)}
    result = simulate(System(fmus, parameters={"early.u": 1.0}), 1.0, 0.1, outputs=["early.y", "early.events"])
    assert event_times(result, "early.events") == approx(0.26 * np.arange(1, 4), abs=1e-12)
    assert last(result, "early.y") == approx(1.0 + 3.0)
    assert result.attrs["events"] == 3


def test_an_announced_event_is_met_where_a_step_cannot_end_early(folder):
    """An FMU that cannot go back is not allowed to: the master has to end its step there."""
    fmus = {"early": build("early", folder, fmi=3, rollback=False, start={"period": 0.26})}
    result = simulate(System(fmus, parameters={"early.u": 1.0}), 1.0, 0.1, outputs=["early.y", "early.events"])
    assert event_times(result, "early.events") == approx(0.26 * np.arange(1, 4), abs=1e-12)
    assert result.attrs["events"] == 3


def test_event_mode_that_is_claimed_wrongly_is_left_out(folder, tmp_path, caplog):
    plain = build("gain", folder, fmi=3)
    claims = rewritten(plain, tmp_path / "claims.fmu", b'hasEventMode="false"', b'hasEventMode="true"')
    result = simulate(System({"a": claims}, parameters={"a.u": 2.0, "a.a": 3.0}), 0.2, 0.1)
    assert result["a.y"].values == approx([6.0] * 3)
    (warning,) = (record for record in caplog.records if "event mode" in record.message)
    assert warning.message == "The FMU 'a' claims to have event mode and refuses it: it goes on without."


def test_event_mode_that_fails_at_the_start_is_left_out(folder, monkeypatch, caplog):
    """The FMU is begun again with the values that it had been given."""

    def refused(self: FMU3Slave) -> None:
        raise FMICallException("fmi3UpdateDiscreteStates", fmi1Error)

    monkeypatch.setattr(FMU3Slave, "updateDiscreteStates", refused)
    early = build("early", folder, fmi=3, start={"period": 0.26})
    gain = build("gain", folder, fmi=3, unit_u="m", unit_y="m/s")
    system = System({"early": early, "gain": gain}, [("gain.y", "early.u")], {"early.jump": 5.0, "gain.b": 1.0})
    result = simulate(system, 0.5, 0.1, outputs=["early.y", "early.events"])
    assert result["early.events"].values[-1] == 1
    assert result["early.y"].values[-1] == approx(0.5 + 5.0)
    assert "it goes on without" in caplog.text


def test_an_fmu_that_does_not_start_at_all_is_told_with_the_first_reason(folder, tmp_path):
    other = rewritten(
        build("early", folder, fmi=3), tmp_path / "other.fmu", b'instantiationToken="', b'instantiationToken="x'
    )
    with pytest.raises(CouplingError, match="'a' failed to start"):
        simulate(System({"a": other}), 0.2, 0.1)


def test_a_scheduled_value_is_met_exactly(folder):
    schedule = {"a.u": [(0.0, 1.0), (0.123, -2.0), (0.7, 0.0)]}
    system = System({"a": build("discard", folder, start={"h_max": 1.0})}, schedule=schedule)
    result = simulate(system, 1.0, 0.1, outputs=["a.y"])
    assert {0.123, 0.7} <= {*result.time.values}
    assert last(result, "a.y") == approx(0.123 - 2.0 * (0.7 - 0.123))


# Types and units


@pytest.mark.parametrize("fmi", [2, 3])
def test_values_of_every_type_are_passed_on(folder, fmi):
    first, second = build("echo", folder, fmi=fmi), build("echo", folder, fmi=fmi, identifier="echo_2")
    kinds = ["real", "integer", "boolean", "string"]
    start = {"real_in": 2.5, "integer_in": -3, "boolean_in": True, "string_in": "Öl, 40 %"}
    wires = [(f"first.{kind}_out", f"second.{kind}_in") for kind in kinds]
    system = System({"first": first, "second": second}, wires, {f"first.{name}": v for name, v in start.items()})
    result = simulate(system, 0.2, 0.1, outputs=[f"second.{kind}_out" for kind in kinds])
    assert [last(result, f"second.{kind}_out") for kind in kinds] == [2.5, -3, True, "Öl, 40 %"]
    assert len(result.time) == 3


def test_a_tooth_count_is_passed_on_in_the_step_it_changes(folder):
    fmus = {"teeth": build("tooth", folder), "echo": build("echo", folder)}
    system = System(fmus, [("teeth.tooth", "echo.integer_in")])
    result = simulate(system, 1.0, 0.05, outputs=["teeth.tooth", "echo.integer_out"])
    assert (
        result["echo.integer_out"].values.tolist()
        == result["teeth.tooth"].values.tolist()
        == [n // 2 for n in range(21)]
    )


def test_units_are_converted(folder):
    fmus = {"mass": build("mass_1_force", folder), "mm": build("millimetre", folder)}
    result = simulate(System(fmus, [("mass.x", "mm.u")]), 0.1, 0.1, outputs=["mass.x", "mm.y"])
    assert result["mm.y"].values == approx(10.0 * 1000.0 * result["mass.x"].values)
    assert result["mm.y"].attrs["units"] == "N"


@pytest.mark.parametrize(("there", "shift"), [("celsius", -273.15), ("kelvin", 273.15)])
def test_temperatures_are_shifted(folder, there, shift):
    back = {"celsius": "kelvin", "kelvin": "celsius"}[there]
    fmus = {"from": build(back, folder), "to": build(there, folder)}
    system = System(fmus, [("from.y", "to.u")], {"from.u": 300.0})
    assert last(simulate(system, 0.1, 0.1, outputs=["to.y"]), "to.y") == approx(300.0 + shift)


def test_units_that_do_not_fit_are_refused(folder):
    fmus = {"mass": build("mass_1_force", folder), "clock": build("mismatch", folder)}
    with pytest.raises(CouplingError, match=r"'mass\.x'.*'clock\.u'.*'m' measures another quantity than 's'"):
        System(fmus, [("mass.x", "clock.u")])


# Failures


@pytest.mark.parametrize("fmi", [2, 3])
def test_what_is_no_number_is_refused_with_its_name_and_time(folder, fmi):
    fmus = {"bad": build("nan", folder, fmi=fmi), "mass": build("mass_1_displacement", folder, fmi=fmi)}
    with pytest.raises(CouplingError, match=r"'bad\.y' is nan at 0\.6 s"):
        simulate(System(fmus, [("bad.y", "mass.x_other")]), 1.0, 0.1)


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_fmu_that_fails_is_named_with_the_step(folder, fmi, caplog):
    with pytest.raises(CouplingError, match=r"'a' failed in the step from 0\.5 s to 0\.6 s"):
        simulate(alone(build("failing", folder, fmi=fmi)), 1.0, 0.1)
    assert "The model fails after t_fail" in caplog.text


def rewritten(path: Path, target: Path, old: bytes, new: bytes) -> Path:
    """The FMU with another description."""
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(target, "w") as archive:
        for name in source.namelist():
            content = source.read(name)
            archive.writestr(name, content.replace(old, new) if name == "modelDescription.xml" else content)
    return target


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (b"<CoSimulation ", b"<ModelExchange ", "made for model exchange only"),
        (b'fmiVersion="2.0"', b'fmiVersion="1.0"', "cannot be read|is of FMI 1.0"),
        (b"</fmiModelDescription>", b"", "cannot be read"),
    ],
    ids=["model exchange", "FMI 1", "broken"],
)
def test_an_fmu_that_cannot_be_coupled_is_refused(folder, tmp_path, old, new, message):
    path = rewritten(build("discard", folder), tmp_path / "other.fmu", old, new)
    with pytest.raises(CouplingError, match=f"'a'.*({message})"):
        System({"a": path})


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(CouplingError, match=r"nowhere\.fmu' of 'a' does not exist"):
        System({"a": tmp_path / "nowhere.fmu"})


def test_a_file_that_is_no_fmu_is_refused(tmp_path):
    (tmp_path / "text.fmu").write_text("no archive")
    with pytest.raises(CouplingError, match=r"The FMU 'a' cannot be read: '.*text\.fmu' is not a zip archive"):
        System({"a": tmp_path / "text.fmu"})


# Mixed systems


@pytest.mark.parametrize("iterate", [None, "fixed_point"])
def test_an_fmu_in_python_gives_what_the_one_in_c_gives(folder, iterate):
    runs = [
        simulate(
            oscillator(build(name, folder), build("mass_2_spring", folder)),
            1.0,
            0.02,
            iterate=iterate,
            outputs=["one.x"],
        )
        for name in ("mass_1_force", "python_mass")
    ]
    assert runs[1]["one.x"].values == approx(runs[0]["one.x"].values, abs=1e-13)


@pytest.mark.parametrize("order", [0, 1])
@pytest.mark.parametrize(("one", "two"), [(2, 3), (3, 2), (3, 3)])
def test_fmi_2_and_fmi_3_mix(folder, one, two, order):
    def mixed(first: int, second: int) -> xr.Dataset:
        system = oscillator(
            build("mass_1_force", folder, fmi=first, interpolates=False),
            build("mass_2_spring", folder, fmi=second, interpolates=False),
        )
        return simulate(system, 1.0, 0.02, order=order, iterate="quasi_newton", outputs=["one.x", "two.F"])

    reference, result = mixed(2, 2), mixed(one, two)
    for name in ("one.x", "two.F"):
        assert result[name].values == approx(reference[name].values, rel=1e-12, abs=1e-12)


def test_one_fmu_may_be_there_twice(folder):
    path = build("mass_1_force", folder)
    result = simulate(System({"a": path, "b": path}, parameters={"b.x0": 2.0}), 0.5, 0.1, outputs=["a.x", "b.x"])
    assert result["b.x"].values == approx(2.0 * result["a.x"].values)


def test_costs_are_counted_for_each_fmu(folder):
    result = simulate(oscillator(build("mass_1_force", folder), build("mass_2_spring", folder)), 1.0, 0.1)
    costs = json.loads(result.attrs["cost"])
    assert {name: cost["steps"] for name, cost in costs.items()} == {"one": 10, "two": 10}
