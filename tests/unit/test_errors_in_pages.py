"""Errors by cause in the page of a result made by hand: at its end, with bars of the squares."""

import re
from pathlib import Path

import xarray as xr

from system_models.html_report import errors
from system_models.html_report.opened import Run


def result(**variables: list[float]) -> xr.Dataset:
    units = {name: {"units": "1"} for name in variables}
    return xr.Dataset({name: ("time", values, units[name]) for name, values in variables.items()}, {"time": [0.0, 1.0]})


def test_bars_show_shares_of_the_square() -> None:
    """Half widths of 3 and 4 have shares of 9/25 and 16/25 of their sum's square."""
    causes = {"friction_coefficient": {"time": 3e-3, "grid": 4e-3}}
    run = Run(
        Path(), result(friction_coefficient=[0.2, 0.1]), 1.0, True, scene_table={"name": "x"}, causes={"": causes}
    )
    text = errors.sections(run)
    assert re.findall(r"width:([\d.]+)%", text) == ["36.0", "64.0"]
    assert ">5%<" in text  # both together, of the value at the end


def test_errors_of_contacts_are_those_at_the_end() -> None:
    names = {"flank.h_c": [1e-7, 1e-7], "flank.error_film": [0.5, 0.07], "flank.error_friction": [0.02, float("inf")]}
    text = errors.sections(Run(Path(), result(**names), 1.0, True))
    assert ">7%<" in text and ">50%<" not in text
    assert ">not known<" in text and ">2%<" not in text
