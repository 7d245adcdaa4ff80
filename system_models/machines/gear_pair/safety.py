"""Safety factors of a run: by the standards, and by what its own contacts found, against the same tests of the oil."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from contact_core import advance, initial_state
from contact_core.kernels.arrays import Array
from contact_core.scene import Scene

from ..resolve import started
from .flanks import contact_at
from .geometry import FZG_C, load_stages
from .mesh import GearMesh
from .micropitting import TEST_LEVER, Films, films, gf_class, limit, reference_test, safety
from .path import surface_speeds
from .rating import Rating
from .record import RA_OF_RQ, Record
from .scuffing import Flash, Integral, by_flash, by_integral, margin
from .sharing import loads
from .working import Working

_CAP = 1000.0  # of ratios: flanks without roughness


class Micropitting(NamedTuple):
    """Least film over Ra, and its safety, by the standard and by the run's contacts."""

    standard: float  # lambda_GF,min
    safety: float  # S_lambda
    own: float
    own_safety: float


class Scuffing(NamedTuple):
    """Safety against scuffing by the standard's two methods and by the run."""

    flash: Flash
    integral: Integral | None  # None: not for this contact ratio
    own: float  # hottest contact: mean of the bulk temperatures and flash [K]
    own_safety: float  # with the scuffing temperature of the flash temperature method


@dataclass(frozen=True)
class Safeties:
    """Safety factors at rows of a record in which the gears turn under load."""

    record: Record

    @property
    def rating(self) -> Rating:
        """Numbers of the rating, from the machine's file or assumed."""
        found: Rating = self.record.assembly.reported.get("rating") or Rating()
        return found

    def working(self, row: int) -> Working:
        """Return the gears at a row, as the standards see them: with Ra of the new flanks."""
        record = self.record
        torque, speed, oil = (
            float(record.of(name)[row]) for name in ("shafts.mesh_torque", "shafts.speed_1", "gearbox.temperature_oil")
        )
        law = record.scene.lubricant.viscosity
        sharing = record.mesh.load_sharing
        return Working(record.pair, sharing, torque, speed, oil, law, record.roughness, self.rating)

    @cached_property
    def failing(self) -> float:
        """lambda_GFT: the ratio with which the oil fails its test, by the standard."""
        return limit(self._any)

    @cached_property
    def own_failing(self) -> float:
        """The ratio with which the oil fails its test, by contacts as those of the machine."""
        return self._own_limit(0)

    def _own_limit(self, before: int) -> float:
        """Return the least h_c over Ra of the test, at the load stage at which the oil fails or some before.

        At the regression level, with new flanks of the test's Ra, and bulk temperatures of the standard.
        """
        test = reference_test(self._any, self.rating.micropitting_stage - before)
        mesh, bulk = GearMesh(pair=test.pair, load_sharing=test.sharing), films(test).bulk
        scene = _as_rough(self.record.scene, test.ra)
        ra = _ra(scene.surface_1.rms, scene.surface_2.rms)
        carried = loads(test.pair, test.sharing, test.force, np.array([s.position for s in mesh.contacts]))
        found = []
        for load, station in zip(carried, mesh.contacts, strict=True):
            of_contact, start = started(contact_at(scene, test.pair, station))
            u1, u2 = surface_speeds(test.pair, station.position, test.speed, test.speed / test.pair.ratio)
            point = replace(
                start, load=float(load), speed_1=u1, speed_2=u2, temperature=test.oil,
                body_temperature_1=bulk, body_temperature_2=bulk,
            )  # fmt: skip
            found.append(advance(of_contact, point, initial_state(of_contact), 0.0)[1].h_c)
        return min(found) / ra

    def films(self, row: int) -> Films:
        """Return films and temperatures along the path by ISO/TS 6336-22."""
        return films(self.working(row))

    def own_ratio(self, row: int) -> Array:
        """Return h_c over Ra of both flanks as they are, averaged, at the stations; at most 1000."""
        record = self.record
        ra = _ra(record.along("roughness_1")[row], record.along("roughness_2")[row])
        return np.minimum(record.along("h_c")[row], _CAP * ra) / np.maximum(ra, 1e-300)

    def own_temperature(self, row: int) -> Array:
        """Return mean bulk temperature and flash [K] at the stations."""
        bulk = sum(self.record.of(f"gearbox.temperature_{gear}")[row] for gear in ("pinion", "wheel"))
        return 0.5 * bulk + self.record.along("flash_temperature_rise")[row]

    def micropitting(self, row: int) -> Micropitting:
        standard, own = self.films(row).least, float(self.own_ratio(row).min())
        factor = self.rating.material_factor
        return Micropitting(
            standard, safety(standard, self.failing, factor), own, safety(own, self.own_failing, factor)
        )

    def scuffing(self, row: int) -> Scuffing:
        working = self.working(row)
        flash, own = by_flash(working), float(self.own_temperature(row).max())
        return Scuffing(flash, by_integral(working), own, margin(flash.limit, own, working.oil))

    def classes(self) -> tuple[str, str] | None:
        """Return the class of FVA 54/7 by the standard and by the run; None if the run is no such test.

        The oil passes its own test up to a load stage and fails the next one: what it needs lies between the ratios of
        these two. A run fails at the first load stage at whose end it is below their geometric mean.
        """
        numbers = load_stages([stage.torque for stage in self.record.stages], (TEST_LEVER,))
        if self.record.pair != FZG_C or numbers is None:
            return None
        found = [self.micropitting(stage.last) for stage in self.record.stages]
        standard = [its.standard for its in found], self.failing * limit(self._any, 1)
        own = [its.own for its in found], self.own_failing * self._own_limit(1)
        first, second = (
            gf_class(next((n for n, ratio in zip(numbers, ratios, strict=True) if ratio < self._needed(both)), None))
            for ratios, both in (standard, own)
        )
        return first, second

    def _needed(self, product: float) -> float:
        """Return W_W times the geometric mean of two ratios."""
        return self.rating.material_factor * product**0.5

    @property
    def _any(self) -> Working:
        """The gears at some row: what is asked follows from oil and rating alone."""
        return self.working(self.record.stages[0].last)


def _ra(first: float, second: float) -> float:
    return RA_OF_RQ * 0.5 * (first + second)


def _as_rough(scene: Scene, ra: float) -> Scene:
    """Return the scene with Ra [m] on both bodies; measured heights stay as they are."""
    first, second = (
        surface if surface.heights is not None else replace(surface, rq=ra / RA_OF_RQ)
        for surface in (scene.surface_1, scene.surface_2)
    )
    return replace(scene, surface_1=first, surface_2=second)
