"""A chart is drawn alike in a page and in a file, and whatever it has or lacks."""

import json
import re

import numpy as np
import pytest
from comparison import approx

from system_models.charts import files, svg
from system_models.charts.chart import NOTHING, Chart, Line, Sheet

X = np.arange(5.0)
UNKNOWN = np.full(5, np.nan)


def test_both_drawings_of_a_chart_have_the_same_ranges() -> None:
    chart = Chart("film", "x", "h_c [nm]", [Line("", X, 10.0 + X, np.full(5, 2.0), style="o-")], from_zero=False)
    (axes,) = files.figure(Sheet([chart])).axes
    drawn = svg.figure(chart, "film")
    (data,) = re.findall(r'id="points-film">(.*?)</script>', drawn)
    assert axes.get_xlim() == approx(tuple(json.loads(data)["range"]))
    assert axes.get_ylim()[0] < 8.0 and axes.get_ylim()[1] > 16.0  # the band is inside
    _, top, _, bottom = json.loads(data)["box"]
    heights = [float(y) for y in re.findall(r'<circle cx="[\d.]+" cy="([\d.]+)"', drawn)]
    low, high = axes.get_ylim()
    assert heights == approx([bottom - (y - low) / (high - low) * (bottom - top) for y in 10.0 + X], abs=0.1)


def test_a_logarithmic_axis_has_decades_of_one_length() -> None:
    chart = Chart("", "speed", "y", [Line("", np.array([1.0, 10.0, 100.0]), X[:3], style="o")], logarithmic_x=True)
    first, second, third = (float(x) for x in re.findall(r'<circle cx="([\d.]+)"', svg.figure(chart, "k")))
    assert second - first == approx(third - second, abs=0.2)


def test_an_index_is_that_of_a_symbol_and_not_of_a_name() -> None:
    (axes,) = files.figure(Sheet([Chart("contact_load_ratio", "x", "W_c [–]", [Line("", X, X)])])).axes
    assert axes.get_title("left") == "contact_load_ratio"
    assert axes.get_ylabel() == r"$W_{\mathrm{c}}$ [–]"


@pytest.mark.parametrize(
    "chart",
    [
        Chart("nothing", "x", "y"),
        Chart("unknown", "x", "y", [Line("", X, UNKNOWN)]),
        Chart("unknown logarithms", "x", "y", [Line("", X, UNKNOWN)], logarithmic=True, logarithmic_x=True),
        Chart("a point", "x", "y", [Line("", X[:1], X[:1], style="o")]),
        Chart("a key alone", "x", "y", [Line("a", NOTHING, NOTHING), Line("b", X, X, UNKNOWN)], key="which"),
        Chart("zeros", "x", "y", [Line("a", X, 0.0 * X), Line("b", X, X)], logarithmic=True),
        Chart("all", "x", "y", [Line("a", X, X, X, style="sh"), Line("b", X, X, below=0.0 * X)], levels=(1.0,),
              places={"A": 2.0}, y_names={1.0: "one"},
              notes=[(1.0, 1.0, "note")], shaded=[(0.0, 1.0)], dark=[(2.0, 3.0)]),
    ],
    ids=lambda chart: chart.title,
)  # fmt: skip
def test_charts_are_drawn_whatever_they_lack(chart: Chart) -> None:
    files.figure(Sheet([chart, None], "title")).draw_without_rendering()
    assert svg.figure(chart, "k").endswith("</figure>")


def test_a_sheet_without_charts_is_empty() -> None:
    assert files.figure(Sheet([])).axes == []
