"""Roughness: generated surfaces and their statistics. Heights [m], arrays [ny, nx], x along entrainment."""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import SceneError
from ..scene import SelfAffine, Surface


def generate(surface: Surface | SelfAffine, points: int, domain: float, body: int, period: int | None = None) -> Array:
    """Return Gaussian heights [period + 1, points - 1] of the surface's spectrum, periodic along both axes.

    The idea of Hu & Tonder, 1992, doi:10.1016/0890-6955(92)90064-N (filter white noise with the square root
    of the autocorrelation's spectrum) in terms of modes: a mode (kx, ky) has a random coefficient of its own,
    keyed by (seed, body, kx, ky) and blind to the grid. A finer grid shows the same surface; what a grid
    cannot carry (at or beyond its Nyquist wave number) is left out, not folded back. All modes together have
    the rms roughness rq exactly.

    `points` - 1 nodes lie along x, where the patch repeats after `domain` [m]; along y it repeats after `period` nodes
    (points - 1 unless said otherwise), so that the last row equals the first. `body` is 1 or 2: the same seed gives two
    bodies different surfaces. Raises SceneError if all waves are too long for the patch.
    """
    nodes = points - 1
    across = period or nodes
    if surface.rq == 0.0:
        return np.zeros((across + 1, nodes))
    step, step_y = surface.steps(domain, nodes / across)
    last = int(surface.reach / step)
    if last == 0:
        raise SceneError(
            f"{surface.finest} is too long for a {domain:g} m domain: "
            f"no wave of the roughness fits. Use at most {domain:g} m, or rq = 0 for a smooth surface."
        )
    kept, kept_y = min(last, (nodes - 1) // 2), (across - 1) // 2
    spectrum = np.zeros((across, nodes // 2 + 1), dtype=np.complex128)
    power = 0.0
    for kx in range(last + 1):
        ky, waves = _modes(surface, body, kx, step, step_y)
        power += 2.0 * float(np.sum(waves.real**2 + waves.imag**2))  # each wave and its mirror (-kx, -ky)
        if kx <= kept:
            inside = np.abs(ky) <= kept_y
            spectrum[ky[inside], kx] = waves[inside]
            if kx == 0:
                spectrum[-ky[inside], 0] = waves[inside].conj()
    heights = np.fft.irfft2(spectrum, s=(across, nodes), norm="forward") * (surface.rq / np.sqrt(power))
    return np.concatenate([heights, heights[:1]])


def _modes(
    surface: Surface | SelfAffine, body: int, kx: int, step: float, step_y: float
) -> tuple[NDArray[np.int64], NDArray[np.complex128]]:
    """Return the mode numbers ky of one kx >= 0 within the cutoff, and their waves (up to one common factor).

    Each kx has a random stream of its own, read in the order ky = 0, 1, -1, 2, -2 ..., so that a wave depends
    on its mode alone. Raw bits and Box & Muller's transform: only numpy's bit streams stay the same for good.
    """
    most = int(np.sqrt((surface.reach / step) ** 2 - kx**2) * (step / step_y))
    order = np.arange(2 * most + 1)
    ky = np.where(order % 2 == 1, (order + 1) // 2, -(order // 2))
    raw = np.random.Philox(key=[surface.seed, body], counter=[0, 0, 0, kx]).random_raw(2 * order.size)
    uniform = ((raw >> np.uint64(11)) + 0.5) * 2.0**-53
    noise = np.sqrt(-2.0 * np.log(uniform[0::2])) * np.exp(2j * np.pi * uniform[1::2])
    waves = noise * surface.amplitude(step**2 * (kx**2 + (step_y / step * ky) ** 2))
    own = ky > 0 if kx == 0 else np.full(ky.shape, True)  # of kx = 0 one half mirrors the other; no mean
    return ky[own], waves[own]


def groove_free(heights: Array) -> Array:
    """Return heights less each row's mean along x: the groove that a body wears is the same all along x."""
    return heights - heights.mean(axis=1, keepdims=True)


def rms_roughness(heights: Array, rows: NDArray[np.bool_] | slice) -> float:
    """Return the rms deviation [m] of the chosen rows from their common mean."""
    return float(np.std(heights[rows]))


def mean_roughness(heights: Array, rows: NDArray[np.bool_] | slice) -> float:
    """Return the arithmetic mean deviation Ra [m] of the chosen rows from their common mean."""
    chosen = heights[rows]
    return float(np.abs(chosen - chosen.mean()).mean())
