"""Dry contact of rough cylinders that repeat along their axis, against solvers that share no code with this one.

In units of the half width of Hertz's line contact, its largest pressure and the square of the one over the radius.
"""

import numpy as np
import pytest
from comparison import approx
from images import image_matrix
from scipy.ndimage import gaussian_filter

from contact_core.kernels.dry import dry_solution
from contact_core.kernels.half_space import PeriodicHalfSpace

SPAN = 2.6  # along x
REFERENCE = 1.5 * SPAN


def cylinder(rows, nx, rms=0.05, seed=1):
    """Gap of the undeformed bodies [rows, nx], spacing, factor of the half space and load."""
    dx = SPAN / (nx - 1)
    x = (np.arange(nx) - 0.5 * (nx - 1)) * dx
    noise = np.random.Generator(np.random.Philox(seed)).standard_normal((rows, nx))
    z = gaussian_filter(noise, 1.0, mode=("wrap", "nearest")) if rms else noise
    gap = 0.5 * x**2 - rms * z / z.std()
    return gap, dx, 0.25 * np.pi * 2.0 / np.pi**2 * dx, 0.5 * np.pi * rows / dx


def solve(gap, dx, scale, load, cap=np.inf, tolerance=1e-9, start=None):
    half_space = PeriodicHalfSpace(*gap.shape, scale, "scipy", REFERENCE / dx)
    start = np.ones_like(gap) if start is None else start
    return dry_solution(half_space, gap, np.full(gap.shape, cap), load, start, tolerance, 2000)


def active_set(a, gap, load, cap):
    """Pressure and approach: nodes are free, at zero or at the cap until no sign is wrong."""
    n = gap.size
    free, high = gap < np.quantile(gap, 0.3), np.zeros(n, bool)
    for _ in range(100):
        k = int(free.sum())
        system = np.block([[a[np.ix_(free, free)], -np.ones((k, 1))], [np.ones((1, k)), np.zeros((1, 1))]])
        held = a[:, high].sum(axis=1) * cap if high.any() else np.zeros(n)
        right = np.append(-(gap + held)[free], load - (cap * high.sum() if high.any() else 0.0))
        found = np.linalg.solve(system, right)
        p = np.where(high, cap if high.any() else 0.0, 0.0)
        p[free] = found[:-1]
        above = gap + a @ p - found[-1]
        low = free & (p < 0.0) | ~free & ~high & (above >= 0.0)
        now_high = free & (p > cap) | high & (above <= 0.0)
        now_free = ~low & ~now_high
        if (now_free == free).all() and (now_high == high).all():
            return p, found[-1]
        free, high = now_free, now_high
    raise AssertionError("the sets do not settle")


@pytest.mark.parametrize(("rows", "nx"), [(1, 61), (2, 40), (3, 35), (8, 41), (12, 30)])
@pytest.mark.parametrize("cap", [np.inf, 1.1])
def test_pressures_are_those_of_an_active_set_on_the_dense_matrix_of_all_images(rows, nx, cap):
    gap, dx, scale, load = cylinder(rows, nx)
    found = solve(gap, dx, scale, load, cap)
    expected, approach = active_set(scale * image_matrix(rows, nx, REFERENCE / dx), gap.ravel(), load, cap)
    assert found.converged
    touching = expected > 0.0
    assert touching.any()
    assert not touching.all()
    assert np.abs(found.pressure.ravel() - expected).sum() < 1e-6 * load
    assert ((found.pressure.ravel() > 0.0) == touching).all()
    assert (found.pressure.ravel() >= cap).any() == np.isfinite(cap)
    assert -found.rigid == approx(approach, abs=1e-7)


@pytest.mark.parametrize(("rows", "nx"), [(16, 129), (15, 120), (1, 400), (40, 90)])
def test_the_rules_of_contact_hold_on_grids_with_windows_and_coarse_grids(rows, nx):
    gap, dx, scale, load = cylinder(rows, nx, rms=0.1)
    gap = np.concatenate((gap[:, :1] + 2.0 + np.zeros((rows, 3 * nx)), gap), axis=1)  # the contact is off the middle
    found = solve(gap, dx, scale, load)
    p, above = found.pressure, found.gap
    assert found.converged
    assert found.iterations < 60
    assert p.min() == 0.0
    assert p.sum() == approx(load, rel=1e-10)
    assert np.abs(above[p > 0.0]).max() < 1e-7
    assert above[p <= 0.0].min() > -1e-9
    settled = PeriodicHalfSpace(*gap.shape, scale, "scipy", REFERENCE / dx).deform(p)
    assert gap + settled + found.rigid == approx(above, abs=1e-12)


def test_smooth_cylinders_have_the_pressure_of_hertz_on_any_number_of_rows():
    peaks = []
    for rows in (1, 4, 7):
        gap, dx, scale, load = cylinder(rows, 521, rms=0.0)
        p = solve(gap, dx, scale, load).pressure
        x = (np.arange(521) - 260) * dx
        assert p == approx(np.broadcast_to(p[:1], p.shape), abs=1e-7)
        assert np.abs(p[0] - np.sqrt(np.maximum(1.0 - x**2, 0.0))).sum() * dx < 1e-3
        peaks.append(p.max())
    assert peaks == approx([1.0] * 3, rel=1e-3)


def test_a_shifted_roughness_shifts_the_contact_and_two_periods_are_as_good_as_one():
    gap, dx, scale, load = cylinder(9, 64)
    one = solve(gap, dx, scale, load)
    shifted = solve(np.roll(gap, 4, axis=0), dx, scale, load)
    tiled = solve(np.tile(gap, (2, 1)), dx, scale, 2.0 * load)
    assert np.abs(np.roll(one.pressure, 4, axis=0) - shifted.pressure).sum() < 1e-8 * load
    assert np.abs(np.tile(one.pressure, (2, 1)) - tiled.pressure).sum() < 1e-8 * load
    assert tiled.rigid == approx(one.rigid, abs=1e-8)


def test_contact_mechanics_finds_the_same_contact():
    reason = "ContactMechanics is not installed (extra: peers)"
    contact_mechanics = pytest.importorskip("ContactMechanics", reason=reason)
    systems = pytest.importorskip("ContactMechanics.Systems", reason=reason)
    topography = pytest.importorskip("SurfaceTopography", reason=reason).Topography
    rows, nx = 16, 65
    gap, dx, scale, load = cylinder(rows, nx)
    found = solve(gap, dx, scale, load)
    # x first there; 1 / (pi E) times the integral of p / r is scale / dx times it
    size, modulus = (nx * dx, rows * dx), dx / (np.pi * scale)
    substrate = contact_mechanics.SemiPeriodicFFTElasticHalfSpace((nx, rows), modulus, size, n_images=300)
    system = systems.NonSmoothContactSystem(substrate, topography(-gap.T, size))
    peer = system.minimize_proxy(external_force=load * dx**2, pentol=1e-12, thermotol=1e-9, maxiter=5000)
    pressure = np.asarray(peer.jac)[:nx, :rows].T / dx**2
    off = np.abs(found.pressure - pressure).sum() / load
    print(f"mean difference of the pressure: {off:.1e}")
    assert off < 1e-5
    assert ((found.pressure > 0.0) != (pressure > 0.0)).sum() <= 1
