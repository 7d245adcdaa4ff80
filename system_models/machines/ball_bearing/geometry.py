"""Inner geometry of a single-row ball bearing."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from contact_core.errors import SceneError
from contact_core.quantities import parameter
from contact_core.reference import Hertz, hertz_point

RaceName = Literal["inner", "outer"]
RACES: tuple[RaceName, RaceName] = ("inner", "outer")


@dataclass(frozen=True)
class Race:
    """A ball on one of the raceways. x runs along the raceway, y across it."""

    name: RaceName
    groove: float  # radius of the groove across [m]
    track: float  # radius on which the contact circles about the bearing's axis [m]
    radius_x: float  # of combined curvature [m]
    radius_y: float
    reduced_modulus: float  # 2 / sum (1 - v^2)/E [Pa]

    @property
    def curvature_sum(self) -> float:
        """Sum of the four curvatures [1/m]."""
        return 1.0 / self.radius_x + 1.0 / self.radius_y

    @cached_property
    def unit(self) -> Hertz:
        """The contact at 1 N."""
        return hertz_point(1.0, self.radius_x, self.radius_y, self.reduced_modulus)

    @property
    def stiffness(self) -> float:
        """K of load = K approach^(3/2) [N/m^1.5]."""
        return float(self.unit.approach**-1.5)

    def ellipse(self, load: float) -> Hertz:
        """Return the contact at a load [N] > 0."""
        return hertz_point(load, self.radius_x, self.radius_y, self.reduced_modulus)

    @property
    def spin_lever(self) -> float:
        """Mean distance from the contact's centre, weighted with the pressure, at 1 N [m]."""
        return self.unit.lever_share * self.unit.b


@dataclass(frozen=True, kw_only=True)
class BallBearingGeometry:
    """A single row of balls; rings and balls of one material.

    Distance of the groove centres A = (f_i + f_o - 1) D, free contact angle cos(alpha_0) = 1 - clearance / (2 A), R_x =
    (D / 2) (1 -+ D cos(alpha) / d_m) at the inner and the outer race, 1 / R_y = 2 / D - 1 / (f D), f being the
    conformities.

    A deep groove bearing has a clearance and starts with the rings concentric and in one plane. An angular contact
    bearing has a contact angle and starts where balls and grooves just touch, so that its axial force is positive.
    Source: Harris & Kotzalas, Essential Concepts of Bearing Technology, 5th ed., 2006, chapter 2.
    """

    balls: int = parameter("", "number of balls", least=3, most=200, shapes_arrays=True)
    ball_diameter: float = parameter("m", "diameter of a ball", above=0.0, most=1.0)
    pitch_diameter: float = parameter("m", "diameter of the circle of the balls' centres", above=0.0, most=10.0)
    conformity_inner: float = parameter("", "radius of the inner groove over ball diameter", above=0.5, most=1.0)
    conformity_outer: float = parameter("", "radius of the outer groove over ball diameter", above=0.5, most=1.0)
    clearance: float = parameter("m", "diametral clearance; below 0 a press fit", least=-1e-3, most=1e-2, default=0.0)
    contact_angle: float = parameter("rad", "free contact angle; 0: deep groove", least=0.0, most=1.2, default=0.0)
    modulus: float = parameter("Pa", "Young's modulus", above=0.0, most=1e13, default=210e9, quantity="Stress")
    poisson: float = parameter("", "Poisson's ratio", least=0.0, most=0.5, default=0.3)
    density: float = parameter("kg/m3", "density of the balls", above=0.0, most=1e5, default=7800.0)

    def check(self) -> None:
        """Raise SceneError if the dimensions do not go together."""
        if self.clearance != 0.0 and self.contact_angle != 0.0:
            raise SceneError(
                f"clearance = {self.clearance:g} m and contact_angle = {self.contact_angle:g} rad say the same twice: "
                "give the clearance of a deep groove bearing or the angle of an angular contact bearing, the other 0."
            )
        if not self.clearance < 2.0 * self.separation:
            raise SceneError(
                f"clearance = {self.clearance:g} m must be below twice the distance of the grooves' centres, "
                f"{2.0 * self.separation:g} m. Lower it, or raise conformity_inner or conformity_outer."
            )
        room = self.pitch_diameter * math.sin(math.pi / self.balls)
        if not self.ball_diameter < room:
            raise SceneError(
                f"{self.balls} balls of {self.ball_diameter:g} m do not fit on pitch_diameter = "
                f"{self.pitch_diameter:g} m, where each has {room:g} m. Lower balls or ball_diameter."
            )

    @property
    def separation(self) -> float:
        """Distance A of the grooves' centres where ball and grooves just touch [m]."""
        return (self.conformity_inner + self.conformity_outer - 1.0) * self.ball_diameter

    @property
    def free_angle(self) -> float:
        """Contact angle [rad] under an axial force that tends to zero."""
        play = max(self.clearance, 0.0) / (2.0 * self.separation)
        return self.contact_angle or math.acos(1.0 - play)

    @property
    def groove_centre(self) -> tuple[float, float]:
        """Centre of the inner groove before the ring moves, (axial, radial) from that of the outer one [m]."""
        a, angle = self.separation, self.contact_angle
        return a * math.sin(angle), a * math.cos(angle) - 0.5 * self.clearance

    @property
    def groove_centre_radius(self) -> float:
        """Radius R_i of the circle on which the centres of the inner groove lie [m]: tilt works on this arm."""
        reach = (self.conformity_inner - 0.5) * self.ball_diameter
        return 0.5 * self.pitch_diameter + reach * math.cos(self.free_angle)

    @property
    def mass(self) -> float:
        """Mass of a ball [kg]."""
        return self.density * math.pi / 6.0 * self.ball_diameter**3

    @property
    def ratio(self) -> float:
        """Ball diameter over pitch diameter."""
        return self.ball_diameter / self.pitch_diameter

    @cached_property
    def inner(self) -> Race:
        return self._race("inner", self.conformity_inner, -1.0)

    @cached_property
    def outer(self) -> Race:
        return self._race("outer", self.conformity_outer, 1.0)

    def race(self, name: RaceName) -> Race:
        """Return the race of a name; curvatures are those at the nominal contact angle, whatever the loads."""
        return self.inner if name == "inner" else self.outer

    def _race(self, name: RaceName, conformity: float, outward: float) -> Race:
        """Return curvatures are those at the nominal contact angle, whatever the loads."""
        ball = 0.5 * self.ball_diameter
        bend = 1.0 + outward * self.ratio * math.cos(self.contact_angle)
        modulus = self.modulus / (1.0 - self.poisson**2)
        groove = conformity * self.ball_diameter
        across = 1.0 / (1.0 / ball - 1.0 / groove)
        return Race(name, groove, 0.5 * self.pitch_diameter * bend, ball * bend, across, modulus)

    @property
    def stiffness(self) -> float:
        """K_n of both contacts of a ball in series [N/m^1.5]."""
        return float((self.inner.unit.approach + self.outer.unit.approach) ** -1.5)


HARRIS = {"modulus": 206.84e9, "poisson": 0.3, "density": 7800.0}
BEARING_209 = BallBearingGeometry(
    balls=9, ball_diameter=12.7e-3, pitch_diameter=65e-3, conformity_inner=0.52, conformity_outer=0.52,
    clearance=15e-6, **HARRIS,
)  # fmt: skip
BEARING_218 = BallBearingGeometry(
    balls=16, ball_diameter=22.225e-3, pitch_diameter=125.26e-3, conformity_inner=0.5232, conformity_outer=0.5232,
    contact_angle=math.radians(40.0), **HARRIS,
)  # fmt: skip
