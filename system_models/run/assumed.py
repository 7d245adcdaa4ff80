"""What a scene assumes: values left to defaults as an attribute of a result, and what their intervals are worth."""

import json
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import fields
from typing import Any

import numpy as np
import xarray as xr

from contact_core import advance, initial_state
from contact_core.assumed import LEAST, OUTPUTS, RATES, Assumption, text
from contact_core.assumed import assumed as assumed_worth
from contact_core.errors import ContactError
from contact_core.film import Regression
from contact_core.scene import Assumed, Case, OperatingPoint, Scene
from contact_core.scene.intervals import replaced

from ..store.results import ASSUMED

_WORDS = {
    "friction_coefficient": "friction", "h_c": "film", "contact_load_ratio": "W_c", "wear_depth": "wear",
    "tribofilm": "tribofilm",
}  # fmt: skip
_MUCH, _MOST = 0.3, 3  # share of a half width from which on its cause is named, and how many are
ATTRIBUTE = "assumed_json"  # of a result: key, value, where it comes from, kind of each


def attribute(assumed: Sequence[Assumed]) -> dict[str, str]:
    return {ATTRIBUTE: json.dumps([list(each) for each in assumed])}


def stored(attributes: Mapping[str, Any]) -> list[Assumed] | None:
    """Return the assumptions of a result from its attributes; None if an older version made it, without them."""
    text = attributes.get(ATTRIBUTE)
    return None if text is None else [Assumed(*each) for each in json.loads(text)]


def not_in_errors(attributes: Mapping[str, Any]) -> list[str]:
    """Return a sentence on the laws that are off, which no error of a result has in it."""
    off = [each.key for each in stored(attributes) or [] if each.kind == "off"]
    return [f"In no error: what is off ({', '.join(off)})."] if off else []


def with_half_widths(dataset: xr.Dataset, scene: Scene) -> xr.Dataset:
    """Return a contact's result with half widths by what its scene assumes as coordinates, in their outputs' units.

    That of `h_c` is `h_c_assumed`. They are those of `contact_core.assumed` at each row's operating point, to two
    digits of it.
    """
    if not scene.intervals:
        return dataset
    points = [_rounded(point) for point in _points(dataset)]
    worth: dict[OperatingPoint, dict[str, float]] = {}
    for point in dict.fromkeys(points):
        with suppress(ContactError):  # the regression level has no answer there
            worth[point] = {name: each.together for name, each in assumed_worth(scene, point).items()}
    halves = {}
    for output in OUTPUTS:
        halved = np.array([worth.get(point, {}).get(output, math.nan) for point in points])
        for name in (output, f"{output}_1", f"{output}_2"):
            if name in dataset.data_vars:
                variable = dataset.variables[name]
                half = halved * np.abs(variable.values) if output in RATES else halved
                text = f"half width of {name} by what the scene assumes"
                attributes = {"units": variable.attrs.get("units", "1"), "long_name": text}
                halves[f"{name}{ASSUMED}"] = (variable.dims, half, attributes)
    return dataset.assign_coords(halves)


def _points(dataset: xr.Dataset) -> list[OperatingPoint]:
    names = [f.name for f in fields(OperatingPoint) if f.name in dataset]
    columns = [dataset.variables[name].values.tolist() for name in names]
    return [OperatingPoint(**dict(zip(names, row, strict=True))) for row in zip(*columns, strict=True)]


def _rounded(point: OperatingPoint) -> OperatingPoint:
    """Return a point with numbers of two digits, temperatures of one kelvin: its worth changes little between them."""
    digits: dict[str, Any] = {
        name: value if value is None else float(f"{value:.3g}" if "temperature" in name else f"{value:.2g}")
        for name, value in vars(point).items()
    }
    return OperatingPoint(**digits)


def of_microroughness(case: Case, bare: Sequence[str]) -> str:
    """Return a sentence on friction by the regression level, without and with the roughness that bare surfaces lack.

    Empty if nothing is known of it: of heights from a file.
    """
    scene, op = case.scene, case.op
    lacking = {f"{surface}.microroughness.rms" for surface in bare}
    worth = {key: i.ends(scene)[1][key] for i in scene.intervals for key in i.keys if key in lacking}
    if not worth:
        return ""
    fast = scene.at_level(Regression.name)
    rough = fast
    for key, most in worth.items():
        rough = replaced(rough, key, most)
    with suppress(ContactError):
        low, high = (advance(each, op, initial_state(each), 0.0)[1].friction_coefficient for each in (fast, rough))
        return f"friction {low:.2g} without, {high:.2g} with the most that is usual. "
    return ""


def sentence(scene: Scene, dataset: xr.Dataset) -> list[str]:
    """Return a line on the half widths by what a scene assumes at the end of its run, and on what most of them is."""
    if not scene.intervals or not dataset.sizes.get("time"):
        return []
    try:
        worth = assumed_worth(scene, _points(dataset.isel(time=[-1]))[0])
    except ContactError:
        return []
    parts = [f"{_WORDS[name]} {_told(name, each)}" for name, each in worth.items() if each.together >= LEAST[name]]
    return [f"Assumed, beside these errors, of new surfaces: {'; '.join(parts)}."] if parts else []


def _told(output: str, worth: Assumption) -> str:
    """Return a half width, and the assumptions that make most of it."""
    most = [key for key, half in worth.parts.items() if half > _MUCH * worth.together][:_MOST]
    return f"+- {text(output, worth.together)} (by {', '.join(most)})"
