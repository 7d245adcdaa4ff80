"""Cavities of a film: what flows through nodes that are not full."""

import numpy as np
import pytest
from comparison import approx

from contact_core.kernels.mixed import cavities


@pytest.mark.parametrize("held", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("per_dt", [0.0, 2.0, 40.0])
def test_a_cavity_keeps_what_it_held_and_what_flows_in_until_it_flows_out(held, per_dt):
    """Where a node is neither full nor empty the mass balance of a time step holds, without any pressure."""
    ny, nx, wedge, dx = 3, 24, 1.3, 0.1
    full = 1.0 + 0.2 * np.random.default_rng(4).random((ny, nx))
    mass_old, supply = held * full, np.full(ny, 0.5)
    nothing, e = np.zeros((ny, nx)), np.ones((ny, nx))
    mass, flux, filling = np.empty((3, ny, nx))
    carried = np.concatenate([0.5 * (full[:, :1] + full[:, 1:2]), 1.5 * full[:, 1:] - 0.5 * full[:, :-1]], axis=1)
    terms = (per_dt, wedge, dx)
    cavities.carry(nothing, full, carried, mass_old, e, e, *terms, True, supply, 1, mass, flux, filling)
    assert flux[:, 0] == approx(supply, rel=1e-12)
    partly = (filling > 0.0) & (filling < 1.0)
    assert partly.mean() > 0.9
    leaving = wedge * (flux[:, 1:] - flux[:, :-1]) / dx
    gained = per_dt * (mass - mass_old)[:, 1:]
    assert np.abs(leaving + gained)[partly[:, 1:]].max() < 1e-11
