import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from contact_core.quantities import STATED, TABLE
from system_models.charts import files
from system_models.charts.chart import Chart
from system_models.charts.half_widths import with_error
from system_models.run import report
from system_models.store.results import to_dataset, with_half_widths


@pytest.fixture
def long_run() -> xr.Dataset:
    """Two hours with a row per minute: friction falls, the rest is plain."""
    time = 60.0 * np.arange(121)
    columns = {name: np.full(121, 0.5) for name in TABLE}
    columns |= {"valid": np.full(121, True), "range_flags": np.zeros(121, int)}
    columns |= {name: np.zeros(121) for name in STATED.values()}
    columns["friction_coefficient"] = 0.13 - 1e-6 * time
    columns["lambda_ratio"] = np.full(121, 0.25)
    columns["h_c"] = 3e-8 + 1e-12 * time
    units = {name: quantity.unit for name, quantity in TABLE.items()}
    return to_dataset(list(time), columns, units, {name: q.text for name, q in TABLE.items()})


def rows_of(text: str) -> list[list[float]]:
    return [[float(cell) for cell in line.split()] for line in text.splitlines()[2:]]


def test_the_table_has_ten_rows_denser_early_on(long_run: xr.Dataset) -> None:
    minutes = [row[0] for row in rows_of(report.table(long_run))]
    assert minutes == [0.0, 1.0, 2.0, 6.0, 12.0, 24.0, 42.0, 60.0, 90.0, 120.0]


def test_a_short_run_is_printed_whole(long_run: xr.Dataset) -> None:
    assert len(rows_of(report.table(long_run.isel(time=slice(12))))) == 12


def test_times_that_two_digits_cannot_tell_apart_have_more(long_run: xr.Dataset) -> None:
    short = long_run.isel(time=slice(3)).assign_coords(time=[0.0, 60.0, 60.12])
    assert [row[0] for row in rows_of(report.table(short))] == [0.0, 1.0, 1.002]


def test_the_table_converts_to_the_units_of_its_heading(long_run: xr.Dataset) -> None:
    heading, units, *_ = (line.split() for line in report.table(long_run).splitlines())
    assert heading[:3] == ["time", "friction", "h_c"]
    assert units == ["min", *["nm"] * 5, "GPa", "um", "%", "%"]
    assert rows_of(report.table(long_run))[-1][:4] == [120.0, 0.1228, 37.2, 0.25]


def test_the_table_has_columns_of_stress_and_damage_where_there_are_any(long_run: xr.Dataset) -> None:
    names = ("von_mises_max", "von_mises_depth", "damage_1", "damage_2", "micropitted_area_1", "micropitted_area_2")
    bare = long_run.assign({name: 0.0 * long_run[name] for name in names})
    assert "Mises" not in report.table(bare)
    assert "pitted 2" in report.table(long_run)
    assert "damage 1" not in report.table(long_run.assign({name: 0.0 * long_run[name] for name in names[2:]}))


def test_a_value_is_printed_with_the_half_width_of_its_error_to_the_first_digit_of_that(long_run: xr.Dataset) -> None:
    columns = {str(name): long_run[name].values for name in long_run.data_vars}
    columns |= {"error_friction": np.full(121, 0.04), "error_load_ratio": np.full(121, 0.03)}
    units, texts = (
        {str(name): long_run[name].attrs[key] for name in long_run.data_vars} for key in ("units", "long_name")
    )
    last = report.table(to_dataset(long_run["time"].values, columns, units, texts)).splitlines()[-1]
    assert "0.123 +- 0.005" in last  # 4 % of it
    assert "0.50 +- 0.03" in last  # absolute
    assert last.count("+-") == 2


@pytest.mark.parametrize(
    ("value", "half", "text"),
    [
        (0.10637, 0.0043, "0.106 +- 0.004"),
        (0.0298, 0.124, "0.03 +- 0.12"),  # two digits of a half width that begins with 1
        (155.2, 14.4, "155 +- 14"),
        (20.31, 1.26, "20.3 +- 1.3"),
        (0.10637, 1e-6, "0.1064 +- <0.0001"),
        (52.31, 6.2, "52 +- 6"),
        (0.5, 0.0, "0.5000"),
        (1.0, math.inf, "1.0000 +- ?"),
    ],
)
def test_digits_of_a_value_follow_its_error(value: float, half: float, text: str) -> None:
    assert with_error(value, half, 4) == text


def test_a_share_that_may_be_anything_is_unknown(long_run: xr.Dataset) -> None:
    columns = {str(name): long_run[name].values for name in long_run.data_vars}
    units, texts = (
        {str(name): long_run[name].attrs[key] for name in long_run.data_vars} for key in ("units", "long_name")
    )
    for share, half, text in ((0.0, 1.0, "unknown"), (0.4, 0.7, "unknown"), (0.4, 0.5, "0.4 +- 0.5")):
        changed = columns | {"contact_load_ratio": np.full(121, share), "error_load_ratio": np.full(121, half)}
        assert text in report.table(to_dataset(long_run["time"].values, changed, units, texts)).splitlines()[-1]


