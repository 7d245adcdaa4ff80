"""Friction where solids touch."""

from dataclasses import dataclass
from typing import ClassVar

from ..kernels.arrays import Array
from ..quantities import parameter
from .base import BoundaryFriction
from .elementary import tanh
from .equations import Equations


@dataclass(frozen=True)
class FilmBlend:
    """tau = mu p_solid, mu between bare steel's and the full tribofilm's in proportion to the local mean cover.

    `slip_speed` regularises friction about zero sliding: mu, and the limiting stress of the oil, are
    multiplied by tanh(u_s / slip_speed) (`grip`), so that friction is continuous and its slope bounded through zero
    sliding, and 99.99 % of its value at five times that speed. Oil below its limiting stress shears as it does.
    """

    name: ClassVar[str] = "film_blend"
    source: ClassVar[str] = "assumed: linear in the cover between the coefficients given"
    equations: ClassVar[Equations] = Equations(
        ("τ_{solid} = μ p_s tanh(|v|/v_0),   μ = μ_{bare} + (μ_{film} − μ_{bare}) c",),
        "c is the mean cover of both bodies by tribofilm, 0 to 1; v0 is slip_speed.",
        symbols={
            "v_0": "slip_speed",
            "μ_{bare}": "bare",
            "μ_{film}": "film",
            "c": "mean cover of both bodies by tribofilm, 0 to 1 [1]",
        },
    )

    bare: float = parameter("", "friction coefficient of bare solids", least=0.0, most=2.0)
    film: float = parameter("", "friction coefficient under a full tribofilm", least=0.0, most=2.0)
    slip_speed: float = parameter(
        "m/s", "regularisation speed v0: friction rises as tanh(u_s/v0) through zero sliding", above=0.0, most=1.0
    )

    def coefficient(self, cover: Array) -> Array:
        return self.bare + (self.film - self.bare) * cover

    def __call__(self, solid_pressure: Array, cover: Array, sliding_speed: Array | float) -> Array:
        """Return the shear stress [Pa], with the sign of the sliding speed [m/s].

        For cover 0 to 1 and a solid pressure [Pa].
        """
        return self.coefficient(cover) * solid_pressure * self.grip(sliding_speed)

    def grip(self, sliding_speed: Array | float) -> Array:
        return tanh(sliding_speed / self.slip_speed)

    def grip_slope(self, sliding_speed: Array | float) -> Array:
        return (1.0 - self.grip(sliding_speed) ** 2) / self.slip_speed

    def slope(self, solid_pressure: Array, cover: Array, sliding_speed: Array | float) -> Array:
        return self.coefficient(cover) * solid_pressure * self.grip_slope(sliding_speed)


LAWS: tuple[type[BoundaryFriction], ...] = (FilmBlend,)
