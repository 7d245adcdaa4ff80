"""Connections as arrays over the Real variables of all FMUs."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contact_core.arrays import Array

from ..fmu.instance import Instance, Reals
from .system import Port, System

Places = NDArray[np.intp]


class _Ends(NamedTuple):
    """The two outputs of a bond and the inputs that they set, by place, and watt per product of the outputs."""

    watt: float
    effort: int
    effort_received: int
    flow: int
    flow_received: int


class Wiring:
    """The coupled Real variables of a system.

    outputs, inputs: names of all of them
    output_of, input_of: slice of the outputs and inputs that belong to an FMU
    source, factor, offset [inputs]: number of the output that sets an input, and the conversion of its unit
    sampled [inputs]: True if the input holds its value between communication points
    coupled: numbers of the outputs that set an input, if only at events
    beside [coupled]: slice of the inputs of the FMU that has this output
    """

    def __init__(self, system: System, instances: Mapping[str, Instance]) -> None:
        self.output_of, self.outputs = _index({name: instance.outputs for name, instance in instances.items()})
        self.input_of, self.inputs = _index({name: instance.inputs for name, instance in instances.items()})
        self.output_place = {name: n for n, name in enumerate(self.outputs)}
        self.input_place = {name: n for n, name in enumerate(self.inputs)}
        by_target = {connection.target.name: connection for connection in system.connections}
        wired = [by_target[name] for name in self.inputs]
        self.source: Places = np.array([self.output_place[c.source.name] for c in wired], dtype=np.intp)
        self.factor = np.array([c.factor for c in wired])
        self.offset = np.array([c.offset for c in wired])
        self.sampled = np.array([c.sampled for c in wired], dtype=bool)
        sources = {self.output_place[c.source.name] for c in system.connections if c.source.kind == "real"}
        self.coupled: Places = np.array(sorted(sources), dtype=np.intp)
        self.beside = [self.input_of[self.outputs[n].partition(".")[0]] for n in self.coupled]
        self._bonds = [
            _Ends(
                bond.watt * math.copysign(1.0, bond.effort.factor * bond.flow.factor),
                self.output_place[bond.effort.source.name],
                self.input_place[bond.effort.target.name],
                self.output_place[bond.flow.source.name],
                self.input_place[bond.flow.target.name],
            )
            for bond in system.bonds
        ]

    def inputs_from(self, outputs: Array, inputs: slice | Places = slice(None)) -> Array:
        """Return the inputs that follow from outputs, all of them or some."""
        return outputs[self.source[inputs]] * self.factor[inputs] + self.offset[inputs]

    def power_residuals(self, outputs: Array, held: Array | None) -> list[float]:
        """Return for each bond the power [W] that the FMU of the flow takes less what the FMU of the effort gives.

        Each reckons with its own output and with what it received of the other's at the end of the step, `held`. They
        agree unless the coupling errs; it is no integral over the step (Sadjina et al. 2017,
        doi:10.1007/s00366-016-0492-8).
        """
        if held is None or not self._bonds:
            return [0.0] * len(self._bonds)
        received = (held - self.offset) / self.factor
        taken = [received[bond.effort_received] * outputs[bond.flow] for bond in self._bonds]
        given = [outputs[bond.effort] * received[bond.flow_received] for bond in self._bonds]
        return [float(bond.watt * (t - g)) for bond, t, g in zip(self._bonds, taken, given, strict=True)]


def _index(reals: Mapping[str, Reals]) -> tuple[dict[str, slice], list[str]]:
    places, names = {}, list[str]()
    for owner, variables in reals.items():
        places[owner] = slice(len(names), len(names) + variables.count)
        names += [f"{owner}.{name}" for name in variables.names]
    return places, names


def real_inputs(system: System) -> dict[str, list[Port]]:
    """Return the inputs that Real outputs set in every step, by FMU."""
    ports = [c.target for c in system.connections if c.coupled]
    return {name: [port for port in ports if port.model.name == name] for name in system.models}


def real_outputs(system: System, recorded: list[Port]) -> dict[str, list[Port]]:
    """Return the Real outputs that are read, by FMU: for connections, records, events, bonds and derivatives."""
    ports = [c.source for c in system.connections]
    ports += [*recorded, *system.events, *system.derivatives.values()]
    ports += [system.port(of) for of, _ in system.derivatives]
    once = {port.name: port for port in ports if port.kind == "real"}
    return {name: [port for port in once.values() if port.model.name == name] for name in system.models}
