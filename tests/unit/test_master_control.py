"""The norm of errors, and the controller of the step on errors C(t) h^p."""

import json
import math

import numpy as np
import pytest
from comparison import approx

from system_models.numerics.control import StepControl, scale, wrms

ORDERS = (1, 2, 3)


def run(order, size, until, step=1e-3):
    """Ratios of the accepted steps, the accepted times, and the number of rejects, for an error size(t) h^order."""
    control, time, ratios, times, rejects = StepControl(order), 0.0, [], [], 0
    while time < until:
        ratio = size(time) * step**order
        if ratio > 1.0:
            step *= control.reject(ratio)
            rejects += 1
            continue
        time += step
        ratios.append(ratio)
        times.append(time)
        step *= control.accept(ratio)
    return np.array(ratios), np.array(times), rejects


def test_wrms_is_one_where_every_error_is_as_allowed():
    nominal, values = np.array([1.0, 1e-6, 0.0]), np.array([-3.0, 1e-6, 5.0])
    allowed = scale(1e-3, nominal, values)
    assert allowed == approx([4e-3, 2e-9, 5e-3])
    assert wrms(-allowed, allowed) == approx(1.0)
    assert wrms(np.array([3.0, 4.0]), np.ones(2)) == approx(math.sqrt(12.5))
    assert wrms(np.empty(0), np.empty(0)) == 0.0
    assert math.isnan(wrms(np.array([np.nan, 1.0]), np.ones(2)))


@pytest.mark.parametrize("order", ORDERS)
def test_slowly_varying_errors_are_kept_near_the_target_without_rejects(order):
    ratios, _, rejects = run(order, lambda t: 1e4**order * 10.0 ** math.sin(2.0 * math.pi * t), until=1.0)
    settled = ratios[20:]
    assert len(settled) > 1000
    assert np.mean((settled > 0.3) & (settled < 1.0)) == 1.0
    assert rejects <= 2


@pytest.mark.parametrize("order", ORDERS)
def test_jumps_of_the_error_cost_few_rejects_each(order):
    def size(t):
        return 1e2**order * (1e3 if math.floor(5.0 * t) % 2 else 1.0)

    ratios, _, rejects = run(order, size, until=2.0)
    assert np.mean((ratios > 0.3) & (ratios <= 1.0)) > 0.95
    assert 5 <= rejects <= 5 * 6  # five jumps upwards; a factor 1000 of an error of order 1 is five steps of 0.2


def test_rough_errors_are_rejected_seldom():
    rng = np.random.Generator(np.random.Philox(5))
    noise = np.exp(0.1 * rng.standard_normal(100_000))
    ratios, _, rejects = run(2, lambda t: 1e4 * noise[int(1e4 * t) % noise.size], until=10.0)
    assert np.mean((ratios > 0.3) & (ratios <= 1.0)) > 0.99
    assert rejects < 0.05 * len(ratios)


def test_after_a_reject_the_next_step_does_not_grow():
    control = StepControl(2)
    assert control.reject(4.0) == approx(math.sqrt(0.7 / 4.0))
    assert control.accept(0.01) == 1.0
    assert control.accept(0.01) > 1.0


def test_the_step_after_a_reject_says_nothing_about_those_that_follow():
    used, new = StepControl(2), StepControl(2)
    used.reject(1.5)
    used.accept(0.5)
    assert [used.accept(ratio) for ratio in (0.9, 0.4)] == [new.accept(ratio) for ratio in (0.9, 0.4)]


def test_rejects_in_a_row_shrink_harder():
    control = StepControl(3)
    factors = [control.reject(1.5) for _ in range(4)]
    assert factors == approx([(0.7 / 1.5) ** (k / 3.0) for k in (1, 2, 3, 4)])


@pytest.mark.parametrize("ratio", [math.nan, math.inf, 1e300])
def test_errors_without_measure_shrink_the_step_most(ratio):
    assert StepControl(2).reject(ratio) == 0.2
    assert StepControl(2).accept(ratio) == 0.2  # at the smallest step, where the caller goes on


def test_without_error_the_step_grows_most_and_nothing_winds_up():
    control = StepControl(2)
    assert [control.accept(ratio) for ratio in (0.0, 5e-324, 0.0)] == [2.0, 2.0, 2.0]
    assert control.accept(0.7) == approx(1.0)


def test_an_event_makes_the_controller_forget():
    used, new = StepControl(2), StepControl(2)
    used.accept(0.3)
    used.reject(2.0)
    used.after_event()
    assert [used.accept(r) for r in (0.5, 0.9)] == [new.accept(r) for r in (0.5, 0.9)]


def test_memory_survives_a_checkpoint():
    used, new = StepControl(2), StepControl(2)
    used.accept(0.3)
    new.restore(json.loads(json.dumps(used.copy(), allow_nan=False)))
    assert new.accept(0.9) == used.accept(0.9) != StepControl(2).accept(0.9)
