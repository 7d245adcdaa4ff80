"""Dry rollers with ends against Lundberg's even load and Hertz's line."""

from itertools import pairwise

import numpy as np
from closed_forms import lundberg_depth
from comparison import approx

from contact_core import Logarithmic, Rounded, line_contact
from contact_core.reference import hertz_line

E, LENGTH, LOAD, RADIUS = 230e9, 3e-3, 4e5, 10e-3  # LOAD per length
DEPTH = lundberg_depth(LOAD * LENGTH, LENGTH, E)


def dry(load, profile, nx, length=LENGTH):
    """At rest on [-1.3, 1.3] Hertz half widths: no oil is drawn in."""
    a = hertz_line(load * length, RADIUS, length, E).a
    found = line_contact(
        load=load, radius=RADIUS, reduced_modulus=E, speed_1=0.0, speed_2=0.0, viscosity=0.01, pressure_viscosity=1e-8,
        length=length, profile=profile, grid=nx, domain=(-1.3 * a, 1.3 * a),
    )  # fmt: skip
    assert found.converged
    return found


def along(found):
    """Load per length of every row over their mean."""
    rows = found.pressure.sum(axis=1) * (found.x[1] - found.x[0])
    return rows / (rows.sum() / (LENGTH / (found.y[1] - found.y[0])))


def test_lundbergs_profile_spreads_its_design_load_evenly_and_no_other():
    found = dry(LOAD, Logarithmic(DEPTH), 65)
    part = np.abs(found.y) < 0.45 * LENGTH
    assert along(found)[part] == approx(1.0, abs=0.06)
    assert np.ptp(along(found)[part]) < 0.05
    light, heavy = (along(dry(factor * LOAD, Logarithmic(DEPTH), 33)) for factor in (0.25, 4.0))
    assert light[light.size // 2] > 1.1  # the ends hang back
    assert heavy.max() > 1.2 * heavy[heavy.size // 2]  # and carry too much


def beyond_hertz(found, length, part=0.0):
    """How far the pressure of the row at a part of the half length is from Hertz's under its own load, relative: the
    largest, and in the mean.
    """
    row = found.pressure[np.abs(found.y - 0.5 * part * length).argmin()]
    hertz = hertz_line(row.sum() * (found.x[1] - found.x[0]) * length, RADIUS, length, E)
    ellipse = hertz.pressure_max * np.sqrt(np.maximum(1.0 - (found.x / hertz.a) ** 2, 0.0))
    return float(row.max() / hertz.pressure_max) - 1.0, float(np.abs(row - ellipse).sum() / ellipse.sum())


def test_rows_away_from_the_ends_press_like_hertzs_line_under_their_own_load():
    found = dry(LOAD, Logarithmic(DEPTH), 129)
    assert beyond_hertz(found, LENGTH)[1] < 0.005
    assert beyond_hertz(found, LENGTH, 0.5)[1] < 0.01


def test_the_middle_tends_to_hertzs_line_with_the_square_of_width_over_length():
    off = []
    for length in (0.75e-3, 1.5e-3, 3e-3):
        profile = Logarithmic(lundberg_depth(LOAD * length, length, E))
        coarse, fine = (beyond_hertz(dry(LOAD, profile, nx, length), length)[0] for nx in (33, 65))
        assert coarse == approx(fine, abs=1e-3)
        off.append(fine)
    assert all(np.log2(shorter / longer) > 1.7 for shorter, longer in pairwise(off))


def test_the_middle_of_a_crowned_roller_converges_with_the_grid_to_first_order_at_least():
    """A mean over the middle, whose edges cut cells; the ends are smooth."""
    profile = Rounded(0.0, 0.5)
    found = []
    for nx in (33, 65, 129):
        roller = dry(LOAD, profile, nx)
        row = roller.pressure[np.abs(roller.y).argmin()]
        found.append(float(row.sum()) * (roller.x[1] - roller.x[0]))
    steps = [abs(b - a) for a, b in pairwise(found)]
    assert steps[1] < 0.6 * steps[0]
    assert steps[1] < 2e-3 * found[-1]
