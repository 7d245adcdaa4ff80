"""The error of a machine's loss by what its contacts state."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from system_models.machines.report import loss_error

TIMES = np.array([0.0, 1.0, 3.0])


def machine(power_1, power_2, error_1=0.1, error_2=0.3):
    """Two contacts, the second one of two alike."""
    columns = {
        "one.power_loss": power_1, "one.error_friction": error_1, "two.power_loss": power_2,
        "two.error_friction": error_2, "load.count": 2.0,
    }  # fmt: skip
    dataset = xr.Dataset({name: ("time", np.full(3, value)) for name, value in columns.items()}, {"time": TIMES})
    contacts = {"one": SimpleNamespace(count="", scene=None), "two": SimpleNamespace(count="load.count", scene=None)}
    return SimpleNamespace(contacts=contacts, parts={}), dataset


@pytest.mark.parametrize(
    ("first", "second", "error"), [(5.0, 0.0, 0.1), (0.0, 5.0, 0.3), (4.0, 2.0, 0.2), (-4.0, 2.0, 0.2)]
)
def test_contacts_count_by_the_energy_they_lose_and_by_how_many_they_stand_for(first, second, error):
    assert loss_error(*machine(first, second)) == approx(error)


def test_rolling_counts_with_its_own_error():
    assembly, dataset = machine(4.0, 0.0)
    columns = {"rolling_resistance": -3.0, "speed_1": -1.0, "speed_2": -3.0, "error_rolling": 0.5}
    dataset = dataset.assign({f"one.{name}": ("time", np.full(3, value)) for name, value in columns.items()})
    assert loss_error(assembly, dataset) == approx((0.1 * 4.0 + 0.5 * 12.0) / 16.0)


def test_longer_steps_count_more():
    assembly, dataset = machine(1.0, 0.0)
    dataset["one.error_friction"].values[:] = (9.0, 0.1, 0.4)  # the first row is of no time
    assert loss_error(assembly, dataset) == approx((0.1 + 2.0 * 0.4) / 3.0)


def test_without_a_loss_nothing_is_said():
    assert np.isnan(loss_error(*machine(0.0, 0.0)))
