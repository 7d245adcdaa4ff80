"""The work unit: one zero-padded deformation convolution on the same grid, by stand-alone pyfftw code, one thread."""

import time

import numpy as np
import pyfftw


def work_unit(points: int, repeats: int = 200, rows: int | None = None, *, periodic: bool = False) -> float:
    """Seconds of one convolution on rows x points nodes (minimum of the repeats; as many rows as points if not given),
    padded to 2 (n - 1) nodes; not along y if that is periodic.
    """
    rows = points if rows is None else rows
    pad, deep = 2 * (points - 1), rows if periodic else 2 * (rows - 1)
    field = pyfftw.zeros_aligned((deep, pad), dtype="float64")
    spectrum = pyfftw.zeros_aligned((deep, pad // 2 + 1), dtype="complex128")
    forward = pyfftw.FFTW(field, spectrum, axes=(0, 1), flags=("FFTW_ESTIMATE",))
    backward = pyfftw.FFTW(spectrum, field, axes=(0, 1), direction="FFTW_BACKWARD", flags=("FFTW_ESTIMATE",))
    kernel = np.ones(spectrum.shape)
    pressure, out = np.ones((rows, points)), np.empty((rows, points))
    best = np.inf
    for _ in range(repeats):
        start = time.perf_counter()
        field[:rows, :points] = pressure
        field[rows:] = 0.0
        field[:rows, points:] = 0.0
        forward.execute()
        spectrum *= kernel
        backward.execute()
        out[:] = field[:rows, :points]
        best = min(best, time.perf_counter() - start)
    return best
