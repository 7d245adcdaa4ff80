"""The model as a function of some constants of a scene: what a test would have measured with them."""

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from math import exp, isfinite, log
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contact_core import OperatingPoint, Scene, advance, initial_state, uncertainty
from contact_core.arrays import Array
from contact_core.errors import ContactError, SceneError
from contact_core.scene import units
from contact_core.scene.toml import did_you_mean
from contact_core.scene.tunables import tunables, with_values

_DECADE = 10.0  # a range from this factor on is searched by its logarithm
_EITHER_WAY = {"J": 2.0}  # by unit: range about a value, as a factor; energies are in exponents
_USUAL = 10.0
_PART_OF = {"tribofilm": "tribofilm", "coverage": "tribofilm", "wear": "wear", "friction": "boundary_friction"}


@dataclass(frozen=True)
class Constant:
    """A constant of the scene that a fit may change within a range, in SI."""

    key: str
    value: float  # of the scene
    low: float
    high: float
    unit: str

    @property
    def logarithmic(self) -> bool:
        """True if the range is searched by its logarithm."""
        return self.low > 0.0 and self.high >= _DECADE * self.low

    def at(self, share: float) -> float:
        """Return the value at a share of the range, 0 to 1."""
        if self.logarithmic:
            return min(max(exp(log(self.low) + share * log(self.high / self.low)), self.low), self.high)
        return self.low + share * (self.high - self.low)

    def share(self, value: float) -> float:
        """Return the share of the range at which a value is."""
        if self.logarithmic:
            return log(value / self.low) / log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


def constants_of(scene: Scene, asked: Sequence[str], quantities: Sequence[str]) -> tuple[Constant, ...]:
    """Return the constants asked for as "key" or "key=low:high"; without any, those that the quantities name.

    They are all numbers without a default of the laws of tribofilm, wear and boundary friction, but for temperatures.
    Raises SceneError for what is no number of the scene, or a range that is none.
    """
    known = tunables(scene)
    if not asked:
        parts = {_PART_OF[start] for name in quantities for start in _PART_OF if name.startswith(start)}
        asked = [key for key in known if key.partition(".")[0] in parts and _is_needed(scene, key, known[key][1])]
    if not asked:
        raise SceneError(f"No constant of the scene belongs to {', '.join(quantities)} alone. Name some with --vary.")
    found = [_constant(text, known) for text in asked]
    twice = {constant.key for constant in found if sum(constant.key == other.key for other in found) > 1}
    if twice:
        raise SceneError(f"--vary names {', '.join(sorted(twice))} twice. Keep one.")
    return tuple(found)


def _is_needed(scene: Scene, key: str, field: Any) -> bool:
    part, _, name = key.partition(".")
    own = {f.name for f in fields(getattr(scene, part)) if f.default is MISSING}
    return name in own and field.metadata["unit"] != "K"


def _constant(text: str, known: Mapping[str, tuple[float | int, Any]]) -> Constant:
    key, equals, ends = text.partition("=")
    key = key.strip()
    if key not in known:
        raise SceneError(
            f"--vary: '{key}' is not a number of the scene that can be changed.{did_you_mean(key, list(known))} "
            "Use a key such as tribofilm.full_thickness."
        )
    value, field = known[key]
    unit, limits = field.metadata["unit"], field.metadata
    if isinstance(value, int):
        raise SceneError(f"--vary: '{key}' is a whole number, which cannot be fitted.")
    above, least, most = limits["above"], limits["least"], limits["most"]
    floor = above if above is not None else least if least is not None else -np.inf
    top = most if most is not None else np.inf
    low, high = _given_range(key, ends, unit) if equals else _usual_range(key, value, unit, floor, top)
    if not low < high:
        raise SceneError(f"--vary: the range of {key}, {low:g} to {high:g} {unit}, must rise. Write low:high.")
    if low < floor or high > top or (above is not None and low <= above and equals):
        raise SceneError(
            f"--vary: the range of {key}, {low:g} to {high:g} {unit}, leaves what is allowed, {floor:g} to {top:g}"
            f"{' (its lower end excluded)' if above is not None else ''} {unit}."
        )
    if not low <= value <= high:
        raise SceneError(
            f"--vary: {key} = {value:g} {unit} of the scene is outside of its range, {low:g} to {high:g} {unit}. "
            f"Widen the range, or use --set {key}='...' for a start inside it."
        )
    return Constant(key, float(value), low, high, unit)


