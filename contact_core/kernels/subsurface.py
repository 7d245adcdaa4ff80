"""Stress in an elastic half space under pressure and shear that are constant on square cells of its surface.

With the potentials of p, H = sum of p ln(r + z) and V = sum of p / r, and of shear q along x, O = sum of q [z ln(r + z)
- r], F = sum of q ln(r + z) and W = sum of q / r, all sums being integrals over the surface, and letters after a comma
derivatives, the stress under p is 2 pi S_ij = -(1 - 2 nu) H,ij - z V,ij + 2 nu d_ij V,z for i, j = x, y; 2 pi S_zz =
V,z - z V,zz; 2 pi S_iz = -z V,iz. Under q it is 2 pi S_xx = 2 (1 + nu) W,x + 2 nu O,xxx - z F,xxx; 2 pi S_yy = 2 nu W,x
+ 2 nu O,xyy - z F,xyy; 2 pi S_zz = -z W,xz; 2 pi S_yz = -z W,xy; 2 pi S_xz = W,z - z W,xx; 2 pi S_xy = W,y + 2 nu O,xxy
- z F,xxy. Of a periodic half space the nearest images count one by one, beyond them an even load.

Sources of the coefficients: Love, Phil. Trans. R. Soc. A 228 (1929) 377, doi:10.1098/rsta.1929.0009, for pressure; the
potentials of Boussinesq and Cerruti (Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, section 3.2),
integrated over a cell, for shear; of the convolution: Liu & Wang, J. Tribol. 124 (2002) 36, doi:10.1115/1.1401017.
"""

from collections.abc import Iterator
from typing import Any, Protocol

import numpy as np
import scipy
from numpy.typing import NDArray

from .arrays import Array
from .compiled import jit
from .half_space import even_fast_length

Spectrum = NDArray[np.complex128]

_LONG = 1e14  # cells: a rectangle of this length is an infinite strip
_PERIODS, _CELLS = 8, 32  # periods and cells on either side that are summed one by one, at least
_ODD_X = (False, False, False, False, True, True)  # components under pressure that change their sign with x
_ODD_Y = (False, False, False, True, False, True)


