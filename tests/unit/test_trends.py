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
    trends = follow([1.0 + 0.25 * k for k in range(40)], memory)
    assert trends.level == approx(np.full(len(NAMES), 1.0 + 0.25 * 39), rel=1e-12)
    assert trends.slope == approx(np.full(len(NAMES), 0.25), rel=1e-9)


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


def test_a_level_that_cannot_be_negative_is_not():
    trends = follow([1.0, 0.5, 0.0, 0.0, 0.0])
    assert trends.values()["contact_load_ratio"] >= 0.0
    assert trends.values()["friction_force"] < 0.0  # that one has a sign


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
