"""Arrays of heights: identity, reading from a file, statistics."""

import hashlib
import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import SceneError

_LEAST, _MOST = 4, 2**24  # numbers in an array


class HeightMap(str):
    """The SHA-256 of an array, carrying the array.

    A record with one is hashed and compared by content, and its table and JSON hold the digest alone.
    """

    array: Array

    def __new__(cls, array: Array) -> "HeightMap":
        """Keep a read-only copy of an array [ny, nx]."""
        kept = np.asarray(array, dtype="<f8") + 0.0  # a copy; of two zeros one
        kept.setflags(write=False)
        self = super().__new__(cls, hashlib.sha256(repr(kept.shape).encode() + kept.tobytes()).hexdigest())
        self.array = kept
        return self

    @staticmethod
    def of(name: str, heights: ArrayLike) -> "HeightMap":
        """Return the map of an array that a caller gives; SceneError, about the field `name`, if it cannot be used."""
        try:
            array = _real(heights)
        except ValueError as error:
            raise SceneError(f"{name} cannot be used: {error}. Give real numbers in rows of equal length.") from None
        said = _refusal(array)
        if said:
            raise SceneError(f"{name} {said}")
        return HeightMap(array)

    def __getnewargs__(self) -> tuple[Array]:  # type: ignore[override]
        return (self.array,)


class HeightStatistics(NamedTuple):
    """Statistics of heights about their mean."""

    rms: float  # [m]
    ra: float  # mean absolute deviation [m]
    skewness: float
    peak_to_valley: float  # [m]
    slope: float  # rms gradient, by differences between neighbours


def statistics_of(heights: Array, spacing: float) -> HeightStatistics:
    """Return the statistics of heights [m] on a square lattice of a spacing [m]."""
    z = heights - heights.mean()
    rms = float(np.sqrt(np.mean(z * z)))
    slopes_2 = sum(float(np.mean(np.diff(z, axis=i) ** 2)) for i in (0, 1) if z.shape[i] > 1)
    return HeightStatistics(
        rms,
        float(np.abs(z).mean()),
        float(np.mean(z**3)) / rms**3 if rms > 0.0 else 0.0,
        float(np.ptp(z)),
        math.sqrt(slopes_2) / spacing,
    )


def read(name: str, file: str, folders: tuple[Path, ...]) -> HeightMap:
    """Return the numbers of the first such file in the folders.

    Raises SceneError, about the field `name`, if there is none or it cannot be used.
    """
    if not file:
        raise SceneError(f"'{name}' is missing. Give the path of a .npy or .csv file of heights.")
    path = next((folder / file for folder in folders if (folder / file).is_file()), None)
    if path is None:
        looked = " and ".join(f"'{folder}'" for folder in folders)
        raise SceneError(f"{name} = '{file}' is not there; looked in {looked}. Give its path from the scene's file.")
    try:
        array = _numbers(path)
    except (OSError, ValueError, EOFError) as error:
        raise SceneError(
            f"{name} = '{file}' cannot be read: {error}. Give numbers as .npy, or as .csv in rows of equal length."
        ) from None
    said = _refusal(array)
    if said:
        raise SceneError(f"{name} = '{file}' {said}")
    return HeightMap(array)


def _refusal(array: Array) -> str:
    """Return why numbers cannot be heights, or an empty text."""
    if array.ndim != 2 or not _LEAST <= array.size <= _MOST:
        return (
            f"holds numbers of the shape {array.shape}; rows and columns are needed, with {_LEAST} to {_MOST} "
            "numbers. Cut the array, or average neighbours."
        )
    bad = int(array.size - np.isfinite(array).sum())
    return f"has {bad} of {array.size} numbers that are not finite. Fill them in." if bad else ""


def _numbers(path: Path) -> Array:
    if path.suffix == ".npy":
        with path.open("rb") as stream:
            if stream.read(2) == b"PK":
                raise ValueError("it is a .npz archive; save one of its arrays with numpy.save")
        return _real(np.load(path, allow_pickle=False))
    if path.suffix != ".csv":
        raise ValueError(f"its name ends with '{path.suffix}'")
    rows = [line.partition("#")[0] for line in path.read_text("utf-8-sig").splitlines()]
    delimiter = next((mark for mark in ";,\t" if any(mark in row for row in rows)), None)
    return np.loadtxt(rows, dtype=np.float64, delimiter=delimiter, ndmin=2)


def _real(given: ArrayLike) -> Array:
    """Return numbers in double precision; ValueError for what is no array of whole or real ones."""
    try:
        array = np.asarray(given)
    except ValueError:  # numpy's words are about sequences
        raise ValueError("its rows are of unequal length") from None
    if not (np.issubdtype(array.dtype, np.floating) or np.issubdtype(array.dtype, np.integer)):
        raise ValueError(f"its type is {array.dtype}")
    return np.asarray(array, dtype=np.float64)
