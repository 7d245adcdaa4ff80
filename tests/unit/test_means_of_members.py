"""What an ensemble of two surfaces comes to, by hand: means, flags of either, truths of both."""

import numpy as np
import xarray as xr
from comparison import approx

from contact_core.scene.ensemble import Members
from system_models.sweep.ensemble import MEMBER
from system_models.sweep.members import mean_of, plan_of_members
from system_models.sweep.points import with_half_widths

MEMBERS = Members(("surface_2.seeds",), ("1", "2"), ((("surface_2.seed", "1"),), (("surface_2.seed", "2"),)))


def test_flags_are_those_of_any_member_truths_those_of_all_and_numbers_their_mean() -> None:
    values = {
        "h_c": [[1e-7, 2e-7], [3e-7, 2e-7]],
        "error_film": [[0.1, 0.1], [0.2, 0.2]],
        "range_flags": [[1, 4], [4, 4]],
        "valid": [[True, True], [True, False]],
        "iterations": [[10, 0], [21, 0]],
    }
    columns = {name: ((MEMBER, "time"), np.array(each), {"units": "m"}) for name, each in values.items()}
    runs = with_half_widths(xr.Dataset(columns, {MEMBER: ["1", "2"], "time": [0.0, 1.0]}, {"title": "two"}))
    found = mean_of(MEMBERS, plan_of_members(MEMBERS), runs)
    assert found["range_flags"].values.tolist() == [1 | 4, 4]
    assert found["valid"].values.tolist() == [True, False]
    assert found["iterations"].values.tolist() == [16, 0]  # of 15.5 and 0
    assert found["h_c"].values == approx(np.array([2e-7, 2e-7]))
    assert found["h_c_error"].values == approx(np.array([0.5 * (0.1e-7 + 0.6e-7), 0.5 * (0.2e-7 + 0.4e-7)]))
    assert found["h_c_band"].values == approx(np.array([12.7062 * 1e-7, 0.0]), rel=1e-4, abs=1e-15)  # t of one freedom
