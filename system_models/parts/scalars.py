"""What components compute with functions of scipy and numpy, once more with bounded loops: to be written in C.

`INSTEAD` names the functions that these stand for. They agree to rounding.
"""

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import linear, thermal
from .conduction import Modes
from .eigen import symmetric_eigen
from .part import State, Values
from .thermal import Regimes, ThermalNetwork

Array = NDArray[np.float64]
Numbers = Sequence[float]

_TERMS = 18  # of the series of the exponential, for a norm up to 1
_LOOKS = 61  # times in a step at which thermostats are looked at, from 1e-6 of it on
_DECADES = 6.0
_MOST_CHANGES = 100  # of regime in a step
_LOCATED = 1e-14  # of a step, to which a change of regime is found


# matrices


def exponential(matrix: Array) -> Array:
    """Return the exponential of a matrix [n, n], by its series for a part of it that is squared again and again."""
    norm, scale, doublings = max([sum([abs(x) for x in row]) for row in matrix]), 1.0, 0
    while norm > 1.0:
        norm, scale, doublings = 0.5 * norm, 0.5 * scale, doublings + 1
    small = matrix * scale
    found = _next(small, np.eye(len(matrix)), 1.0 / _TERMS)
    for k in range(_TERMS - 1, 0, -1):
        found = _next(small, found, 1.0 / k)
    while doublings > 0:
        found, doublings = _times(found, found), doublings - 1
    return found


def _next(small: Array, found: Array, share: float) -> Array:
    """Return 1 + share * small @ found."""
    return np.eye(len(small)) + (small @ found) * share


def _times(one: Array, other: Array) -> Array:
    return one @ other


# thermal networks


def advance(network: ThermalNetwork, state: State, inputs: Values, step: float) -> State:
    """Return the state of a thermal network after a step [s], as `ThermalNetwork.advance` does."""
    nodes = len(network.nodes)
    temperatures, energies = [*state[:nodes]], [*state[nodes:]]
    regimes = tuple([_regime(temperatures[_place(network, k)], _band(network, k, inputs)) for k in _held(network)])
    left, changes = step, 0
    while left > 0.0:
        time, regimes, temperatures, energies = _piece(network, regimes, temperatures, energies, inputs, left, changes)
        left, changes = left - time, changes + 1
    return (*temperatures, *energies)


def _held(network: ThermalNetwork) -> range:
    return range(len(network.thermostats))


def _place(network: ThermalNetwork, k: int) -> int:
    return network._place(network.thermostats[k].node)


def _band(network: ThermalNetwork, k: int, inputs: Values) -> tuple[float, float]:
    return thermal._band(network.thermostats[k], inputs)


def _regime(temperature: float, band: tuple[float, float]) -> int:
    return int(temperature > band[1]) - int(temperature < band[0])


def _possible(network: ThermalNetwork) -> list[Regimes]:
    return [*product((0, -1, 1), repeat=len(network.thermostats))]


def _piece(
    network: ThermalNetwork,
    regimes: Regimes,
    temperatures: Numbers,
    energies: Numbers,
    inputs: Values,
    left: float,
    changes: int,
) -> tuple[float, Regimes, list[float], list[float]]:
    """Return the time [s] until a thermostat leaves its regime, at most `left`, and what holds from then on."""
    known = _possible(network)
    for each in known[:-1]:
        if regimes == each:
            return _in_regimes(network, each, temperatures, energies, inputs, left, changes)
    return _in_regimes(network, known[-1], temperatures, energies, inputs, left, changes)


def _in_regimes(
    network: ThermalNetwork,
    regimes: Regimes,
    temperatures: Numbers,
    energies: Numbers,
    inputs: Values,
    left: float,
    changes: int,
) -> tuple[float, Regimes, list[float], list[float]]:
    modes, ambient, heat = (
        thermal._modes(network, regimes),
        inputs["temperature_ambient"],
        _heat(network, regimes, inputs),
    )
    start, growth = _product(modes.inverse, [t - ambient for t in temperatures]), _product(modes.entry, heat)
    time, following = left, regimes
    if changes < _MOST_CHANGES:
        for k in _held(network):
            low, high = _band(network, k, inputs)
            least, most = ((low, high), (high, math.inf), (-math.inf, low))[regimes[k]]
            when, turn = _leaves(modes, _place(network, k), start, growth, least - ambient, most - ambient, left)
            if when < time:
                time, following = when, (*regimes[:k], regimes[k] + turn, *regimes[k + 1 :])
    courses = [_course(rate, time) for rate in modes.rates.tolist()]
    now = [decay * s + first * g for (decay, first, _), s, g in zip(courses, start, growth, strict=True)]
    summed = _product(
        modes.shapes, [first * s + second * g for (_, first, second), s, g in zip(courses, start, growth, strict=True)]
    )
    after = [ambient + t for t in _product(modes.shapes, now)]
    given = _given(network, regimes, inputs, summed, time)
    return time, following, after, [energy + more for energy, more in zip(energies, given, strict=True)]


