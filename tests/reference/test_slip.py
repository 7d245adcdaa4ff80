"""Dry bodies in near rolling: the part of their contact that slips, against the strain under its traction."""

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad

from contact_core.reference import slipping_share

FRICTION, HALF_WIDTH, RADIUS, MODULUS = 0.12, 150e-6, 9.525e-3, 230e9  # 1, m, m, Pa
FULL = FRICTION * HALF_WIDTH / RADIUS  # creep from which on all of it slips


def strain(x: float, stuck: float) -> float:
    """Strain of one surface against the other under Carter's traction, which leaves the front |x - c| < `stuck` stuck.

    By the half plane's own integral, 2 / (pi E*) of q(s) / (x - s): nothing of the formula under test.
    """
    pressure, centre = MODULUS * HALF_WIDTH / (2.0 * RADIUS), HALF_WIDTH - stuck

    def traction(s: float) -> float:
        slip = np.sqrt(max(1.0 - (s / HALF_WIDTH) ** 2, 0.0))
        held = stuck / HALF_WIDTH * np.sqrt(max(1.0 - ((s - centre) / stuck) ** 2, 0.0)) if stuck > 0.0 else 0.0
        return FRICTION * pressure * (slip - held)

    found, _ = quad(traction, -HALF_WIDTH, HALF_WIDTH, weight="cauchy", wvar=x, limit=400)
    return 2.0 / (np.pi * MODULUS) * found


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_the_surfaces_creep_evenly_where_they_stick_under_the_slip_that_the_share_says(share):
    stuck = (1.0 - share) * HALF_WIDTH
    inside = HALF_WIDTH - stuck + stuck * np.array([-0.7, -0.2, 0.4, 0.8])
    found = [slipping_share(strain(x, stuck), FRICTION, HALF_WIDTH, RADIUS) for x in inside]
    assert found == approx([share] * inside.size, rel=1e-6, abs=0.0)


def test_nothing_slips_without_creep_and_all_of_it_above_the_full_one():
    assert slipping_share(0.0, FRICTION, HALF_WIDTH, RADIUS) == 0.0
    assert slipping_share(-2.0 * FULL, FRICTION, HALF_WIDTH, RADIUS) == 1.0
    assert slipping_share(0.5 * FULL, FRICTION, HALF_WIDTH, RADIUS) == approx(0.5, rel=1e-12)


def test_bodies_without_friction_slip_on_all_of_it():
    assert slipping_share(1e-9, 0.0, HALF_WIDTH, RADIUS) == 1.0
    assert slipping_share(0.0, 0.0, HALF_WIDTH, RADIUS) == 0.0
