"""Kinds of variables, whatever the version of FMI calls their types."""

from fmpy.model_description import ModelVariable

NUMBERS = ("real", "float")  # kinds that have a unit and can be scaled
REAL = ("Real", "Float64")  # coupled as a continuous signal; the other types are passed on at communication points
INTEGER = ("Integer", "Enumeration", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64")
_KINDS = {**dict.fromkeys(REAL, "real"), "Float32": "float", **dict.fromkeys(INTEGER, "integer")}
_KINDS |= {"Boolean": "boolean", "String": "string"}


def kind(variable: ModelVariable) -> str:
    """Return the kind of a variable: real, float, integer, boolean or string.

    A real one is continuous; those that keep their value between communication points count as float.
    """
    if variable.type in REAL and variable.variability == "discrete":
        return "float"
    return _KINDS.get(variable.type, variable.type)
