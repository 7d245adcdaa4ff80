"""What is said of a result made by hand: the worst row of a flag, the body that is known less, a cam at work."""

from types import SimpleNamespace

import xarray as xr
from comparison import approx

from contact_core import RangeFlag, Scene
from system_models.machines.cam_follower.report import _heading
from system_models.run import flags, verdict


def test_a_slow_body_is_told_at_the_row_where_it_is_slowest_beside_the_other() -> None:
    speeds = {"speed_1": ("time", [1.0, 1.0, 0.5]), "speed_2": ("time", [0.5, -0.01, 0.4])}
    told = flags.by_how_much(RangeFlag.SLOW_BODY, Scene.from_toml("mtm_zddp"), xr.Dataset(speeds))
    assert told == "0.01 m/s beside 1 m/s"


def test_of_both_bodies_the_one_known_less_is_told() -> None:
    """10 % of the depth of body 1 and 50 % of that of body 2, whichever comes first."""
    for first, second in ((1e-8, 5e-8), (5e-8, 1e-8)):
        halves = {"wear_depth_1_error": first, "wear_depth_2_error": second}
        (wear,) = verdict.known(xr.Dataset({"wear_depth_1": 1e-7, "wear_depth_2": 1e-7}, halves), {})
        assert wear.half == approx(0.5)
        assert wear.text == "wear only to 50 %"


def test_a_cam_is_told_at_the_last_row_in_which_it_turns() -> None:
    found = {
        "shaft.speed": [0.0, 100.0, 0.0],
        "head.temperature_oil": [293.15, 353.15, 350.0],
        "head.temperature_cam": [293.15, 363.15, 350.0],
        "head.temperature_follower": [293.15, 358.15, 350.0],
    }
    record = SimpleNamespace(last=1, time=[0.0, 5.0, 9.0], of=found.__getitem__)
    told = _heading(record)  # type: ignore[arg-type]
    assert told == "At 5 s: 955 rpm, oil at 80.0 degC, cam at 90.0 degC, follower at 85.0 degC."
