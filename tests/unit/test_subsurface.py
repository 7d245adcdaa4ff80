"""Stress below tractions on cells, held against integrals of point forces and sums of their own."""

import numpy as np
import pytest
from comparison import approx

from contact_core.film.shared import subsurface
from contact_core.kernels.subsurface import Subsurface

LIBRARIES = ("pyfftw", "scipy")
DEPTHS = np.array([0.0, 0.3, 2.0, 30.0])  # in cells
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(48)


def tractions(ny, nx):
    return np.random.Generator(np.random.Philox(ny * 100 + nx)).normal(size=(3, ny, nx))


def boussinesq(x, y, z, poisson):
    """Stress of a unit force along z at the origin, by its components in polar coordinates."""
    r, out, soft = np.hypot(x, y), np.sqrt(x * x + y * y + z * z), 1.0 - 2.0 * poisson
    radial = soft / (out * (out + z)) - 3.0 * z * r**2 / out**5
    hoop = soft * (z / out**3 - 1.0 / (out * (out + z)))
    c, s, shear = x / r, y / r, -3.0 * r * z**2 / out**5
    xx, yy, xy = radial * c * c + hoop * s * s, radial * s * s + hoop * c * c, (radial - hoop) * s * c
    return np.stack([xx, yy, -3.0 * z**3 / out**5, shear * s, shear * c, xy]) / (2.0 * np.pi)


def cerruti(x, y, z, poisson):
    """Stress of a unit force along x at the origin."""
    r, soft = np.sqrt(x * x + y * y + z * z), 1.0 - 2.0 * poisson
    near = 1.0 / (r * (r + z) ** 2)
    bend = 1.0 / (r**3 * (r + z) ** 2) + 2.0 / (r**2 * (r + z) ** 3)
    push = -3.0 * x / r**5
    xx = push * x * x + soft * (x / r**3 - 3.0 * x * near + x**3 * bend)
    yy = push * y * y + soft * (x / r**3 - x * near + x * y * y * bend)
    xy = push * x * y + soft * (-y * near + x * x * y * bend)
    return np.stack([xx, yy, push * z * z, push * y * z, push * x * z, xy]) / (2.0 * np.pi)


def turned(x, y, z, poisson):
    """Stress of a unit force along y: the other one, seen in a mirror."""
    return cerruti(y, x, z, poisson)[[1, 0, 2, 4, 3, 5]]


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("load", range(3))
def test_a_cell_is_the_integral_of_point_forces(load, poisson):
    depth = 0.6
    unit = np.zeros((3, 5, 4))
    unit[load, 1, 2] = 1.0
    found = Subsurface((5, 4), 1.0, np.array([depth]), poisson, "scipy").stress(*unit)[:, 0]
    s, t = np.meshgrid(0.5 * _GAUSS, 0.5 * _GAUSS)
    weight = 0.25 * np.outer(_WEIGHTS, _WEIGHTS)
    point = (boussinesq, cerruti, turned)[load]
    for j in range(5):
        for i in range(4):
            expected = (point(i - 2 - s, j - 1 - t, depth, poisson) * weight).sum(axis=(1, 2))
            assert found[:, j, i] == approx(expected, abs=1e-12)


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("load", range(3))
def test_a_surface_bears_its_own_tractions(load, periodic):
    given = np.zeros((3, 6, 5))
    given[load] = tractions(6, 5)[load]
    found = Subsurface((6, 5), 1.0, np.zeros(1), 0.3, "scipy", periodic=periodic).stress(*given)[:, 0]
    for component, traction in zip((2, 4, 3), given, strict=True):
        assert found[component] == approx(-traction, abs=1e-13)


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize(("ny", "nx"), [(1, 7), (6, 5), (5, 1), (9, 12)])
def test_both_libraries_agree_to_round_off(ny, nx, periodic):
    one, other = (
        Subsurface((ny, nx), 2.0, 2.0 * DEPTHS, 0.3, library, periodic=periodic).stress(*tractions(ny, nx))
        for library in LIBRARIES
    )
    assert one == approx(other, abs=1e-14 * nx * ny)


@pytest.mark.parametrize("library", LIBRARIES)
def test_tractions_at_the_edge_reach_the_opposite_edge_and_no_further(library):
    """Zero padding leaves no images: single cells in the corners against the coefficients of one cell."""
    wide = np.zeros((3, 15, 19))
    wide[:, 7, 9] = 1.0
    around = Subsurface((15, 19), 1.0, DEPTHS, 0.3, "scipy").stress(*wide)
    for j in (0, 7):
        for i in (0, 9):
            unit = np.zeros((3, 8, 10))
            unit[:, j, i] = 1.0
            found = Subsurface((8, 10), 1.0, DEPTHS, 0.3, library).stress(*unit)
            assert found == approx(around[:, :, 7 - j : 15 - j, 9 - i : 19 - i], abs=1e-14)


