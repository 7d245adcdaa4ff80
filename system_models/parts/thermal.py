"""Housing, shafts and oil as heat capacities, joined by conductances, heated by losses and held by thermostats."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain
from typing import ClassVar, NamedTuple

import numpy as np
import scipy  # its parts are loaded at their first use

from contact_core.errors import SceneError, did_you_mean
from contact_core.kernels.arrays import Array
from contact_core.quantities import parameter

from .part import Input, Output, Part, State, Values, indexed

Regimes = tuple[int, ...]  # by thermostat: -1 heats and 1 cools as much as it can, 0 is between

AMBIENT = "ambient"
_MOST_CHANGES = 100  # of regime in a step; the rest of the step stays in the last one
_LOOKS = np.geomspace(1e-6, 1.0, 61)  # shares of a step at which thermostats are looked at


@dataclass(frozen=True)
class Modes:
    """Modes of n heat capacities joined by conductances: temperatures and their integrals over any step, exact.

    C T' = Q - K T, with K symmetric and without negative eigenvalues. Its modes are those of C^-1/2 K C^-1/2, which are
    orthogonal, so stiff networks and long steps lose no digits.
    """

    rates: Array  # [n] 1/s, of decay
    shapes: Array  # [n, n] T = shapes @ amplitudes
    inverse: Array  # [n, n] amplitudes = inverse @ T
    entry: Array  # [n, n] rate of change of the amplitudes = entry @ Q

    @staticmethod
    def of(capacities: Array, conductances: Array) -> "Modes":
        """Return the modes of heat capacities C [n] in J/K and the symmetric matrix K [n, n] in W/K."""
        root = np.sqrt(capacities)
        rates, vectors = np.linalg.eigh(conductances / np.outer(root, root))
        return Modes(np.maximum(rates, 0.0), vectors / root[:, None], vectors.T * root, vectors.T / root)

    def after(self, temperatures: Array, heat: Array, time: Array) -> tuple[Array, Array]:
        """Return temperatures [t, n] in K and their integrals [t, n] in K s after times [t], under held heat [n] in W.

        Temperatures count from that of the surroundings.
        """
        start, growth, span = self.inverse @ temperatures, self.entry @ heat, time[:, None]
        decay, first, second = _decays(span * self.rates)
        now = decay * start + span * first * growth
        summed = span * first * start + span**2 * second * growth
        return now @ self.shapes.T, summed @ self.shapes.T


def _decays(x: Array) -> tuple[Array, Array, Array]:
    """Return exp(-x), its mean over (0, x), and that mean's weighted one, (exp(-x) - 1 + x) / x^2, for x >= 0."""
    decay = np.exp(-x)
    safe = np.where(x > 0.0, x, 1.0)
    first = np.where(x > 0.0, -np.expm1(-x) / safe, 1.0)
    near = np.minimum(x, 0.5)  # there, the closed form cancels
    series = np.zeros_like(x)
    for k in range(14, 1, -1):
        series = (1.0 - series * near) / k
    return decay, first, np.where(x < 0.5, series, (1.0 - first) / safe)


@dataclass(frozen=True)
class Node:
    """Something of one temperature."""

    name: str = parameter("", "name, part of the names of its variables")
    heat_capacity: float = parameter("J/K", "C, heat capacity", least=1e-9, most=1e9)
    temperature: float = parameter("K", "temperature at the start", least=200.0, most=1000.0)
    heat_flows: int = parameter("", "number of heat flows that come in from outside", least=1, most=1000, default=1)

    @property
    def heats(self) -> tuple[str, ...]:
        """Names of the inputs for them."""
        name = f"heat_{self.name}"
        return (name,) if self.heat_flows == 1 else tuple(indexed(name, k + 1) for k in range(self.heat_flows))


@dataclass(frozen=True)
class Link:
    """A conductance between two nodes, or a node and the surroundings, which are called "ambient"."""

    first: str = parameter("", "name of a node")
    second: str = parameter("", "name of another node, or 'ambient'")
    conductance: float = parameter("W/K", "G, heat flow by temperature difference", least=0.0, most=1e9)


