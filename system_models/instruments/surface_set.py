"""A measured patch as files: its heights, and a set that a scene takes, with how it was made in its comments."""

import math
from pathlib import Path

import numpy as np

from contact_core.laws.asperity_layer import AsperityLayer

from .image import HeightImage
from .patch import Patch

_BODIES = ("surface_1", "surface_2")


def lines(image: HeightImage, patch: Patch) -> list[str]:
    """Return what the image is, what was done to it and what came out, a line each."""
    (dy, dx), (ly, lx) = image.spacing, image.size
    said = [
        f"{image.source}, SHA-256 {image.digest}",
        f"format: {image.format}",
        *(f"{key}: {value}" for key, value in image.remarks.items() if value),
        f"window: {1e6 * lx:.6g} by {1e6 * ly:.6g} um, {image.heights.shape[1]} by {image.heights.shape[0]} points, "
        f"{1e6 * dx:.6g} by {1e6 * dy:.6g} um apart",
        f"points without a height: {100 * patch.missing:.3g} %, filled as smoothly as their edges allow",
        _form(patch),
        f"waves cut: longer than {_length(patch.longest)}, shorter than {_length(patch.shortest)}",
    ]
    said += [
        f"{stage}: Sq {1e9 * z.Sq:.4g} nm, Sa {1e9 * z.Sa:.4g} nm, Ssk {z.Ssk:.3g}" for stage, z in patch.stages.items()
    ]
    return [*said, _below(patch)]


def set_text(name: str, image: HeightImage, patch: Patch) -> str:
    """Return the file of a set `name`, for either body."""
    told = "".join(f"# {line}\n" for line in lines(image, patch))
    z = patch.stages["in the patch"]
    length = 2.0 * z.Sq / patch.slope
    layer = _layer(patch)
    body = [
        'model = "gaussian"',
        'rq = "0 nm"  # chosen: all roughness is that of the file',
        f'correlation_length = "{1e6 * length:.4g} um"  # 2 Sq / rms slope of the file; of no effect with rq = 0',
        "seed = 1  # chosen: of no effect with rq = 0",
        f'heights = {{ file = "{name}.npy", spacing = "{1e6 * patch.spacing!r} um", unit = "nm" }}',
        *([layer] if layer else ["# no microroughness: " + _below(patch)]),
    ]
    tables = "".join(f"\n[{name}.{each}]  # measured: {image.source}\n" + "\n".join(body) + "\n" for each in _BODIES)
    return f'# A measured surface, for one body or the other: set = "{name}.toml:{name}".\n{told}{tables}'


def write(name: str, folder: Path, image: HeightImage, patch: Patch) -> list[Path]:
    """Write NAME.npy and NAME.toml and return their paths."""
    heights, table = folder / f"{name}.npy", folder / f"{name}.toml"
    np.save(heights, 1e9 * patch.heights)
    table.write_text(set_text(name, image, patch), "utf-8")
    return [heights, table]


def _length(value: float | None) -> str:
    return "none" if value is None else f"{1e6 * value:.6g} um"


def _form(patch: Patch) -> str:
    form = patch.removed
    if form.name == "none":
        return "form removed: none but the mean"
    slopes = f"slopes {1e3 * form.slope[0]:.4g} and {1e3 * form.slope[1]:.4g} um/mm along x and y"
    radii = ", ".join(_radius(radius) for radius in form.radius)
    curved = "" if form.name == "plane" else f", radii of curvature {radii} (above 0: convex)"
    return f"form removed: {form.name}, {1e6 * form.peak_to_valley:.4g} um peak to valley; {slopes}{curved}"


def _radius(radius: float) -> str:
    return "none" if math.isinf(radius) else f"{1e3 * radius:.5g} mm"


def _below(patch: Patch) -> str:
    below = patch.below
    if below.rms is None:
        return f"roughness below the patch is not known from this file: {below.why}"
    return (
        f"roughness below the patch: {1e9 * below.rms:.3g} nm rms of waves from {1e6 * below.longest:.4g} down to "
        f"{1e6 * below.resolution:.4g} um; {100 * below.last_octave:.2g} % of the variance is in the shortest octave "
        "of these, shorter ones are not in this file"
    )


def _layer(patch: Patch) -> str:
    """Return the key of the roughness below the patch; an empty text if it is not known or the law refuses it."""
    below = patch.below
    if below.rms is None or AsperityLayer(below.rms, below.longest).error:
        return ""
    values = f'rms = "{1e9 * below.rms:.4g} nm", longest = "{1e6 * below.longest!r} um"'
    return f"microroughness = {{ {values} }}  # waves that the image resolves down to {1e6 * below.resolution:.4g} um"
