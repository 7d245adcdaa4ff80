"""CPU time of a task and the work unit, in which costs compare across machines.

A work unit is one zero-padded deformation convolution on the same grid, by stand-alone pyfftw code on one thread.
"""

import math
import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np
import pyfftw

Found = TypeVar("Found")


def timed(task: Callable[[], Found], repeats: int = 1) -> tuple[Found, float]:
    """Return the result and the least CPU time [s] of several runs; a task longer than 0.3 s runs once."""
    best = math.inf
    for _ in range(repeats):
        start = time.process_time()
        found = task()
        best = min(best, time.process_time() - start)
        if best > 0.3:
            break
    return found, best


def unit_of(nodes: int) -> float:
    """Return the duration of a work unit on nodes x nodes [s]."""
    return work_unit(nodes, 200 if nodes < 200 else 30)


def work_unit(points: int, repeats: int = 200, rows: int | None = None, *, periodic: bool = False) -> float:
    """Return the duration of one convolution on rows x points nodes [s], the least of the repeats.

    Without `rows` there are as many rows as points. The grid is padded to 2 (n - 1) nodes, but not along a periodic y.
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
