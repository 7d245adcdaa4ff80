"""The record of a gear pair's run as gear engineers look at it: along the path, by stages, beside formulas."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contact_core.kernels.arrays import Array, Mask
from contact_core.laws.viscosity import kinematic_viscosity
from contact_core.reference import hertz_line
from contact_core.scene import Scene

from ..report import Recorded
from .geometry import FZG_A, FZG_C, SpurGearPair, load_stages
from .mesh import GearMesh, flank
from .path import steps
from .textbook import iso_14179_1, load_intensity, ohlendorf, schlenk

RA_OF_RQ = math.sqrt(2.0 / math.pi)  # of Gaussian heights
_TURNS, _LOADED = 1.0, 1e-3  # rad/s and N m: less is standing still or idling


class Stage(NamedTuple):
    """A stretch of the duty with one speed and torque, both above zero."""

    number: int  # of the load stage if the duty is one of FZG's, else counted from 1
    start: float  # [s]
    end: float
    torque: float  # of the pinion, as the duty has it [N m]
    speed: float  # [rad/s]
    rows: slice  # of the record

    @property
    def last(self) -> int:
        """The row at its end."""
        return int(self.rows.stop) - 1


class Textbook(NamedTuple):
    """Mean coefficients of friction by formula."""

    schlenk: float
    iso_14179_1: float
    covered: bool  # whether load intensity and speed are those for which ISO/TR 14179-1 is meant


@dataclass(frozen=True)
class Record(Recorded):
    """A run of the machine that `gear_pair.assemble` makes."""

    @cached_property
    def mesh(self) -> GearMesh:
        mesh = self.assembly.parts["mesh"]
        assert isinstance(mesh, GearMesh)
        return mesh

    @property
    def pair(self) -> SpurGearPair:
        return self.mesh.pair

    @cached_property
    def positions(self) -> Array:
        """Positions of the stations, from T1 [m]."""
        return np.array([station.position for station in self.mesh.contacts])

    @cached_property
    def weights(self) -> Array:
        """Weights of the stations in a mean over the mesh cycle."""
        return np.array([station.weight for station in self.mesh.contacts])

    @property
    def scene(self) -> Scene:
        return self.assembly.contacts[flank(1)].scene

    @cached_property
    def pieces(self) -> list[NDArray[np.intp]]:
        """Stations between the points where pairs of teeth come or go."""
        jumps = [edge for edge in steps(self.pair)[1:-1] if edge != self.pair.pitch_point]
        return np.split(np.arange(self.mesh.stations), np.searchsorted(self.positions, jumps))

    def along(self, quantity: str) -> Array:
        """Return a quantity of the contacts by row and station."""
        return np.stack([self.of(f"{flank(k)}.{quantity}") for k in range(1, self.mesh.stations + 1)], axis=1)

    def pressures(self, row: int) -> Array:
        """Return Hertz's largest pressure [Pa] at the stations; 0 without load."""
        modulus = self.pair.reduced_modulus
        return np.array(
            [
                hertz_line(load, station.radius_x, station.face_width, modulus).pressure_max if load > 0.0 else 0.0
                for load, station in zip(self.along("load")[row], self.mesh.contacts, strict=True)
            ]
        )

    def pressure_at_pitch_point(self, torque: float) -> float:
        """Return Hertz's largest pressure [Pa] at C if one pair of teeth carries all, as load stages are known by."""
        pair, force = self.pair, torque / self.pair.base_radius_1
        radius = pair.pitch_point * (pair.line_length - pair.pitch_point) / pair.line_length
        return float(hertz_line(force, radius, pair.face_width, pair.reduced_modulus).pressure_max)

    @cached_property
    def works(self) -> Mask:
        """The rows in which the gears turn under load."""
        return (self.of("shafts.speed_1") > _TURNS) & (self.of("shafts.mesh_torque") > _LOADED)

    @cached_property
    def friction(self) -> Array:
        """Mean coefficient of friction of the mesh by row; NaN without load or motion."""
        return np.where(self.works, self.of("mesh.friction_coefficient"), np.nan)

    @cached_property
    def friction_error(self) -> Array:
        """Half width of its error by row, absolute: those that the contacts state, as if all were off the same way."""
        lost = (self.weights * np.abs(self.along("power_loss")) * self.along("error_friction")).sum(axis=1)
        whole = np.abs(self.of("mesh.power_transmitted")) * ohlendorf(self.pair)
        return np.divide(lost, whole, out=np.full(len(whole), np.nan), where=self.works)

    @property
    def roughness(self) -> float:
        """Ra of the new flanks, averaged over both [m]."""
        return RA_OF_RQ * 0.5 * (self.scene.surface_1.rms + self.scene.surface_2.rms)

    def textbook(self, row: int) -> Textbook:
        """Return the formulas for torque, speed and oil temperature at a row in which the gears work."""
        torque, speed = float(self.of("shafts.mesh_torque")[row]), float(self.of("shafts.speed_1")[row])
        warm, law = float(self.of("gearbox.temperature_oil")[row]), self.scene.lubricant.viscosity
        viscosity, kinematic = float(law(0.0, warm)), float(kinematic_viscosity(law, warm))
        within = 1.4e6 < load_intensity(self.pair, torque) <= 14e6 and 2.0 < speed * self.pair.pitch_radius_1 <= 25.0
        return Textbook(
            schlenk(self.pair, torque / self.pair.base_radius_1, speed, viscosity, self.roughness),
            iso_14179_1(self.pair, torque, speed, kinematic),
            within,
        )

    @cached_property
    def stages(self) -> list[Stage]:
        """The stretches of the duty in which the gears are to turn under load, in order."""
        speeds = self.assembly.schedule["drive.speed_setpoint"]
        torques = self.assembly.schedule["brake.torque_setpoint"]
        end = float(self.time[-1])
        edges = sorted({time for time in (*_changes(speeds), *_changes(torques)) if time < end})
        found: list[Stage] = []
        for start, stop in zip(edges, (*edges[1:], end), strict=True):
            speed, torque = _held(speeds, start), _held(torques, start) / self.pair.ratio
            # in the row at `start` the stretch before it ends
            first, last = (int(np.searchsorted(self.time, t * (1.0 + 1e-12), "right")) for t in (start, stop))
            if speed > 0.0 and torque > 0.0 and last > first and self.works[last - 1]:
                found.append(Stage(len(found) + 1, start, stop, torque, speed, slice(first, last)))
        tested = load_stages([stage.torque for stage in found]) if self.pair in (FZG_A, FZG_C) else None
        return [stage._replace(number=n) for stage, n in zip(found, tested, strict=True)] if tested else found

    def shown(self, most: int) -> list[Stage]:
        """Return at most so many stages, spread evenly, with the first and the last."""
        if len(self.stages) <= most:
            return self.stages
        return [self.stages[k] for k in np.linspace(0, len(self.stages) - 1, most).round().astype(int)]


def _changes(course: Sequence[tuple[float, Any]]) -> list[float]:
    """Return times at which a value differs from the one before, and the first."""
    return [course[0][0], *(later[0] for before, later in pairwise(course) if later[1] != before[1])]


def _held(course: Sequence[tuple[float, float | int | bool | str]], time: float) -> float:
    return float([value for start, value in course if start <= time][-1])
