"""Elastic half space under a pressure that is constant on square cells.

Source of the coefficients: Love, Phil. Trans. R. Soc. A 228 (1929) 377, doi:10.1098/rsta.1929.0009; of the zero-padded
convolution: Liu, Wang & Liu, Wear 243 (2000) 101, doi:10.1016/S0043-1648(00)00427-0.
"""

from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]

_MARGIN = 16


@lru_cache(maxsize=16)
def influence(ny: int, nx: int) -> Array:
    """Love's coefficients for unit square cells: C[j, i] at the distance (j, i) from a cell under unit pressure.

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

    def __init__(self, ny: int, nx: int, scale: float, library: str) -> None:
        self.shape = (ny, nx)
        self.scale, self.library = scale, library
        self._padded = (_even_fast_length(2 * (ny - 1)), _even_fast_length(2 * (nx - 1)))
        self._part = (_even_fast_length(ny - 1), _even_fast_length(nx - 1))
        self.near = scale * influence(ny, nx)[:9, :9]
        self._deform = Convolution(ny, _spectrum(self._padded, scale), library)

    def deform(self, pressure: Array) -> Array:
        """Deformation [ny, nx] under a pressure [ny, nx]."""
        return self.deform_padded(pressure)[:, : self.shape[1]].copy()

    def deform_padded(self, pressure: Array) -> Array:
        """Deformation under a pressure [ny, nx] in the first nx columns of scratch [ny, mx] that the next call uses."""
        self._deform.field[:, : self.shape[1]] = pressure
        return self._deform.run()

    def press(self, gap: Array) -> Array:
        """Pressure that would open a small gap [ny, nx] on the padded, periodic plane: an approximate inverse of
        `deform`.
        """
        nx = self.shape[1]
        self._press.field[:, :nx] = gap
        return self._press.run()[:, :nx].copy()

    def press_part(self, height: int, width: int) -> Convolution:
        """The inverse for gaps that vanish outside height x width nodes.

        The inverse kernel falls like 1 / r^3: the images on a periodic plane half as wide do no harm if they stay
        `_MARGIN` nodes away. `field` is all of that plane, or that of `press` if the gap does not fit.
        """
        fits = height + _MARGIN <= self._part[0] and width + _MARGIN <= self._part[1]
        return self._press_part if fits else self._press

    @cached_property
    def _press(self) -> Convolution:
        return Convolution(self.shape[0], _inverse(_spectrum(self._padded, self.scale)), self.library)

    @cached_property
    def _press_part(self) -> Convolution:
        return Convolution(self._part[0], _inverse(_spectrum(self._part, self.scale)), self.library)


def _even_fast_length(least: int) -> int:
    return 2 * scipy.fft.next_fast_len(max((least + 1) // 2, 1), real=False)


def _spectrum(padded: tuple[int, int], scale: float) -> Array:
    """Transform of the kernel up to half the even lengths of the plane; real, since it is even in both directions."""
    my, mx = padded
    ny, nx = my // 2 + 1, mx // 2 + 1
    kernel = np.zeros((my, mx))
    quarter = scale * influence(ny, nx)
    kernel[:ny, :nx] = quarter
    kernel[ny:, :nx] = quarter[-2:0:-1, :]
    kernel[:, nx:] = kernel[:, nx - 2 : 0 : -1]
    return np.asarray(scipy.fft.rfft2(kernel).real)


def _inverse(spectrum: Array) -> Array:
    inverse = 1.0 / np.maximum(spectrum, 1e-3 * np.median(spectrum))
    inverse[0, 0] = inverse[0, 1]
    return inverse


def _with_fftw(ny: int, mx: int, factor: Array) -> tuple[Array, Callable[[], Array]]:
    """Scratch [ny, mx] and what filters it by a factor [mx // 2 + 1, my].

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
    """The same by scipy."""
    field, rows = np.zeros((ny, mx)), np.ascontiguousarray(factor.T)

    def run() -> Array:
        spectrum = scipy.fft.fft(scipy.fft.rfft(field, axis=1), rows.shape[0], axis=0, overwrite_x=True)
        spectrum *= rows
        spectrum = scipy.fft.ifft(spectrum, axis=0, norm="forward", overwrite_x=True)[:ny]
        return np.asarray(scipy.fft.irfft(spectrum, mx, axis=1, norm="forward"))

    return field, run
