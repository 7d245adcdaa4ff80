"""Elastic half space under a pressure that is constant on square cells.

Source of the coefficients: Love, Phil. Trans. R. Soc. A 228 (1929) 377, doi:10.1098/rsta.1929.0009; of the zero-padded
convolution: Liu, Wang & Liu, Wear 243 (2000) 101, doi:10.1016/S0043-1648(00)00427-0.
"""

from functools import lru_cache
from typing import Any

import numpy as np
import scipy.fft
from numpy.typing import NDArray

Array = NDArray[np.float64]


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


class HalfSpace:
    """Convolution with `scale` times Love's coefficients on an [ny, nx] grid, and its approximate inverse.

    The kernel is even, so padding to 2(n - 1) is exact: the one offset that two distances share has equal values.
    Holds plans and scratch: one instance per thread.
    """

    def __init__(self, ny: int, nx: int, scale: float, library: str) -> None:
        self.shape = (ny, nx)
        my, mx = (scipy.fft.next_fast_len(max(2 * (n - 1), 2), real=True) for n in (ny, nx))
        kernel = np.zeros((my, mx))
        quarter = scale * influence(ny, nx)
        kernel[:ny, :nx] = quarter
        kernel[my - ny + 1 :, :nx] = quarter[:0:-1, :]
        kernel[:, mx - nx + 1 :] = kernel[:, nx - 1 : 0 : -1]
        spectrum = np.ascontiguousarray(scipy.fft.rfft2(kernel).real)  # even in both directions: real
        inverse = 1.0 / np.maximum(spectrum, 1e-3 * np.median(spectrum))
        inverse[0, 0] = inverse[0, 1]
        norm = 1.0 / (my * mx)
        self.near = quarter[: min(ny, 9), : min(nx, 9)]
        self._forward, self._backward, self._padded = _plans(my, mx, library)
        self._deform = spectrum * norm
        self._undo = inverse * norm

    def deform(self, pressure: Array) -> Array:
        """Deformation [ny, nx] under a pressure [ny, nx]."""
        return self._filter(pressure, self._deform)

    def press(self, gap: Array) -> Array:
        """Pressure that would open a small gap [ny, nx] on the padded, periodic plane: an approximate inverse of
        `deform`.
        """
        return self._filter(gap, self._undo)

    def _filter(self, field: Array, factor: Array) -> Array:
        ny, nx = self.shape
        self._padded[:ny, :nx] = field
        self._padded[ny:, :] = 0.0
        self._padded[:ny, nx:] = 0.0
        spectrum = self._forward()
        spectrum *= factor
        return self._backward()[:ny, :nx].copy()


def _plans(my: int, mx: int, library: str):  # type: ignore[no-untyped-def]
    """Forward and backward transform over a padded scratch array. Both are unnormalised."""
    if library == "pyfftw":
        import pyfftw  # FFTW is GPL: loaded only where it is asked for

        padded = pyfftw.zeros_aligned((my, mx), dtype="float64")
        spectrum = pyfftw.zeros_aligned((my, mx // 2 + 1), dtype="complex128")
        back = pyfftw.zeros_aligned((my, mx), dtype="float64")
        # ESTIMATE: plans that do not depend on timing give the same bits every time
        flags = ("FFTW_ESTIMATE", "FFTW_DESTROY_INPUT")
        forward = pyfftw.FFTW(padded, spectrum, axes=(0, 1), flags=("FFTW_ESTIMATE",))
        inverse = pyfftw.FFTW(spectrum, back, axes=(0, 1), direction="FFTW_BACKWARD", flags=flags)

        def run_forward():  # type: ignore[no-untyped-def]
            forward.execute()
            return spectrum

        def run_backward():  # type: ignore[no-untyped-def]
            inverse.execute()
            return back

        return run_forward, run_backward, padded

    padded = np.zeros((my, mx))
    held = {}

    def scipy_forward():  # type: ignore[no-untyped-def]
        held["spectrum"] = scipy.fft.rfft2(padded, workers=1)
        return held["spectrum"]

    def scipy_backward():  # type: ignore[no-untyped-def]
        return scipy.fft.irfft2(held["spectrum"], (my, mx), norm="forward", overwrite_x=True, workers=1)

    return scipy_forward, scipy_backward, padded
