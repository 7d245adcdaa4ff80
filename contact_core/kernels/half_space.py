"""Elastic half space under a pressure that is constant on square cells, single or periodic along y.

Source of the coefficients: Love, Phil. Trans. R. Soc. A 228 (1929) 377, doi:10.1098/rsta.1929.0009; of the zero-padded
convolution: Liu, Wang & Liu, Wear 243 (2000) 101, doi:10.1016/S0043-1648(00)00427-0; of the line load: Johnson, Contact
Mechanics, 1985, doi:10.1017/CBO9781139171731, section 2.3.
"""

from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from .arrays import Array

_MARGIN = 16
_LOVE_UP_TO = 64  # cells, from where on two terms of the expansion of a cell's potential are as exact
_PERIODS = 12  # periods on either side that are summed one by one
# datum of `near`: in periods, the one for which the images of a node do not displace it; and its least nodes
_LOCAL, _LEAST_LOCAL = 2.0 * np.exp(-np.euler_gamma), 3.0


@lru_cache(maxsize=16)
def influence(ny: int, nx: int) -> Array:
    """Return Love's coefficients C[j, i] of unit square cells at the distance (j, i) from a unit pressure.

    The displacement of a half space is 2 / (pi E') * spacing * sum C p, E' = 2 / sum (1 - v^2)/E.
    """
    x, y = np.arange(nx)[None, :], np.arange(ny)[:, None]
    xp, xm, yp, ym = x + 0.5, x - 0.5, y + 0.5, y - 0.5

    def s(u: NDArray[Any], v: NDArray[Any]) -> NDArray[Any]:
        return u + np.hypot(u, v)

    coefficients = (
        xp * np.log(s(yp, xp) / s(ym, xp))
        + ym * np.log(s(xm, ym) / s(xp, ym))
        + xm * np.log(s(ym, xm) / s(yp, xm))
        + yp * np.log(s(xp, yp) / s(xm, yp))
    )
    coefficients.setflags(write=False)
    return coefficients


