"""Measured numbers against time, which the constants of a scene are fitted to: docs/how-to/fit.md.

A table as `duty_table` reads it, in any order of times, with empty cells. Columns are outputs, each with the standard
deviation of its numbers (`_sd`) or without, and inputs: rows with the same inputs are of one test from time 0 on.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from math import inf
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact_core import OperatingPoint, Scene
from contact_core.errors import SceneError
from contact_core.kernels.arrays import Array, Indices, Mask
from contact_core.quantities import CELSIUS, INPUTS, OUTPUTS, Quantity, measured_range

from . import duty_table

SD = "_sd"  # after the name of an output: its standard deviation
# a temperature of degC and a difference of K share their unit; errors are not measured
MEASURABLE = {q.name: q for q in OUTPUTS if q.kind == "Real" and q.unit != "K" and not q.name.startswith("error_")}
_HELD_BY = 20160112  # seed of the choice of points that are held back


@dataclass(frozen=True)
class Measured:
    """Measured numbers in SI, one an entry of each array, by quantity, test and time."""

    quantity: NDArray[np.str_]
    test: Indices  # index of `tests`
    time: Array  # [s] since its test began
    value: Array
    sd: Array  # standard deviation; 0: not given
    tests: tuple[OperatingPoint, ...]
    source: str  # name of the file
    digest: str  # of its bytes

    def __len__(self) -> int:
        return len(self.value)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of the measured outputs, in the order of the points."""
        return tuple(dict.fromkeys(self.quantity.tolist()))

    def held_back(self, share: float) -> Mask:
        """Return which points to hold back: about a share of them, one at random of each stretch, always the same."""
        count = min(round(share * len(self)), len(self) - 1)
        held = np.zeros(len(self), np.bool_)
        edges = np.linspace(0.0, len(self), count + 1)
        random = np.random.default_rng(_HELD_BY)
        for first, end in pairwise(np.ceil(edges).astype(int)):
            held[random.integers(first, end)] = True
        return held


def read(path: Path, scene: Scene, level: str) -> Measured:
    """Return the measured numbers of a file; inputs without a column are those of the scene's `[operation]`.

    Raises SceneError with one sentence that names file, line, column, value and remedy.
    """
    known = {
        name: replace(q, minimum=-most, maximum=most)
        for name, q in MEASURABLE.items()
        for most in [measured_range(q)[1]]
    }
    spread = {f"{name}{SD}": replace(q, name=f"{name}{SD}") for name, q in known.items()}
    inputs = {f.name: q for f in fields(OperatingPoint) for q in INPUTS if q.name == f.name}
    found: list[tuple[str, OperatingPoint, float, float, float]] = []
    for where, (time, values) in duty_table.rows_of(path, inputs | known | spread, "data", {*known, *spread}):
        _check(path, where, time, values, level, scene)
        point = replace(scene.operation.point, **{name: x for name, x in values.items() if name in inputs})
        found += [(name, point, time, x, values.get(f"{name}{SD}", 0.0)) for name, x in values.items() if name in known]
    if not found:
        raise SceneError(f"{path}: no row has a measured number. Give a column such as 'tribofilm_1 [nm]'.")
    for name in {row[0] for row in found if MEASURABLE[row[0]].minimum >= 0.0}:  # scatter may bring some below 0
        least, most = (extreme(row[3] for row in found if row[0] == name) for extreme in (min, max))
        if most < 0.0:
            raise SceneError(f"{path}: every '{name}' is below 0, which it cannot be. Check its sign.")
        if least < -most:
            raise SceneError(
                f"{path}: {name} = {least:g} is further below 0 than any other is above it, which scatter does not do. "
                "Leave cells empty where nothing was measured."
            )
    tests = tuple(sorted({row[1] for row in found}, key=_order))
    names = list(dict.fromkeys(row[0] for row in found))
    found.sort(key=lambda row: (names.index(row[0]), tests.index(row[1]), row[2]))
    return Measured(
        np.array([row[0] for row in found]),
        np.array([tests.index(row[1]) for row in found]),
        time=np.array([row[2] for row in found]),
        value=np.array([row[3] for row in found]),
        sd=np.array([row[4] for row in found]),
        tests=tests,
        source=path.name,
        digest=hashlib.sha256(path.read_bytes()).hexdigest()[:16],
    )


def _order(point: OperatingPoint) -> list[float]:
    values = (getattr(point, f.name) for f in fields(point))
    return [-inf if value is None else value for value in values]


def _check(path: Path, where: str, time: float, values: dict[str, float], level: str, scene: Scene) -> None:
    """Raise SceneError for a row that no run of the scene at the level can have."""
    for name in values:
        output = MEASURABLE.get(name.removesuffix(SD))
        if output is None:
            continue
        if not {level, "regression"} <= {*output.levels}:
            raise SceneError(
                f"{path}: level 'regression', at which every fit begins, has no '{output.name}'; only "
                f"{' and '.join(output.levels)} has it. Leave that column out."
            )
        if name.endswith(SD) and output.name not in values:
            raise SceneError(f"{where}: '{name}' is given, but '{output.name}' is not. Give both or neither.")
        if name.endswith(SD) and values[name] <= 0.0:
            raise SceneError(f"{where}: {name} = {values[name]:g} {output.unit} must be above 0. Or leave it empty.")
    if not 0.0 <= time <= scene.operation.duration:
        raise SceneError(
            f"{where}: time = {time:g} s is not between 0 and operation.duration = {scene.operation.duration:g} s of "
            f"the scene. Check its unit, or use --set operation.duration='{time:g} s'."
        )


def words(tests: Sequence[OperatingPoint]) -> list[str]:
    """Return a few words for each test: the inputs in which they differ, in the units people read."""
    differing = [f.name for f in fields(OperatingPoint) if len({getattr(test, f.name) for test in tests}) > 1]
    return [", ".join(_input(name, getattr(test, name)) for name in differing) or "the test" for test in tests]


def _input(name: str, value: float | None) -> str:
    if value is None:
        return f"{name} of the scene"
    q: Quantity = next(q for q in INPUTS if q.name == name)
    return f"{value - CELSIUS:.4g} °C" if q.display == "degC" else f"{name} {value:.4g} {q.unit}"
