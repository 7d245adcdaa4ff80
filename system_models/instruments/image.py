"""Heights as an instrument gives them: an image with points that have no height."""

from dataclasses import dataclass, field, replace

import numpy as np

from contact_core.arrays import Array
from contact_core.errors import ContactError

MOST_MISSING = 0.25  # share of points: more is not filled but invented
LEAST = 8  # points along an edge of an image


@dataclass(frozen=True)
class HeightImage:
    """Heights [m] of an instrument, outward of the body, [ny, nx]; nan where it found none."""

    heights: Array
    spacing: tuple[float, float]  # of neighbours along y and x [m]
    source: str  # name of the file
    digest: str = ""  # SHA-256 of its bytes
    format: str = ""  # of the file, in words
    remarks: dict[str, str] = field(default_factory=dict)  # what the file says on instrument and measurement

    @property
    def size(self) -> tuple[float, float]:
        """Length along y and x [m]."""
        (ny, nx), (dy, dx) = self.heights.shape, self.spacing
        return ny * dy, nx * dx

    @property
    def missing(self) -> float:
        """Share of points without a height."""
        return float(np.mean(~np.isfinite(self.heights)))

    def without_marks(self) -> "HeightImage":
        """Return the image without heights farther from their median than it is long: instruments mark gaps so.

        Where these are too many to be gaps, all stay: then the unit is wrong, or the size.
        """
        known = self.heights[np.isfinite(self.heights)]
        middle = float(np.median(known)) if known.size else 0.0
        with np.errstate(invalid="ignore"):
            far = np.abs(self.heights - middle) > max(self.size)
        if not far.any() or np.mean(far | ~np.isfinite(self.heights)) > MOST_MISSING:
            return self
        said = f"{int(far.sum())} heights, such as {self.heights[far][0]:.3g} m, are farther off than the image is long"
        return replace(self, heights=np.where(far, np.nan, self.heights), remarks={**self.remarks, "no heights": said})

    def turned(self) -> "HeightImage":
        """Return the image with its y axis along x, its x axis along y."""
        return replace(self, heights=self.heights.T, spacing=self.spacing[::-1])

    def window(self, x: tuple[float, float], y: tuple[float, float]) -> "HeightImage":
        """Return the part between two places [m] along x and along y, from the image's first point.

        Raises ContactError if the image does not reach so far or too few points are left.
        """
        cuts = []
        for axis, (low, high), length, step in zip("yx", (y, x), self.size, self.spacing, strict=True):
            if not 0.0 <= low < high <= length * (1.0 + 1e-9):
                raise ContactError(
                    f"--window asks for {1e6 * low:g} to {1e6 * high:g} um along {axis}; the image of "
                    f"'{self.source}' has 0 to {1e6 * length:.6g} um. Give two places in it, the smaller one first."
                )
            cuts.append(slice(round(low / step), round(high / step)))
        found = replace(self, heights=self.heights[cuts[0], cuts[1]])
        if min(found.heights.shape) < LEAST:
            raise ContactError(
                f"--window leaves {found.heights.shape[1]} by {found.heights.shape[0]} points of '{self.source}'; "
                f"{LEAST} are needed each way. Give a larger window."
            )
        return found
