"""The error that a finer simulation tells is the error there is; jumps of the duty are none."""

import numpy as np
import pytest
import xarray as xr

from system_models.machine.coupling_error import errors, finer, settled


def euler(step: float, jump: float = 2.0) -> xr.Dataset:
    """x' = a - x by explicit Euler, a = 1 and from `jump` on 3, with what follows a at once."""
    times = np.arange(round(6.0 / step) + 1) * step
    values = [0.0]
    for time in times[:-1]:
        values.append(values[-1] + step * ((3.0 if time >= jump else 1.0) - values[-1]))
    columns = {
        "a.x": ("time", np.array(values), {"units": "m"}),
        "a.T": ("time", np.array(values) + 373.15, {"units": "K"}),
        "a.at_once": ("time", np.where(times > jump + 1.5 * step, 3.0, 1.0), {"units": "1"}),
        "a.on": ("time", times > 1.0, {"units": "1"}),
        "master.step_size": ("time", np.full(len(times), step), {"units": "s"}),
    }
    return xr.Dataset(columns, {"time": times})


SCHEDULE = {"a.setpoint": [(0.0, 1.0), (2.0, 3.0)]}


def exact(times: np.ndarray) -> np.ndarray:
    before = 1.0 - np.exp(-np.minimum(times, 2.0))
    return np.where(times < 2.0, before, 3.0 + (before - 3.0) * np.exp(-np.maximum(times - 2.0, 0.0)))


def test_the_error_is_that_against_the_exact_solution() -> None:
    coarse, fine = euler(0.02), euler(0.01)
    found = errors(coarse, fine, SCHEDULE)
    rows = settled(coarse, SCHEDULE)
    true = np.abs(coarse["a.x"].values - exact(coarse["time"].values))[rows].max()
    largest = float(coarse["a.x"].max())
    assert found["a.x"] == pytest.approx(true / largest, rel=0.03)
    assert found["a.x"] > 0.002
    assert found["a.T"] == pytest.approx(found["a.x"] * largest / (100.0 + largest), rel=1e-9)


def test_a_jump_is_no_error_and_truths_have_none() -> None:
    found = errors(euler(0.02), euler(0.01), SCHEDULE)
    assert found["a.at_once"] == 0.0
    assert errors(euler(0.02), euler(0.01), {})["a.at_once"] > 0.1
    assert "a.on" not in found
    assert "master.step_size" not in found


def test_finer_settings_are_halved() -> None:
    settings = {"tolerance": 1e-3, "max_step": 30.0, "step_size": 0.01, "stop_time": 5.0, "algorithm": "jacobi"}
    assert finer(settings) == settings | {"tolerance": 5e-4, "max_step": 15.0, "step_size": 0.005}
