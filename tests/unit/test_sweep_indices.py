"""Intervals of Sobol indices beside those by leaving out one sample at a time."""

import numpy as np
import xarray as xr
from comparison import approx

from system_models.sweep.plan import plan_of
from system_models.sweep.sensitivity import indices


def estimates(whole: np.ndarray) -> np.ndarray:
    """First and total indices of both keys by the formulas of Saltelli et al. 2010, table 2."""
    first, second, *mixed = whole - whole[:2].mean()
    variance = np.var(whole[:2])
    alone = [np.mean(second * (each - first)) / variance for each in mixed]
    return np.array([*alone, *(0.5 * np.mean((first - each) ** 2) / variance for each in mixed)])


def test_intervals_of_indices_are_about_two_standard_errors_either_way() -> None:
    """95 % are 1.96 of the jackknife's: Efron & Tibshirani, An Introduction to the Bootstrap, 1993, chapter 11."""
    count = 64
    plan = plan_of(["a=0:1", "b=0:1"], count, "indices")
    a, b = plan.shares.T
    values = 3.0 * a + 2.0 * b + 4.0 * a * b
    found = indices(plan, xr.Dataset({"y": ("sample", values)}), ("y",))
    told = [getattr(each, order) for order in ("first", "total") for each in found]
    whole = values.reshape(4, count)
    assert [value for value, _, _ in told] == approx(estimates(whole), rel=0.05)
    left = [estimates(np.delete(whole, k, axis=1)) for k in range(count)]
    errors = np.sqrt((count - 1) * np.var(left, axis=0))
    assert np.array([high - low for _, low, high in told]) / errors == approx(2.0 * 1.96, rel=0.2)
