"""A pair of involute spur gears: its drawing, and the geometry of its mesh."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from contact_core.quantities import parameter

_JAM = 1e-3  # backlash below zero, in modules, that rounded profile shifts may ask for


def fixed(unit: str, text: str, **limits: Any) -> Any:
    """Declare a number that no FMU lets change: the contacts of a mesh are built for it."""
    return parameter(unit, text, shapes_arrays=True, **limits)


@dataclass(frozen=True, kw_only=True)
class SpurGearPair:
    """An external pair without helix; both gears of one material. Body 1 is the pinion, body 2 the wheel."""

    teeth_1: int = fixed("", "teeth of the pinion", least=5, most=1000)
    teeth_2: int = fixed("", "teeth of the wheel", least=5, most=1000)
    module: float = fixed("m", "module", above=0.0, most=0.1)
    pressure_angle: float = fixed("rad", "pressure angle of the basic rack", least=0.17, most=0.61)
    shift_1: float = fixed("", "profile shift of the pinion, in modules", least=-2.0, most=3.0)
    shift_2: float = fixed("", "profile shift of the wheel, in modules", least=-2.0, most=3.0)
    face_width: float = fixed("m", "width of the flanks in contact", above=0.0, most=10.0)
    centre_distance: float = fixed("m", "distance of the axes", above=0.0, most=100.0)
    tip_diameter_1: float = fixed("m", "tip diameter of the pinion", above=0.0, most=100.0)
    tip_diameter_2: float = fixed("m", "tip diameter of the wheel", above=0.0, most=100.0)
    elastic_modulus: float = fixed("Pa", "Young's modulus of both gears", above=1e6, most=1e13, default=206e9)
    poisson_ratio: float = fixed("", "Poisson's ratio of both gears", least=0.0, most=0.5, default=0.3)

    def wrong(self) -> Iterator[str]:
        """Yield a sentence for each rule that the numbers break together."""
        bases = self.base_radius_1, self.base_radius_2
        if sum(bases) >= self.centre_distance:
            yield (
                f"centre_distance = {1e3 * self.centre_distance:g} mm must be above the sum of the base radii, "
                f"{1e3 * sum(bases):.6g} mm. Check module, teeth and pressure_angle."
            )
            return
        for body, base, tip in zip((1, 2), bases, (self.tip_diameter_1, self.tip_diameter_2), strict=True):
            most = math.hypot(base, self.line_length)  # reaches where the line of action touches the other base circle
            if not base < 0.5 * tip < most:
                yield (
                    f"tip_diameter_{body} = {1e3 * tip:g} mm must be above the base diameter, {2e3 * base:.6g} mm, and "
                    f"below {2e3 * most:.6g} mm, where the other gear's involute ends."
                )
                return
        if self.contact_ratio < 1.0:
            yield (
                f"The contact ratio of {self.contact_ratio:.3g} must be at least 1, or a pair of teeth parts before "
                "the next one touches. Raise the tip diameters or lower centre_distance."
            )
        if self.backlash < -_JAM * self.module:
            yield (
                f"shift_1 + shift_2 = {self.shift_1 + self.shift_2:g} gives a backlash of {1e6 * self.backlash:.3g} "
                "um; it must be at least 0, or the teeth jam. Lower the shifts or raise centre_distance."
            )

    @property
    def ratio(self) -> float:
        """u, turns of the pinion to one of the wheel."""
        return self.teeth_2 / self.teeth_1

    @property
    def reduced_modulus(self) -> float:
        """E' = 2 / sum (1 - v^2)/E [Pa]."""
        return self.elastic_modulus / (1.0 - self.poisson_ratio**2)

    @property
    def base_radius_1(self) -> float:
        """Base radius of the pinion [m]."""
        return 0.5 * self.teeth_1 * self.module * math.cos(self.pressure_angle)

    @property
    def base_radius_2(self) -> float:
        """Base radius of the wheel [m]."""
        return self.base_radius_1 * self.ratio

    @property
    def base_pitch(self) -> float:
        """Distance of two flanks along the line of action [m]."""
        return math.pi * self.module * math.cos(self.pressure_angle)

    @property
    def working_pressure_angle(self) -> float:
        """Between the line of action and the common tangent of the pitch circles [rad]."""
        return math.acos((self.base_radius_1 + self.base_radius_2) / self.centre_distance)

    @property
    def pitch_radius_1(self) -> float:
        """Radius of the pinion's working pitch circle [m]."""
        return self.centre_distance / (1.0 + self.ratio)

    @property
    def backlash(self) -> float:
        """Backlash along the line of action [m], for teeth of the thickness that the profile shifts give them."""
        grown = _involute(self.working_pressure_angle) - _involute(self.pressure_angle)
        thicker = 2.0 * self.module * (self.shift_1 + self.shift_2) * math.sin(self.pressure_angle)
        return 2.0 * (self.base_radius_1 + self.base_radius_2) * grown - thicker

    @property
    def line_length(self) -> float:
        """T1 T2, the line of action between both base circles [m]."""
        return self.centre_distance * math.sin(self.working_pressure_angle)

    @property
    def start(self) -> float:
        """Position of A, where the tip of the wheel touches the pinion [m]."""
        return self.line_length - math.sqrt(0.25 * self.tip_diameter_2**2 - self.base_radius_2**2)

    @property
    def end(self) -> float:
        """E, where the pinion's tip leaves the wheel [m]."""
        return math.sqrt(0.25 * self.tip_diameter_1**2 - self.base_radius_1**2)

    @property
    def single_start(self) -> float:
        """B, where the pair ahead leaves contact [m]."""
        return self.end - self.base_pitch

    @property
    def single_end(self) -> float:
        """D, where the pair behind comes into contact [m]."""
        return self.start + self.base_pitch

    @property
    def pitch_point(self) -> float:
        """C, where the surfaces roll without sliding [m]."""
        return self.base_radius_1 * math.tan(self.working_pressure_angle)

    @property
    def contact_ratio(self) -> float:
        """Pairs of teeth in contact, on average."""
        return (self.end - self.start) / self.base_pitch


