"""Names of variables in C."""

import re


def c_name(name: str) -> str:
    """Return the name of a variable in C: load_1 of load[1]."""
    return re.sub(r"\W+", "_", name).strip("_")
