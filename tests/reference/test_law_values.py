import numpy as np
import pytest
from comparison import approx

from contact_core import Scene
from contact_core.laws.viscosity import Barus, Roelands
from contact_core.laws.wear import Archard


def test_roelands_at_the_pressures_of_the_source():
    alpha = 0.706 * 5.1e-9 * (np.log(0.004) + 9.67)  # the exponent z = 0.706 as a slope at p = 0
    oil = Roelands(0.004, 363.15, alpha, 0.03)
    low, high = oil(np.array([0.84e9, 1.26e9]), 363.15)
    assert low == approx(43.0, abs=0.5)
    assert high == approx(1663.0, abs=0.5)


def test_the_shipped_oil_has_that_exponent():
    oil = Scene.from_toml("azam_case_a").lubricant.viscosity
    exponent = oil.pressure_coefficient / (5.1e-9 * (np.log(oil.viscosity) + 9.67))
    assert exponent == approx(0.706, abs=5e-4)


def test_barus_far_above_roelands_at_contact_pressures():
    oil = Barus(0.004, 363.15, 14.94e-9, 0.03)
    assert oil(np.array([0.84e9, 1.26e9]), 363.15) == approx([1128.0, 6e5], rel=0.01)


@pytest.mark.parametrize(("name", "ball", "disc"), [("azam_case_a", 28361, 7419), ("mtm_zddp", 12331, 4858)])
def test_load_cycles_of_the_shipped_cases_in_two_hours(name, ball, disc):
    scene = Scene.from_toml(name)
    point, tracks = scene.operation.point, scene.geometry
    assert point.speed_1 * 7200.0 / tracks.track_length_1 == approx(ball, abs=0.5)
    assert point.speed_2 * 7200.0 / tracks.track_length_2 == approx(disc, abs=0.5)


def test_wear_in_steps_adds_up_to_archards_depth():
    law = Archard(bare=1e-5, film=1e-6)
    depth = np.zeros(1)
    for step in (0.1, 7.0, 100.0, 0.9):
        depth += law.rate(np.array([0.8e9]), np.zeros(1), (0.2475, 0.2525), 0, 6e9, 1e-7) * step
    assert depth[0] == approx(1e-5 * 0.8e9 * 0.005 * 108.0 / 6e9, rel=1e-14, abs=0.0)