def test_stress_is_linear_in_the_tractions_and_has_no_length_of_its_own():
    first, second = tractions(6, 7), np.roll(tractions(6, 7), 3, axis=2)
    half_space = Subsurface((6, 7), 1.0, DEPTHS, 0.3, "scipy")
    both = half_space.stress(*(2.0 * first - 3.0 * second))
    assert both == approx(2.0 * half_space.stress(*first) - 3.0 * half_space.stress(*second), abs=1e-13)
    p, along, across = first
    alone = half_space.stress(p) + half_space.stress(0.0 * p, along) + half_space.stress(0.0 * p, None, across)
    assert half_space.stress(p, along, across) == approx(alone, abs=1e-13)
    metres = Subsurface((6, 7), 3e-6, 3e-6 * DEPTHS, 0.3, "scipy").stress(p, along, across)
    assert metres == approx(half_space.stress(p, along, across), abs=1e-13)
    assert not half_space.stress(0.0 * p).any()


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("axis", [1, 2])
def test_a_mirror_turns_the_signs_of_what_points_across_it(axis, periodic):
    given = tractions(6, 7)
    half_space = Subsurface((6, 7), 1.0, DEPTHS, 0.3, "scipy", periodic=periodic)
    signs = {1: ((1, 1, -1), (1, 1, 1, -1, 1, -1)), 2: ((1, -1, 1), (1, 1, 1, 1, -1, -1))}[axis]
    mirrored = half_space.stress(
        *(sign * np.flip(field, axis - 1) for sign, field in zip(signs[0], given, strict=True))
    )
    expected = np.array(signs[1])[:, None, None, None] * np.flip(half_space.stress(*given), axis + 1)
    assert mirrored == approx(expected, abs=1e-13)


def test_x_and_y_change_places():
    p, along, across = tractions(5, 7)
    one = Subsurface((5, 7), 1.0, DEPTHS, 0.3, "scipy").stress(p, along, across)
    other = Subsurface((7, 5), 1.0, DEPTHS, 0.3, "scipy").stress(p.T, across.T, along.T)
    assert other[[1, 0, 2, 4, 3, 5]].swapaxes(2, 3) == approx(one, abs=1e-13)


def test_layers_are_the_stress_of_one_depth_after_the_other():
    given, half_space = tractions(4, 5), Subsurface((4, 5), 1.0, DEPTHS, 0.3, "scipy")
    layers = list(half_space.layers(*given))
    assert np.array_equal(np.stack(layers, axis=1), half_space.stress(*given))


def summed(given, depth, periods):
    """Stress of so many periods on either side beside the middle one, on a grid that holds all of them."""
    ny = given.shape[1]
    tall = np.tile(given, (1, 2 * periods + 1, 1))
    shape = tall.shape[1:]
    stress = Subsurface(shape, 1.0, np.array([depth]), 0.3, "scipy").stress(*tall)[:, 0]
    return stress[:, periods * ny : (periods + 1) * ny]


@pytest.mark.parametrize("depth", [0.0, 0.4, 6.0])
@pytest.mark.parametrize(("ny", "nx"), [(1, 6), (2, 5), (5, 4), (8, 7)])
def test_a_periodic_half_space_is_the_sum_of_all_images(ny, nx, depth):
    """What lies beyond the images falls with the length that is summed: two lengths tell the limit to its square."""
    given = tractions(ny, nx)
    few, many = (summed(given, depth, n) for n in (200, 400))
    expected = many + (many - few) / (801 / 401 - 1.0)
    found = Subsurface((ny, nx), 1.0, np.array([depth]), 0.3, "scipy", periodic=True).stress(*given)[:, 0]
    assert found == approx(expected, abs=6e-5)


@pytest.mark.parametrize("rows", [1, 4, 7])
def test_what_does_not_vary_along_y_is_in_plane_strain(rows):
    row = tractions(1, 9)
    row[2] = 0.0
    found = Subsurface((rows, 9), 1.0, DEPTHS, 0.27, "scipy", periodic=True).stress(*np.repeat(row, rows, axis=1))
    assert found == approx(np.repeat(found[:, :, :1], rows, axis=2), abs=1e-13)
    assert found[1] == approx(0.27 * (found[0] + found[2]), abs=1e-13 if rows == 1 else 2e-7)
    assert not np.abs(found[[3, 5]]).max() > 1e-13


@pytest.mark.parametrize(
    ("load", "component", "depth", "beyond"), [(0, 2, 4.0, 1e-4), (1, 4, 0.1, 2e-3), (2, 3, 0.1, 2e-3)]
)
@pytest.mark.parametrize("periodic", [False, True])
def test_a_horizontal_plane_bears_the_load(periodic, load, component, depth, beyond):
    """-szz adds up to the load, -sxz and -syz to the friction, but for what wide planes miss."""
    ny, nx = (6, 601) if periodic else (241, 241)
    given = np.zeros((3, ny, nx))
    middle = np.s_[:, 295:305] if periodic else np.s_[117:123, 115:125]
    given[load][middle] = np.abs(tractions(6, 10)[load])
    found = Subsurface((ny, nx), 1.0, np.array([depth]), 0.3, "scipy", periodic=periodic).stress(*given)[:, 0]
    assert -found[component].sum() == approx(given.sum(), rel=beyond)


def test_stresses_that_are_kept_for_a_grid_are_not_those_of_another():
    """Each of shape, spacing, depths and Poisson's ratio counts, and whether the rows repeat."""
    base = {"shape": (8, 8), "spacing": 1e-6, "depths": (1e-6, 2e-6), "poisson": 0.3, "periodic": False}
    others = ({}, {"shape": (8, 10)}, {"spacing": 2e-6}, {"depths": (1e-6, 3e-6)}, {"poisson": 0.2}, {"periodic": True})
    for change in others:
        given = base | change
        shape, spacing, depths, poisson, periodic = given.values()
        pressure = np.random.default_rng(3).uniform(size=shape)
        kept = subsurface(shape, spacing, depths, poisson, "scipy", periodic=periodic)
        fresh = Subsurface(shape, spacing, np.array(depths), poisson, "scipy", periodic=periodic)
        assert np.array_equal(kept.stress(pressure), fresh.stress(pressure)), change
        assert subsurface(shape, spacing, depths, poisson, "scipy", periodic=periodic) is kept
