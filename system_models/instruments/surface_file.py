"""Reads the formats that instruments write for surfaces, by SurfaceTopography (the extra `surfaces`)."""

import hashlib
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from contact_core.errors import ContactError
from contact_core.scene import units

from .image import LEAST, HeightImage

_TOLD = ("instrument", "acquisition_time", "software", "comment")  # of what a file says beside its heights
_LONGEST = 200  # characters of a remark


def read(path: Path, unit: str | None = None, size: tuple[float, float] | None = None) -> HeightImage:
    """Return the image of heights in a file; of several channels the one that its format shows first.

    `unit` of lengths and heights and `size` along x and y [m] are for files that do not say them.
    Raises ContactError if SurfaceTopography is not there, or the file cannot be used.
    """
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
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            reader = open_topography(str(path))
            channel = reader.default_channel
            asked = _asked(path, channel.unit, channel.physical_sizes, unit, size)
            topography = channel.topography(**asked)
            heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=np.float64), np.nan)
    except ContactError:
        raise
    except Exception as error:  # of some forty readers, each with errors of its own
        said = str(error) or type(error).__name__
        raise ContactError(
            f"SurfaceTopography {SurfaceTopography.__version__} cannot read '{path}': {said}. Export the surface as "
            ".x3p (ISO 25178-72) or .sdf (ISO 25178-71)."
        ) from None
    if topography.dim != 2 or not topography.is_uniform or min(heights.shape) < LEAST:
        raise ContactError(
            f"'{path}' has no image of heights but the shape {heights.shape}; {LEAST} points or more are needed each "
            "way. A profile does not say what a surface is like across it: measure an area."
        )
    factor, dimension = units.unit(_ascii(topography.unit))
    if dimension[:4] != (1, 0, 0, 0):
        raise ContactError(f"'{path}' has heights in '{topography.unit}', which is no length. Export heights.")
    dx, dy = (factor * float(step) for step in topography.pixel_size)
    return HeightImage(
        heights=factor * heights.T,
        spacing=(dy, dx),
        source=path.name,
        digest=hashlib.sha256(content).hexdigest(),
        format=f"{reader.name()} (.{reader.format()}), by SurfaceTopography {SurfaceTopography.__version__}",
        remarks={"channel": str(channel.name), **dict(_remarks(topography.info))},
    )


def _asked(
    path: Path, own_unit: str | None, own_size: Any, unit: str | None, size: tuple[float, float] | None
) -> dict[str, Any]:
    """Return what the reader is told beside the file. Raises ContactError for what is told twice or not at all."""
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
        factor = units.unit(_ascii(own_unit or unit or ""))[0]
        asked["physical_sizes"] = tuple(length / factor for length in size)
    return asked


def _ascii(unit: str) -> str:
    """Return a unit with the one of the two letters mu that is known here."""
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
