"""One gram that 300 N press into a stiff contact: the master finds the rest position where plain coupling does not."""

import logging
import math

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from benchmarks.models import systems
from benchmarks.models.systems import Case
from system_models.master import CouplingError, simulate

REST = 1.0795e-6  # [m]: (300 / F_ref)^(2/3) x_ref
STEPS = 100
ALGORITHMS = "jacobi", "gauss_seidel"

FOLLOWED = ["mass.x", "contact.F"]


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    return systems.stiff_contact(tmp_path_factory.mktemp("fmus"))


def run(case: Case, step: float, algorithm: str, iterate: str | None = None, order: int = 0) -> xr.Dataset:
    how = {"algorithm": algorithm, "order": order, "iterate": iterate}
    return simulate(case.system, STEPS * step, step, **how, outputs=FOLLOWED)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_quasi_newton_finds_the_rest_position_in_few_iterations(case, algorithm):
    result = run(case, 1e-5, algorithm, "quasi_newton")
    assert result["mass.x"].values[-1] == approx(REST, rel=0.01)
    assert result["contact.F"].values[-1] == approx(300.0, rel=0.01)
    assert result.attrs["unconverged"] == 0
    assert result.attrs["iterations"] < 4 * STEPS


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_quasi_newton_also_bears_ten_times_the_step(case, algorithm):
    result = run(case, 1e-4, algorithm, "quasi_newton")
    assert result["mass.x"].values[-1] == approx(REST, rel=0.01)
    assert result.attrs["unconverged"] == 0


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_without_iteration_the_mass_flies_off(case, algorithm, order):
    position = run(case, 1e-5, algorithm, order=order)["mass.x"].values[-1]
    assert abs(position - REST) > REST


def test_a_small_step_follows_the_exact_course(case):
    result = run(case, 1e-7, "jacobi", "quasi_newton", order=1)
    exact = case.solution(result.time.values)[:, 0]
    assert result.attrs["unconverged"] == 0
    assert np.abs(result["mass.x"].values - exact).max() < 0.01 * REST


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_an_iteration_that_does_not_converge_is_reported(case, algorithm, caplog):
    with caplog.at_level(logging.WARNING, "system_models"):
        result = run(case, 1e-5, algorithm, "fixed_point")
    assert result.attrs["unconverged"] > 0
    assert result.attrs["unconverged"] == (result["master.residual"].values > 1.0).sum()
    assert "has not converged in" in caplog.text


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # overflow, on the way to what is refused
@pytest.mark.parametrize("step", [1e-5, 1e-4, 1e-3])
@pytest.mark.parametrize("iterate", [None, "fixed_point", "aitken", "quasi_newton"])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_what_is_not_finite_never_comes_out(case, algorithm, iterate, step):
    try:
        result = run(case, step, algorithm, iterate)
    except CouplingError as error:
        assert "is inf at" in str(error) or "is nan at" in str(error) or "-inf at" in str(error)
    else:
        assert all(math.isfinite(value) for name in result.data_vars for value in result[name].values)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_error_control_follows_the_exact_course_without_iteration(case, algorithm):
    result = simulate(case.system, 1e-4, 1e-8, algorithm=algorithm, order=2, tolerance=1e-3, outputs=case.states)
    exact = case.solution(result.time.values)
    for name, column in zip(case.states, exact.T, strict=True):
        assert np.abs(result[name].values - column).max() < 3e-3 * np.abs(column).max()
    assert result.attrs["below_min_step"] == 0
