"""A measured image made ready for a scene: form removed, gaps filled, waves cut, on a square lattice.

Waves are cut sharply, in the cosine series of the image and its mirror images: no wave is both in the patch and in the
roughness below it, as with the Gaussian filters of ISO 16610-61, half of whose waves pass at the cut-off.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from contact_core.errors import ContactError
from contact_core.kernels.arrays import Array
from contact_core.scene.height_map import statistics_of
from contact_core.scene.heights import WIDEST, implausible

from .image import MOST_MISSING, HeightImage

FORMS = {"none": (), "plane": ((1, 0), (0, 1)), "curvature": ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2))}  # powers of x, y
_OCTAVES = 2  # below the patch that must be resolved


class Statistics(NamedTuple):
    """Heights about their mean, by the names of ISO 25178-2."""

    Sq: float  # root mean square [m]
    Sa: float  # mean absolute deviation [m]
    Ssk: float  # skewness


class Removed(NamedTuple):
    """A form that was taken out."""

    name: str  # of FORMS
    slope: tuple[float, float]  # along x and y, at the middle
    radius: tuple[float, float]  # of curvature along x and y [m], above 0 for a ball, infinite for a plane
    peak_to_valley: float  # [m]


class Below(NamedTuple):
    """Roughness of waves that the patch has not: shorter than it shows, as far as the image resolves them."""

    rms: float | None  # [m]; None: this image cannot tell
    longest: float  # [m]
    resolution: float  # the shortest wave [m] that is counted
    last_octave: float  # share of the variance in the shortest octave
    why: str = ""  # it cannot tell


@dataclass(frozen=True)
class Patch:
    """Heights [m] for a scene, [ny, nx] on a square lattice, and what was done to the image."""

    heights: Array
    spacing: float  # [m]
    removed: Removed
    missing: float  # share of the points that were filled
    longest: float | None  # waves [m] that were cut: longer than this
    shortest: float | None  # and shorter than this
    stages: dict[str, Statistics]  # statistics after each stage
    below: Below

    @property
    def slope(self) -> float:
        """Rms gradient, by differences between neighbours."""
        return math.sqrt(sum(float(np.mean(np.diff(self.heights, axis=i) ** 2)) for i in (0, 1))) / self.spacing


def patch_of(
    image: HeightImage, form: str, longest: float | None, shortest: float | None, resolution: float | None = None
) -> Patch:
    """Return the patch of an image: waves from `shortest` to `longest` [m], all that it has without them.

    `resolution` [m] is the shortest wave that the instrument resolves; without it two points of the image.
    Raises ContactError if too much is missing, or the cuts leave nothing.
    """
    finest = 2.0 * max(image.spacing)
    resolved = finest if resolution is None else resolution
    _check(image, longest, shortest, resolved, finest)
    known, missing = np.isfinite(image.heights), image.missing
    stages = {"as measured": statistics(image.heights[known])}
    rest, removed = without_form(image, form)
    stages[f"without form ({form})"] = statistics(rest[known])
    series, lengths = _series(filled(rest)), _wavelengths(image)
    kept = np.ones(series.shape, dtype=bool) if longest is None else lengths <= longest
    square = abs(image.spacing[0] / image.spacing[1] - 1.0) < 1e-6
    if shortest is None and not square:  # the coarser lattice shows no shorter ones
        shortest = finest
    if shortest is not None:
        kept &= lengths >= shortest * (1.0 - 1e-9)
    spacing = 0.5 * (finest if shortest is None else shortest)
    series[0, 0] = 0.0  # the mean
    cut = np.where(kept, series, 0.0)
    if not cut.any():
        raise ContactError(f"No wave of '{image.source}' is left. Use a larger --longest, or a smaller --shortest.")
    heights = _evaluated(cut, image, None if shortest is None else spacing)
    stages["in the patch"] = statistics(heights)
    _check_size(image, heights, spacing)
    below = _below(series**2 / series.size, lengths, shortest or 2.0 * spacing, resolved)
    return Patch(heights, spacing, removed, missing, longest, shortest, stages, below)


def statistics(heights: Array) -> Statistics:
    """Return the statistics of heights [m]."""
    z = heights - heights.mean()
    sq = math.sqrt(float(np.mean(z * z)))
    return Statistics(sq, float(np.abs(z).mean()), float(np.mean(z**3)) / sq**3 if sq > 0.0 else 0.0)


def _check(image: HeightImage, longest: float | None, shortest: float | None, resolved: float, finest: float) -> None:
    if image.missing > MOST_MISSING:
        raise ContactError(
            f"'{image.source}' has no height at {100 * image.missing:.3g} % of its points; up to "
            f"{100 * MOST_MISSING:g} % are filled from their surroundings. Choose a --window that was measured better."
        )
    if shortest is not None and shortest < finest * (1.0 - 1e-9):
        raise ContactError(
            f"--shortest = {1e6 * shortest:g} um, but '{image.source}' shows waves down to {1e6 * finest:g} um, two of "
            "its points. Give at least that, or leave --shortest out."
        )
    if resolved < finest * (1.0 - 1e-9):
        raise ContactError(
            f"--resolution = {1e6 * resolved:g} um, but two points of '{image.source}' are {1e6 * finest:g} um apart. "
            "Give at least that, or leave --resolution out."
        )
    if longest is not None and longest <= (shortest or finest):
        raise ContactError(
            f"--longest = {1e6 * longest:g} um is not above the shortest wave, {1e6 * (shortest or finest):g} um."
        )


def _check_size(image: HeightImage, heights: Array, spacing: float) -> None:
    """Raise ContactError for heights that a scene would refuse."""
    found = [*implausible(statistics_of(heights, spacing))]
    if not 0.0 < spacing <= WIDEST:
        found.append(("distance of neighbours", f"{spacing:.3g} m", f"above 0, up to {WIDEST:g} m"))
    for what, value, plausible in found:
        raise ContactError(
            f"The {what} of '{image.source}' is {value}; {plausible} is plausible. Correct its unit or size, --unit "
            "and --size where the file does not say them, or the waves that are cut."
        )


def without_form(image: HeightImage, form: str) -> tuple[Array, Removed]:
    """Return the heights [m] less the least-squares polynomial of a form, nan where there is none, and the form."""
    z, known = image.heights, np.isfinite(image.heights)
    (ny, nx), (ly, lx) = z.shape, image.size
    powers = ((0, 0), *FORMS[form])
    y, x = ((2.0 * np.arange(n) + 1.0) / n - 1.0 for n in (ny, nx))  # from -1 to 1
    vy, vx = np.vander(y, 5, increasing=True), np.vander(x, 5, increasing=True)
    moments = vy.T @ known.astype(float) @ vx
    right = vy.T @ np.where(known, z, 0.0) @ vx
    matrix = np.array([[moments[q + s, p + r] for r, s in powers] for p, q in powers])
    found = dict(zip(powers, np.linalg.solve(matrix, np.array([right[q, p] for p, q in powers])), strict=True))
    polynomial: Array = sum(c * np.outer(vy[:, q], vx[:, p]) for (p, q), c in found.items())
    slope = (2.0 * found.get((1, 0), 0.0) / lx, 2.0 * found.get((0, 1), 0.0) / ly)
    curvature = (-8.0 * found.get((2, 0), 0.0) / lx**2, -8.0 * found.get((0, 2), 0.0) / ly**2)
    radius = (1.0 / curvature[0] if curvature[0] else math.inf, 1.0 / curvature[1] if curvature[1] else math.inf)
    return z - polynomial, Removed(form, slope, radius, float(np.ptp(polynomial)))


def filled(z: Array) -> Array:
    """Return heights whose gaps, nan, are as smooth as their edges allow: each the mean of its neighbours."""
    gap = ~np.isfinite(z)
    if not gap.any():
        return z.copy()
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import spsolve

    number = np.full(z.shape, -1)
    number[gap] = np.arange(gap.sum())
    rows, columns = [number[gap]], [number[gap]]
    neighbours, right = np.zeros(gap.sum()), np.zeros(gap.sum())
    for axis in (0, 1):
        for here, there in ((slice(1, None), slice(None, -1)), (slice(None, -1), slice(1, None))):
            at = (here, slice(None)) if axis == 0 else (slice(None), here)
            to = (there, slice(None)) if axis == 0 else (slice(None), there)
            mine, other, value = number[at][gap[at]], number[to][gap[at]], z[to][gap[at]]
            neighbours[mine] += 1.0
            right[mine[other < 0]] += value[other < 0]
            rows.append(mine[other >= 0])
            columns.append(other[other >= 0])
    values = np.concatenate([neighbours, *(np.full(len(each), -1.0) for each in rows[1:])])
    matrix = coo_array((values, (np.concatenate(rows), np.concatenate(columns))), shape=(gap.sum(), gap.sum()))
    complete = z.copy()
    complete[gap] = spsolve(matrix.tocsc(), right)
    return complete


def _series(z: Array) -> Array:
    """Return the cosine series of heights, with the sum of squares of the heights."""
    from scipy.fft import dctn

    found: Array = dctn(z, norm="ortho")
    return found


def _wavelengths(image: HeightImage) -> Array:
    """Return the wavelength [m] of each term of the cosine series; of the mean infinite."""
    fy, fx = (np.arange(n) / (2.0 * length) for n, length in zip(image.heights.shape, image.size, strict=True))
    with np.errstate(divide="ignore"):
        found: Array = 1.0 / np.hypot(fy[:, None], fx[None, :])
    return found


def _evaluated(series: Array, image: HeightImage, spacing: float | None) -> Array:
    """Return the heights of a cosine series on a square lattice of a spacing [m], on the image's own without one."""
    if spacing is None:
        from scipy.fft import idctn

        own: Array = idctn(series, norm="ortho")
        return own
    for axis in (0, 1):
        n, length = series.shape[axis], image.size[axis]
        count = math.floor(length / spacing * (1.0 + 1e-9))
        terms = np.arange(1 + int(np.flatnonzero(series.any(axis=1 - axis))[-1]))
        places = 0.5 * (length - count * spacing) + (np.arange(count) + 0.5) * spacing
        base = np.cos(np.pi / length * np.outer(places, terms)) * math.sqrt(2.0 / n)
        base[:, 0] = math.sqrt(1.0 / n)
        series = base @ series[: len(terms)] if axis == 0 else series[:, : len(terms)] @ base.T
    return series


def _below(variances: Array, lengths: Array, longest: float, resolution: float) -> Below:
    """Return the roughness of the waves below a length [m], by the variance [m2] of each wave."""

    def between(low: float, high: float) -> float:
        return float(variances[(lengths >= low * (1.0 - 1e-9)) & (lengths < high * (1.0 - 1e-9))].sum())

    if longest < 2.0**_OCTAVES * resolution * (1.0 - 1e-9):
        why = (
            f"the image resolves waves down to {1e6 * resolution:.3g} um, and the patch shows them down to "
            f"{1e6 * longest:.3g} um; --shortest of {1e6 * 2.0**_OCTAVES * resolution:.3g} um or more leaves 2 octaves"
        )
        return Below(None, longest, resolution, 0.0, why)
    total = between(resolution, longest)
    last, before = between(resolution, 2.0 * resolution), between(2.0 * resolution, 4.0 * resolution)
    if last > before:
        why = (
            f"the octave of waves from {1e6 * resolution:.3g} um has {last / before:.2g} times the variance of the "
            "next longer one, as noise of an instrument has and roughness has not; give its --resolution"
        )
        return Below(None, longest, resolution, last / total, why)
    return Below(math.sqrt(total), longest, resolution, last / total if total else 0.0)
