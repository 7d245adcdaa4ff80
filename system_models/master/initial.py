"""Consistent initial values: each connected input has the value of its source, while the FMUs are being initialised.

Connections are worked through in the order of the initial dependencies; a loop is cut at few and solved for these.
"""

import logging
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from fmpy.fmi1 import FMICallException, fmi1Discard

from contact_core.kernels.arrays import Array

from ..fmu.errors import CouplingError
from ..fmu.instance import Instance
from ..numerics.control import scale, wrms
from ..numerics.quasi_newton import QuasiNewton
from .sequence import sorted_loops
from .system import Connection

Edges = set[tuple[str, str]]

log = logging.getLogger(__name__)

_MOST_PASSES = 20  # until discrete values around a loop come to rest


def initialise(
    instances: Mapping[str, Instance], connections: Iterable[Connection], tolerance: float = 1e-10, most: int = 100
) -> int:
    """Set the connected inputs of FMUs that are being initialised, and return how many evaluations that took.

    tolerance: of the inputs at which a loop is cut, relative and in the unit of `nominal`. most: evaluations of a loop
    between changes of its discrete values. It is solved from the start values of these inputs, so that of several
    solutions always the same is found. Raises CouplingError if none is.
    """
    by_target = {connection.target.name: connection for connection in connections}
    edges = _edges(by_target)
    evaluations = 0
    for names in sorted_loops(sorted(by_target), sorted(edges)):
        loop = _Loop(instances, by_target, names, edges)
        evaluations += loop.solve(tolerance, most)
    return evaluations


def with_feedthrough(instances: Mapping[str, Instance], names: list[str]) -> list[str]:
    """Return those of some FMUs that give outputs for inputs newly set, without a step between: FMI 2 leaves it open.

    The outputs of the others follow their inputs a step later.
    """
    return [name for name in names if _gives_outputs(instances[name])]


def _gives_outputs(instance: Instance) -> bool:
    state = instance.save() if instance.model.restores else None
    try:
        instance.read()
        variables = [instance.model.variables[own] for own in instance.inputs.names]
        instance.inputs.values[:] = [instance.get(variable) for variable in variables]
        instance.set_inputs()
        instance.read()
    except FMICallException as error:
        if state is None:
            raise instance.failure("to give outputs after its inputs were set", error) from error
        log.info("The FMU '%s' refuses outputs before a step; they lag behind its inputs.", instance.name)
        instance.restore(state)
        instance.feedthrough = False
    finally:
        if state is not None:
            instance.release(state)
    return instance.feedthrough


def _edges(by_target: Mapping[str, Connection]) -> Edges:
    """Return pairs of connected inputs, by name, of which the first must be known to work out the second."""
    edges = set()
    for name, connection in by_target.items():
        model = connection.source.model
        inputs = (v.name for v in model.variables.values() if v.causality == "input")
        needed = model.initial_dependencies.get(connection.source.variable.name, inputs)
        edges |= {(f"{model.name}.{known}", name) for known in needed if f"{model.name}.{known}" in by_target}
    return edges