def _given_range(key: str, ends: str, unit: str) -> tuple[float, float]:
    low, colon, high = ends.partition(":")
    if not colon:
        raise SceneError(f"--vary: '{key}={ends}' has no range. Write {key}=low:high, each with its unit.")
    return units.parse(low.strip(), unit, key), units.parse(high.strip(), unit, key)


def _usual_range(key: str, value: float, unit: str, floor: float, top: float) -> tuple[float, float]:
    """Return the range of a constant for which none is given: about its value, within what is allowed."""
    if unit == "K" and isfinite(floor + top):
        return floor, top
    if value <= 0.0:
        raise SceneError(f"--vary: {key} = {value:g} {unit} gives no range. Write {key}=low:high, each with its unit.")
    factor = _EITHER_WAY.get(unit, _USUAL)
    return max(value / factor, floor), min(value * factor, top)


class Model:
    """Outputs of tests at their times, as a function of constants of a scene."""

    def __init__(
        self, scene: Scene, tests: Sequence[OperatingPoint], constants: Sequence[Constant], quantities: Sequence[str]
    ) -> None:
        self.scene, self.tests, self.constants, self.quantities = scene, tests, constants, tuple(quantities)
        self.runs = 0  # tests simulated so far

    def values(self, shares: Array) -> dict[str, float]:
        """Return the constants [SI] at shares of their ranges."""
        return {one.key: one.at(float(x)) for one, x in zip(self.constants, shares, strict=True)}

    def curves(self, shares: Array, times: Sequence[Array]) -> list[Array]:
        """Return for each test the outputs [time, quantity] at rising times [s].

        Raises ContactError if the contact cannot be computed with these constants.
        """
        scene = with_values(self.scene, self.values(shares))
        return [self._test(scene, test, when)[0] for test, when in zip(self.tests, times, strict=True)]

    def stated(self, shares: Array, times: Sequence[Array]) -> dict[str, float]:
        """Return the largest stated error (95 %) of each quantity at the end of a test, over its value then."""
        scene, found = with_values(self.scene, self.values(shares)), dict.fromkeys(self.quantities, 0.0)
        for test, when in zip(self.tests, times, strict=True):
            rows, state = self._test(scene, test, when)
            errors = uncertainty(scene, state)
            for i, name in enumerate(self.quantities):
                if name in errors and rows[-1, i] != 0.0:
                    found[name] = max(found[name], errors[name].together / abs(float(rows[-1, i])))
        return found

    def _test(self, scene: Scene, test: OperatingPoint, times: Array) -> tuple[Array, Any]:
        state, now, rows, outputs = initial_state(scene), 0.0, np.empty((len(times), len(self.quantities))), None
        for i, time in enumerate(times):
            if outputs is None or time > now:
                state, outputs = advance(scene, test, state, float(time - now))
            now = float(time)
            rows[i] = [getattr(outputs, name) for name in self.quantities]
        if not np.isfinite(rows).all():
            raise ContactError("An output is not finite.")
        self.runs += 1
        return rows, state


class Places(NamedTuple):
    """Where numbers are taken from curves, one an entry of each array."""

    test: NDArray[np.int64]
    time: Array  # [s]
    quantity: NDArray[np.str_]


class Points:
    """The numbers at given places (test, time, quantity) of a model's curves, or NaN where it has none."""

    def __init__(self, model: Model, test: NDArray[np.int64], time: Array, quantity: NDArray[np.str_]) -> None:
        self.model, self.failures, self.places = model, 0, Places(test, time, quantity)
        self._times = [np.unique(time[test == i]) for i in range(len(model.tests))]
        self._column = np.array([model.quantities.index(name) for name in quantity.tolist()])
        self._place = [(i, int(np.searchsorted(self._times[i], when))) for i, when in zip(test, time, strict=True)]

    def __call__(self, shares: Array) -> Array:
        """Return the numbers with constants at shares of their ranges. Raises ContactError if there are none."""
        curves = self.model.curves(shares, self._times)
        return np.array([curves[i][row, column] for (i, row), column in zip(self._place, self._column, strict=True)])

    def or_nothing(self, shares: Array) -> Array:
        """Return the numbers, NaN if the contact cannot be computed with these constants."""
        try:
            return self(shares)
        except ContactError:
            self.failures += 1
            return np.full(len(self._place), np.nan)
