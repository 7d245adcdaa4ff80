"""The error that steps of double size tell is the error there is; jumps of the duty are none."""

from collections.abc import Mapping

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from system_models.machines.coupling_error import ATTRIBUTE, coarser, differences, relative, settled, stated

SCHEDULE = {"a.setpoint": [(0.0, 1.0), (2.0, 3.0)]}


def euler(times: np.ndarray, jump: float = 2.0) -> xr.Dataset:
    """x' = a - x by explicit Euler, a = 1 and from `jump` on 3, with what follows a, two steps late."""
    values, setpoints = [0.0], [1.0, 1.0]
    for time, size in zip(times[:-1], np.diff(times), strict=True):
        setpoints.append(3.0 if time >= jump else 1.0)
        values.append(values[-1] + size * (setpoints[-1] - values[-1]))
    columns = {
        "a.x": ("time", np.array(values), {"units": "m"}),
        "a.T": ("time", np.array(values) + 373.15, {"units": "K"}),
        "a.at_once": ("time", np.array(setpoints[:-1]), {"units": "1"}),
        "a.error_film": ("time", np.array(values), {"units": "1"}),
        "a.on": ("time", times > 1.0, {"units": "1"}),
        "master.step_size": ("time", np.diff(times, prepend=0.0), {"units": "s"}),
    }
    return xr.Dataset(columns, {"time": times})


def uneven() -> np.ndarray:
    """Steps that grow from the start, and again from the jump at 2 s, their number odd and even."""
    grown = np.cumsum(np.geomspace(1e-3, 0.05, 40))
    return np.concatenate([[0.0], 2.0 * grown[:39] / grown[38], 2.0 + 4.0 * grown / grown[-1]])


def exact(times: np.ndarray) -> np.ndarray:
    before = 1.0 - np.exp(-np.minimum(times, 2.0))
    return np.where(times < 2.0, before, 3.0 + (before - 3.0) * np.exp(-np.maximum(times - 2.0, 0.0)))


@pytest.fixture
def result() -> xr.Dataset:
    return euler(uneven())


@pytest.fixture
def doubled(result: xr.Dataset) -> xr.Dataset:
    return euler(np.array([0.0, *coarser(result, {}, SCHEDULE)["points"]]))


def test_the_error_stated_covers_that_against_the_exact_solution_and_a_tenth_would_not(
    result: xr.Dataset, doubled: xr.Dataset
) -> None:
    found = stated(result, doubled, SCHEDULE)
    true = np.abs(result["a.x"].values - exact(result["time"].values)).max()
    assert true > 0.02
    # the difference is the error, to a tenth; three times that is stated
    assert differences(result, doubled, result["time"].values)["a.x"] == approx(true, rel=0.1)
    assert true < found["a.x"].attrs[ATTRIBUTE] < 3.3 * true
    assert 0.1 * found["a.x"].attrs[ATTRIBUTE] < true
    assert found["a.T"].attrs[ATTRIBUTE] == approx(found["a.x"].attrs[ATTRIBUTE], rel=1e-9)
    assert ATTRIBUTE not in result["a.x"].attrs


def test_errors_are_told_relative_to_the_largest_value_in_degrees_celsius(
    result: xr.Dataset, doubled: xr.Dataset
) -> None:
    found = relative(stated(result, doubled, SCHEDULE), {"a.x": 1e4})
    error, largest = stated(result, doubled, SCHEDULE)["a.x"].attrs[ATTRIBUTE], float(result["a.x"].max())
    assert found["a.T"] == approx(error / (100.0 + largest), rel=1e-9)
    assert found["a.x"] == approx(error / 100.0, rel=1e-9)  # a hundredth of its nominal is more


def test_a_jump_is_no_error_and_truths_and_stated_errors_have_none(result: xr.Dataset, doubled: xr.Dataset) -> None:
    found = stated(result, doubled, SCHEDULE)
    assert found["a.at_once"].attrs[ATTRIBUTE] == 0.0
    assert np.ptp(result["a.at_once"].values) == 2.0
    for name in ("a.on", "a.error_film", "master.step_size"):
        assert ATTRIBUTE not in found[name].attrs


