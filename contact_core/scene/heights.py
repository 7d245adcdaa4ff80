"""Heights of a body that are given: a measured patch, a texture, a dimple; from a file or an array."""

import io
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import SceneError
from ..quantities import parameter
from . import units
from .height_map import HeightMap, HeightStatistics, read, statistics_of

WIDEST = 1e-3  # m between neighbours
_RMS = (2e-10, 1e-4)  # m: less is smooth, more is no roughness
_SLOPE = (1e-4, 1.0)  # assumed: a thousandfold error of unit takes slopes of 1e-3 to 0.1 out of it
_STRETCH = 0.02  # of a tile, at most, to fit a whole number of them
_LEVEL = 0.02  # rms deviation of a level edge, at most, over peak to valley
_LEAST, _MOST = 4, 2**14  # heights along an edge of the patch


@dataclass(frozen=True)
class Heights:
    """Heights on a square lattice, from a file [ny, nx] whose rows run along x; they are added to the roughness.

    One row stands for a surface that is the same all along y, one column for one that is the same along x. Only
    numbers and spacing matter: the same numbers in another file are the same heights.
    """

    spacing: float = parameter(
        "m", "distance between neighbours in the file of heights", above=0.0, most=WIDEST, shapes_arrays=True
    )
    unit: str = parameter("", "unit of the numbers in the file of heights", choices=("m", "mm", "um", "nm"))
    file: str = parameter("", "file of heights: .npy or .csv, beside the scene's file", default="")
    beyond: str = parameter(
        "",
        "the patch beyond the file's edges: mirrored; repeated, in whole numbers; or flat, as high as the edge",
        choices=("mirrored", "repeated", "flat"),
        default="mirrored",
    )
    digest: str = parameter("", "SHA-256 of the numbers, to be sure of the file; empty: any", default="")

    def loaded(self, name: str, folders: tuple[Path, ...]) -> "Heights":
        """Return the heights with the numbers of their file, looked for in the folders.

        Raises SceneError, about the field `name`, if the file cannot be used or is not that of the digest.
        """
        if isinstance(self.digest, HeightMap):
            return self
        found = read(f"{name}.file", self.file, folders)
        if self.digest not in ("", found):
            raise SceneError(
                f"{name}.file = '{self.file}' holds other numbers than before: their digest is {found[:16]}, not "
                f"{self.digest[:16]}. Restore the file, or leave {name}.digest out."
            )
        return replace(self, digest=found)

    @cached_property
    def values(self) -> Array:
        """The heights [m], [ny, nx]."""
        assert isinstance(self.digest, HeightMap)  # Scene reads the file
        return self.digest.array * units.unit(self.unit)[0]

    @cached_property
    def statistics(self) -> HeightStatistics:
        """Statistics of all numbers of the file."""
        return statistics_of(self.values, self.spacing)

    @property
    def packed(self) -> "Heights":
        """The same heights under a file name that follows from their numbers, see `npy`."""
        return replace(self, file=f"heights_{self.digest[:16]}.npy")

    def npy(self) -> bytes:
        """Return the numbers as a file."""
        assert isinstance(self.digest, HeightMap)
        buffer = io.BytesIO()
        np.save(buffer, self.digest.array)
        return buffer.getvalue()

    @cached_property
    def edge(self) -> Array:
        """The heights [m] along the edge of the file."""
        z = self.values
        rows = z[[0, -1]].ravel() if z.shape[0] > 1 else z[:, :0].ravel()
        columns = z[:, [0, -1]].ravel() if z.shape[1] > 1 else z[:0].ravel()
        return np.concatenate([rows, columns])

    def samples(self, axis: int, length: float) -> NDArray[np.int64]:
        """Return which rows (`axis` 0) or columns (1) of the file make up a periodic patch of a length [m].

        -1 stands for the flat surroundings. The lattice is stretched so that it fits, as a rule by less than half
        its spacing at either end.
        """
        n, count = self.values.shape[axis], length / self.spacing
        if n == 1:
            return np.zeros(1, dtype=np.int64)
        if self.beyond == "repeated":
            return np.tile(np.arange(n), max(1, round(count / n)))
        if self.beyond == "flat":
            beside = max(round(0.5 * (count - n)), 0)
            return np.pad(np.arange(n), beside, constant_values=-1)
        half = max(round(0.5 * count), 1)  # its mirror image closes the patch without a step
        at = (np.arange(half) + max((n - half) // 2, 0)) % (2 * n)
        at = np.minimum(at, 2 * n - 1 - at)
        return np.concatenate([at, at[::-1]])

    def errors(self, size: tuple[float, float]) -> Iterator[str]:
        """Yield what makes the heights unusable for a patch of a size along y and x [m]; begins with a field's name."""
        yield from self._unit_errors()
        for axis, length in enumerate(size):
            along, n = "yx"[axis], self.values.shape[axis]
            if n == 1:
                continue
            count, tile = length / self.spacing, n * self.spacing
            if not _LEAST <= count <= _MOST:
                yield (
                    f"spacing = {self.spacing:g} m gives {count:.3g} heights along the {length:g} m of the patch "
                    f"along {along}; {_LEAST} to {_MOST} can be used. Give the file a spacing of "
                    f"{length / _MOST:.2g} to {length / _LEAST:.2g} m, or change film.domain or film.width."
                )
            fit = length / tile
            if self.beyond == "repeated" and abs(fit / max(1, round(fit)) - 1.0) > _STRETCH:
                yield (
                    f"beyond = 'repeated': {fit:.3g} tiles of {tile:g} m along {along} make up the patch of "
                    f"{length:g} m; a whole number is needed. Use a film.domain (along y: film.width) of "
                    f"{max(1, round(fit)) * tile:g} m, or beyond = 'mirrored'."
                )
            if self.beyond == "flat" and tile > length * (1.0 + _STRETCH):
                yield (
                    f"beyond = 'flat': the file is {tile:g} m long along {along}, the patch {length:g} m. Use a "
                    f"film.domain (along y: film.width) of at least {tile:g} m, or beyond = 'mirrored'."
                )
        step = float(np.std(self.edge))
        if self.beyond == "flat" and step > _LEVEL * self.statistics.peak_to_valley:
            yield (
                f"beyond = 'flat': the edge of the file is not level; it deviates by {step:.2g} m rms of "
                f"{self.statistics.peak_to_valley:.2g} m peak to valley, and {_LEVEL:g} of that is allowed. Level "
                "the file, or use beyond = 'mirrored'."
            )

    def _unit_errors(self) -> Iterator[str]:
        for what, value, plausible in implausible(self.statistics):
            yield (
                f"unit = '{self.unit}' with spacing = {self.spacing:g} m makes the {what} of the file {value}; "
                f"{plausible} is plausible. Give the unit of the numbers in the file and the distance of its "
                "neighbours; for a smooth surface leave heights out."
            )


def implausible(found: HeightStatistics) -> Iterator[tuple[str, str, str]]:
    """Yield which rms of heights is none of a rough surface, its value, and the range of what can be one, in words."""
    for what, value, (least, most), unit in (
        ("rms height", found.rms, _RMS, " m"),
        ("rms slope", found.slope, _SLOPE, ""),
    ):
        if not least <= value <= most:
            yield what, f"{value:.3g}{unit}", f"{least:g} to {most:g}{unit}"
