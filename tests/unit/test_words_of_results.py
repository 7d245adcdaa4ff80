"""What is said of a result made by hand: the worst row of a flag, and the body that is known less."""

import xarray as xr
from comparison import approx

from contact_core import RangeFlag, Scene
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
