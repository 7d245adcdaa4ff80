"""Rating lives of a bearing over its run: by ISO 281 and ISO 16281, row by row, and of the duty if it is repeated."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact_core.errors import ContactError
from contact_core.kernels.arrays import Array

from ...parts.part import indexed
from . import rating, stress_life
from .geometry import RACES, RaceName
from .record import CAPPED, BearingRun, ContactClass

_HOUR = 3600.0


@dataclass(frozen=True)
class RatedRun:
    """Lives [revolutions] of a run; arrays [time], of rows in which the shaft turns."""

    run: BearingRun

    @property
    def given(self) -> rating.Rating:
        """What the machine's file says on the rating."""
        found = self.run.assembly.reported["rating"]
        assert isinstance(found, rating.Rating)
        return found

    @cached_property
    def dynamic_rating(self) -> float:
        """C_r that counts [N]."""
        return self.given.of(self.run.bearing.dimensions)

    @cached_property
    def fatigue_load_limit(self) -> float:
        """C_u [N]."""
        return rating.fatigue_load_limit(self.run.bearing.dimensions)

    def loads(self, race: RaceName) -> Array:
        """Return the loads of all balls on a race [time, Z]."""
        count = self.run.bearing.dimensions.balls
        return np.stack(
            [self.run.of("bearing." + indexed(f"load_ball_{race}", j)) for j in range(1, count + 1)], axis=1
        )

    @cached_property
    def equivalent_load(self) -> Array:
        """P of ISO 281 [N], NaN where its factors are not known here."""
        rows = zip(self.run.radial.tolist(), self.run.axial.tolist(), strict=True)
        try:
            return np.array([rating.equivalent_load(self.run.bearing.dimensions, *row) for row in rows])
        except ContactError:
            return np.full(self.run.time.size, np.nan)

    @cached_property
    def basic(self) -> Array:
        """L10 of ISO 281."""
        with np.errstate(divide="ignore"):
            return np.asarray(rating.MILLION * (self.dynamic_rating / self.equivalent_load) ** 3)

    @cached_property
    def reference(self) -> Array:
        """L10r of ISO 16281, with the loads of the balls."""
        return rating.both(*self.race_lives.values())

    @cached_property
    def reference_load(self) -> Array:
        """P_ref of ISO 16281 [N]."""
        return rating.reference_load(self.dynamic_rating, self.reference)

    @cached_property
    def kappa_of_viscosity(self) -> Array:
        """Viscosity ratio nu / nu_1, NaN at rest."""
        speed = np.where(self.run.runs, self.run.speed, np.nan)
        return self.run.kinematic_viscosity / rating.reference_viscosity(
            self.run.bearing.dimensions.pitch_diameter, speed
        )

    @cached_property
    def film_ratio(self) -> Array:
        """Lambda: h_c over the roughness of both undeformed surfaces, of the loaded class that has least; NaN at rest.

        The standard's lambda but for h_c, which is that of the rough, warm contacts; capped where nothing is rough.
        """
        least = np.full(self.run.time.size, CAPPED)
        for which in self.run.classes:
            rough = np.hypot(*(self.run.solved(which, f"roughness_{i}") for i in (1, 2)))
            ratio = np.divide(self.run.solved(which, "h_c"), rough, out=np.full_like(rough, CAPPED), where=rough > 0.0)
            least = np.where(self.run.loaded(which), np.minimum(least, ratio), least)
        return np.where(self.run.runs, least, np.nan)

    @cached_property
    def kappa_of_film(self) -> Array:
        """Viscosity ratio that stands for our film: lambda^1.3."""
        return rating.kappa_of_lambda(self.film_ratio)

    def life_factor(self, kappa: Array) -> Array:
        """Return a_ISO for a viscosity ratio, with P_ref; that of no film where the shaft is at rest."""
        with np.errstate(divide="ignore"):
            ratio = self.fatigue_load_limit / self.reference_load
        clean = self.given.contamination * ratio if self.given.contamination > 0.0 else np.zeros_like(ratio)
        return rating.life_factor(np.nan_to_num(kappa, nan=0.0), clean)

    def modified(self, kappa: Array) -> Array:
        """Return L10mr of ISO 16281 for a viscosity ratio."""
        return self.life_factor(kappa) * self.reference

    @cached_property
    def friction(self) -> dict[RaceName, Array]:
        """Coefficient of friction of the most loaded class of each race."""
        top = self.run.bearing.levels
        return {race: self.run.solved(ContactClass(race, top), "friction_coefficient") for race in RACES}

    @cached_property
    def race_lives(self) -> dict[RaceName, Array]:
        """L10r of each race alone."""
        geometry = self.run.bearing.dimensions
        lives = rating.race_lives(geometry, self.dynamic_rating, self.loads("inner"), self.loads("outer"))
        return dict(zip(RACES, lives, strict=True))

    @cached_property
    def stressed(self) -> Array:
        """Life by the integral of the stress, of smooth contacts with our friction: see `stress_life`."""
        geometry = self.run.bearing.dimensions
        inner, outer = (
            self.race_lives[race]
            * stress_life.smooth_contact(geometry.race(race), geometry.poisson).life_factor(self.friction[race])
            for race in RACES
        )
        return rating.both(inner, outer)

    def consumed(self, life: Array) -> float:
        """Return the share of a life that the run takes, by Palmgren & Miner; NaN if the life is not known."""
        turning = np.where(self.run.runs, self.run.speed, 0.0)
        return rating.consumed(self.run.time, turning, life) if not np.isnan(life).any() else math.nan

    def hours(self, life: Array, row: int) -> float:
        """Return a life in hours at the speed of a row, infinite at rest."""
        speed = abs(self.run.speed[row]) if self.run.runs[row] else 0.0
        return float(life[row] * 2.0 * math.pi / speed / _HOUR) if speed > 0.0 else math.inf

    def hours_of_duty(self, life: Array) -> float:
        """Return the hours until a life is used up if the duty is repeated, times at rest included."""
        share = self.consumed(life)
        return (self.run.time[-1] - self.run.time[0]) / share / _HOUR if share != 0.0 else math.inf
