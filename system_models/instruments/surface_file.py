"""Reads the formats that instruments write for surfaces, by SurfaceTopography (the extra `surfaces`)."""

import hashlib
import io
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from contact_core.errors import ContactError
from contact_core.scene import units

from . import text_heights
from .image import LEAST, HeightImage

_TOLD = ("instrument", "acquisition_time", "software", "comment")  # fields of a file that are kept with its heights
_LONGEST = 200  # characters of a remark
_ARRAYS = ("npy", "npz", "mat", "h5")  # arrays alone: as files of heights of scenes, with rows along x
_ANGSTROM = ("\u00c5", "\u212b", "A", "angstrom")
_POINT = 3  # numbers in a line of x, y, z


def read(path: Path, unit: str | None = None, size: tuple[float, float] | None = None) -> HeightImage:
    """Return the image of heights in a file; of several channels the one that its format shows first.

    Heights that stand for none, such as 1e30, are left out. `unit` of lengths and heights and `size` along x and y [m]
    are for files that do not say them.
    Raises ContactError if SurfaceTopography is not there, or the file cannot be used.
    """
    return _read(path, unit, size).without_marks()


def _read(path: Path, unit: str | None, size: tuple[float, float] | None) -> HeightImage:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of packages that it can do without
            import SurfaceTopography
            from SurfaceTopography.IO import open_topography
    except ImportError as error:
        raise ContactError(
            f"Files of instruments are read by SurfaceTopography, which is not there ({error}). Install it by "
            "pip install 'tribofmu[surfaces]'."
        ) from None
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ContactError(f"The file '{path}' cannot be read: {error.strerror}.") from None
    digest, text = hashlib.sha256(content).hexdigest(), path.suffix.lower() in text_heights.SUFFIXES
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # it leaves files of arrays open
            reader = open_topography(io.BytesIO(content) if path.suffix == ".npy" else str(path))
            channel = reader.default_channel
            if text and len(channel.nb_grid_pts) == 2 and _POINT in channel.nb_grid_pts:
                raise ValueError("lines of x, y and z")
            array = reader.format() in _ARRAYS  # with y as the first index, for this library it is x
            asked = _asked(path, channel.unit, channel.physical_sizes, unit, size[::-1] if size and array else size)
            topography = channel.topography(**asked)
            heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=np.float64), np.nan)
    except ContactError:
        raise
    except Exception as error:  # of some forty readers, each with errors of its own
        found = text_heights.read(content) if text else None
        if found is not None:
            return _of_text(path, digest, found, unit, size)
        said = " ".join(str(error).split()) or type(error).__name__
        if len(said) > _LONGEST:
            said = "its format is none that is known, or it is damaged"
        raise ContactError(
            f"SurfaceTopography {SurfaceTopography.__version__} cannot read '{path}': {said}. Export the surface as "
            ".x3p (ISO 25178-72) or .sdf (ISO 25178-71)."
        ) from None
    if topography.dim != 2 or not topography.is_uniform or min(heights.shape) < LEAST:
        raise ContactError(_no_image(path, heights.shape))
    factor = _length(path, topography.unit)
    dx, dy = (factor * float(step) for step in topography.pixel_size)
    return HeightImage(
        heights=factor * (heights if array else heights.T),
        spacing=(dx, dy) if array else (dy, dx),
        source=path.name,
        digest=digest,
        format=f"{reader.name()} (.{reader.format()}), by SurfaceTopography {SurfaceTopography.__version__}"
        + ("; its first index is taken along y" if array else ""),
        remarks={"channel": str(channel.name), **dict(_remarks(topography.info))},
    )


def _of_text(
    path: Path, digest: str, found: text_heights.TextHeights, unit: str | None, size: tuple[float, float] | None
) -> HeightImage:
    """Return the image of heights in text, which never says its unit."""
    asked = _asked(path, None, None if found.spacing is None else "as its points say,", unit, size)
    ny, nx = found.heights.shape
    if min(ny, nx) < LEAST:
        raise ContactError(_no_image(path, found.heights.shape))
    factor = _length(path, asked["unit"])
    dx, dy = (length / n for length, n in zip(asked["physical_sizes"], (nx, ny), strict=True)) if size else (0.0, 0.0)
    spacing = (dy, dx) if found.spacing is None else found.spacing
    kind = "matrix of numbers" if found.spacing is None else "points x, y, z on a lattice"
    return HeightImage(
        factor * found.heights, (factor * spacing[0], factor * spacing[1]), path.name, digest, f"text, {kind}"
    )


def _no_image(path: Path, shape: tuple[int, ...]) -> str:
    return (
        f"'{path}' has no image of heights but the shape {shape}; {LEAST} points or more are needed each "
        "way. A profile does not say what a surface is like across it: measure an area."
    )


def _length(path: Path, unit: str) -> float:
    """Return a unit of length in m. Raises ContactError for another unit."""
    if unit in _ANGSTROM:
        return 1e-10
    factor, dimension = units.unit(_ascii(unit))
    if dimension[:4] != (1, 0, 0, 0):
        raise ContactError(f"'{path}' has heights in '{unit}', which is no length. Export heights.")
    return factor


def _asked(
    path: Path, own_unit: str | None, own_size: Any, unit: str | None, size: tuple[float, float] | None
) -> dict[str, Any]:
    """Return unit and size for the reader, as far as the file lacks them.

    Raises ContactError if one of them is given twice, by file and option, or not at all.
    """
    asked: dict[str, Any] = {}
    if own_unit is None and unit is None:
        raise ContactError(f"'{path}' does not say in which unit it is. Give --unit, such as --unit um.")
    if own_unit is not None and unit is not None:
        raise ContactError(f"'{path}' says that it is in {own_unit}. Leave --unit out.")
    if own_unit is None:
        asked["unit"] = unit
    if own_size is None and size is None:
        raise ContactError(f"'{path}' does not say how large it is. Give --size X Y, such as --size '1 mm' '1 mm'.")
    if own_size is not None and size is not None:
        raise ContactError(f"'{path}' says how large it is: {own_size} {own_unit or unit}. Leave --size out.")
    if own_size is None and size is not None:
        factor = _length(path, own_unit or unit or "")
        asked["physical_sizes"] = tuple(length / factor for length in size)
    return asked


def _ascii(unit: str) -> str:
    """Return a unit with u in place of either of the two letters mu."""
    return unit.replace("\u03bc", "u").replace("\u00b5", "u")


def _remarks(info: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield what a file says on instrument and measurement, in one line each."""
    for key in _TOLD:
        found = info.get(key)
        if isinstance(found, Mapping):
            yield from ((f"{key} {name}", _line(value)) for name, value in found.items())
        elif found is not None:
            yield key, _line(found)


def _line(value: object) -> str:
    return " ".join(str(value).split())[:_LONGEST]
