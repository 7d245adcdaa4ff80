"""A gear pair at work, as standards of load capacity see it: loads, radii and speeds from A to E."""

from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

import numpy as np

from contact_core.kernels.arrays import Array
from contact_core.laws.base import Viscosity
from contact_core.reference import hertz_line

from .geometry import SpurGearPair
from .path import radius, steps, surface_speeds
from .rating import Rating
from .sharing import Sharing, loads
from .textbook import ohlendorf

_POINTS = 41  # between two of A, B, C, D, E
_ASIDE = 1e-7  # of the path: on which side of B or D a load is taken


@dataclass(frozen=True)
class Working:
    """Torque > 0 [N m] and speed > 0 [rad/s] of the pinion, oil temperature [K], Ra averaged over both flanks [m].

    Loads are those of `sharing`, without factors for dynamic load and bad alignment: K_A K_V K_Hb K_Ha = 1.
    """

    pair: SpurGearPair
    sharing: Sharing
    torque: float
    speed: float
    oil: float
    viscosity: Viscosity
    ra: float
    rating: Rating = field(default_factory=Rating)

    @property
    def force(self) -> float:
        """F_bt, along the line of action [N]."""
        return self.torque / self.pair.base_radius_1

    @property
    def tangential_force(self) -> float:
        """F_t, at the reference circle [N]."""
        return 2.0 * self.torque / (self.pair.teeth_1 * self.pair.module)

    @property
    def lost(self) -> float:
        """Power lost by a coefficient of friction of 1 [W]: P H_V, with Ohlendorf's loss factor."""
        return self.torque * self.speed * ohlendorf(self.pair)

    @property
    def contact_ratios(self) -> tuple[float, float]:
        """Parts of the contact ratio after C and before it: e1, of the pinion's addendum, and e2, of the wheel's."""
        pair = self.pair
        return (pair.end - pair.pitch_point) / pair.base_pitch, (pair.pitch_point - pair.start) / pair.base_pitch

    @property
    def oil_viscosity(self) -> float:
        """Viscosity at p = 0 and the oil's temperature [Pa s]."""
        return float(self.viscosity(0.0, self.oil))

    @cached_property
    def places(self) -> Array:
        """Positions from A to E [m]; those where pairs of teeth come or go, twice, on both sides."""
        aside = _ASIDE * (self.pair.end - self.pair.start)
        pieces = pairwise(steps(self.pair))
        return np.concatenate([np.linspace(low + aside, high - aside, _POINTS) for low, high in pieces])

    @cached_property
    def load(self) -> Array:
        """Load of the pair of teeth at each place [N]."""
        return loads(self.pair, self.sharing, self.force, self.places)

    @cached_property
    def radius(self) -> Array:
        """Combined radius of curvature [m]."""
        return radius(self.pair, self.places)

    @cached_property
    def pressure(self) -> Array:
        """Hertz's largest pressure [Pa]; 0 without load."""
        width, modulus = self.pair.face_width, self.pair.reduced_modulus
        return np.array(
            [
                hertz_line(float(load), float(r), width, modulus).pressure_max if load > 0.0 else 0.0
                for load, r in zip(self.load, self.radius, strict=True)
            ]
        )

    @cached_property
    def speeds(self) -> tuple[Array, Array]:
        """Surface speeds of pinion and wheel [m/s]."""
        return surface_speeds(self.pair, self.places, self.speed, self.speed / self.pair.ratio)

    def mean(self, values: Array) -> float:
        """Return the mean over the path."""
        return float(np.trapezoid(values, self.places) / (self.places[-1] - self.places[0]))
