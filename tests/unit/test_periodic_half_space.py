"""A half space that repeats along y, held against sums and integrals of its own."""

import numpy as np
import pytest
from comparison import approx
from images import image_matrix
from independent import love

from contact_core.kernels.half_space import PeriodicHalfSpace

LIBRARIES = ("pyfftw", "scipy")
REFERENCE = 20.0


def pressure(ny, nx):
    return np.random.Generator(np.random.Philox(ny * 100 + nx)).random((ny, nx))


@pytest.mark.parametrize("library", LIBRARIES)
@pytest.mark.parametrize(("rows", "nx"), [(1, 12), (2, 9), (3, 8), (4, 1), (7, 6), (8, 11)])
def test_deformation_is_the_product_with_the_dense_matrix_of_all_images(rows, nx, library):
    p = pressure(rows, nx)
    expected = 0.7 * (image_matrix(rows, nx, REFERENCE) @ p.ravel()).reshape(rows, nx)
    found = PeriodicHalfSpace(rows, nx, 0.7, library, REFERENCE).deform(p)
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()


@pytest.mark.parametrize("rows", [1, 2, 5, 16])
def test_what_does_not_vary_along_y_is_a_line_load(rows):
    """Displacement -4 / (pi E') times the integral of p ln(|x - s| / reference) ds: in units of the call, factor 2."""
    nx = 200
    unit = np.zeros((rows, nx))
    unit[:, 0] = 1.0
    found = PeriodicHalfSpace(rows, nx, 1.0, "scipy", REFERENCE).deform(unit)
    ends = np.arange(nx)[None, :] + np.array([[-0.5], [0.5]])
    primitive = ends * (np.log(np.abs(ends) / REFERENCE) - 1.0)
    assert np.abs(found + 2.0 * (primitive[1] - primitive[0])).max() < 1e-8


