"""Error bands of charts, and the stretches of time of marked rows."""

import re

import numpy as np
from comparison import approx

from system_models.charts.chart import Chart, Line
from system_models.charts.svg import figure
from system_models.charts.units import time_unit
from system_models.html_report.trust import spans

PAIR = re.compile(r"([\d.]+)[ ,]([\d.]+)")


def test_a_band_reaches_as_far_below_its_line_as_above() -> None:
    x, y, half = np.array([0.0, 1.0, 2.0]), np.array([3.0, 5.0, 4.0]), np.array([0.5, 1.0, 0.25])
    drawn = figure(Chart("film", "time [s]", "h [nm]", [Line("film", x, y, half)]), "film")
    (band,), (curve,) = re.findall(r'class="band"[^>]*points="([^"]*)"', drawn), re.findall(r' d="(M[^"]*)"', drawn)
    edge, line = (np.array([[float(a), float(b)] for a, b in PAIR.findall(text)]) for text in (band, curve))
    above, below = edge[:3], edge[:2:-1]
    np.testing.assert_allclose(above[:, 0], line[:, 0], atol=0.11)  # places have one digit
    np.testing.assert_allclose(0.5 * (above + below), line, atol=0.11)
    per_unit = (line[0, 1] - line[1, 1]) / 2.0  # between values of 3 and 5
    np.testing.assert_allclose(line[:, 1] - above[:, 1], per_unit * half, atol=0.3)


def test_a_row_stands_for_the_step_that_ends_there() -> None:
    times, marked = np.array([0.0, 10.0, 20.0, 30.0, 40.0]), np.array([True, False, True, True, False])
    assert list(spans(times, marked)) == [(0.0, 0.0), (10.0, 30.0)]
    assert list(spans(times, ~marked)) == [(0.0, 10.0), (30.0, 40.0)]


def test_times_are_read_in_seconds_minutes_or_hours() -> None:
    read = [(float(time_unit(end).of(end)), time_unit(end).name) for end in (60.0, 1800.0, 36000.0)]
    assert read == [(60.0, "s"), (approx(30.0), "min"), (approx(10.0), "h")]
