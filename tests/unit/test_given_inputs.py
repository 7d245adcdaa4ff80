"""Inputs of a machine's contact that nothing is connected to: given ones and scheduled ones."""

import numpy as np
import xarray as xr

from contact_core import Scene
from system_models.machines import resolve
from system_models.machines.assembly import Assembly, Contact

CONTACT = Contact(Scene.from_toml("mtm_zddp").at_level("regression"), {"speed_2": 0.1})
ASSEMBLY = Assembly(
    name="shoe",
    description="",
    parts={},
    contacts={"contact": CONTACT},
    connections=(("wheel.speed", "contact.speed_1"),),
    parameters={},
    schedule={"contact.temperature": [(0.0, 350.0), (1.0, 360.0)], "wheel.torque": [(0.0, 1.0)]},
    settings={},
)


def test_a_result_has_the_inputs_that_change() -> None:
    assert ASSEMBLY.inputs_of("contact") == ["speed_1", "temperature"]
    assert "contact.temperature" in ASSEMBLY.outputs()


def test_rows_at_work_are_found_by_the_given_speed_and_load() -> None:
    speeds = [0.1, 0.1, -0.1, -0.1, 0.1, 0.1]  # with that of the other body: 0 twice
    dataset = xr.Dataset(
        {"contact.speed_1": ("time", speeds), "contact.valid": ("time", [True] * 6)},
        coords={"time": np.arange(6.0)},
    )
    found = resolve._usable(dataset, "contact", CONTACT)
    assert found.tolist() == [True, True, False, False, False, True]