def _involute(angle: float) -> float:
    return math.tan(angle) - angle


# Gears of the back-to-back rig of 91.5 mm centre distance. Type A: ISO 14635-1, tip diameters as quoted from it;
# shortened to keep the clearance they would be 88.50 and 112.32 mm. Type C: FVA 54/7, so shortened.
_FZG: dict[str, Any] = {
    "teeth_1": 16,
    "teeth_2": 24,
    "module": 4.5e-3,
    "pressure_angle": math.radians(20.0),
    "centre_distance": 91.5e-3,
}
FZG_C = SpurGearPair(
    **_FZG, shift_1=0.1817, shift_2=0.1715, face_width=14e-3, tip_diameter_1=82.46e-3, tip_diameter_2=118.36e-3
)
FZG_A = SpurGearPair(
    **_FZG, shift_1=0.8532, shift_2=-0.5, face_width=20e-3, tip_diameter_1=88.77e-3, tip_diameter_2=112.5e-3
)

# Torque of the pinion [N m] at load stages 1 to 14, by the length of the lever that loads the rig [m]. Source:
# Fernandes' program Gear-Calculation (github.com/cfernandesFEUP/Gear-Calculation); the longer one: ISO 14635-1, to 12.
FZG_STAGES: dict[float, tuple[float, ...]] = {
    0.5: (3.3, 13.7, 35.25, 60.75, 94.1, 135.3, 183.35, 239.25, 302.0, 372.7, 450.1, 534.5, 626.93, 714.2),
    0.35: (3.3, 13.7, 28.79, 46.64, 69.98, 98.82, 132.46, 171.59, 215.51, 265.0, 319.18, 378.26, 438.85, 499.94),
}
_SAME = 0.01  # relative difference of torques up to which they are of a load stage


def load_stages(torques: Sequence[float], levers: Sequence[float] = tuple(FZG_STAGES)) -> list[int] | None:
    """Return the numbers of FZG's load stages with torques of the pinion [N m]; None if no lever [m] has them all."""
    for lever in levers:
        its = FZG_STAGES[lever]
        found = [next((n for n, own in enumerate(its, 1) if abs(torque - own) < _SAME * own), 0) for torque in torques]
        if all(found):
            return found
    return None