def test_half_widths_are_coordinates_that_the_outputs_name(long_run: xr.Dataset) -> None:
    found = with_half_widths(long_run.assign(error_film=("time", np.full(121, 0.1))))
    half = found["h_c"].attrs["ancillary_variables"]
    assert half == "h_c_error"
    assert found[half].values == approx(0.1 * found["h_c"].values)
    assert found[half].attrs["units"] == "m"
    assert half in found.coords


def test_load_cycles_are_whole_passes(long_run: xr.Dataset) -> None:
    long_run["load_cycles_1"][-1], long_run["load_cycles_2"][-1] = 28361.9, 999.0
    assert report.closing_lines(long_run)[0] == "Load cycles: 28 361 of body 1, 999 of body 2."


def test_the_share_of_blocks_is_told(long_run: xr.Dataset) -> None:
    for name, count in (("dry", 6.0), ("mixed", 3.0), ("fallback", 1.0)):
        long_run[f"blocks_{name}"][-1] = count
    line = report.closing_lines(long_run)[1]
    assert line == (
        "Pressures that drive tribofilm and wear: dry contact in 60.0 % of 10 blocks, "
        "mixed lubrication in 30.0 %, dry contact in place of a mixed solution that failed in 10.0 %."
    )


def charts(run: xr.Dataset) -> dict[str, Chart]:
    """The charts of the overview by their titles."""
    return {chart.title: chart for chart in report.overview(run).charts if chart}


def test_every_panel_has_a_label_and_a_legend_where_lines_must_be_told_apart(long_run: xr.Dataset) -> None:
    drawn = charts(long_run)
    assert len(drawn) == 8
    assert drawn["Tribofilm"].y_label.startswith("thickness [")
    axes = files.figure(report.overview(long_run)).axes
    for axis, chart in zip(axes, drawn.values(), strict=True):
        assert (axis.get_legend() is None) == (len(chart.lines) == 1)


def test_panels_draw_converted_values_against_minutes(long_run: xr.Dataset) -> None:
    gap, sigma = charts(long_run)["Height"].lines
    np.testing.assert_allclose(gap.x, np.arange(121))
    np.testing.assert_allclose(gap.y, 30.0 + 0.06 * np.arange(121))
    np.testing.assert_allclose(sigma.y, 4.0 * gap.y)
    (axis,) = (axis for axis in files.figure(report.overview(long_run)).axes if axis.get_title("left") == "Height")
    np.testing.assert_array_equal(axis.lines[0].get_ydata(), gap.y)


def test_the_composite_roughness_is_left_out_where_the_film_ratio_is_capped(long_run: xr.Dataset) -> None:
    long_run["lambda_ratio"][:] = 1000.0
    assert np.isnan(charts(long_run)["Height"].lines[1].y).all()


def test_invalid_steps_are_shaded(long_run: xr.Dataset) -> None:
    assert not files.figure(report.overview(long_run)).axes[0].patches
    long_run["valid"][7] = False
    for axis in files.figure(report.overview(long_run)).axes:
        (shade,) = axis.patches
        extent = shade.get_extents().transformed(axis.transData.inverted())
        assert extent.intervalx == approx([6.0, 7.0])


@pytest.mark.usefixtures("rendered")
def test_the_overview_is_a_png(long_run: xr.Dataset, tmp_path: Path) -> None:
    path = files.save(report.overview(long_run), tmp_path / "overview.png")
    assert path.read_bytes().startswith(b"\x89PNG")
    assert path.stat().st_size > 10_000


def test_bodies_that_are_warmer_than_the_oil_are_told(long_run: xr.Dataset) -> None:
    told = report.closing_lines(long_run)
    assert not any("take up the heat" in line for line in told)
    warmer = long_run.assign(
        temperature_1=long_run["temperature"] + 10.0,
        temperature_2=long_run["temperature"],
        heat_flow_1=("time", np.full(long_run.sizes["time"], 1.25)),
        heat_flow_2=("time", np.full(long_run.sizes["time"], 0.5)),
    )
    at = float(long_run["temperature"][-1]) + 10.0 - 273.15
    (line,) = [line for line in report.closing_lines(warmer) if "take up the heat" in line]
    assert f"body 1 at {at:.1f} degC with 1.25 W, body 2 at {at - 10.0:.1f} degC with 0.5 W" in line


def test_what_is_off_has_no_columns(long_run: xr.Dataset) -> None:
    on, off = {"model": "archard"}, {"model": "none"}
    found = long_run.assign_attrs(scene_json=json.dumps({"tribofilm": off, "wear": on}))
    assert "tribofilm 1" in report.table(long_run) and "tribofilm" not in report.table(found)
    assert "wear 1" in report.table(found)
    assert "Off, and not computed: tribofilm." in report.closing_lines(found)
