"""What a finish such as "ground" says of a surface: data/finishes.toml, with sources and intervals.

Roughness rq with its correlation length for a grid, and what is shorter than 4 um as microroughness: none counts twice,
as the shortest waves of Gaussian heights are 0.7 of their correlation length.
"""

import math
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

from ..errors import SceneError, did_you_mean
from .surface import Surface
from .toml import flat, read_table
from .units import parse

FILE = Path(str(files("contact_core"))) / "data" / "finishes.toml"
LENGTH_PER_RQ = 40.0  # of roughness, at least: rms slopes stay below 0.05
LAYS = ("along", "across")  # of the motion
MOST_BELOW = 0.5  # rms of the waves under `LONGEST` over rq, at most: ends of the intervals in data/finishes.toml
LONGEST = 4e-6  # m
_FAR = 4.0  # largest factor between a surface's rq and that of its finish over which microroughness scales with rq


def finishes() -> list[str]:
    """Return the names of all finishes."""
    return list(read_table(FILE, "finish"))


def values_of_finish(name: str) -> dict[str, Any]:
    """Return the values of a finish. Raises SceneError for an unknown one, with the list."""
    table = read_table(FILE, "finish")
    if name not in table:
        raise SceneError(f"There is no finish '{name}'.{did_you_mean(name, list(table))} Known are {', '.join(table)}.")
    return {key: value for key, value in table[name].items() if key != "intervals"}


def ends_of_finish(name: str) -> dict[str, tuple[str, str]]:
    """Return the interval of each value of a finish, as percentages of it, by its key within the surface's table."""
    found: Mapping[str, list[str]] = read_table(FILE, "finish")[name]["intervals"]
    own = flat(values_of_finish(name))
    return {key: tuple(_percent(end, own[key]) for end in ends) for key, ends in found.items()}  # type: ignore[misc]


def _percent(end: str, value: str) -> str:
    return f"{100.0 * (parse(end, 'm', 'end') / parse(value, 'm', 'value') - 1.0):+.0f} %"


def part_below(rq: float, own_rq: float) -> float:
    """Return the factor on a finish's microroughness where a surface has an rq [m] of its own beside it.

    Measured spectra of surfaces of the same finish are similar: their shorter waves go with rq, within reason. A file
    of heights (rq = 0) says nothing of them.
    """
    return min(max(rq / own_rq, 1.0 / _FAR), _FAR) if rq > 0.0 else 1.0


def longest_below(length: float) -> float:
    """Return the longest wave [m] of microroughness beside Gaussian heights of a correlation length [m].

    No wave counts twice.
    """
    return min(LONGEST, 0.99 * 2.0 * math.pi / Surface.reach * length)
