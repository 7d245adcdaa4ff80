"""Elastic half space under a pressure that is symmetric about a row of nodes: half the nodes, half the work.

Across that row pressure and kernel are even, so their transforms are cosine transforms. Each takes one complex
transform of half the period: even samples and differences of odd ones are packed into one sequence, whose transform
parts into an even and an odd half. Source of the packing: Cooley, Lewis & Welch, J. Sound Vib. 12 (1970) 315,
doi:10.1016/0022-460X(70)90075-1.
"""

import numpy as np
import scipy

from ..arrays import Array
from ..compiled import jit
from ..half_space import influence


@jit
def _pack(x, packed, odd):  # type: ignore[no-untyped-def]
    """Pack the even, periodic sequence of samples x[0], x[1]..., zero between x[-1] and its image.

    `odd`: sum of its odd samples.
    """
    half, columns = packed.shape
    last = x.shape[0] - 1
    odd[:] = 0.0
    for n in range(half // 2 + 1):
        below, here, above = abs(2 * n - 1), 2 * n, 2 * n + 1
        if n == 0 or n == half // 2:
            for k in range(columns):
                packed[n, k] = x[here, k] if here <= last else 0.0
        elif below > last:
            packed[n, :] = 0.0
            packed[half - n, :] = 0.0
        else:
            for k in range(columns):
                even = x[here, k] if here <= last else 0.0
                rise = (x[above, k] if above <= last else 0.0) - x[below, k]
                packed[n, k] = even + rise
                packed[half - n, k] = even - rise
        if n > 0 and below <= last:
            for k in range(columns):
                odd[k] += 2.0 * x[below, k]


@jit
def _unpack(packed, odd, sine, factor, out):  # type: ignore[no-untyped-def]
    """Compute the transform of the sequence from that of the packed one, times a factor of each term.

    packed [half, 2 columns], odd [2 columns], out [at most half + 1, 2 columns]: real and imaginary parts in turn.
    """
    half, columns = packed.shape
    last = out.shape[0] - 1
    for k in range(columns):
        out[0, k] = (packed[0, k] + odd[k]) * factor[0, k // 2]
        if last == half:
            out[half, k] = (packed[0, k] - odd[k]) * factor[half, k // 2]
    for m in range(1, half // 2 + 1):
        other = half - m
        c = sine[m]
        for k in range(0, columns, 2):
            real, imag = packed[m, k] + packed[other, k], packed[m, k + 1] + packed[other, k + 1]
            odd_real = c * (packed[m, k + 1] - packed[other, k + 1])
            odd_imag = c * (packed[other, k] - packed[m, k])
            if m <= last:
                f = factor[m, k // 2]
                out[m, k] = f * (0.5 * real + odd_real)
                out[m, k + 1] = f * (0.5 * imag + odd_imag)
            if other <= last:
                f = factor[other, k // 2]
                out[other, k] = f * (0.5 * real - odd_real)
                out[other, k + 1] = f * (0.5 * imag - odd_imag)


class MirroredHalfSpace:
    """Convolution of Love's coefficients with pressures on the rows up to the middle one of an [ny, nx] grid."""

    def __init__(self, ny: int, nx: int, library: str) -> None:
        self.shape = ((ny + 1) // 2, nx)
        half = 2 * scipy.fft.next_fast_len(ny // 2)
        width = scipy.fft.next_fast_len(nx - 1)
        kernel = np.zeros((half + 1, width + 1))
        kernel[:ny, :nx] = influence(ny, nx)
        self._factor = scipy.fft.dctn(kernel, type=1) / (4.0 * half * width)
        self._sine = np.zeros(half)
        self._sine[1:] = 0.25 / np.sin(np.pi * np.arange(1, half) / half)
        columns = (half, width + 1)
        self._rows, self._in_rows, self._packed, self._across, self._out_rows, self._from_rows = _plans(
            self.shape[0], columns, 2 * width, library
        )
        self._spectrum, self._odd = np.zeros((half + 1, 2 * width + 2)), np.zeros(2 * width + 2)
        self._ones = np.ones((self.shape[0], width + 1))

    def deform(self, pressure: Array) -> Array:
        """Return the deformation [rows, nx] for unit scale under a pressure [rows, nx]; the last row is the middle."""
        nx = self.shape[1]
        self._rows[:, :nx] = pressure[::-1]
        packed, odd, sine = self._packed.view(np.float64), self._odd, self._sine
        _pack(self._in_rows().view(np.float64), packed, odd)
        self._across()
        _unpack(packed, odd, sine, self._factor, self._spectrum)
        _pack(self._spectrum, packed, odd)
        self._across()
        _unpack(packed, odd, sine, self._ones, self._out_rows.view(np.float64))
        return np.ascontiguousarray(self._from_rows()[::-1, :nx])


def _plans(rows: int, columns: tuple[int, int], width: int, library: str):  # type: ignore[no-untyped-def]
    """Return scratch and transforms: along rows, across the packed ones, back along rows. All unnormalised."""
    if library == "pyfftw":
        import pyfftw  # FFTW is GPL: loaded only where it is asked for

        # ESTIMATE: plans that do not depend on timing give the same bits every time
        keep, destroy = ("FFTW_ESTIMATE",), ("FFTW_ESTIMATE", "FFTW_DESTROY_INPUT")
        field, back = (pyfftw.zeros_aligned((rows, width), dtype="float64") for _ in range(2))
        spectra, out = (pyfftw.zeros_aligned((rows, columns[1]), dtype="complex128") for _ in range(2))
        packed = pyfftw.zeros_aligned(columns, dtype="complex128")
        along = pyfftw.FFTW(field, spectra, axes=(1,), flags=keep)
        across = pyfftw.FFTW(packed, packed, axes=(0,), flags=keep)
        backward = pyfftw.FFTW(out, back, axes=(1,), direction="FFTW_BACKWARD", flags=destroy)

        def run_along():  # type: ignore[no-untyped-def]
            along.execute()
            return spectra

        def run_back():  # type: ignore[no-untyped-def]
            backward.execute()
            return back

        return field, run_along, packed, across.execute, out, run_back

    field, packed = np.zeros((rows, width)), np.zeros(columns, np.complex128)
    out = np.zeros((rows, columns[1]), np.complex128)

    def scipy_across() -> None:
        packed[:] = scipy.fft.fft(packed, axis=0, workers=1)

    return (
        field,
        lambda: scipy.fft.rfft(field, axis=1, workers=1),
        packed,
        scipy_across,
        out,
        lambda: scipy.fft.irfft(out, width, axis=1, norm="forward", workers=1),
    )
