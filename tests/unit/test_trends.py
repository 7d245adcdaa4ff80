"""Levels without noise, and what is said about their errors."""

import numpy as np
import pytest
from comparison import approx

from contact_core.state.trends import NAMES, Trends


def follow(values, memory=0.75, lag=0.5, trends=None):
    trends = trends or Trends.fresh()
    for value in values:
        trends = trends.followed(dict.fromkeys(NAMES, value), {}, memory, lag)
    return trends


def test_what_does_not_change_is_kept_to_the_last_bit():
    trends = follow([0.1 + 0.2] * 30)
    assert set(trends.level) == {0.1 + 0.2}
    assert trends.half_widths()["h_c"] == (0.0, 0.0)


def test_before_a_drift_can_be_known_an_error_is_reported_all_the_same():
    trends = follow([2.0])
    assert trends.half_widths()["h_c"][0] == approx(0.1)
    assert trends.over(10.0, 0.0).time_error == approx([1.0, 1.0])


def test_scatter_known_from_another_operating_point_is_kept_in_proportion():
    trends = follow(10.0 + np.random.Generator(np.random.Philox(7)).normal(size=60)).restarted()
    again = follow([1000.0], trends=trends)
    assert again.half_widths()["h_c"][1] == approx(200.0, rel=0.5)


@pytest.mark.parametrize("memory", [0.5, 0.75])
def test_a_straight_line_is_followed_without_lag(memory):
    trends = follow([0.1 + 0.02 * k for k in range(40)], memory)
    assert trends.level == approx(np.full(len(NAMES), 0.1 + 0.02 * 39), rel=1e-12)
    assert trends.slope == approx(np.full(len(NAMES), 0.02), rel=1e-9)


def test_noise_is_smoothed_and_lies_within_the_reported_half_width():
    random = np.random.Generator(np.random.Philox(5))
    inside, spread = [], []
    for _ in range(40):
        trends = follow(10.0 + 0.02 * np.arange(60) + random.normal(size=60))
        error = trends.values()["h_c"] - (10.0 + 0.02 * 59)
        spread.append(error)
        inside.append(abs(error) <= trends.half_widths()["h_c"][1])
    assert np.std(spread) < 0.7
    assert np.mean(inside) >= 0.9
    assert trends.half_widths()["h_c"][1] < 4.0


@pytest.mark.parametrize("memory", [0.5, 0.75])
@pytest.mark.parametrize("last", [0.0, 1e-3, 0.1])
@pytest.mark.parametrize("before", [1, 2, 3, 30])
def test_after_a_step_no_level_passes_zero_or_half_of_the_new_value(memory, last, before):
    signs = dict.fromkeys(NAMES, 1.0) | {"friction_force": -1.0, "friction_fluid": -1.0, "approach": -1.0}
    trends = Trends.fresh()
    for value in [1.0] * before + [last] * 40:
        trends = trends.followed({name: value * sign for name, sign in signs.items()}, {}, memory, 0.5)
        for name, level in trends.values().items():
            assert 0.499 * last <= level * signs[name] <= 1.001, name
    assert trends.values()["friction_fluid"] == approx(-last, abs=1e-4)


def test_a_value_about_zero_keeps_its_slope_where_it_changes_sign():
    trends = follow([0.3, 0.1, -0.1])
    assert trends.values()["rolling_resistance"] == approx(-0.1)


def test_parts_of_friction_that_step_apart_still_add_up_to_it_and_to_the_heat():
    random, trends = np.random.Generator(np.random.Philox(9)), Trends.fresh()
    for k in range(60):
        fluid = -(0.3 if k % 20 < 12 else 2e-3) * random.uniform(0.8, 1.2)
        solid = -7.0 * random.uniform(0.9, 1.0)
        power = -0.01 * (solid + fluid)
        parts = {
            "friction_solid": solid,
            "friction_fluid": fluid,
            "friction_force": solid + fluid,
            "power_loss": power,
            "heat_flow_1": 0.99 * power,
            "heat_flow_2": 0.01 * power,
        }
        trends = trends.followed(dict.fromkeys(NAMES, 0.5) | parts, {}, 0.75, 0.5)
        seen = trends.values()
        assert -0.4 < seen["friction_fluid"] < 0.0
        assert seen["friction_force"] == approx(seen["friction_solid"] + seen["friction_fluid"], rel=1e-12)
        assert seen["power_loss"] == approx(-0.01 * seen["friction_force"], rel=1e-12)
        assert seen["power_loss"] == approx(seen["heat_flow_1"] + seen["heat_flow_2"], rel=1e-12)
        assert min(seen["heat_flow_1"], seen["heat_flow_2"]) > 0.0


def test_a_restart_forgets_levels_and_keeps_errors_made():
    trends = follow([1.0, 2.0, 3.0, 4.0]).over(10.0, 0.0)
    again = trends.restarted()
    assert again.blocks == 0
    assert again.time_error == approx(np.full(2, 0.5 * 1.0 * 10.0))
    assert np.array_equal(again.time_error, trends.time_error)


def test_errors_of_a_block_do_not_depend_on_how_its_time_is_cut():
    trends = follow(np.random.Generator(np.random.Philox(6)).normal(size=12))
    whole = trends.over(8.0, 0.0)
    cut = trends.over(3.0, 0.0).over(4.0, 3.0).over(1.0, 7.0)
    assert cut.time_error == approx(whole.time_error, rel=1e-12)
    assert cut.sampling == approx(whole.sampling, rel=1e-12)
    assert (whole.sampling > 0.0).all()


def test_the_scatter_of_rates_adds_up_to_an_error_of_the_depth_that_is_reported_and_no_wider():
    random = np.random.Generator(np.random.Philox(8))
    ratios = []
    for _ in range(60):
        trends, depth = Trends.fresh(), 0.0
        for rate in 10.0 + random.normal(size=60):
            trends = trends.followed(dict.fromkeys(NAMES, rate), {}, 0.75, 0.5).over(3.0, 0.0)
            depth += 3.0 * rate
        ratios.append(abs(depth - 3.0 * 10.0 * 60) / trends.half_widths()["wear_depth_1"][1])
    assert np.mean(np.less(ratios, 1.0)) >= 0.9
    assert np.mean(np.less(ratios, 0.5)) < 0.85