def _product(matrix: Array, vector: Numbers) -> list[float]:
    return [sum([a * x for a, x in zip(row, vector, strict=True)]) for row in matrix.tolist()]


def _heat(network: ThermalNetwork, regimes: Regimes, inputs: Values) -> list[float]:
    """Return the heat flows [W] into the nodes."""
    heat = [sum([inputs[name] for name in node.heats]) for node in network.nodes]
    for held, regime in zip(network.thermostats, regimes, strict=True):
        below = held.gain * (inputs[f"setpoint_{held.node}"] - inputs["temperature_ambient"])
        power = (below, -held.cooling, held.heating)[regime]
        place = network._place(held.node)
        heat = [*heat[:place], heat[place] + power, *heat[place + 1 :]]
    return heat


def _given(network: ThermalNetwork, regimes: Regimes, inputs: Values, summed: Numbers, time: float) -> list[float]:
    """Return energies [J] that have gone to the surroundings and come from the thermostats."""
    given = [sum([loss * summed[network._place(name)] for name, loss in [*network._losses()]])]
    for held, regime in zip(network.thermostats, regimes, strict=True):
        above = inputs[f"setpoint_{held.node}"] - inputs["temperature_ambient"]
        below = above * time - summed[network._place(held.node)]
        given = [*given, (held.gain * below, -held.cooling * time, held.heating * time)[regime]]
    return given


def _course(rate: float, time: float) -> tuple[float, float, float]:
    """Return exp(-rate t), its integral, and the integral of that, at a time."""
    decay, first, second = _decays(rate * time)
    return decay, time * first, time * time * second


def _decays(x: float) -> tuple[float, float, float]:
    """Return what `conduction._decays` returns of a number."""
    decay = math.exp(-x)
    first = 1.0 if x <= 0.0 else -math.expm1(-x) / x
    if x >= 0.5:
        return decay, first, (1.0 - first) / x
    series = 0.0
    for k in range(14, 1, -1):
        series = (1.0 - series * x) / k
    return decay, first, series


def _leaves(
    modes: Modes, place: int, start: Numbers, growth: Numbers, least: float, most: float, until: float
) -> tuple[float, int]:
    """Return when a node's temperature above the surroundings leaves a range, and -1 for below, 1 for above.

    (until, 0) if never.
    """
    earlier = 0.0
    for look in range(_LOOKS):
        time = until * math.exp(math.log(10.0) * (0.1 * look - _DECADES))
        now = _above(modes, place, start, growth, time)
        if now < least:
            return _crossing(modes, place, start, growth, -1, least, earlier, time)
        if now > most:
            return _crossing(modes, place, start, growth, 1, most, earlier, time)
        earlier = time
    return until, 0


def _above(modes: Modes, place: int, start: Numbers, growth: Numbers, time: float) -> float:
    """Return a node's temperature above the surroundings at a time."""
    courses = [_course(rate, time) for rate in modes.rates.tolist()]
    now = [decay * s + first * g for (decay, first, _), s, g in zip(courses, start, growth, strict=True)]
    return sum([shape * x for shape, x in zip(modes.shapes[place].tolist(), now, strict=True)])


def _crossing(
    modes: Modes, place: int, start: Numbers, growth: Numbers, turn: int, level: float, before: float, after: float
) -> tuple[float, int]:
    """Return when a node's temperature passes a level between two times; at once where it has by rounding."""
    low, high = before, after
    if turn * (_above(modes, place, start, growth, low) - level) >= 0.0:
        return low, turn
    while high - low > _LOCATED * after:
        middle = 0.5 * (low + high)
        if turn * (_above(modes, place, start, growth, middle) - level) < 0.0:
            low = middle
        else:
            high = middle
    return high, turn


INSTEAD: Mapping[Any, Callable[..., Any]] = {
    linear.exponential: exponential,
    ThermalNetwork.advance: advance,
    inspect.unwrap(np.linalg.eigh): symmetric_eigen,
}
