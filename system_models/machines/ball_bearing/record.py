"""Results of a bearing's run beside its outputs: torque in parts and by textbooks, film of each ball, starts."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contact_core import OperatingPoint, advance, initial_state
from contact_core.kernels.arrays import Array, Mask
from contact_core.laws.viscosity import kinematic_viscosity

from ...parts.part import indexed
from ..report import Recorded, heat_stored
from .equilibrium import RingLoads, solve
from .geometry import RACES, RaceName
from .part import BallBearing, contact_name
from .textbook import CatalogueBearing, Torque, catalogue_of, palmgren_torque, skf_torque

Parts = dict[str, Array]  # friction torque [N m] by cause, arrays [time], NaN at standstill
Formula = Callable[[CatalogueBearing, float, float, float, float], Torque]  # radial, axial, speed, viscosity

CAPPED = 1e3  # lambda ratio from which on it is at its cap
FEWEST = 0.02  # balls: a class of fewer stands for none
_HARDLY = 0.02  # of the largest load or speed
_REACHED = 0.99  # of its largest speed: a start ends there
_POSITIONS = 24  # positions of the cage between one ball and the next


class ContactClass(NamedTuple):
    """A class of contacts: a race and a load class of it."""

    race: RaceName
    level: int

    @property
    def contact(self) -> str:
        return contact_name(self.race, self.level)


class Passage(NamedTuple):
    """A ball on its way around a race, arrays [place] by rising azimuth from -pi to pi."""

    azimuth: Array  # [rad]
    load: Array  # [N]
    pressure: Array  # Hertz's largest [Pa]


@dataclass(frozen=True)
class BearingRun(Recorded):
    """A run of a bearing."""

    @property
    def bearing(self) -> BallBearing:
        part = self.assembly.parts["bearing"]
        assert isinstance(part, BallBearing)
        return part

    @property
    def classes(self) -> tuple[ContactClass, ...]:
        """All classes, lightest first, inner race first."""
        return tuple(ContactClass(race, k) for race in RACES for k in range(1, self.bearing.levels + 1))

    @cached_property
    def carrying(self) -> tuple[ContactClass, ...]:
        """The classes that have more than hardly any balls and load at some time."""
        loads = {which: float(self.given(which, "load").max()) for which in self.classes}
        balls = {which: float(self.given(which, "count").max()) for which in self.classes}
        least = _HARDLY * max(loads.values())
        return tuple(which for which in self.classes if loads[which] > least and balls[which] > FEWEST)

    def loaded(self, which: ContactClass) -> Mask:
        """Return True in rows in which a load class has balls that carry more than hardly any load."""
        load, balls = self.given(which, "load"), self.given(which, "count")
        return (balls > FEWEST) & (load > _HARDLY * self.of("bearing.load_max"))

    def given(self, which: ContactClass, name: str) -> Array:
        """Return a value that the bearing sends to a load class: load, speeds, count, ..."""
        return self.of("bearing." + indexed(f"{name}_{which.race}", which.level))

    def solved(self, which: ContactClass, name: str) -> Array:
        """Return an output of the contact of a load class."""
        return self.of(f"{which.contact}.{name}")

    @cached_property
    def speed(self) -> Array:
        """Speed of the shaft [rad/s]."""
        return self.of("shaft.speed")

    @cached_property
    def runs(self) -> Mask:
        """True in rows in which the shaft turns."""
        return np.abs(self.speed) > self.bearing.standstill

    @property
    def last(self) -> int:
        """The last row near the speed of the last start; the last row of all if the shaft never starts."""
        if not self.starts:
            return self.time.size - 1
        rows = np.arange(self.starts[-1][-1], self.time.size)
        speed = np.abs(self.speed)
        return int(rows[speed[rows] >= _REACHED * speed[rows[0]]][-1])

    def scheduled(self, name: str) -> Array:
        """Return an input of the bearing that the duty sets, as it was in the step to each row; zero if it does not."""
        course = self.assembly.schedule.get(f"bearing.{name}", ((0.0, 0.0),))
        times, values = np.array([[float(at), float(value)] for at, value in course]).T
        return values[np.maximum(np.searchsorted(times, self.time, side="left") - 1, 0)]

    def ring_loads(self, row: int) -> RingLoads:
        names = ("force_x", "force_y", "force_z", "moment_y", "moment_z")
        return RingLoads(*(float(self.scheduled(name)[row]) for name in names))

    @cached_property
    def torque(self) -> Parts:
        """Friction torque from the contacts' outputs: the bearing's, but for a step's delay between them."""
        speed = np.where(self.runs, np.abs(self.speed), np.nan)
        rolling, sliding, spin = np.zeros((3, speed.size))
        for which in self.classes:
            count, u1, u2 = (self.given(which, name) for name in ("count", "speed_1", "speed_2"))
            rolling += count * np.abs(self.solved(which, "rolling_resistance") * (u1 + u2)) / speed
            sliding += count * np.abs(self.solved(which, "friction_force") * (u1 - u2)) / speed
            spin += count * self._spin_torque(which) * np.abs(self.given(which, "spin")) / speed
        return {"rolling": rolling, "sliding": sliding, "spin": spin}

    def _spin_torque(self, which: ContactClass) -> Array:
        """Return the size of a contact's torque about its normal [N m], by its power."""
        slid = self.solved(which, "friction_force") * (self.solved(which, "speed_1") - self.solved(which, "speed_2"))
        spin = np.abs(self.solved(which, "spin"))
        lost = np.maximum(self.solved(which, "power_loss") - np.abs(slid), 0.0)
        return np.divide(lost, spin, out=np.zeros_like(lost), where=spin > 0.0)

    @property
    def radial(self) -> Array:
        """Radial load [N]."""
        return np.hypot(self.scheduled("force_y"), self.scheduled("force_z"))

    @property
    def axial(self) -> Array:
        """Size of the axial load [N]."""
        return np.abs(self.scheduled("force_x"))

    @property
    def kinematic_viscosity(self) -> Array:
        """Kinematic viscosity of the oil [m2/s]."""
        oil = next(iter(self.assembly.contacts.values())).scene.lubricant
        return np.asarray(kinematic_viscosity(oil.viscosity, self.of("housing.temperature_oil")))

    @cached_property
    def skf(self) -> Parts:
        """Friction torque after SKF at each row's load, speed and oil temperature."""
        return self._textbook(skf_torque, "rolling", "sliding")

    @cached_property
    def palmgren(self) -> Parts:
        """Friction torque after Palmgren."""
        return self._textbook(palmgren_torque, "by oil", "by load")

    def _textbook(self, formula: Formula, by_speed: str, by_load: str) -> Parts:
        bearing, found = catalogue_of(self.bearing.dimensions), np.full((2, self.time.size), np.nan)
        rows = np.stack([self.radial, self.axial, np.abs(self.speed), self.kinematic_viscosity], axis=1)
        for k in np.flatnonzero(self.runs):
            found[:, k] = formula(bearing, *rows[k].tolist())
        return {by_speed: found[0], by_load: found[1]}

    @property
    def starts(self) -> list[NDArray[np.int_]]:
        """Rows of each start.

        From the last row at rest, or the first in a direction, to the row in which the speed has nearly reached its
        largest.
        """
        direction = np.concatenate([[0.0], np.where(self.runs, np.sign(self.speed), 0.0), [0.0]])
        found = []
        for first, end in pairwise(np.flatnonzero(np.diff(direction))):
            if direction[first + 1] == 0.0:
                continue
            rest = 1 if first > 0 and not self.runs[first - 1] else 0
            speed = np.abs(self.speed[first:end])
            if speed.max() < _HARDLY * np.abs(self.speed).max():
                continue
            there = first + int(np.argmax(speed >= _REACHED * speed.max()))
            found.append(np.arange(first - rest, there + 1))
        return found

    @property
    def start_peaks(self) -> Array:
        """Largest friction torque of each start [N m] while the shaft turns: friction at rest is given."""
        torque = np.abs(self.of("bearing.friction_torque"))
        return np.array([torque[rows[self.runs[rows]]].max() for rows in self.starts])

    def pressure(self, race: RaceName, load: Array) -> Array:
        """Return Hertz's largest pressure [Pa] of balls with loads [N]."""
        return self.bearing.dimensions.race(race).unit.pressure_max * np.cbrt(load)

    def balls(self, race: RaceName, row: int) -> tuple[Array, Array]:
        """Return azimuth [rad] from -pi to pi and load [N] of each ball at a row, by rising azimuth."""
        count = self.bearing.dimensions.balls
        turn = self.bearing.first_ball + 2.0 * np.pi * np.arange(count) / count
        azimuth = np.remainder(turn + np.pi - 1e-12, 2.0 * np.pi) - np.pi + 1e-12
        load = np.array([self.of("bearing." + indexed(f"load_ball_{race}", j))[row] for j in range(1, count + 1)])
        order = np.argsort(azimuth)
        return azimuth[order], load[order]

    def passage(self, race: RaceName, row: int) -> Passage:
        """Return the orbit of a ball under the loads and speed of a row: equilibria of many positions of the cage."""
        loads, speed, part = self.ring_loads(row), float(self.speed[row]), self.bearing
        found: list[tuple[float, float]] = []
        start: tuple[float, ...] | None = None
        for shift in np.arange(_POSITIONS) / _POSITIONS * 2.0 * np.pi / part.dimensions.balls:
            rest = solve(part.dimensions, loads, speed, start, float(shift), part.tilt_stiffness)
            start, carried = rest.start, rest.load_inner if race == "inner" else rest.load_outer
            place = np.remainder(rest.azimuth + np.pi, 2.0 * np.pi) - np.pi
            found += zip(place.tolist(), carried.tolist(), strict=True)
        azimuth, load = np.array(sorted(found)).T
        return Passage(azimuth, load, self.pressure(race, load))

    def at_load(self, race: RaceName, name: str, row: int, load: Array) -> Array:
        """Return h_c [m] or lambda ratio, by `name`, of balls with loads [N] on a race at a row.

        Interpolated between the classes is not the film, of which idle balls have many times as much, but its share of
        what the regression level gives for fresh surfaces at the same load: that hardly changes. NaN with hardly any
        load and at rest.
        """
        found, loaded = np.full(load.shape, np.nan), load > _HARDLY * load.max()
        known = [
            (float(self.given(which, "load")[row]), float(self.solved(which, name)[row]), which)
            for which in self.classes
            if which.race == race and self.loaded(which)[row]
        ]
        known = sorted(each for each in known if each[1] < CAPPED)
        if known and self.runs[row]:
            loads, values, own = zip(*known, strict=True)
            shares = np.array(values) / self._fresh_gaps(own[-1], row, loads)
            gaps = self._fresh_gaps(own[-1], row, load[loaded].tolist())
            found[loaded] = np.interp(load[loaded], loads, shares) * gaps
        return found

    def _fresh_gaps(self, which: ContactClass, row: int, loads: Sequence[float]) -> Array:
        """Return h_c [m] of the regression level under loads [N]: fresh surfaces, all else as at a row."""
        contact = self.assembly.contacts[which.contact]
        names = {field.name for field in fields(OperatingPoint)}
        given = {name: float(value) for name, value in contact.parameters.items() if name in names}
        given |= {name: float(self.solved(which, name)[row]) for name in self.assembly.inputs_of(which.contact)}
        scene = contact.scene.at_level("regression")
        op, fresh = OperatingPoint(**given), initial_state(scene)
        return np.array([advance(scene, replace(op, load=load), fresh, 0.0)[1].h_c for load in loads])

    @property
    def heat_stored(self) -> float:
        """Heat that the housing's nodes hold more than at the start [J]."""
        return heat_stored(self.assembly, self.dataset, "housing")

    @property
    def heat_in(self) -> float:
        """Heat that friction has made since the start [J], by the trapezoidal rule."""
        return float(np.trapezoid(self.of("bearing.power_loss"), self.time))
