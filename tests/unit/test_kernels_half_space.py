import numpy as np
import pytest
from comparison import approx
from independent import love, love_matrix

from contact_core.kernels.half_space import HalfSpace, influence

LIBRARIES = ("pyfftw", "scipy")
GRIDS = [(9, 9), (8, 8), (17, 16), (5, 24), (23, 6), (1, 12), (12, 1), (1, 1), (2, 3)]


def pressure(ny, nx):
    return np.random.Generator(np.random.Philox(ny * 100 + nx)).random((ny, nx))


@pytest.mark.parametrize("library", LIBRARIES)
@pytest.mark.parametrize(("ny", "nx"), GRIDS)
def test_deformation_is_the_product_with_the_dense_matrix_of_love(ny, nx, library):
    p = pressure(ny, nx)
    expected = 0.7 * (love_matrix(ny, nx) @ p.ravel()).reshape(ny, nx)
    found = HalfSpace(ny, nx, 0.7, library).deform(p)
    assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize(("ny", "nx"), [(33, 33), (65, 33), (20, 31)])
def test_both_libraries_agree_to_round_off(ny, nx):
    p = pressure(ny, nx)
    fields = [HalfSpace(ny, nx, 0.2, library) for library in LIBRARIES]
    for filtered in ("deform", "press"):
        one, other = (getattr(field, filtered)(p) for field in fields)
        assert np.abs(one - other).max() < 1e-13 * np.abs(one).max()


def test_the_coefficient_of_a_cell_on_itself_is_the_closed_form():
    assert influence(3, 3)[0, 0] == approx(4.0 * np.log(1.0 + np.sqrt(2.0)), rel=1e-14)


def test_far_cells_act_like_point_forces():
    """1/r, and the next term of the expansion of a square's potential, 1/(24 r^3)."""
    far = influence(200, 200)[120, 160]
    assert far == approx(1.0 / 200.0 + 1.0 / (24.0 * 200.0**3), rel=1e-10)
    assert far == approx(love(160, 120), rel=1e-9)


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_second_pressure_leaves_no_trace_of_the_first(library):
    half_space, p = HalfSpace(12, 9, 1.0, library), pressure(12, 9)
    first = half_space.deform(p)
    kept = first.copy()
    half_space.press(100.0 * p)
    half_space.deform(-p)
    assert first.tobytes() == kept.tobytes()
    assert half_space.deform(p).tobytes() == kept.tobytes()


def test_deformation_is_symmetric():
    """Maxwell and Betti: the work of one pressure on the other's deformation is the same both ways."""
    half_space = HalfSpace(15, 18, 1.0, "scipy")
    one, other = pressure(15, 18), pressure(18, 15).T
    assert (one * half_space.deform(other)).sum() == approx((other * half_space.deform(one)).sum(), rel=1e-13)


def test_press_undoes_the_deformation_of_a_ripple_in_the_middle():
    n = 65
    half_space = HalfSpace(n, n, 1.0, "scipy")
    x = np.arange(n) - n // 2
    window = np.exp(-((x[None, :] / 10.0) ** 2) - (x[:, None] / 10.0) ** 2)
    p = np.cos(np.pi * x[None, :] / 3.0) * window
    again = half_space.press(half_space.deform(p))
    middle = slice(n // 2 - 12, n // 2 + 13)
    assert np.abs((again - p)[middle, middle]).max() < 0.02


@pytest.mark.parametrize("library", LIBRARIES)
@pytest.mark.parametrize(("ny", "nx"), [(65, 65), (48, 80), (101, 33)])
def test_the_inverse_of_part_of_the_plane_agrees_with_that_of_all_of_it(ny, nx, library):
    half_space = HalfSpace(ny, nx, 0.3, library)
    top, left, height, width = 7, 5, ny // 2, nx // 2
    gap = np.zeros((ny, nx))
    box = np.s_[top : top + height, left : left + width]
    gap[box] = pressure(height, width)
    gap[box] -= gap[box].mean()
    part = half_space.press_part(height, width)
    part.field[:] = 0.0
    part.field[:height, :width] = gap[box]
    expected = half_space.press(gap)[box]
    fits = height + 16 <= ny - 1 and width + 16 <= nx - 1
    assert (part.field.shape != (half_space.press_part(ny, nx).field.shape)) == fits
    assert np.abs(part.run()[:height, :width] - expected).max() < 0.02 * np.abs(expected).max()
