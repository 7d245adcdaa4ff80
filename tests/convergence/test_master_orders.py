"""The order of the coupling on the two-mass oscillator, and its errors beside those of exact sub-solvers elsewhere."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from comparison import approx

from benchmarks.models import build, systems
from benchmarks.models.systems import Case
from system_models.master import System, simulate

END = 2.0
STEPS = 0.04, 0.01, 0.005
KINDS = {"force": systems.two_mass_force, "displacement": systems.two_mass_displacement}
OTHER_KIND_LATER = pytest.mark.parametrize("kind", ["force", pytest.param("displacement", marks=pytest.mark.long)])
ALGORITHMS = "jacobi", "gauss_seidel"

# Largest error of a state at t = 2 for steps of 0.04 and 0.005, computed once by matrix exponentials, without FMUs.
REFERENCE = {
    ("force", "jacobi"): ((7.5e-1, 8.2e-2), (4.7e-2, 5.4e-4), (2.4e-2, 4.7e-5)),
    ("force", "gauss_seidel"): ((4.8e-1, 5.6e-2), (3.1e-2, 3.7e-4), (1.9e-2, 3.7e-5)),
    ("displacement", "jacobi"): ((4.7e-1, 5.4e-2), (4.4e-2, 5.3e-4), (1.4e-2, 2.9e-5)),
    ("displacement", "gauss_seidel"): ((1.8e-1, 2.3e-2), (2.7e-2, 4.3e-4), (9.9e-3, 1.8e-5)),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fmus")


def run(case: Case, step: float, algorithm: str, order: int, **options: Any) -> np.ndarray:
    """Final states, from a start with the exact past."""
    past = case.history()
    if "two.F" in {c.source.name for c in case.system.connections}:
        past["two.F"] = systems.spring_force
    run = simulate(
        case.system, END, step, algorithm=algorithm, order=order, history=past, outputs=case.states, **options
    )
    assert run.time.values[-1] == END
    assert run.attrs["steps"] == round(END / step)
    assert run.attrs["unconverged"] == 0
    return np.array([run[name].values[-1] for name in case.states])


def errors(case: Case, algorithm: str, order: int, steps: tuple[float, ...] = STEPS, **options: Any) -> list[float]:
    exact = case.solution(END)[0]
    return [float(np.abs(run(case, step, algorithm, order, **options) - exact).max()) for step in steps]


def last_order(found: list[float]) -> float:
    return float(np.log2(found[-2] / found[-1]))


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
@OTHER_KIND_LATER
def test_an_extrapolated_input_gives_order_k_plus_1_and_the_known_errors(folder, kind, algorithm, order):
    found = errors(KINDS[kind](folder), algorithm, order)
    assert last_order(found) == approx(order + 1, abs=0.15)
    assert (found[0], found[-1]) == approx(REFERENCE[kind, algorithm][order], rel=0.2)


WAYS = [(method, algorithm) for method in ("fixed_point", "aitken", "quasi_newton") for algorithm in ALGORITHMS]
ITERATED = [*(pytest.param(*way, marks=pytest.mark.long) for way in WAYS[:-1]), WAYS[-1]]


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize(("method", "algorithm"), ITERATED)
def test_an_iterated_step_gives_order_k_plus_1(folder, method, algorithm, order):
    case = systems.two_mass_force(folder)
    found = errors(case, algorithm, order, (0.01, 0.005), iterate=method, iteration_tolerance=1e-11)
    assert last_order(found) == approx(order + 1, abs=0.15)


def test_an_iterated_line_is_far_better_than_an_extrapolated_one(folder):
    case = systems.two_mass_force(folder)
    iterated = errors(case, "jacobi", 1, (0.04, 0.005), iterate="quasi_newton", iteration_tolerance=1e-9)
    assert iterated == approx([7.2e-3, 1.1e-4], rel=0.2)  # implicit, linear interpolation


@pytest.mark.parametrize("method", ["fixed_point", "aitken", "quasi_newton"])
def test_what_an_iteration_finds_depends_neither_on_the_method_nor_on_the_sequence(folder, method):
    case = systems.two_mass_force(folder)
    jacobi, gauss_seidel, reference = (
        run(case, 0.04, algorithm, 1, iterate=iterate, iteration_tolerance=1e-11)
        for algorithm, iterate in (("jacobi", method), ("gauss_seidel", method), ("jacobi", "fixed_point"))
    )
    assert jacobi == approx(reference, rel=1e-7)
    assert gauss_seidel == approx(reference, rel=1e-7)


@OTHER_KIND_LATER
@pytest.mark.parametrize("order", [0, 1])
def test_a_held_mean_costs_no_order_up_to_the_second(folder, kind, order):
    found = errors(KINDS[kind](folder, interpolates=False), "jacobi", order)
    assert last_order(found) == approx(order + 1, abs=0.15)


@OTHER_KIND_LATER
@pytest.mark.parametrize("order", [1, 2])
def test_no_more_than_the_second_order_is_there_with_a_held_mean(folder, kind, order):
    # Iterated: extrapolation adds an error of third order that hides the one of the mean down to steps of 0.005.
    case = KINDS[kind](folder, interpolates=False)
    found = errors(case, "gauss_seidel", order, iterate="quasi_newton", iteration_tolerance=1e-11)
    assert last_order(found) == approx(2, abs=0.15)


ITERATED = {"iterate": "quasi_newton", "iteration_tolerance": 1e-11}


@pytest.mark.parametrize("options", [{}, ITERATED])
@pytest.mark.parametrize("order", [0, 1, 2])
def test_fmi_3_asks_for_what_fmi_2_is_given(folder, order, options):
    two = run(systems.two_mass_force(folder), 0.02, "jacobi", order, **options)
    three = run(systems.two_mass_force(folder, fmi=3, intermediate=True), 0.02, "jacobi", order, **options)
    assert three == approx(two, rel=1e-9 if options else 1e-12)


@pytest.mark.parametrize("options", [{}, ITERATED])
def test_fmi_3_asks_for_what_fmi_2_is_given_also_after_a_change_of_the_schedule(folder, options):
    """Derivatives that FMI 2 was told before it would stay where no others of that order are told."""
    found = []
    for variant in ({}, {"fmi": 3, "intermediate": True}):
        system, states, _ = systems.quarter_car_force(folder, **variant)
        system.schedule = {"wheel.road": [(0.0, 0.1), (0.3, 0.2), (0.31, -0.1)]}
        end = simulate(system, 0.4, 0.01, order=2, **options, outputs=states)
        found.append([float(end[name].values[-1]) for name in states])
    assert found[1] == approx(found[0], rel=1e-9 if options else 1e-12)


def test_fmi_3_without_intermediate_inputs_holds_the_mean(folder):
    two = run(systems.two_mass_force(folder, interpolates=False), 0.02, "jacobi", 2)
    three = run(systems.two_mass_force(folder, fmi=3), 0.02, "jacobi", 2)
    assert three == approx(two, rel=1e-12)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_an_input_that_was_told_as_it_is_needs_no_correction(folder, order):
    """In a Gauss-Seidel sequence the drag knows the speed at the end of the step: its derivative changes nothing."""
    fmus = {"body": build("mass_1_force", folder), "drag": build("drag", folder)}
    wires = [("body.v", "drag.u"), ("drag.F", "body.F")]
    plain, corrected = (
        simulate(
            System(fmus, wires, derivatives=known), 1.0, 0.02, algorithm="gauss_seidel", order=order, outputs=["drag.F"]
        )
        for known in ({}, {("drag.F", "drag.u"): "drag.dF_du"})
    )
    assert corrected["drag.F"].values == approx(plain["drag.F"].values, rel=1e-12, abs=1e-12)
