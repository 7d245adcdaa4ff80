"""Every message has a listed category; flags are logged once, and are no failure."""

import math
from dataclasses import replace

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2Error, fmi2OK, fmi2Warning
from fmu_host import hosted

from contact_core import ConvergenceError, RangeFlag
from fmu_src.runtime import slave


def no_solution(scene, point, state, dt):
    raise ConvergenceError("No solution was found.")


def surprise(scene, point, state, dt):
    raise ZeroDivisionError("surprising")


def entries(host, action):
    """Log entries of `action`: (status, category)."""
    before = len(host.entries)
    action(host)
    return [entry[:2] for entry in host.entries[before:]]


@pytest.mark.parametrize(
    ("action", "entry"),
    [
        (lambda host: host.step(60.0, load=-1.0), (fmi2Warning, "logValidity")),
        (lambda host: host.step(60.0, temperature=math.nan), (fmi2Warning, "logValidity")),
        (lambda host: host.step(-60.0), (fmi2Warning, "logValidity")),
        (lambda host: host.step(60.0, fidelity=5), (fmi2Warning, "logValidity")),
        (lambda host: host.restore(b"something else"), (fmi2Error, "logValidity")),
        (lambda host: host.step(60.0, load=0.0), (fmi2OK, "logValidity")),
        (lambda host: host.set(h_c=1.0), (fmi2Warning, "logStatusWarning")),
        (lambda host: host.set(wear__bare=1.0), (fmi2Warning, "logStatusWarning")),
        (lambda host: host.fmu.getReal([9999]), (fmi2Warning, "logStatusWarning")),
    ],
)
def test_a_message_has_status_and_category(stepped, action, entry):
    assert entries(stepped, action) == [entry]


@pytest.mark.parametrize(
    ("advance", "entry"),
    [(no_solution, (fmi2Warning, "logSolver")), (surprise, (fmi2Error, "logStatusError"))],
)
def test_a_failure_of_the_solver_and_an_unexpected_error_are_told_apart(stepped, monkeypatch, advance, entry):
    monkeypatch.setattr(slave, "advance", advance)
    assert entries(stepped, lambda host: host.step(60.0)) == [entry]


def test_solutions_that_missed_their_tolerance_are_told_by_the_solver(host):
    host.initialise(film__iterations=1, film__tolerance=1e-12)
    host.step(60.0)
    assert RangeFlag.NOT_CONVERGED in RangeFlag(host.get("range_flags"))
    assert (fmi2OK, "logSolver", f"range_flags: {RangeFlag.NOT_CONVERGED.text}.") in host.entries


@pytest.mark.parametrize("flag", [flag for flag in RangeFlag if flag != RangeFlag.OTHER_LEVEL], ids=lambda f: f.name)
def test_what_the_solver_failed_to_do_is_told_apart_from_what_is_outside_its_range(stepped, monkeypatch, flag):
    whole = slave.advance

    def raising(raised):
        def advance(*given):
            state, outputs = whole(*given)
            return state, replace(outputs, range_flags=int(raised))

        monkeypatch.setattr(slave, "advance", advance)

    raising(RangeFlag(0))
    stepped.step(10.0)
    raising(flag)
    of_solver = flag in (RangeFlag.NOT_CONVERGED, RangeFlag.FALLBACK)
    assert entries(stepped, lambda host: host.step(10.0)) == [(fmi2OK, "logSolver" if of_solver else "logValidity")]


def test_the_description_lists_exactly_these_categories(folder):
    listed = fmpy.read_model_description(str(folder)).logCategories
    assert {c.name for c in listed} == {"logStatusWarning", "logStatusError", "logValidity", "logSolver"}
    assert all(c.description for c in listed)


def test_a_flag_is_told_when_it_appears_and_is_no_failure(stepped):
    told = f"range_flags: {RangeFlag.LAMBDA_CAPPED.text}."

    def times():
        return [text for _, _, text in stepped.entries].count(told)

    for load, expected in ((0.0, 1), (0.0, 1), (50.0, 1), (50.0, 1), (0.0, 2)):
        row = stepped.step(10.0, load=load)
        assert bool(row["range_flags"] & RangeFlag.LAMBDA_CAPPED) == (load == 0.0)
        assert row["valid"]
        assert times() == expected
    assert stepped.log == []


def test_a_refused_step_between_does_not_tell_a_flag_again(stepped):
    stepped.step(10.0, load=0.0)
    before = len(stepped.entries)
    stepped.step(10.0, load=-1.0)
    stepped.step(10.0, load=0.0)
    assert [status for status, _, _ in stepped.entries[before:]] == [fmi2Warning]


def test_flags_of_the_first_evaluation_are_told(host):
    host.initialise()
    flags = RangeFlag(host.get("range_flags"))
    assert flags
    assert [text for _, _, text in host.entries] == [f"range_flags: {flag.text}." for flag in flags]


def test_the_host_hears_nothing_until_it_switches_logging_on(folder):
    with hosted(folder, logging=False) as host:
        host.initialise(load=-1.0)
        assert host.entries == []
        host.fmu.setDebugLogging(True, [])
        host.step(60.0)
        assert len(host.entries) == 1


def test_the_host_hears_only_the_categories_it_asked_for(stepped, monkeypatch):
    stepped.fmu.setDebugLogging(True, ["logSolver"])
    stepped.step(60.0, load=-1.0)
    assert stepped.entries == []
    monkeypatch.setattr(slave, "advance", no_solution)
    stepped.step(60.0)
    assert [category for _, category, _ in stepped.entries] == ["logSolver"]


def test_a_host_that_switches_logging_off_hears_errors_only(isolated_folder):
    with hosted(isolated_folder, logging=False) as host:
        host.initialise()
        host.step(1.0, load=-1.0)
        assert [status for status, *_ in host.entries] == [fmi2Warning]
        host.fmu.setDebugLogging(False, [])
        host.step(1.0)
        with pytest.raises(FMICallException):
            host.fmu.getReal([9999])
        assert [status for status, *_ in host.entries] == [fmi2Warning, fmi2Error]


@pytest.mark.parametrize(("categories", "heard"), [([], 1), (["logValidity"], 1), (["logAll"], 1), (["logSolver"], 0)])
def test_a_host_hears_the_categories_it_names(isolated_folder, categories, heard):
    with hosted(isolated_folder, logging=False) as host:
        host.initialise()
        host.fmu.setDebugLogging(True, categories)
        host.step(1.0, load=-1.0)
        assert [category for _, category, _ in host.entries] == ["logValidity"] * heard


def test_where_kernels_are_kept_apart_is_a_note_of_every_instance(folder, monkeypatch):
    monkeypatch.setattr(slave, "NOTICE", "Compiled kernels are kept in '/somewhere'.")
    with hosted(folder) as host:
        host.initialise()
        assert host.entries[0] == (fmi2OK, "logStatusWarning", "Compiled kernels are kept in '/somewhere'.")