@pytest.mark.parametrize("waves", [1, 3])
def test_a_cosine_across_a_wide_strip_settles_by_4_over_e_q(waves):
    """Pressure cos(q y): displacement 4 / (E' q) cos(q y), here 2 pi / q, through the steps of the cells."""
    rows, nx = 48, 601
    q = 2.0 * np.pi * waves / rows
    wave = np.cos(q * np.arange(rows))
    settled = PeriodicHalfSpace(rows, nx, 1.0, "scipy").deform(np.repeat(wave[:, None], nx, axis=1))[:, nx // 2]
    aliases = np.abs(q + 2.0 * np.pi * np.arange(-2000, 2001))
    expected = (2.0 * np.pi / aliases * np.sinc((q + 2.0 * np.pi * np.arange(-2000, 2001)) / (2.0 * np.pi))).sum()
    assert expected == approx(2.0 * np.pi / q, rel=0.01)
    assert settled == approx(expected * wave, abs=1e-6 * expected)


@pytest.mark.parametrize(("rows", "nx"), [(1, 40), (6, 33), (33, 20)])
def test_both_libraries_agree_to_round_off(rows, nx):
    p = pressure(rows, nx)
    fields = [PeriodicHalfSpace(rows, nx, 0.2, library) for library in LIBRARIES]
    for filtered in ("deform", "press"):
        one, other = (getattr(field, filtered)(p) for field in fields)
        assert np.abs(one - other).max() < 1e-13 * np.abs(one).max()


@pytest.mark.parametrize("library", LIBRARIES)
@pytest.mark.parametrize("rows", [1, 2, 5])
def test_rows_of_images_change_nothing_and_get_the_deformation_of_what_they_are_images_of(rows, library):
    half_space, p = PeriodicHalfSpace(rows, 12, 1.0, library), pressure(rows, 12)
    with_images = np.pad(p, ((1, 1), (0, 0)), mode="wrap")
    found, expected = half_space.deform(with_images), half_space.deform(p)
    assert found.tobytes() == np.pad(expected, ((1, 1), (0, 0)), mode="wrap").tobytes()


def test_shifts_along_y_shift_the_deformation_and_equal_periods_are_one():
    p = pressure(6, 15)
    one = PeriodicHalfSpace(6, 15, 1.0, "scipy", REFERENCE)
    three = PeriodicHalfSpace(18, 15, 1.0, "scipy", REFERENCE)
    settled = one.deform(p)
    assert one.deform(np.roll(p, 2, axis=0)) == approx(np.roll(settled, 2, axis=0), rel=1e-13)
    assert three.deform(np.tile(p, (3, 1))) == approx(np.tile(settled, (3, 1)), rel=1e-8)


def test_a_window_keeps_the_datum_and_coarse_cells_act_like_the_nodes_in_them():
    p = np.zeros((8, 64))
    p[:, 30:42] = pressure(8, 12)
    whole = PeriodicHalfSpace(8, 64, 0.3, "scipy", REFERENCE)
    assert whole.window(8, 20, 1).deform(p[:, 26:46]) == approx(whole.deform(p)[:, 26:46], rel=1e-12)
    flat = np.zeros((8, 64))
    flat[:, 24:36] = np.repeat(np.repeat(pressure(4, 6), 2, axis=0), 2, axis=1)
    fine = whole.deform(flat).reshape(4, 2, 32, 2).mean(axis=(1, 3))
    coarse = whole.window(4, 32, 2).deform(flat[::2, ::2])
    apart = np.r_[0:9, 21:32]
    assert coarse[:, apart] == approx(fine[:, apart], abs=1e-3 * fine.max())


def test_a_wide_period_is_the_half_space_of_one_contact_beside_a_constant():
    p = np.zeros((400, 12))
    p[190:202] = pressure(12, 12)
    settled = PeriodicHalfSpace(400, 12, 1.0, "scipy").deform(p)[190:202]
    y, x = (index.ravel() for index in np.indices((12, 12)))
    alone = (love(x[:, None] - x[None, :], y[:, None] - y[None, :]) @ p[190:202].ravel()).reshape(12, 12)
    assert np.ptp(settled - alone) < 1e-5 * alone.max()


@pytest.mark.parametrize("rows", [1, 2, 3])
def test_a_patch_counts_no_node_twice(rows):
    near = PeriodicHalfSpace(rows, 12, 1.0, "scipy").near
    assert near.shape == (9, 9)
    settled = PeriodicHalfSpace(rows, 12, 1.0, "scipy").deform(np.eye(1, 12).repeat(rows, axis=0))[0]
    patch = 2.0 * near.sum(axis=0) - near[0]
    # up to the datum, all rows of a column are in it
    assert patch - patch[0] == approx(settled[:9] - settled[0], abs=1e-9)


@pytest.mark.parametrize("rows", [1, 4, 31])
def test_press_undoes_the_deformation_of_a_ripple_in_the_middle(rows):
    n = 129
    half_space = PeriodicHalfSpace(rows, n, 1.0, "scipy")
    x, y = np.arange(n) - n // 2, np.arange(rows)
    ripple = np.cos(np.pi * x / 3.0) * np.exp(-((x / 10.0) ** 2))
    p = ripple * np.cos(2.0 * np.pi * y / rows)[:, None]
    again = half_space.press(half_space.deform(p))
    middle = slice(n // 2 - 12, n // 2 + 13)
    assert np.abs((again - p)[:, middle]).max() < 0.02


@pytest.mark.parametrize("rows", [1, 5, 40])
def test_the_inverse_of_part_of_the_plane_agrees_with_that_of_all_of_it(rows):
    half_space, gap = PeriodicHalfSpace(rows, 101, 0.3, "scipy"), np.zeros((rows, 101))
    gap[:, 20:70] = pressure(rows, 50)
    gap -= np.where(gap > 0.0, gap.sum() / (gap > 0.0).sum(), 0.0)
    part = half_space.press_part(rows, 50)
    part.field[:] = 0.0
    part.field[:, :50] = gap[:, 20:70]
    expected = half_space.press(gap)[:, 20:70]
    assert part.field.shape[1] < 2 * 100
    assert np.abs(part.run()[:rows, :50] - expected).max() < 0.02 * np.abs(expected).max()
