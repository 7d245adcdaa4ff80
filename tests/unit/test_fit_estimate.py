import numpy as np
import pytest
from comparison import approx

from system_models.run import fit_estimate
from system_models.run.fit_estimate import Estimate, Problem, jacobian, searched, silent, starts

TIMES = np.linspace(100.0, 7200.0, 24)
LOW, HIGH = np.array([50.0, 1e-4, 1.0, 1e-5]), np.array([500.0, 1e-2, 150.0, 1e-2])
TRUE = np.array([180.0, 1.2e-3, 50.0, 3e-4])  # h_max, k, C3, C4: not the middle of the ranges
NOISE = 4.0


def at(shares: np.ndarray) -> np.ndarray:
    return LOW * (HIGH / LOW) ** shares


def grown(constants: np.ndarray) -> np.ndarray:
    full, growth, removed, removal = constants
    return full * (1.0 - np.exp(-growth * TIMES)) - removed * (1.0 - np.exp(-removal * TIMES))


def fitted(
    curve: fit_estimate.Curve, measured: np.ndarray, count: int, held: np.ndarray | None = None, sd: float = 0.0
) -> Estimate:
    left = np.ones(len(measured), bool) if held is None else ~held
    group = np.zeros(len(measured), int)
    problem = Problem(curve, measured, np.full(len(measured), sd), group, left, count)
    tried = np.vstack([np.full(count, 0.5), starts(count, 8 * count)])
    return searched(problem, tried, np.array([curve(one) for one in tried]), 2)


@pytest.fixture(scope="module")
def many() -> list[tuple[np.ndarray, np.ndarray, Estimate]]:
    """Measured numbers, those held back (8 of 24) and the fit, for 24 seeds."""
    found = []
    for seed in range(24):
        random = np.random.default_rng(seed)
        measured = grown(TRUE) + NOISE * random.standard_normal(24)
        held = np.isin(np.arange(24), random.permutation(24)[:8])
        found.append((measured, held, fitted(lambda shares: grown(at(shares)), measured, 4, held)))
    return found


def test_seven_of_eight_held_back_points_are_inside_and_a_tenth_of_the_interval_is_too_narrow(
    many: list[tuple[np.ndarray, np.ndarray, Estimate]],
) -> None:
    def inside(factor: float) -> float:
        return 8.0 * float(np.mean([(abs(m - e.curve) <= factor * e.half)[held].mean() for m, held, e in many]))

    print(inside(1.0), inside(0.1))
    assert 7.0 <= inside(1.0) <= 7.8  # 7.2 would be 90 %: wide intervals would hold all 8
    assert inside(0.1) < 2.0


def test_constants_are_within_their_intervals(many: list[tuple[np.ndarray, np.ndarray, Estimate]]) -> None:
    true = np.log(TRUE / LOW) / np.log(HIGH / LOW)

    def holds(estimate: Estimate, i: int) -> bool:
        low, high = estimate.limits[i].low, estimate.limits[i].high
        return (low is None or low <= true[i]) and (high is None or true[i] <= high)

    for i in range(4):
        assert np.mean([holds(estimate, i) for _, _, estimate in many]) >= 0.8
    assert np.mean([estimate.scatter[0] for _, _, estimate in many if not estimate.proportional[0]]) == approx(
        NOISE, rel=0.1
    )


def test_points_held_back_leave_no_trace_in_the_constants() -> None:
    line = np.linspace(1.0, 2.0, 12)
    measured = 5.2 * line + 0.1 * np.random.default_rng(8).standard_normal(12)
    held = np.arange(12) % 3 == 0
    found = [
        fitted(lambda shares: 10.0 * shares[0] * line, numbers, 1, held) for numbers in (measured, measured + held)
    ]
    assert found[0].shares == found[1].shares
    assert found[0].limits == found[1].limits
    assert found[0].scatter == found[1].scatter
    assert found[0].half.tolist() == found[1].half.tolist()


def test_constants_that_only_act_together_are_not_identifiable_though_the_curve_is() -> None:
    curve = lambda shares: 100.0 * (shares[0] + shares[1]) * np.linspace(0.1, 1.0, 20)  # noqa: E731
    measured = curve(np.array([0.6, 0.4])) + np.random.default_rng(3).standard_normal(20)
    found = fitted(curve, measured, 2)
    assert all(limits.open for limits in found.limits)
    assert np.abs(found.curve - curve(np.array([0.6, 0.4]))).max() < 2.0
    assert found.half.max() < 3.0


def test_a_constant_at_the_end_of_its_range_has_one_limit() -> None:
    curve = lambda shares: 10.0 * shares[0] * np.ones(15) + shares[1] * np.linspace(0.0, 10.0, 15)  # noqa: E731
    measured = curve(np.array([0.0, 0.5])) + 0.2 * np.random.default_rng(1).standard_normal(15) - 0.1
    found = fitted(curve, measured, 2)
    assert found.limits[0].low is None
    assert 0.0 < found.limits[0].high < 0.1
    assert found.limits[1].low < 0.5 < found.limits[1].high


def test_a_local_minimum_beside_the_scenes_own_constants_is_left() -> None:
    times = np.linspace(0.0, 1.0, 30)
    curve = lambda shares: np.sin(2.0 * np.pi * (1.0 + 9.0 * shares[0]) * times)  # noqa: E731
    measured = curve(np.array([0.83])) + 0.1 * np.random.default_rng(2).standard_normal(30)
    assert fitted(curve, measured, 1).shares[0] == approx(0.83, abs=0.01)


def test_given_deviations_weigh_the_points_and_are_added_to_only_where_residuals_ask_for_it() -> None:
    line = np.linspace(1.0, 2.0, 200)
    curve = lambda shares: 10.0 * shares[0] * line  # noqa: E731
    random = np.random.default_rng(5)
    quiet = fitted(curve, curve(np.array([0.4])) + 0.1 * random.standard_normal(200), 1, sd=0.15)
    loud = fitted(curve, curve(np.array([0.4])) + 0.5 * random.standard_normal(200), 1, sd=0.3)
    assert quiet.scatter == (0.0,)
    assert quiet.sigma == approx(np.full(200, 0.15))
    assert loud.scatter[0] == approx(0.4, rel=0.2)
    assert loud.sigma == approx(np.full(200, 0.5), rel=0.15)


def test_scatter_in_proportion_to_the_curve_is_found() -> None:
    decades = np.logspace(0.0, 2.0, 40)
    curve = lambda shares: 10.0 ** shares[0] * decades  # noqa: E731
    measured = curve(np.array([0.5])) * (1.0 + 0.05 * np.random.default_rng(6).standard_normal(40))
    found = fitted(curve, measured, 1)
    assert found.proportional == (True,)
    assert found.scatter[0] == approx(0.05, rel=0.3)


def test_points_that_no_constant_changes_are_silent_and_failed_curves_are_passed_over() -> None:
    curves = np.array([[0.0, 1.0, 5.0], [0.0, 2.0, 5.0], [np.nan, np.nan, np.nan]])
    assert silent(curves).tolist() == [True, False, True]


def test_starts_where_the_model_has_no_answer_do_not_stop_the_search() -> None:
    line = np.linspace(1.0, 2.0, 12)

    def curve(shares: np.ndarray) -> np.ndarray:
        return np.full(12, np.nan) if shares[0] > 0.55 else 10.0 * shares[0] * line

    measured = 5.2 * line + 0.01 * np.random.default_rng(7).standard_normal(12)
    assert fitted(curve, measured, 1).shares[0] == approx(0.52, rel=0.01)
    assert jacobian(curve, np.array([0.549]))[:, 0] == approx(10.0 * line)
