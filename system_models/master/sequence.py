"""In which order FMUs step, and which of them form a loop: from the graph, never from the order of listing."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy  # its parts are loaded at their first use
from numpy.typing import NDArray

from ..fmu.instance import Instance
from ..numerics.algorithms import ALGORITHMS
from .settings import Settings
from .system import System


@dataclass(frozen=True)
class Block:
    """FMUs that depend on one another around a loop, or one alone.

    sequence: name and which of its own inputs are fresh: set by FMUs that have stepped before it. Of the inputs of the
    whole system, unknown: those that an iteration has to find; outside: those set from other blocks.
    """

    sequence: list[tuple[str, NDArray[np.intp]]]
    unknown: NDArray[np.intp]
    outside: NDArray[np.intp]

    @property
    def names(self) -> list[str]:
        return [name for name, _ in self.sequence]


def blocks(system: System, instances: Mapping[str, Instance], inputs: list[str], settings: Settings) -> list[Block]:
    """Return the blocks in the order of the signals; all FMUs are in one unless loops are iterated."""
    visible, loops = ALGORITHMS[settings.algorithm], settings.iterate is not None
    order = _gauss_seidel_order(system, instances)
    source = {c.target.name: c.source.model.name for c in system.connections}
    groups = order if loops else [[name for group in order for name in group]]
    result, before = [], set[str]()
    for group in groups:
        within = [n for n, name in enumerate(inputs) if name.partition(".")[0] in group]
        stepped, sequence, fresh_inputs = list[str](), [], set[str]()
        for name in group:
            own = [f"{name}.{variable}" for variable in instances[name].inputs.names]
            seen = before.union(visible(stepped))
            fresh = [n for n, target in enumerate(own) if source[target] in seen]
            fresh_inputs |= {own[n] for n in fresh}
            sequence.append((name, np.array(fresh, dtype=np.intp)))
            stepped.append(name)
        unknown = [n for n in within if inputs[n] not in fresh_inputs]
        outside = [n for n in within if source[inputs[n]] in before]
        result.append(Block(sequence, *(np.array(which, dtype=np.intp) for which in (unknown, outside))))
        before |= set(group)
    return result


def direct_loops(system: System) -> list[list[str]]:
    """Return coupled Real inputs around a loop of outputs that depend on them directly, as the FMUs declare it."""
    source = {c.target.name: c.source for c in system.connections if c.coupled}
    edges = [
        (f"{port.model.name}.{known}", target)
        for target, port in source.items()
        for known in port.model.declared_dependencies.get(port.variable.name, ())
        if f"{port.model.name}.{known}" in source
    ]
    loops = sorted_loops(sorted(source), edges)
    return [loop for loop in loops if len(loop) > 1 or (loop[0], loop[0]) in edges]


def feedthrough_order(system: System, instances: Mapping[str, Instance]) -> list[str]:
    """Return the FMUs with outputs that depend directly on coupled inputs, each after those that it depends on."""
    return [name for group in _gauss_seidel_order(system, instances) for name in group if instances[name].feedthrough]


def _gauss_seidel_order(system: System, instances: Mapping[str, Instance]) -> list[list[str]]:
    """Return loops of FMUs in the order of the signals; in a loop those first whose outputs do not wait for inputs.

    Of these, those first that the schedule sets, and next those that they set: a change arrives within the step.
    """
    names, reached = list(instances), _distances(system)
    result = []
    for loop in sorted_loops(names, [(c.source.model.name, c.target.model.name) for c in system.connections]):
        direct = [name for name in loop if instances[name].feedthrough]
        waits = [
            (c.source.model.name, c.target.model.name)
            for c in system.connections
            if c.source.model.name in direct and c.target.model.name in direct
        ]
        calm = sorted((name for name in loop if name not in direct), key=lambda name: reached.get(name, math.inf))
        result.append(calm + [name for group in sorted_loops(direct, waits) for name in group])
    return result


def _distances(system: System) -> dict[str, int]:
    """Return the number of connections over which the schedule reaches each FMU."""
    found: dict[str, int] = {}
    front = {target.partition(".")[0] for target in system.schedule}
    while front:
        found |= dict.fromkeys(front, max(found.values(), default=-1) + 1)
        ends = {c.target.model.name for c in system.connections if c.source.model.name in front}
        front = ends - found.keys()
    return found


def sorted_loops(names: list[str], edges: list[tuple[str, str]]) -> list[list[str]]:
    """Return strongly connected components in topological order; where that leaves a choice, by name."""
    number = {name: n for n, name in enumerate(names)}
    if not names:
        return []
    pairs = sorted({(number[a], number[b]) for a, b in edges})
    rows, columns = [a for a, _ in pairs], [b for _, b in pairs]
    graph = scipy.sparse.coo_array((np.ones(len(pairs)), (rows, columns)), shape=(len(names), len(names)))
    count, labels = scipy.sparse.csgraph.connected_components(graph, connection="strong")
    groups = [[name for name, label in zip(names, labels, strict=True) if label == n] for n in range(count)]
    waiting = {n: {int(labels[a]) for a, b in pairs if labels[b] == n and labels[a] != n} for n in range(count)}
    result = []
    while waiting:
        ready = min((n for n, needs in waiting.items() if not needs), key=lambda n: groups[n])
        result.append(groups[ready])
        del waiting[ready]
        for needs in waiting.values():
            needs.discard(ready)
    return result