@lru_cache(maxsize=16)
def periodic_influence(ny: int, nx: int) -> Array:
    """Return the coefficients [ny // 2 + 1, nx] of `influence` for cells that repeat every ny rows.

    The sum over all rows is that of a line load, the integral of -2 ln |x| over a cell: displacements, which have no
    limit far away, are counted from that at the distance of one cell from a line. The periods that are not summed one
    by one follow from the midpoint rule of Euler and Maclaurin, to 1e-8.
    """
    j = np.arange(ny // 2 + 1)
    most = max(_PERIODS, -(-_LOVE_UP_TO // ny))
    total = _cells(j, nx)
    for period in range(ny, (most + 1) * ny, ny):
        total = total + _cells(period + j, nx) + _cells(period - j, nx)
    end = (most + 0.5) * ny
    total = total + _rest(end + j, nx, ny) + _rest(end - j, nx, ny)
    total.setflags(write=False)
    return total


def _cells(rows: NDArray[Any], nx: int) -> NDArray[Any]:
    """Return rows of `influence` at any whole distances."""
    x, y = np.arange(nx)[None, :], rows[:, None]
    far = y[:, 0] >= _LOVE_UP_TO
    out = np.empty((rows.size, nx))
    out[~far] = influence(_LOVE_UP_TO, nx)[rows[~far]]
    r = np.hypot(x, y[far])
    out[far] = 1.0 / r + 1.0 / (24.0 * r**3)
    return out


def _rest(distance: NDArray[Any], nx: int, period: int) -> NDArray[Any]:
    """Return sums [m, nx] of g = 1 / r + 1 / (24 r^3) over all periods beyond a `distance` [m].

    The rows lie 1/2, 3/2, ... periods beyond it; the sums are integral, first and third derivative. They grow like the
    logarithm of where they end; ln(twice that) / period is left out.
    """
    x, y = np.arange(nx)[None, :], distance[:, None]
    r = np.hypot(x, y)
    integral = 1.0 / (24.0 * r * (r + y)) - np.log(r + y)
    slope = -y / r**3 - y / (8.0 * r**5)
    third = (9.0 * x**2 * y - 6.0 * y**3) / r**7
    return integral / period + period / 24.0 * slope - 7.0 / 5760.0 * period**3 * third


class Convolution:
    """Filter of fields [ny, nx] by a real, even spectrum on the plane [my, mx] that they are padded to by zeros.

    The caller fills `field` [ny, mx], of which the columns from nx on stay zero, and gets the filtered one from `run`.
    """

    def __init__(self, ny: int, spectrum: Array, library: str) -> None:
        my, half = spectrum.shape
        mx = 2 * (half - 1)
        self.field: Array
        factor = np.ascontiguousarray(spectrum.T) / (my * mx)
        self.field, self.run = _with_fftw(ny, mx, factor) if library == "pyfftw" else _with_scipy(ny, mx, factor)


class HalfSpace:
    """Convolution with `scale` times Love's coefficients on an [ny, nx] grid, and its approximate inverse.

    The kernel is even, so padding to 2(n - 1) is exact: the one offset that two distances share has equal values.
    Holds plans and scratch: one instance per thread.
    """

    periodic = False  # along y, with the period of its rows

    def __init__(self, ny: int, nx: int, scale: float, library: str) -> None:
        self.shape = (ny, nx)
        self.scale, self.library = scale, library
        self._padded = self.plane(2 * (ny - 1), 2 * (nx - 1))
        self._part = self.plane(ny - 1, nx - 1)
        self.near = scale * self._nearest()
        self._deform = Convolution(ny, self.spectrum(self._padded), library)

    def window(self, ny: int, nx: int, width: int) -> "HalfSpace":
        """Return the half space of a window of the grid, in cells of `width` nodes."""
        scale = width * self.near[0, 0] / influence(1, 1)[0, 0]
        return HalfSpace(ny, nx, scale, self.library)

    def plane(self, ny: int, nx: int) -> tuple[int, int]:
        """Return the sides of a periodic plane of at least ny rows and nx columns, fast to transform."""
        return even_fast_length(ny), even_fast_length(nx)

    def spectrum(self, plane: tuple[int, int]) -> Array:
        """Return the transform [my, mx // 2 + 1] of the even kernel up to half the sides of a plane; it is real."""
        my, mx = plane
        return _spectrum(self._coefficients(my // 2 + 1, mx // 2 + 1), plane)

    def _coefficients(self, ny: int, nx: int) -> Array:
        return self.scale * influence(ny, nx)

    def _nearest(self) -> Array:
        return influence(*self.shape)[:9, :9]

    def deform(self, pressure: Array) -> Array:
        """Return the deformation [ny, nx] under a pressure [ny, nx]."""
        return self.deform_padded(pressure)[:, : self.shape[1]].copy()

    def deform_padded(self, pressure: Array) -> Array:
        """Return the deformation in the first nx columns of scratch [ny, mx], which the next call overwrites."""
        self._deform.field[:, : self.shape[1]] = pressure
        return self._deform.run()

    def respond(self, pressure: Array, step: Array) -> Array:
        """Return the change [ny, nx] of the deformation with a small step from a pressure [ny, nx]."""
        return self.deform(step)

    def press(self, gap: Array) -> Array:
        """Return the pressure that would open a small gap [ny, nx] on the padded, periodic plane.

        It is an approximate inverse of `deform`.
        """
        nx = self.shape[1]
        self._press.field[:, :nx] = gap
        return self._press.run()[:, :nx].copy()

    def press_part(self, height: int, width: int) -> Convolution:
        """Return the inverse for gaps that vanish outside height x width nodes.

        The inverse kernel falls like 1 / r^3: the images on a periodic plane half as wide do no harm if they stay
        `_MARGIN` nodes away. `field` is all of that plane, or that of `press` if the gap does not fit.
        """
        fits = (self.periodic or height + _MARGIN <= self._part[0]) and width + _MARGIN <= self._part[1]
        return self._press_part if fits else self._press

    @cached_property
    def _press(self) -> Convolution:
        return Convolution(self.shape[0], _inverse(self.spectrum(self._padded)), self.library)

    @cached_property
    def _press_part(self) -> Convolution:
        return Convolution(self._part[0], _inverse(self.spectrum(self._part)), self.library)


class PeriodicHalfSpace(HalfSpace):
    """A half space that is periodic along y with the rows of the grid, and free along x.

    A pressure has these rows [ny, nx], or two more [ny + 2, nx] that are images: the first of the last but one and the
    last of the second; so has its deformation. A line load displaces by -(4 / (pi E')) ln(r / d) per unit, zero at the
    distance d of `reference` nodes, by default the width of the grid, so that all coefficients on it are positive.
    `near` has a datum of its own, for which the first period acts all but alone.
    """

    periodic = True

    def __init__(self, ny: int, nx: int, scale: float, library: str, reference: float | None = None) -> None:
        self.reference = float(nx) if reference is None else reference
        super().__init__(ny, nx, scale, library)
        self._wrapped = np.empty((ny + 2, self._padded[1]))

    def window(self, ny: int, nx: int, width: int) -> "PeriodicHalfSpace":
        """Return the half space of a window of columns, in cells of `width` nodes."""
        return PeriodicHalfSpace(ny, nx, width * self.scale, self.library, self.reference / width)

    def plane(self, ny: int, nx: int) -> tuple[int, int]:
        """Return the sides of a periodic plane of at least nx columns; its rows are the period."""
        return self.shape[0], even_fast_length(nx)

    def deform_padded(self, pressure: Array) -> Array:
        """Return the deformation in the first nx columns of scratch, which the next call overwrites."""
        if pressure.shape[0] == self.shape[0]:
            return super().deform_padded(pressure)
        self._wrapped[1:-1] = super().deform_padded(pressure[1:-1])
        self._wrapped[0], self._wrapped[-1] = self._wrapped[-2], self._wrapped[1]
        return self._wrapped

    def _coefficients(self, ny: int, nx: int) -> Array:
        rows = self.shape[0]
        return self.scale * (periodic_influence(rows, nx)[:ny] + 2.0 / rows * np.log(self.reference))

    def _nearest(self) -> Array:
        """Return the coefficients of the nodes around one; sums over a patch count each node once."""
        ny = self.shape[0]
        near, rows = np.zeros((9, 9)), min(ny // 2 + 1, 9)
        near[:rows] = periodic_influence(ny, 9)[:rows] + 2.0 / ny * np.log(max(_LOCAL * ny, _LEAST_LOCAL))
        if ny % 2 == 0 and ny // 2 < 9:
            near[ny // 2] *= 0.5  # half a period on either side: the same node
        return near


def even_fast_length(least: int) -> int:
    """Return an even length from `least` on that is fast to transform."""
    return 2 * scipy.fft.next_fast_len(max((least + 1) // 2, 1), real=False)


def _spectrum(quarter: Array, plane: tuple[int, int]) -> Array:
    """Return the real transform on a periodic plane of an even kernel, given up to half its sides."""
    my, mx = plane
    ny, nx = quarter.shape
    kernel = np.zeros((my, mx))
    kernel[:ny, :nx] = quarter
    kernel[ny:, :nx] = quarter[(my - 1) // 2 : 0 : -1, :]
    kernel[:, nx:] = kernel[:, nx - 2 : 0 : -1]
    return np.asarray(scipy.fft.rfft2(kernel).real)


def _inverse(spectrum: Array) -> Array:
    inverse = 1.0 / np.maximum(spectrum, 1e-3 * np.median(spectrum))
    inverse[0, 0] = inverse[0, 1]
    return inverse


def _with_fftw(ny: int, mx: int, factor: Array) -> tuple[Array, Callable[[], Array]]:
    """Return scratch [ny, mx] and a function that filters it by a factor [mx // 2 + 1, my].

    Rows of zeros are not transformed, and columns lie contiguous between their two transforms.
    """
    import pyfftw  # FFTW is GPL: loaded only where it is asked for

    half, my = factor.shape
    field, back = (pyfftw.zeros_aligned((ny, mx), dtype="float64") for _ in range(2))
    rows, rows_back = (pyfftw.zeros_aligned((my, half), dtype="complex128") for _ in range(2))
    columns = pyfftw.zeros_aligned((half, my), dtype="complex128")
    numbers, twice = columns.view(np.float64), np.repeat(factor, 2, axis=1)
    # ESTIMATE: plans that do not depend on timing give the same bits every time
    keep, destroy = ("FFTW_ESTIMATE",), ("FFTW_ESTIMATE", "FFTW_DESTROY_INPUT")
    steps = (
        pyfftw.FFTW(field, rows[:ny], axes=(1,), flags=keep).execute,
        pyfftw.FFTW(rows, columns.T, axes=(0,), flags=keep).execute,
        lambda: np.multiply(numbers, twice, out=numbers),
        pyfftw.FFTW(columns.T, rows_back, axes=(0,), direction="FFTW_BACKWARD", flags=destroy).execute,
        pyfftw.FFTW(rows_back[:ny], back, axes=(1,), direction="FFTW_BACKWARD", flags=destroy).execute,
    )

    def run() -> Array:
        for step in steps:
            step()
        return back

    return field, run


def _with_scipy(ny: int, mx: int, factor: Array) -> tuple[Array, Callable[[], Array]]:
    """Return the same as `_with_fftw`, by scipy."""
    field, rows = np.zeros((ny, mx)), np.ascontiguousarray(factor.T)

    def run() -> Array:
        spectrum = scipy.fft.fft(scipy.fft.rfft(field, axis=1), rows.shape[0], axis=0, overwrite_x=True)
        spectrum *= rows
        spectrum = scipy.fft.ifft(spectrum, axis=0, norm="forward", overwrite_x=True)[:ny]
        return np.asarray(scipy.fft.irfft(spectrum, mx, axis=1, norm="forward"))

    return field, run