@dataclass(frozen=True)
class Thermostat:
    """A heater and cooler that holds a node's temperature: power = gain (setpoint - temperature) within its limits."""

    node: str = parameter("", "name of the node")
    setpoint: float = parameter("K", "temperature to hold where nothing sets it", least=200.0, most=1000.0)
    gain: float = parameter("W/K", "power by temperature below the setpoint", least=1e-9, most=1e9)
    heating: float = parameter("W", "largest power of heating", least=0.0, most=1e9)
    cooling: float = parameter("W", "largest power of cooling", least=0.0, most=1e9, default=0.0)


@dataclass(frozen=True)
class ThermalNetwork(Part):
    """C_i T_i' = Q_i + sum of G (T_j - T_i) + thermostat, exact for held inputs.

    Energy to the surroundings and from thermostats is counted, so that the energy balance can be
    closed: sum of C (T - T_start) = heat in + heater energies - energy_to_ambient.
    """

    name: ClassVar[str] = "ThermalNetwork"
    text: ClassVar[str] = "Heat capacities joined by conductances, with thermostats"

    nodes: tuple[Node, ...]
    links: tuple[Link, ...]
    thermostats: tuple[Thermostat, ...] = ()

    def check(self) -> None:
        for sentence in self._complaints():
            raise SceneError(sentence)

    def _complaints(self) -> Iterator[str]:
        names = [node.name for node in self.nodes]
        if not names:
            yield "nodes is empty. Give the thermal network at least one node."
        for name in names:
            if not re.fullmatch(r"[A-Za-z]\w*", name) or name == AMBIENT:
                yield f"A node cannot be called '{name}'. Take letters, digits and _, and another name than 'ambient'."
            if names.count(name) > 1:
                yield f"There are {names.count(name)} nodes called '{name}'. Give each its own name."
        ends = [(f"links[{i}]", end) for i, link in enumerate(self.links) for end in (link.first, link.second)]
        held = [(f"thermostats[{i}]", thermostat.node) for i, thermostat in enumerate(self.thermostats)]
        for where, end in chain(ends, held):
            known = [*names, AMBIENT] if where.startswith("links") else names
            if end not in known:
                yield f"{where} names no node: '{end}'.{did_you_mean(end, known)} Known are {', '.join(known)}."
        for i, link in enumerate(self.links):
            if link.first == link.second:
                yield f"links[{i}] joins '{link.first}' to itself. Name two ends, or leave it out."
        for where, node in held:
            if [other for _, other in held].count(node) > 1:
                yield f"{where}: '{node}' has more than one thermostat. Leave one."

    @property
    def inputs(self) -> tuple[Input, ...]:
        heats = [(name, node.name) for node in self.nodes for name in node.heats]
        return (
            *(Input(name, "Q", "W", f"heat that comes into '{node}'", nominal=100.0) for name, node in heats),
            _temperature("temperature_ambient", "temperature of the surroundings", 293.15),
            *(
                _temperature(f"setpoint_{held.node}", f"temperature at which '{held.node}' is held", held.setpoint)
                for held in self.thermostats
            ),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        names, ambient = [node.name for node in self.nodes], ("temperature_ambient",)
        return (
            *(
                Output(f"temperature_{n}", "T", "K", f"temperature of '{n}'", nominal=300.0, display="degC")
                for n in names
            ),
            Output("heat_to_ambient", "Q_a", "W", "heat flow to the surroundings", nominal=100.0, direct=ambient),
            Output("energy_to_ambient", "E_a", "J", "heat gone to the surroundings since the start", nominal=1e5),
            *chain.from_iterable(_heater(held.node) for held in self.thermostats),
        )

    def initial(self, inputs: Values) -> State:
        """Return temperatures [K], energy to the surroundings and of the thermostats [J]."""
        return (*(node.temperature for node in self.nodes), 0.0, *(0.0 for _ in self.thermostats))

    def advance(self, state: State, inputs: Values, step: float) -> State:
        """Return the exact state after the step, with the moments at which thermostats reach or leave their limits."""
        nodes = len(self.nodes)
        temperatures, energies = [*state[:nodes]], [*state[nodes:]]
        regimes, left, changes = self._regimes(temperatures, inputs), step, 0
        while left > 0.0 or changes == 0:
            piece = self._piece(regimes, temperatures, inputs, left, changes)
            temperatures = piece.temperatures
            energies = [energy + more for energy, more in zip(energies, piece.energies, strict=True)]
            regimes, left, changes = piece.following, left - piece.time, changes + 1
        return (*temperatures, *energies)

    def _piece(self, regimes: Regimes, temperatures: list[float], inputs: Values, left: float, changes: int) -> "Piece":
        """Return what `in_regimes` says; in C, where regimes are known at run time only, for one of all of them."""
        return self.in_regimes(regimes, temperatures, inputs, left, changes)

    def in_regimes(
        self, regimes: Regimes, temperatures: list[float], inputs: Values, left: float, changes: int
    ) -> "Piece":
        """Return what happens until a thermostat leaves its regime, at most in `left` [s], after some such changes."""
        course = self._course(np.array(temperatures), regimes, inputs)
        time, following = left, regimes
        if changes < _MOST_CHANGES:
            time, following = self._next_change(course, regimes, inputs, left)
        return Piece(time, following, course.end(time).tolist(), self._given(course, regimes, inputs, time).tolist())

    def heat_stored(self, temperatures: Sequence[float]) -> float:
        """Return the heat [J] that the nodes hold at temperatures [K] more than at the start."""
        pairs = zip(self.nodes, temperatures, strict=True)
        return sum(node.heat_capacity * (temperature - node.temperature) for node, temperature in pairs)

    def _regimes(self, temperatures: Sequence[float], inputs: Values) -> Regimes:
        found = []
        for held in self.thermostats:
            (low, high), now = _band(held, inputs), temperatures[self._place(held.node)]
            found.append(int(now > high) - int(now < low))
        return tuple(found)

    def _place(self, name: str) -> int:
        return [node.name for node in self.nodes].index(name)

    def _course(self, temperatures: Array, regimes: Regimes, inputs: Values) -> "Course":
        ambient = inputs["temperature_ambient"]
        heat = np.array([sum(inputs[name] for name in node.heats) for node in self.nodes])
        for held, regime in zip(self.thermostats, regimes, strict=True):
            powers = (held.gain * (inputs[f"setpoint_{held.node}"] - ambient), -held.cooling, held.heating)
            heat[self._place(held.node)] += powers[regime]
        return Course(_modes(self, regimes), temperatures - ambient, heat, ambient)

    def _next_change(self, course: "Course", regimes: Regimes, inputs: Values, left: float) -> tuple[float, Regimes]:
        """Return the time until a thermostat leaves its regime, at most `left` [s], and the regimes from then on."""
        first, following = left, regimes
        for k, (held, regime) in enumerate(zip(self.thermostats, regimes, strict=True)):
            low, high = _band(held, inputs)
            least, most = ((low, high), (high, np.inf), (-np.inf, low))[regime]
            time, turn = course.leaves(self._place(held.node), least, most, left)
            if time < first:
                first, following = time, (*regimes[:k], regime + turn, *regimes[k + 1 :])
        return first, following

    def _given(self, course: "Course", regimes: Regimes, inputs: Values, time: float) -> Array:
        """Return energies [J] that have gone to the surroundings and come from the thermostats after a time."""
        summed = course.summed(time)
        energies = [sum(loss * summed[self._place(name)] for name, loss in self._losses())]
        for held, regime in zip(self.thermostats, regimes, strict=True):
            below = (inputs[f"setpoint_{held.node}"] - course.ambient) * time - summed[self._place(held.node)]
            energies.append((held.gain * below, -held.cooling * time, held.heating * time)[regime])
        return np.array(energies)

    def _losses(self) -> Iterator[tuple[str, float]]:
        """Yield nodes and their conductances [W/K] to the surroundings."""
        for link in self.links:
            if AMBIENT in (link.first, link.second):
                yield link.second if link.first == AMBIENT else link.first, link.conductance

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        temperatures = dict(zip((node.name for node in self.nodes), state, strict=False))
        lost, *given = state[len(self.nodes) :]
        ambient = inputs["temperature_ambient"]
        values = {f"temperature_{name}": value for name, value in temperatures.items()}
        values["heat_to_ambient"] = sum((loss * (temperatures[name] - ambient) for name, loss in self._losses()), 0.0)
        values["energy_to_ambient"] = lost
        for held, energy in zip(self.thermostats, given, strict=True):
            wanted = held.gain * (inputs[f"setpoint_{held.node}"] - temperatures[held.node])
            values[f"heater_power_{held.node}"] = min(max(wanted, -held.cooling), held.heating)
            values[f"heater_energy_{held.node}"] = energy
        return values


def _temperature(name: str, text: str, start: float) -> Input:
    return Input(name, "T", "K", text, start=start, nominal=300.0, minimum=200.0, maximum=1000.0, display="degC")


def _heater(node: str) -> tuple[Output, Output]:
    who, by = f"the thermostat of '{node}'", (f"setpoint_{node}",)
    return (
        Output(f"heater_power_{node}", "P", "W", f"heat flow from {who}, negative: cools", nominal=100.0, direct=by),
        Output(f"heater_energy_{node}", "E", "J", f"heat given by {who} since the start", nominal=1e5),
    )


def _band(held: Thermostat, inputs: Values) -> tuple[float, float]:
    """Return temperatures [K] below which it heats and above which it cools as much as it can."""
    setpoint = inputs[f"setpoint_{held.node}"]
    return setpoint - held.heating / held.gain, setpoint + held.cooling / held.gain


@lru_cache(maxsize=64)
def _modes(network: ThermalNetwork, regimes: Regimes) -> Modes:
    """Return the modes of the network with the gains of those thermostats that are within their limits."""
    places = {node.name: k for k, node in enumerate(network.nodes)}
    conductances = np.zeros((len(places) + 1, len(places) + 1))  # the last one is the surroundings
    for link in network.links:
        ends = [places.get(end, len(places)) for end in (link.first, link.second)]
        conductances[ends, ends] += link.conductance
        conductances[ends, ends[::-1]] -= link.conductance
    for held, regime in zip(network.thermostats, regimes, strict=True):
        if regime == 0:
            conductances[places[held.node], places[held.node]] += held.gain
    return Modes.of(np.array([node.heat_capacity for node in network.nodes]), conductances[:-1, :-1])


class Piece(NamedTuple):
    """What happens while no thermostat changes its regime."""

    time: float  # [s]
    following: Regimes  # from then on
    temperatures: list[float]  # then [K]
    energies: list[float]  # gone to the surroundings and come from the thermostats meanwhile [J]


@dataclass(frozen=True)
class Course:
    """Temperatures against time, as long as no thermostat changes its regime."""

    modes: Modes
    start: Array  # above the surroundings
    heat: Array
    ambient: float

    def at(self, times: Array) -> Array:
        """Return temperatures [t, n] in K at times [t]."""
        return self.ambient + self.modes.after(self.start, self.heat, times)[0]

    def end(self, time: float) -> Array:
        """Return temperatures [n] in K at a time."""
        return self.at(np.array([time]))[0]

    def summed(self, time: float) -> Array:
        """Return integrals [n] in K s of the temperatures above the surroundings up to a time."""
        return self.modes.after(self.start, self.heat, np.array([time]))[1][0]

    def leaves(self, place: int, least: float, most: float, until: float) -> tuple[float, int]:
        """Return when a node's temperature leaves a range, and -1 for below, 1 for above; (until, 0) if never."""
        times = until * _LOOKS
        temperatures = self.at(times)[:, place]
        outside = np.flatnonzero((temperatures < least) | (temperatures > most))
        if not outside.size:
            return until, 0
        found = int(outside[0])
        level, turn = (least, -1) if temperatures[found] < least else (most, 1)
        first = times[found - 1] if found else 0.0

        def beyond(time: float) -> float:
            return turn * (float(self.end(time)[place]) - level)

        if beyond(first) >= 0.0:  # by rounding, where one regime ends and the next begins
            return float(first), turn
        return float(scipy.optimize.brentq(beyond, first, times[found], xtol=1e-14 * until, rtol=1e-15)), turn