def test_double_steps_end_at_every_second_time_and_at_every_change_of_the_duty(result: xr.Dataset) -> None:
    settings = {"tolerance": 1e-3, "horizon": 1.0, "max_step": 30.0, "step_size": 0.01, "controlled": ["a.x"]}
    found = coarser(result, settings, SCHEDULE)
    times, points = result["time"].values, found.pop("points")
    assert found == {"step_size": 0.01}
    assert 2.0 in points
    assert points[-1] == times[-1]
    assert points[:3] == times[2:7:2].tolist()
    assert points[20:22] == times[41:44:2].tolist()  # the 39 steps before the jump have made 20
    assert settled(result, SCHEDULE).tolist() == [*times[4:40], *times[43:]]


def test_a_jump_that_lies_in_another_step_is_left_out(result: xr.Dataset) -> None:
    times = result["time"].values

    def jumping(row: int) -> xr.Dataset:
        return result.assign({"a.y": ("time", np.where(np.arange(len(times)) > row, 1.0, 0.01 * times))})

    # three steps later is the last that is taken for the same jump
    assert [differences(jumping(60), jumping(row), times)["a.y"] > 0.9 for row in (61, 63, 64)] == [False, False, True]
    assert differences(jumping(60), jumping(63), times)["a.y"] == 0.0
    assert [differences(jumping(60), jumping(row), times)["a.y"] > 0.9 for row in (57, 56)] == [False, True]


def test_a_small_jump_is_an_error_of_its_own_size_even_where_both_results_have_it_in_one_step(
    result: xr.Dataset, doubled: xr.Dataset
) -> None:
    """As of a roughness whose film goes: finer steps may have it in another step."""

    def falling(dataset: xr.Dataset, fall: float) -> xr.Dataset:
        times = dataset["time"].values
        values = np.where(times > 4.0, 1.0 - fall, 1.0) + 1e-4 * times
        return dataset.assign({"a.y": ("time", values, {"units": "m"})})

    for fall, said in ((0.06, 0.06), (0.03, 0.03)):
        found = stated(falling(result, fall), falling(doubled, fall), SCHEDULE)
        assert found["a.y"].attrs[ATTRIBUTE] == approx(said, rel=0.01)
    smooth = stated(falling(result, 0.0), falling(doubled, 0.0), SCHEDULE)
    assert smooth["a.y"].attrs[ATTRIBUTE] < 1e-9


def with_changes(dataset: xr.Dataset, changes: Mapping[int, float]) -> xr.Dataset:
    """The result with a.y, which begins at 1 and changes by 1e-3 in every step, or by so many times that from a row."""
    each = np.full(len(dataset["time"]) - 1, 1e-3)
    for row, factor in changes.items():
        each[row] *= factor
    return dataset.assign({"a.y": ("time", 1.0 + np.append(0.0, np.cumsum(each)), {"units": "m"})})


@pytest.mark.parametrize(
    ("changes", "jump"),
    [({60: 2.0}, 0.0), ({60: 5.0}, 5e-3), ({60: -5.0}, 5e-3), ({60: 5.0, 61: 5.0}, 0.0), ({60: 50.0, 64: 5.0}, 0.05)],
)
def test_a_change_is_a_jump_where_it_is_far_larger_than_those_on_both_sides(
    changes: dict[int, float], jump: float, result: xr.Dataset, doubled: xr.Dataset
) -> None:
    """What both results have alike at their common times differs nowhere, so only a jump is stated."""
    whole = with_changes(result, changes)
    found = stated(whole, whole.sel(time=doubled["time"]), SCHEDULE)
    assert found["a.y"].attrs[ATTRIBUTE] == (approx(jump, rel=1e-6) if jump else 0.0)


def test_a_small_jump_in_the_first_steps_after_the_start_or_a_change_of_the_duty_is_none(
    result: xr.Dataset, doubled: xr.Dataset
) -> None:
    changed = int(np.flatnonzero(result["time"].values == 2.0)[0])
    for begin in (0, changed):
        errors = []
        for row in range(begin, begin + 8):
            whole = with_changes(result, {row: 50.0})
            found = stated(whole, whole.sel(time=doubled["time"]), SCHEDULE)
            errors.append(found["a.y"].attrs[ATTRIBUTE])
        assert errors[:6] == [0.0] * 6
        assert errors[6:] == approx([0.05, 0.05], rel=1e-6)
