"""A scene at an operating point: what every calculation of one step asks for, bound once."""

from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import NamedTuple

import numpy as np

from ..errors import OperatingPointError, SceneError
from ..film.inlet_loss import lost_film
from ..film.instant import Grid
from ..laws.asperity_layer import AsperityLayer
from ..quantities import TABLE
from ..reference import Hertz, SmoothContact, SmoothLine, slipping_share
from ..shapes import Shape
from ..shapes.base import Viscosity
from .operation import OperatingPoint
from .scene import Scene
from .self_affine import SelfAffine
from .surface import Surface

Pair = tuple[float, float]


class Side(NamedTuple):
    """One body of a case."""

    body: int  # 0 of body 1, 1 of body 2, as in the laws
    surface: Surface | SelfAffine  # as new
    speed: float  # of the surface along +x [m/s]
    track_length: float  # travel of a surface point between two passes [m]
    temperature: float  # of the bulk [K]

    @property
    def moves(self) -> bool:
        """True if the surface moves through the contact."""
        return self.speed != 0.0


@dataclass(frozen=True)
class Case:
    """A scene at a checked operating point with the bulk temperatures of both bodies."""

    scene: Scene
    op: OperatingPoint

    @staticmethod
    def bind(scene: Scene, op: OperatingPoint, stored: Pair | None = None) -> "Case":
        """Check an operating point and bind it to a scene.

        Parameters
        ----------
        stored : bulk temperatures [K] of a state, from which heat.bulk = "lumped" continues; None: none yet.

        Raises
        ------
        OperatingPointError
            For inputs that cannot be used.
        SceneError
            For what `dataclasses.replace` lets through, see `Scene.refused`.

        """
        if scene.refused:
            raise SceneError(scene.refused)
        op.check()
        refusal = scene.refusal(op)
        if refusal:
            raise OperatingPointError(refusal)
        return Case.at(scene, op, stored)

    @staticmethod
    def at(scene: Scene, op: OperatingPoint, stored: Pair | None = None) -> "Case":
        """Bind a scene to an operating point that has been checked; otherwise as `bind`."""
        return Case(scene, _with_bulk_temperatures(scene, op, stored))

    def check_tribofilm(self) -> None:
        """Raise OperatingPointError if the caller gives temperatures outside the range of the tribofilm law.

        Bodies that warm by themselves raise a range flag instead.
        """
        op = self.op
        given = op.bodies if self.scene.heat.bulk.from_inputs else (op.temperature,)
        for refusal in map(self.scene.tribofilm.refusal, given):
            if refusal:
                raise OperatingPointError(refusal)

    def warmed(self, stored: Pair | None) -> "Case":
        """Return the case with the bulk temperatures [K] of a state.

        Raises OperatingPointError if bodies have warmed out of all range.
        """
        op = _with_bulk_temperatures(self.scene, self.op, stored)
        hottest = TABLE["body_temperature_1"].maximum
        if self.scene.heat.bulk.stores_heat and not max(op.bodies) <= hottest:
            raise OperatingPointError(
                f"The bodies have warmed to {op.bodies[0]:.4g} K and {op.bodies[1]:.4g} K, above {hottest:g} K. Raise "
                "heat.bulk.conductance_1 and _2, or lower load or sliding speed."
            )
        return self if op is self.op else Case(self.scene, op)

    def unloaded(self) -> "Case":
        """Return the case without a load."""
        return Case(self.scene, replace(self.op, load=0.0))

    @property
    def loaded(self) -> bool:
        """True if a load presses the bodies together."""
        return self.op.load > 0.0

    @property
    def entrained(self) -> bool:
        """True if the bodies entrain oil."""
        return self.op.entrainment_speed != 0.0

    @cached_property
    def shape(self) -> Shape:
        """Undeformed bodies at the radii of the operating point."""
        return self.scene.shape(self.op)

    @cached_property
    def hertz(self) -> Hertz:
        """Hertz's contact of the smooth, dry bodies; needs a load."""
        return self.shape.hertz(self.op.load, self.scene.solids.reduced_modulus)

    @cached_property
    def unit_hertz(self) -> Hertz:
        """Hertz's contact at 1 N and the radii of the operating point."""
        return self.scene.unit_hertz_at(self.op)

    @cached_property
    def growth(self) -> Pair:
        """Factors on Hertz's half width along x and pressure, and on the half width along y, from 1 N to the load."""
        return self.unit_hertz.growth(self.op.load)

    @property
    def pressed(self) -> float:
        """Hertz's largest pressure over the hardness of the bodies."""
        return self.unit_hertz.pressure_max * self.growth[0] / self.scene.plasticity.hardness

    @cached_property
    def sides(self) -> tuple[Side, Side]:
        """Body 1 and body 2."""
        scene, op = self.scene, self.op
        lengths, warm = scene.track_lengths, op.bodies
        return (
            Side(0, scene.surface_1, op.speed_1, lengths[0], warm[0]),
            Side(1, scene.surface_2, op.speed_2, lengths[1], warm[1]),
        )

    @cached_property
    def microroughness(self) -> AsperityLayer | None:
        """Asperities of both bodies together that are too short for the grid; None without any."""
        given = [side.surface.microroughness for side in self.sides]
        rough = [layer for layer in given if layer is not None and layer.rms > 0.0]
        return reduce(AsperityLayer.beside, rough) if rough else None

    def slipping(self, sliding_speed: float) -> float:
        """Return the share of the contact's length in which solids slip rather than stick, at a sliding speed [m/s].

        It is 1 but in near rolling and at a creep, where friction has not its full size, and 0 without sliding.
        """
        entrainment, hertz = abs(self.op.entrainment_speed), self.unit_hertz
        boundary = self.scene.boundary_friction
        grip = abs(float(boundary.grip(sliding_speed)))
        if not self.loaded or grip == 0.0 or entrainment == 0.0:
            return grip
        half_width = hertz.a * self.growth[0]
        return grip * slipping_share(sliding_speed / entrainment, boundary.bare, half_width, self.shape.radius_x)

    @property
    def speeds(self) -> Pair:
        """Surface speeds [m/s] of body 1 and 2."""
        return self.op.speed_1, self.op.speed_2

    @property
    def fastest(self) -> float:
        """Speed [m/s] of the faster body."""
        return max(abs(self.op.speed_1), abs(self.op.speed_2))

    @property
    def rough_speed(self) -> float:
        """Speed [m/s] of the faster rough body, 0 of smooth ones."""
        return max((abs(side.speed) for side in self.sides if not side.surface.smooth), default=0.0)

    @property
    def smooth_contact(self) -> SmoothContact | SmoothLine:
        """The contact of the smooth bodies in the terms of film formulas."""
        return self.shape.smooth(*self._film_inputs)

    @property
    def smooth_film(self) -> float:
        """Central film thickness [m] of the smooth bodies by formula."""
        return self.smooth_contact.film

    @property
    def missing_film(self) -> float:
        """Part of the film, over the one that is found, that may be missing as film.domain ends within the inlet."""
        supply, before = self.scene.lubricant.supply, 0.5 * self.scene.film.domain
        return lost_film(before, self.hertz.a, self.shape, self.smooth_contact, supply.layer, supply.inlet)

    @property
    def conventional_film(self) -> float:
        """Central film thickness [m] of the smooth bodies by the shape's conventional formula; 0 at rest."""
        return self.shape.conventional_film(*self._film_inputs) if self.entrained else 0.0

    @property
    def _film_inputs(self) -> tuple[float, float, Viscosity, float, float]:
        op, scene = self.op, self.scene
        oil = scene.lubricant.viscosity, op.inlet_temperature
        return op.load, op.entrainment_speed, *oil, scene.solids.reduced_modulus

    def grid(self, rows: int) -> Grid:
        """Return the nodes of the contact with `rows` of them along y."""
        return self.scene.grid(rows)

    def differs_from(self, old: OperatingPoint) -> bool:
        """Return True if an input is further from an old one than control.input_change tolerates.

        Temperature counts by the viscosity at the inlet.
        """
        op, scene = self.op, self.scene
        if op == old:
            return False
        viscosity = scene.lubricant.viscosity
        eta, eta_old = (float(viscosity(np.zeros(1), t)[0]) for t in (op.inlet_temperature, old.inlet_temperature))
        fastest = max(abs(op.speed_1), abs(op.speed_2), abs(old.speed_1), abs(old.speed_2))
        now_then_scale = (
            (op.load, old.load, max(op.load, old.load)),
            (op.entrainment_speed, old.entrainment_speed, fastest),
            (op.sliding_speed, old.sliding_speed, max(abs(op.sliding_speed), abs(old.sliding_speed))),
            (op.spin, old.spin, max(abs(op.spin), abs(old.spin))),
            (eta, eta_old, max(eta, eta_old)),
            *(
                (now, then, max(now, then))
                for (_, now), (_, then) in zip(self.shape.radii, scene.shape(old).radii, strict=True)
            ),
        )
        for name in ("load", "speed_1", "speed_2", "entrainment_speed", "sliding_speed", "spin"):
            if (getattr(op, name) == 0.0) != (getattr(old, name) == 0.0):
                return True
        return any(abs(now - then) > scene.control.input_change * scale for now, then, scale in now_then_scale)


def _with_bulk_temperatures(scene: Scene, op: OperatingPoint, stored: Pair | None) -> OperatingPoint:
    """Return the operating point with the bulk temperatures that the scene's law gives the bodies."""
    inputs, bulk = (op.body_temperature_1, op.body_temperature_2), scene.heat.bulk
    if bulk.follows_oil and inputs == (None, None):
        return op
    first, second = bulk.bodies(op.temperature, inputs, stored)
    return op if inputs == (first, second) else replace(op, body_temperature_1=first, body_temperature_2=second)
