"""Kinds of variables, whatever the version of FMI calls their types."""

from typing import Any

import numpy as np
from fmpy.model_description import ModelVariable

REAL = ("Real", "Float64", "Float32")
INTEGER = ("Integer", "Enumeration", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64")
KINDS = {**dict.fromkeys(REAL, "real"), **dict.fromkeys(INTEGER, "integer"), "Boolean": "boolean", "String": "string"}


def kind(variable: ModelVariable) -> str:
    """Return the kind of a variable: real, integer, boolean or string; its type if it is none of them."""
    return KINDS.get(variable.type, variable.type)


def holds(variable: ModelVariable, value: Any) -> bool:
    """Return False for a number that the C type of a variable cannot have, and would wrap or make infinite."""
    if variable.type == "Float32":
        return bool(abs(value) <= float(np.finfo(np.float32).max))
    if KINDS.get(variable.type) != "integer":
        return True
    limits = np.iinfo({"Integer": "int32", "Enumeration": "int64"}.get(variable.type, variable.type.lower()))
    return bool(limits.min <= value <= limits.max)


def discrete(variable: ModelVariable) -> bool:
    """Return True if a variable keeps its value between communication points."""
    return bool(variable.variability == "discrete")
