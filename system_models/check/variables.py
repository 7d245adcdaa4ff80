"""Attributes of a variable in fmpy's model description."""

import math
from collections.abc import Mapping

from fmpy.model_description import ModelVariable

from ..fmu.kinds import kind

Start = Mapping[str, float | int | str]  # values by name

_REALS = {"Real", "Float32", "Float64"}
_KINDS = {"real", "integer", "boolean", "string"}
_MILLION = 1e6


def is_real(variable: ModelVariable) -> bool:
    """Return True for variables of floating-point type."""
    return variable.type in _REALS


def is_readable(variable: ModelVariable) -> bool:
    """Return True for a single number, Boolean or String; FMI 3.0 has arrays, clocks and binary data, too."""
    return kind(variable) in _KINDS and not variable.dimensions


def attribute(variable: ModelVariable, name: str) -> str | None:
    """Return `unit`, `nominal`, `min` or `max` of a variable, its declared type's where it has none of its own."""
    own = getattr(variable, name)
    return getattr(variable.declaredType, name) if own is None and variable.declaredType is not None else own


def magnitude(variable: ModelVariable) -> float:
    """Return the nominal value of a Real, else its start value, else 1."""
    for text in (attribute(variable, "nominal"), variable.start):
        value = abs(float(text or 0.0))
        if value and math.isfinite(value):
            return value
    return 1.0


def clipped(variable: ModelVariable, value: float) -> float:
    """Return `value` within the declared range."""
    low, high = attribute(variable, "min"), attribute(variable, "max")
    if low is not None:
        value = max(value, float(low))
    return value if high is None else min(value, float(high))


def is_free(variable: ModelVariable) -> bool:
    """Return True unless the declared range is a single value."""
    low, high = attribute(variable, "min"), attribute(variable, "max")
    return low is None or high is None or float(low) < float(high)


def elsewhere(variable: ModelVariable) -> list[float]:
    """Return the start value moved by the magnitude, up and down, within the declared range."""
    start = float(variable.start or 0.0)
    return sorted({clipped(variable, start + step) for step in (-magnitude(variable), magnitude(variable))} - {start})


def extremes(variable: ModelVariable) -> list[float]:
    """Return both ends of the declared range, at most a million magnitudes from zero, and zero if within."""
    far = _MILLION * magnitude(variable)
    ends = [attribute(variable, "min"), attribute(variable, "max")]
    values = [clipped(variable, min(max(float(end), -far), far)) for end in ends if end is not None]
    return sorted({*values, *([0.0] if clipped(variable, 0.0) == 0.0 else [])})
