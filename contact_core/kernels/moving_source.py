"""Steady surface temperature of half spaces that move through a heat source.

The source is constant on square cells; one half space alone, or two with oil between them.

Sources: Jaeger, Proc. R. Soc. N. S. W. 76 (1942) 203; Carslaw & Jaeger, Conduction of Heat in Solids, 1959, section
10.7. A point that takes up heat at the rate Q warms the surface by Q exp[-u (r - x) / (2 k)] / (2 pi K r), x along the
motion of the material: K conductivity [W/(m K)], k diffusivity [m2/s], u speed [m/s].
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from .arrays import Array, Mask
from .half_space import influence

Spectrum = NDArray[np.complex128]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_BATCH = 64  # panels at once, which bounds the memory
_STILL = 1e-100  # Peclet number up to which a source does not move
_FAR = 1e16  # cells: heat that has spread over so many counts as none
_DEEP = 6.0  # erfc(6) = 2e-17
_IMAGES = 6  # on either side, of a cell whose heat has spread to a Gaussian no wider than the period
_WAVES = 2  # of one that is wider: exp[-(3 pi)^2] = 3e-39


def moving_influence(ny: int, nx: int, peclet: float) -> Array:
    """Return coefficients [ny, 2 nx - 1] of unit square cells.

    Rows are at the distances 0 ... ny - 1 across the motion, columns at -(nx - 1) ... nx - 1 along x.

    They are the integrals of exp[-peclet (r - x)] / r over the cell, peclet = u spacing / (2 k); the rise is
    spacing / (2 pi K) times their sum with the flux. Heat taken up a time t ago has moved by u t and spread to a
    Gaussian, so the integral over a cell is one over s = 2 sqrt(k t) / spacing of a product of differences of error
    functions along and across: one quadrature for all distances, without the singularity.
    """
    if peclet == 0.0:
        half = influence(ny, nx)
        return np.hstack((half[:, :0:-1], half))
    if peclet < 0.0:
        return moving_influence(ny, nx, -peclet)[:, ::-1]
    along, across = np.arange(-nx, nx) + 0.5, np.arange(-1, ny) + 0.5
    coefficients = np.zeros((ny, 2 * nx - 1))
    for s, weights in _quadrature(nx, peclet):
        in_x = np.diff(scipy.special.erf(along / s - 0.5 * peclet * s), axis=1)
        in_y = np.diff(scipy.special.erf(across / s), axis=1)
        coefficients += (in_y * weights).T @ in_x
    return 0.5 * np.sqrt(np.pi) * coefficients


def periodic_moving_influence(ny: int, nx: int, peclet: float, face: float) -> Array:
    """Return the coefficients of cells that repeat along y with the period of ny rows.

    They repeat over a `face` of so many nodes; rows at the distances 0 ... ny - 1 in the middle of it.

    The integral across is that of all images of a cell, times the share erf(face / (2 s)) of the Gaussian that lies on
    the face: exact as long as the images merge before the ends matter. A face without end has no steady temperature
    at rest.
    """
    if peclet < 0.0:
        return periodic_moving_influence(ny, nx, -peclet, face)[:, ::-1]
    along = np.arange(-nx, nx) + 0.5
    coefficients = np.zeros((ny, 2 * nx - 1))
    for s, weights in _quadrature(nx, peclet):
        in_x = np.diff(scipy.special.erf(along / s - 0.5 * peclet * s), axis=1)
        in_y = _images(ny, s) * scipy.special.erf(0.5 * face / s)
        coefficients += (in_y * weights).T @ in_x
    return 0.5 * np.sqrt(np.pi) * coefficients


def _images(ny: int, s: Array) -> Array:
    """Return the sum over all k of erf((y + 1/2) / s) - erf((y - 1/2) / s), y = j + k ny: [n, ny] for s [n, 1].

    Where the Gaussian is narrower than the period, image by image; where it is wider, by its Fourier series.
    """
    rows = np.arange(ny)
    found = np.full((s.size, ny), 2.0 / ny)
    narrow = s[:, 0] < ny
    ends = np.arange(-_IMAGES * ny, (_IMAGES + 1) * ny + 1) - 0.5
    found[narrow] = np.diff(scipy.special.erf(ends / s[narrow]), axis=1).reshape(-1, 2 * _IMAGES + 1, ny).sum(axis=1)
    for wave in range(1, _WAVES + 1):
        angle = np.pi * wave / ny
        amplitude = np.exp(-((angle * s[~narrow]) ** 2)) * np.sinc(wave / ny)
        found[~narrow] += 4.0 / ny * amplitude * np.cos(2.0 * angle * rows)
    return found


def _quadrature(nx: int, peclet: float) -> Iterator[tuple[Array, Array]]:
    """Yield Gauss nodes and weights [n, 1] in panels of s.

    The error functions change over s itself or over 1 / peclet.
    """
    end, widest = _FAR, np.inf
    if peclet > _STILL:
        end = min((_DEEP + np.sqrt(_DEEP**2 + 2.0 * peclet * nx)) / peclet, _FAR)
        widest = 4.0 / peclet
    edges = [0.0, min(0.1, widest)]
    while edges[-1] < end:
        edges.append(edges[-1] + min(0.5 * edges[-1], widest))
    for first in range(0, len(edges) - 1, _BATCH):
        batch = np.array(edges[first : first + _BATCH + 1])[:, None]
        half = 0.5 * np.diff(batch, axis=0)
        yield (batch[:-1] + half * (1.0 + _NODES)).reshape(-1, 1), (half * _WEIGHTS).reshape(-1, 1)


@lru_cache(maxsize=8)
def _spectrum(ny: int, nx: int, peclet: float, face: float | None) -> Spectrum:
    """Return the transform of the coefficients on a plane padded by zeros.

    Across the motion they are even, so that 2 (ny - 1) rows keep all distances apart; along it that takes 2 nx - 1.
    Rows on a `face` are those of their period.
    """
    mx = _row_length(nx)
    if face is None:
        my, coefficients = scipy.fft.next_fast_len(max(2 * (ny - 1), 1)), moving_influence(ny, nx, peclet)
    else:
        my, coefficients = ny, periodic_moving_influence(ny, nx, peclet, face)
    kernel = np.zeros((my, mx))
    kernel[:ny, :nx] = coefficients[:, nx - 1 :]
    kernel[:ny, mx - nx + 1 :] = coefficients[:, : nx - 1]
    kernel[my - ny + 1 :] = kernel[ny - 1 : 0 : -1]
    spectrum = scipy.fft.rfft2(kernel)
    spectrum.setflags(write=False)
    return spectrum


@dataclass(frozen=True)
class MovingSurface:
    """Surface of one body on a grid [ny, nx], moving along +x; linear and without memory."""

    shape: tuple[int, int]
    spacing: float  # [m]
    conductivity: float  # [W/(m K)]
    diffusivity: float  # [m2/s]
    speed: float  # [m/s], of either sign
    face: float | None = None  # length [m] along which the rows repeat themselves; None: they do not

    @property
    def spectrum(self) -> Spectrum:
        """Transform of the rise per flux [K m2/W] on the padded plane."""
        return self._scale * _spectrum(*self.shape, self._peclet, self._face)

    @property
    def rise_of_cell(self) -> float:
        """Rise of a cell, with its images, per flux into itself alone [K m2/W]."""
        if self._face is None:
            return self._scale * float(moving_influence(1, 1, self._peclet)[0, 0])
        return self._scale * float(periodic_moving_influence(self.shape[0], 1, self._peclet, self._face)[0, 0])

    @property
    def _scale(self) -> float:
        return self.spacing / (2.0 * np.pi * self.conductivity)

    @property
    def _face(self) -> float | None:
        return None if self.face is None else self.face / self.spacing

    @property
    def _peclet(self) -> float:
        return 0.5 * self.speed * self.spacing / self.diffusivity

    def rise(self, flux: Array) -> Array:
        """Return the steady temperature rise [K] under a heat flux [W/m2], both [ny, nx]."""
        return _filtered(flux, self.spectrum)


def _filtered(field: Array, spectrum: Spectrum) -> Array:
    """Return the zero-padded convolution of a field [ny, nx]; rows of zeros are not transformed."""
    ny, nx = field.shape
    my, mx = spectrum.shape[0], _row_length(nx)
    rows = scipy.fft.fft(scipy.fft.rfft(field, mx, axis=1), my, axis=0, overwrite_x=True)
    rows *= spectrum
    rows = scipy.fft.ifft(rows, axis=0, overwrite_x=True)[:ny]
    return np.asarray(scipy.fft.irfft(rows, mx, axis=1)[:, :nx])


def _row_length(nx: int) -> int:
    return scipy.fft.next_fast_len(2 * nx - 1, real=True)


@dataclass(frozen=True)
class Partition:
    """Heat of the film shared between two surfaces. Arrays [ny, nx]."""

    into_1: Array  # heat flux into each body [W/m2]
    into_2: Array
    rise_1: Array  # of the surface above the body [K]
    rise_2: Array
    mismatch: float  # error of the temperature drop across the film, rms over the rms of the rises
    convolutions: int


def partition(
    dissipation: Array,
    resistance: Array,
    inside: Mask,
    difference: float,
    surfaces: tuple[MovingSurface, MovingSurface],
    tolerance: float = 1e-7,
    iterations: int = 200,
) -> Partition:
    """Share the heat [W/m2] that a film dissipates evenly over its thickness h so that both surfaces match it.

    `resistance` is h / (conductivity of the film) [m2 K/W], `difference` that of the bodies, T_2 - T_1 [K]. Body 1
    takes up q_1 = q/2 + d and body 2 q_2 = q/2 - d with d = (T_2 - T_1) / resistance of the surfaces where `inside`,
    else 0; so [resistance + G_1 + G_2] d = (G_2 - G_1) q/2 + difference, G_i being what `MovingSurface.rise` does.
    Whatever d, no heat is lost. Stops when the mismatch is below `tolerance`, or at the latest after `iterations`.
    """
    one, two = surfaces
    half, mask = 0.5 * dissipation, inside.astype(np.float64)
    rise_1, rise_2 = one.rise(half), two.rise(half)
    wanted = mask * (rise_2 - rise_1 + difference)
    if not wanted.any():
        return Partition(half, half, rise_1, rise_2, 0.0, 2)
    scale = float(np.linalg.norm(mask * (rise_1 + rise_2 + abs(difference))))
    both, calls = one.spectrum + two.spectrum, 0

    def drop(flux: Array) -> Array:
        nonlocal calls
        calls += 1
        field = flux.reshape(half.shape)
        return (resistance * field + mask * _filtered(field, both)).ravel()

    inverse = (mask / (resistance + one.rise_of_cell + two.rise_of_cell)).ravel()
    size = (half.size, half.size)
    through, _ = scipy.sparse.linalg.bicgstab(
        scipy.sparse.linalg.LinearOperator(size, drop, dtype=np.float64),
        wanted.ravel(),
        rtol=0.0,
        atol=tolerance * scale,
        maxiter=iterations,
        M=scipy.sparse.linalg.LinearOperator(size, lambda flux: flux * inverse, dtype=np.float64),
    )
    conducted = through.reshape(half.shape)
    into_1 = half + conducted
    into_2 = dissipation - into_1
    rise_1, rise_2 = one.rise(into_1), two.rise(into_2)
    missed = float(np.linalg.norm(mask * (resistance * conducted - (rise_2 - rise_1 + difference))))
    return Partition(into_1, into_2, rise_1, rise_2, missed / scale, calls + 4)