class _Loop:
    """Connections that depend on one another, or one alone."""

    def __init__(
        self, instances: Mapping[str, Instance], by_target: Mapping[str, Connection], names: list[str], edges: Edges
    ) -> None:
        self._instances, self._names = instances, names
        discrete = {name for name in names if by_target[name].source.kind != "real"}
        cuts, order = _cut(names, edges, discrete)
        self._chain = [by_target[name] for name in order]
        self._reals = [by_target[name] for name in cuts if name not in discrete]
        self._discrete = [by_target[name] for name in cuts if name in discrete]

    def solve(self, tolerance: float, most: int) -> int:
        """Set the inputs, and return how many times all of them were worked out."""
        evaluations = 0
        targets = [connection.target for connection in self._reals]
        values = np.array([self._instances[t.model.name].get(t.variable) for t in targets], dtype=float)
        discrete: list[Any] = []
        for _ in range(_MOST_PASSES):
            values, count = self._solved(values, tolerance, most)
            evaluations += count
            before, discrete = discrete, [self._result(connection) for connection in self._discrete]
            if discrete == before:
                return evaluations
            for connection, value in zip(self._discrete, discrete, strict=True):
                self._set(connection, value)
        raise CouplingError(
            f"The initial values of the loop {', '.join(self._names)} do not come to rest: after {_MOST_PASSES} passes "
            f"'{self._discrete[0].target.name}' still changes. Break the loop: leave out one of its connections."
        )

    def _solved(self, values: Array, tolerance: float, most: int) -> tuple[Array, int]:
        """Return the inputs at the cuts, from a guess, and how many evaluations they took."""
        nominal = np.array([connection.target.nominal or 1.0 for connection in self._reals])
        method = QuasiNewton()
        method.start(scale(tolerance, nominal, values))
        for count in range(1, most + 1):
            results = self._evaluated(values)
            if count == 1 and not np.isfinite(results).all():
                raise CouplingError(
                    f"The loop {', '.join(self._names)} has no values to begin with: from its start values "
                    f"{self._listed(values)} it gives {self._listed(results)}. "
                    "Give other start values by `parameters`, or break the loop."
                )
            if wrms(results - values, scale(tolerance, nominal, values)) <= 1.0:
                return values, count
            last, values = values, method.next(values, results)
        raise CouplingError(
            f"The initial values of the loop {', '.join(self._names)} do not converge: after {most} evaluations, "
            f"{self._listed(last)} gives {self._listed(results)}. "
            "Give start values near a solution by `parameters`, or break the loop."
        )

    def _listed(self, values: Array) -> str:
        pairs = zip(self._reals, values, strict=True)
        return ", ".join(f"'{connection.target.name}' = {value:.9g}" for connection, value in pairs)

    def _evaluated(self, values: Array) -> Array:
        """Return the inputs at the cuts that follow from inputs there, NaN where an FMU cannot say."""
        try:
            for connection, value in zip(self._reals, values, strict=True):
                self._set(connection, float(value))
            for connection in self._chain:
                self._set(connection, self._result(connection))
            return np.array([self._result(connection) for connection in self._reals], dtype=float)
        except _UndefinedError:
            if not self._reals:
                raise
            return np.full(len(values), np.nan)

    def _result(self, connection: Connection) -> Any:
        instance = self._instances[connection.source.model.name]
        with _named(instance, f"to give '{connection.source.name}'"):
            return connection.result(instance.get(connection.source.variable))

    def _set(self, connection: Connection, value: Any) -> None:
        instance = self._instances[connection.target.model.name]
        with _named(instance, f"to take '{connection.target.name}' = {value!r}"):
            instance.set(connection.target.variable, value)


class _UndefinedError(CouplingError):
    """An output is undefined for these inputs, and may be defined for others."""


@contextmanager
def _named(instance: Instance, what: str) -> Iterator[None]:
    try:
        yield
    except FMICallException as error:
        failure = instance.failure(f"{what} while it was initialised", error)
        raise (_UndefinedError(str(failure)) if error.status == fmi1Discard else failure) from error


def _cut(names: list[str], edges: Edges, discrete: set[str]) -> tuple[list[str], list[str]]:
    """Return inputs without which the others depend on one another in an order, and these in that order.

    Discrete ones are cut first, then those through which most pairs of others hang together.
    """
    cuts: list[str] = []
    while True:
        left = [name for name in names if name not in cuts]
        among = sorted((a, b) for a, b in edges if a in left and b in left)
        groups = sorted_loops(left, among)
        loop = next((g for g in groups if len(g) > 1 or (g[0], g[0]) in edges), None)
        if loop is None:
            return sorted(cuts), [name for group in groups for name in group]

        inner = [(a, b) for a, b in among if a in loop and b in loop]
        rank = {
            name: (name in discrete, sum(a == name for a, _ in inner) * sum(b == name for _, b in inner))
            for name in loop
        }
        cuts.append(max(loop, key=rank.__getitem__))