class Subsurface:
    """Stress [6, ny, nx] at some depths below the cell centres: xx, yy, zz, yz, xz, xy, tension positive.

    z points into the body. A positive pressure presses, a positive shear_x or shear_y pulls the surface along +x or +y.
    All have one unit. A periodic half space repeats along y with the rows of the grid. Spectra are made at their first
    use and kept. Holds plans and scratch: one instance per thread.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        spacing: float,
        depths: Array,
        poisson: float,
        library: str,
        *,
        periodic: bool = False,
    ) -> None:
        self.shape, self.poisson, self.periodic = shape, poisson, periodic
        self._ratios = np.asarray(depths, dtype=np.float64) / spacing
        ny, nx = shape
        self.plane = ny if periodic else even_fast_length(2 * ny - 1), even_fast_length(2 * nx - 1)
        self._fourier: _Fourier = (_WithFftw if library == "pyfftw" else _WithScipy)(ny, *self.plane)
        self._kept: dict[tuple[int, int], Array] = {}

    def stress(self, pressure: Array, shear_x: Array | None = None, shear_y: Array | None = None) -> Array:
        """Return the stress [6, nz, ny, nx] under tractions [ny, nx]."""
        out = np.empty((6, self._ratios.size, *self.shape))
        for at, layer in enumerate(self.layers(pressure, shear_x, shear_y)):
            out[:, at] = layer
        return out

    def layers(self, pressure: Array, shear_x: Array | None = None, shear_y: Array | None = None) -> Iterator[Array]:
        """Yield the stress [6, ny, nx] under tractions [ny, nx], one depth after the other."""
        nx = self.shape[1]
        given = [
            (load, self._fourier.forward(traction))
            for load, traction in enumerate((pressure, shear_x, shear_y))
            if traction is not None and traction.any()
        ]
        total = self._fourier.columns.view(np.float64)
        for layer in range(self._ratios.size):
            out = np.zeros((6, *self.shape))
            for component in range(6) if given else ():
                for at, (load, transform) in enumerate(given):
                    odd_x, odd_y = _odd(component, load)
                    factor = self._factors(layer, load)[component]
                    _add(total, factor, transform.view(np.float64), odd_y, odd_x != odd_y, at == 0)
                out[component] = self._fourier.backward()[:, :nx]
            yield out

    def _factors(self, layer: int, load: int) -> Array:
        """Return the spectra [6, mx // 2 + 1, my // 2 + 1] of the coefficients of one traction.

        Those of coefficients that are odd along one axis are imaginary, and stored without i.
        """
        if (layer, load) not in self._kept:
            (ny, nx), (my, mx) = self.shape, self.plane
            made = periodic_coefficients if self.periodic else coefficients
            values = made(ny, nx, self._ratios[layer], self.poisson, load)
            factors = np.empty((6, mx // 2 + 1, my // 2 + 1))
            for component in range(6):
                odd_x, odd_y = _odd(component, load)
                factor = _transformed(_transformed(values[component], mx, odd_x).T, my, odd_y)
                factors[component] = factor * ((-1.0 if odd_x and odd_y else 1.0) / (my * mx))
            self._kept[layer, load] = factors
        return self._kept[layer, load]


def graded(first: float, deepest: float, layers: int) -> Array:
    """Return depths [layers] down to the deepest: the first one, and steps that grow from it by one factor."""
    steps = np.arange(layers)
    if layers == 1 or layers * first >= deepest:
        return np.asarray(deepest / layers * (steps + 1.0), dtype=np.float64)

    def reach(factor: float) -> float:
        return first * float((factor**steps).sum()) - deepest

    factor = scipy.optimize.brentq(reach, 1.0, (deepest / first) ** (1.0 / (layers - 1)))
    depths = first * np.cumsum(factor**steps)
    depths[-1] = deepest
    return np.asarray(depths)


def coefficients(ny: int, nx: int, depth: float, poisson: float, load: int) -> Array:
    """Return the stress [6, ny, nx] at distances (j, i) from a unit square cell under a unit traction, at a depth.

    Lengths in cells. Load 0 is a pressure, 1 and 2 are shear along x and y.
    """
    return _rectangles(np.arange(ny) - 0.5, np.arange(ny) + 0.5, nx, depth, poisson, load)


def periodic_coefficients(ny: int, nx: int, depth: float, poisson: float, load: int) -> Array:
    """Return the coefficients [6, ny // 2 + 1, nx] of cells that repeat every ny rows.

    The nearest periods are summed one by one. The others act like an even load, that of an infinite strip in plane
    strain less that of the one rectangle which covers the nearest periods, and the midpoint rule's first term.
    """
    j = np.arange(ny // 2 + 1)
    most = max(_PERIODS, -(-_CELLS // ny))

    def between(low: NDArray[Any], high: NDArray[Any]) -> Array:
        return _rectangles(low, high, nx, depth, poisson, load)

    total = np.zeros((6, j.size, nx))
    for period in range(-most * ny, (most + 1) * ny, ny):
        total += between(period + j - 0.5, period + j + 0.5)
    far = np.full(j.size, _LONG)
    for sign in (-1.0, 1.0):
        end = j + sign * (most + 0.5) * ny
        rest = between(end, far) if sign > 0.0 else between(-far, end)
        slope = between(end, end + 1.0) - between(end - 1.0, end)
        total += rest / ny + sign * (ny - 1.0 / ny) / 24.0 * slope
    return total


def _rectangles(low: NDArray[Any], high: NDArray[Any], nx: int, depth: float, poisson: float, load: int) -> Array:
    """Return the stress [6, m, nx] of rectangles between rows low and high [m], one cell wide, i columns away."""
    x = np.arange(nx + 1)[None, :] - 0.5
    corner = (_pressed, _sheared_x, _sheared_y)[load]
    edges = corner(x, high[:, None], depth, poisson) - corner(x, low[:, None], depth, poisson)
    return np.diff(edges, axis=2) / (2.0 * np.pi)


def _pressed(x: NDArray[Any], y: NDArray[Any], z: float, poisson: float) -> NDArray[Any]:
    """Return 2 pi times the stress of a unit pressure on the quadrant behind a corner at (-x, -y), up to constants.

    What depends on x or y alone cancels between the corners of a cell.
    """
    r, across, along = np.sqrt(x * x + y * y + z * z), x * x + z * z, y * y + z * z
    solid, soft = np.arctan2(x * y, z * r), 1.0 - 2.0 * poisson
    part_x, part_y = z * x * y / (r * across), z * x * y / (r * along)
    return np.stack(
        [
            part_x - 2.0 * poisson * solid - soft * np.arctan2(x * y, across + z * r),
            part_y - 2.0 * poisson * solid - soft * np.arctan2(x * y, along + z * r),
            -solid - part_x - part_y,
            z * z * x / (r * along),
            z * z * y / (r * across),
            -soft * np.log(r + z) - z / r,
        ]
    )


def _sheared_x(x: NDArray[Any], y: NDArray[Any], z: float, poisson: float) -> NDArray[Any]:
    """Return the same for a unit shear along x."""
    r, across = np.sqrt(x * x + y * y + z * z), x * x + z * z
    log_x, log_y = np.arcsinh(y / np.sqrt(across)), np.arcsinh(x / np.sqrt(y * y + z * z))
    reach = (2.0 * poisson + z / r) / (r + z)
    deep = z * z * y / (r * across)
    return np.stack(
        [
            2.0 * log_x + y * reach - deep,
            2.0 * poisson * log_x - y * reach,
            deep,
            np.broadcast_to(-z / r, r.shape),
            z * x * y / (r * across) - np.arctan2(x * y, z * r),
            log_y - x * reach,
        ]
    )


def _sheared_y(x: NDArray[Any], y: NDArray[Any], z: float, poisson: float) -> NDArray[Any]:
    """Return the same for a unit shear along y."""
    return _sheared_x(y, x, z, poisson)[[1, 0, 2, 4, 3, 5]]


def _odd(component: int, load: int) -> tuple[bool, bool]:
    """Return whether a component under a load changes its sign with x, and with y."""
    return _ODD_X[component] != (load == 1), _ODD_Y[component] != (load == 2)


def _transformed(half: Array, n: int, odd: bool) -> Array:
    """Return the transform along the last axis of what is even or, without i, odd with a period n."""
    known = half.shape[-1]
    full = np.zeros((half.shape[0], n))
    full[:, :known] = half
    full[:, n - known + 1 :] = (-1.0 if odd else 1.0) * half[:, :0:-1]
    spectrum = scipy.fft.rfft(full, axis=-1)
    return np.asarray(spectrum.imag if odd else spectrum.real)


@jit
def _add(total, factor, transform, odd, turned, first):  # type: ignore[no-untyped-def]
    """Add factor times transform to the total, or put it there first; times i if turned.

    Total and transform are pairs of real numbers [m, 2 n]; the factor [m, n // 2 + 1] is even or odd along n.
    """
    m, n = total.shape[0], total.shape[1] // 2
    half = n // 2 + 1
    sign = -1.0 if odd else 1.0
    for i in range(m):
        if first:
            total[i] = 0.0
        if turned:
            for j in range(half):
                total[i, 2 * j] -= factor[i, j] * transform[i, 2 * j + 1]
                total[i, 2 * j + 1] += factor[i, j] * transform[i, 2 * j]
            for j in range(half, n):
                total[i, 2 * j] -= sign * factor[i, n - j] * transform[i, 2 * j + 1]
                total[i, 2 * j + 1] += sign * factor[i, n - j] * transform[i, 2 * j]
        else:
            for j in range(half):
                total[i, 2 * j] += factor[i, j] * transform[i, 2 * j]
                total[i, 2 * j + 1] += factor[i, j] * transform[i, 2 * j + 1]
            for j in range(half, n):
                total[i, 2 * j] += sign * factor[i, n - j] * transform[i, 2 * j]
                total[i, 2 * j + 1] += sign * factor[i, n - j] * transform[i, 2 * j + 1]


class _Fourier(Protocol):
    """Transforms of fields [ny, nx], padded by zeros to [my, mx]; spectra are [mx // 2 + 1, my]."""

    columns: Spectrum  # what `backward` transforms

    def forward(self, field: Array) -> Spectrum:
        """Return the spectrum of a field."""

    def backward(self) -> Array:
        """Return my mx times the field [ny, mx] of the spectrum in `columns`, which is lost: scratch."""


class _WithFftw:
    """Transforms by FFTW: rows of zeros are left out, and columns lie contiguous."""

    def __init__(self, ny: int, my: int, mx: int) -> None:
        import pyfftw  # FFTW is GPL: loaded only where it is asked for

        half = mx // 2 + 1
        self._field, self._back = (pyfftw.zeros_aligned((ny, mx), dtype="float64") for _ in range(2))
        rows, rows_back = (pyfftw.zeros_aligned((my, half), dtype="complex128") for _ in range(2))
        self.columns: Spectrum = pyfftw.zeros_aligned((half, my), dtype="complex128")
        # ESTIMATE: plans that do not depend on timing give the same bits every time
        keep, destroy = ("FFTW_ESTIMATE",), ("FFTW_ESTIMATE", "FFTW_DESTROY_INPUT")
        self._forward = (
            pyfftw.FFTW(self._field, rows[:ny], axes=(1,), flags=keep).execute,
            pyfftw.FFTW(rows, self.columns.T, axes=(0,), flags=keep).execute,
        )
        self._backward = (
            pyfftw.FFTW(self.columns.T, rows_back, axes=(0,), direction="FFTW_BACKWARD", flags=destroy).execute,
            pyfftw.FFTW(rows_back[:ny], self._back, axes=(1,), direction="FFTW_BACKWARD", flags=destroy).execute,
        )

    def forward(self, field: Array) -> Spectrum:
        self._field[:, : field.shape[1]] = field
        for step in self._forward:
            step()
        return self.columns.copy()

    def backward(self) -> Array:
        for step in self._backward:
            step()
        return self._back


class _WithScipy:
    """The same by scipy."""

    def __init__(self, ny: int, my: int, mx: int) -> None:
        self._sides = ny, my, mx
        self.columns: Spectrum = np.zeros((mx // 2 + 1, my), np.complex128)

    def forward(self, field: Array) -> Spectrum:
        _, my, mx = self._sides
        return np.ascontiguousarray(scipy.fft.fft(scipy.fft.rfft(field, mx, axis=1), my, axis=0).T)

    def backward(self) -> Array:
        ny, _, mx = self._sides
        rows = scipy.fft.ifft(self.columns.T, axis=0, norm="forward")[:ny]
        return np.asarray(scipy.fft.irfft(rows, mx, axis=1, norm="forward"))
