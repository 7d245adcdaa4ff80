"""The differences with which the checker compares derivatives."""

from types import SimpleNamespace

import pytest
from comparison import approx
from fmpy.model_description import ModelVariable

from system_models.check.derivatives import _slope


@pytest.mark.parametrize("nominal", ["1", "1e6"])
def test_the_slope_of_a_line_is_its_own_whatever_the_magnitude(nominal: str) -> None:
    given = ModelVariable("u", 1)
    given.start, given.nominal = "2", nominal
    held = {"u": 2.0}
    instance = SimpleNamespace(put=held.update, read=lambda names: {"y": 3.0 * held["u"] - 1.0})
    fmu = SimpleNamespace(variables={"u": given})
    assert _slope(fmu, lambda: instance, "y", "u", 1e-4) == approx(3.0)  # type: ignore[arg-type,return-value]
