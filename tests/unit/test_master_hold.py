"""Polynomials of the coupled inputs: exact for polynomials, of the right order for anything else."""

import numpy as np
import pytest
from comparison import approx
from hypothesis import given
from hypothesis import strategies as st

from system_models.numerics.hold import History, mean, value

ORDERS = (0, 1, 2)


def polynomial(coefficients):
    """u(t) of two entries, and its integral, by numpy's own polynomials."""
    entries = [np.polynomial.Polynomial(c) for c in coefficients]
    integrals = [entry.integ() for entry in entries]
    return (
        lambda t: np.array([entry(t) for entry in entries]),
        lambda a, b: np.array([integral(b) - integral(a) for integral in integrals]),
    )


@st.composite
def cases(draw):
    order = draw(st.sampled_from(ORDERS))
    number = st.floats(-10.0, 10.0)
    coefficients = draw(st.lists(st.lists(number, min_size=order + 1, max_size=order + 1), min_size=2, max_size=2))
    steps = draw(st.lists(st.floats(0.1, 2.0), min_size=order + 2, max_size=order + 4))
    return order, coefficients, np.cumsum(steps), draw(st.floats(0.1, 2.0))


@given(cases())
def test_polynomials_up_to_the_order_are_reproduced(case):
    order, coefficients, times, step = case
    u, integral = polynomial(coefficients)
    history = History(order)
    for time in times:
        history.push(time, u(time))
    now = times[-1]
    for held in (history.extrapolate(), history.interpolate(step, u(now + step))):
        assert held.shape == (order + 1, 2)
        for s in (0.0, 0.3 * step, step):
            assert value(held, s) == approx(u(now + s), rel=1e-9, abs=1e-7)
        assert mean(held, step) == approx(integral(now, now + step) / step, rel=1e-9, abs=1e-7)


@given(cases())
def test_sampled_inputs_hold_their_values_and_others_do_not_notice(case):
    order, coefficients, times, step = case
    u, _ = polynomial(coefficients)
    free, history = History(order), History(order, np.array([False, True]))
    for time in times:
        for each in (free, history):
            each.push(time, u(time))
    now, end = u(times[-1]), u(times[-1] + step)
    for held, plain, value_held in (
        (history.extrapolate(), free.extrapolate(), now[1]),
        (history.interpolate(step, end), free.interpolate(step, end), end[1]),
    ):
        assert np.array_equal(held[:, 0], plain[:, 0])
        assert held[:, 1].tolist() == [value_held, *[0.0] * order]
    assert history.interpolate(step, end[1:], slice(1, 2)).tolist() == [[end[1]], *[[0.0]] * order]


@pytest.mark.parametrize("order", ORDERS)
def test_extrapolation_is_of_one_order_more_than_its_degree(order):
    def error(step):
        history = History(order)
        for k in range(-order, 1):
            history.push(1.0 + k * step, np.array([np.exp(1.0 + k * step)]))
        return abs(value(history.extrapolate(), step)[0] - np.exp(1.0 + step))

    assert np.log2(error(0.02) / error(0.01)) == approx(order + 1, abs=0.1)


@pytest.mark.parametrize("order", ORDERS)
def test_interpolation_is_of_one_order_more_than_its_degree(order):
    def error(step):
        history = History(order)
        for k in range(-order, 1):
            history.push(1.0 + k * step, np.array([np.exp(1.0 + k * step)]))
        held = history.interpolate(step, np.array([np.exp(1.0 + step)]))
        return abs(value(held, 0.5 * step)[0] - np.exp(1.0 + 0.5 * step))

    assert np.log2(error(0.02) / error(0.01)) == approx(order + 1, abs=0.1)


def test_interpolation_passes_the_newest_point_and_the_end():
    history = History(2)
    for time, at in ((0.0, 3.0), (0.4, -1.0), (1.0, 2.0)):
        history.push(time, np.array([at]))
    held = history.interpolate(0.25, np.array([7.0]))
    assert value(held, -0.6)[0] == approx(-1.0)
    assert value(held, 0.0)[0] == 2.0
    assert value(held, 0.25)[0] == approx(7.0)
    assert History(0).interpolate(0.25, np.array([7.0])).tolist() == [[7.0]]


def test_after_an_event_the_order_grows_again():
    history = History(2)
    for time in (0.0, 1.0, 2.0, 3.0):
        history.push(time, np.array([time**3]))
    history.clear()
    degrees = []
    for time in (4.0, 5.0, 6.0, 7.0):
        history.push(time, np.array([time]))
        held = history.extrapolate()
        degrees.append((len(held) - 1, len(history.interpolate(1.0, np.array([time + 1.0]))) - 1))
        assert held[0] == time  # nothing of the cubes
        assert held[1:2] == approx(1.0)
    assert degrees == [(0, 1), (1, 2), (2, 2), (2, 2)]


def test_a_restored_history_is_bitwise_what_it_was():
    rng = np.random.Generator(np.random.Philox(3))
    history, buffer = History(2), np.empty(4)
    for time in (0.0, 0.1, 0.35):
        buffer[:] = rng.standard_normal(4)
        history.push(time, buffer)
    before, past = history.extrapolate(), history.copy()
    buffer[:] = np.nan  # the caller's own
    history.push(0.5, rng.standard_normal(4))
    history.push(0.9, rng.standard_normal(4))
    history.clear()
    history.restore(past)
    assert np.array_equal(history.extrapolate(), before)
    assert len(before) == 3
