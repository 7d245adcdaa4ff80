"""The work unit: one zero-padded deformation convolution on the same grid, by stand-alone pyfftw code, one thread."""

import time

import numpy as np
import pyfftw


def work_unit(points: int, repeats: int = 200) -> float:
    """Seconds of one convolution on points x points nodes (minimum of the repeats), padded to 2 (points - 1)."""
    pad = 2 * (points - 1)
    field = pyfftw.zeros_aligned((pad, pad), dtype="float64")
    spectrum = pyfftw.zeros_aligned((pad, pad // 2 + 1), dtype="complex128")
    forward = pyfftw.FFTW(field, spectrum, axes=(0, 1), flags=("FFTW_ESTIMATE",))
    backward = pyfftw.FFTW(spectrum, field, axes=(0, 1), direction="FFTW_BACKWARD", flags=("FFTW_ESTIMATE",))
    kernel = np.ones(spectrum.shape)
    pressure, out = np.ones((points, points)), np.empty((points, points))
    best = np.inf
    for _ in range(repeats):
        start = time.perf_counter()
        field[:points, :points] = pressure
        field[points:] = 0.0
        field[:points, points:] = 0.0
        forward.execute()
        spectrum *= kernel
        backward.execute()
        out[:] = field[:points, :points]
        best = min(best, time.perf_counter() - start)
    return best
