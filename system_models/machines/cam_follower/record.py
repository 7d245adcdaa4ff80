"""The record of a cam's run: over the angle of the cam, and against time."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact_core.kernels.arrays import Array

from ..report import Recorded, heat_stored
from .part import CamFollower, contact_name

_TURNS = 1.0  # rad/s: less is standing still


@dataclass(frozen=True)
class Record(Recorded):
    """A run of a cam."""

    @cached_property
    def cam(self) -> CamFollower:
        cam = self.assembly.parts["cam"]
        assert isinstance(cam, CamFollower)
        return cam

    @cached_property
    def names(self) -> list[str]:
        """Names of the contacts over the event; that of the base circle is the last."""
        count = self.cam.stations
        return [contact_name(k, count) for k in range(1, count + 2)]

    @cached_property
    def angles(self) -> Array:
        """Angles of the stations of the event, from the nose [deg]."""
        return np.degrees([station.angle for station in self.cam.contacts[:-1]])

    @cached_property
    def weights(self) -> Array:
        """Shares of a turn, that of the base circle last."""
        return np.array([station.weight for station in self.cam.contacts])

    @cached_property
    def last(self) -> int:
        """The last row in which the cam turns; the last of all if it never does."""
        rows = np.flatnonzero(np.abs(self.of("shaft.speed")) > _TURNS)
        return int(rows[-1]) if len(rows) else len(self.time) - 1

    def along(self, quantity: str) -> Array:
        """Return a quantity of the contacts by row and station, the base circle last."""
        return np.stack([self.of(f"{name}.{quantity}") for name in self.names], axis=1)

    def pressures(self, row: int) -> Array:
        """Return Hertz's largest pressure [Pa] at the stations; 0 without load."""
        scene = self.assembly.contacts[self.names[0]].scene
        geometry, modulus = scene.geometry, scene.solids.reduced_modulus
        rows = zip(self.along("load")[row], self.along("radius_x")[row], strict=True)
        return np.array(
            [geometry.shape(r).hertz(load, modulus).pressure_max if load > 0.0 else 0.0 for load, r in rows]
        )

    def energies(self) -> dict[str, float]:
        """Return the energies [J] since the start: of friction, from thermostats, stored, to the surroundings."""
        heaters = [str(name) for name in self.dataset if str(name).startswith("head.heater_energy_")]
        return {
            "friction": float(np.trapezoid(self.of("cam.power_loss"), self.time)),
            "thermostats": float(sum(self.of(name)[-1] for name in heaters)),
            "stored": heat_stored(self.assembly, self.dataset, "head"),
            "to the surroundings": float(self.of("head.energy_to_ambient")[-1]),
        }
