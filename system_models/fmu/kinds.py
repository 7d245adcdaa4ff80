"""Kinds of variables, whatever the version of FMI calls their types."""

from fmpy.model_description import ModelVariable

REAL = ("Real", "Float64", "Float32")
INTEGER = ("Integer", "Enumeration", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64")
KINDS = {**dict.fromkeys(REAL, "real"), **dict.fromkeys(INTEGER, "integer"), "Boolean": "boolean", "String": "string"}


def kind(variable: ModelVariable) -> str:
    """Return the kind of a variable: real, integer, boolean or string; its type if it is none of them."""
    return KINDS.get(variable.type, variable.type)


def discrete(variable: ModelVariable) -> bool:
    """Return True if a variable keeps its value between communication points."""
    return bool(variable.variability == "discrete")
