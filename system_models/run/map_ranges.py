"""Ranges of operating points and the places of the knots of a map, drawn at random."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from contact_core.corrections.knot import Plan
from contact_core.errors import ContactError
from contact_core.scene import OperatingPoint, Scene, units

Range = tuple[float, float]

_LOADS, _SPEEDS, _SLIPS = (0.5, 1.5), (0.3, 3.0), (0.2, 5.0)  # times those of the scene's operation
_WARMER = 15.0  # K, either way
_SLIDING = 2.0  # sliding over entrainment speed of a body at rest
_SLIP = 0.05  # of a scene that only rolls
_HARD = 0.95  # of the hardness: the largest Hertz pressure
_LOOKS, _ELSEWHERE = 12, 4  # of a history: looks while it rubs, and at other operating points
_EARLY = 3  # power by which looks come early, when the surfaces change fast
OPTIONS = {"load": "N", "entrainment": "m/s", "slide_roll": "", "temperature": "K", "radius_x": "m"}
_SUCH = {
    "load": "10:80",
    "entrainment": "0.05:0.5",
    "slide_roll": "'1 %:50 %'",
    "temperature": "60degC:100degC",
    "radius_x": "5mm:12mm",
}


@dataclass(frozen=True)
class Ranges:
    """Lowest and highest operating points of a map; of both directions of sliding."""

    load: Range  # N
    entrainment: Range  # m/s
    slide_roll: Range  # sliding over entrainment speed
    temperature: Range  # of the oil [K]
    radius_x: Range  # along entrainment [m]
    duration: float  # time for which surfaces rub [s]
    operation: OperatingPoint  # of the scene

    @staticmethod
    def of(scene: Scene, given: dict[str, str]) -> "Ranges":
        """Return the ranges about a scene's operation, those `given` as "LOW:HIGH" in their place.

        The load is at most what grid and hardness allow. Raises ContactError for ranges that cannot be used.
        """
        point, operation = scene.operation.point, scene.operation
        speed = abs(point.entrainment_speed)
        slip = abs(point.sliding_speed) / speed if speed > 0.0 else _SLIDING
        found = Ranges(
            (_LOADS[0] * point.load, min(_LOADS[1] * max(point.load, scene.largest_load), _largest_load(scene))),
            (_SPEEDS[0] * speed, _SPEEDS[1] * speed),
            (_SLIPS[0] * (slip or _SLIP), min(_SLIPS[1] * (slip or _SLIP), _SLIDING)),
            (point.temperature - _WARMER, point.temperature + _WARMER),
            (scene.shape(point).radius_x,) * 2,
            operation.duration,
            point,
        )
        chosen: dict[str, Any] = {name: _parsed(name, text) for name, text in given.items()}
        found = replace(found, **chosen)
        for name in ("load", "entrainment", "slide_roll"):
            if not getattr(found, name)[0] > 0.0:
                raise ContactError(
                    f"The range of {name} begins at {getattr(found, name)[0]:g}. Give one above zero, such as "
                    f"--{name.replace('_', '-')} LOW:HIGH."
                )
        if "radius_x" in chosen and "radius_y" not in scene.geometry.lacks:
            raise ContactError(
                f"--radius-x = '{given['radius_x']}': geometry.model = '{scene.geometry.name}' has two radii, and a "
                "map knows the ellipse of the scene alone. Leave the option out."
            )
        return found

    def extreme(self) -> OperatingPoint:
        """Return the point whose film is the thickest for its contact, with the most sliding."""
        speed, half = self.entrainment[1], 0.5 * self.slide_roll[1]
        return OperatingPoint(
            self.load[0], speed * (1.0 + half), speed * (1.0 - half), self.temperature[0], radius_x=self.radius_x[0]
        )

    @property
    def rows(self) -> tuple[tuple[str, float, float], ...]:
        """Name, lowest and highest value [SI] of each."""
        return tuple((name, *getattr(self, name)) for name in OPTIONS)

    def draw(self, seed: int, number: int) -> Plan:
        """Return a history; the same for the same seed and number. Number 0 rubs at the scene's operation."""
        random = np.random.Generator(np.random.Philox(key=[seed, number]))
        first = self._point(random)
        times = tuple(self.duration * (k / _LOOKS) ** _EARLY for k in range(1 + _LOOKS))
        elsewhere = tuple((int(random.integers(1 + _LOOKS)), self._point(random)) for _ in range(_ELSEWHERE))
        return Plan(first if number else self.operation, times, elsewhere)

    def _point(self, random: np.random.Generator) -> OperatingPoint:
        load, speed, slip = (
            float(np.exp(random.uniform(math.log(ends[0]), math.log(ends[1]))))
            for ends in (self.load, self.entrainment, self.slide_roll)
        )
        temperature = float(random.uniform(*self.temperature))
        half = math.copysign(0.5 * slip * speed, 0.5 - float(random.random()))
        low, high = self.radius_x
        radius = float(random.uniform(low, high)) if high > low else self.operation.radius_x
        return OperatingPoint(load, speed + half, speed - half, temperature, radius_x=radius)


def _largest_load(scene: Scene) -> float:
    """Return the largest load [N] that grid and hardness have room for."""
    low, high = scene.operation.load, 1e3 * scene.operation.load
    for _ in range(60):
        load = math.sqrt(low * high)
        hertz = scene.hertz(load)
        fits = scene.has_room(hertz) and hertz.pressure_max <= _HARD * scene.plasticity.hardness
        low, high = (load, high) if fits else (low, load)
    return low


def _parsed(name: str, text: str) -> Range:
    option = f"--{name.replace('_', '-')}"
    low, colon, high = text.partition(":")
    if not colon:
        raise ContactError(f"{option} = '{text}' is not LOW:HIGH, such as {_SUCH[name]}.")
    ends = _number(name, low, option), _number(name, high, option)
    if not ends[0] < ends[1]:
        raise ContactError(f"{option} = '{text}' must begin below its end.")
    return ends


def _number(name: str, text: str, option: str) -> float:
    """Return a number in SI units; without a unit it is in that of `OPTIONS`, and a temperature needs one."""
    try:
        number = float(text)
    except ValueError:
        return units.parse(text.strip(), OPTIONS[name], option)
    if name == "temperature":
        raise ContactError(f"{option}: {text} may be degC or K. Write {text}degC or {text}K, such as {_SUCH[name]}.")
    return number
