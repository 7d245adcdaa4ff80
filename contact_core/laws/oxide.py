"""Oxide on the solids where no tribofilm covers them: for Azam's thesis 2018, section 8.3, point 6."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..quantities import parameter
from ..reference.constants import BOLTZMANN
from .base import Oxide
from .elementary import Numbers, exp, minimum
from .equations import Equations

_BELOW_ONE = 1.0 - 2.0**-53


@dataclass(frozen=True)
class NoOxide:
    """The solids stay bare."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("x = 0",),
        symbols={
            "x": "thickness of the oxide [m]",
        },
        left_out="Oxide: solids that no tribofilm covers stay bare, with the friction and wear of bare solids.",
    )
    grows: ClassVar[bool] = False
    friction: ClassVar[float] = 0.0  # of nothing
    volume_ratio: ClassVar[float] = 1.0

    def growth(self, temperature: float) -> float:
        """Return 0: nothing oxidises."""
        return 0.0

    def removal(self, pressure: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return 0: there is nothing to rub off."""
        return 0.0 * pressure

    def left_open(self, film: Numbers) -> Numbers:
        """Return 0: no share of the solid counts."""
        return 0.0 * film

    def cover(self, oxide: Numbers) -> Numbers:
        """Return 0: nothing covers the solids."""
        return 0.0 * oxide

    def added_friction(self, bare: float, oxides: Numbers, films: Numbers) -> Numbers:
        """Return 0: there is no oxide."""
        return 0.0 * films

    def evolve(self, oxide: Numbers, growing: Numbers, rubbing: Numbers) -> tuple[Numbers, Numbers]:
        """Return the oxide as it is, and nothing rubbed off."""
        return oxide, 0.0 * oxide


@dataclass(frozen=True)
class Logarithmic:
    """An oxide x that slows down its own growth by the factor e for every thickness x_0, and that rubbing wears.

    dx/dt = s (A exp(-x / x_0) - K p v / H) while x > 0, with A = A_0 exp[-E / (k_B T)], T the bulk temperature and s =
    exp(-h_t / h_s) the share that a tribofilm h_t leaves open. Rubbing takes as much from a thin oxide as from a thick
    one, at most what has grown. u = exp(x / x_0) then obeys x_0 du/dt = s (A - K p v u / H), which is linear: the
    closed form holds for any time, and x = 0 is met at most once, on the way to an end below it.

    Iron stops at 1.8 (moist) to 2.6 nm (dry) at 300 K (Kruger & Yolken 1964). The default constants, all assumed,
    give 2.5 nm in an hour at 300 K and 0.46 nm more for every decade of time. `volume_ratio` is that of Fe2O3 on Fe,
    from their densities.
    """

    name: ClassVar[str] = "logarithmic"
    source: ClassVar[str] = (
        "direct logarithmic law: Fehlner & Mott, Oxid. Met. 2 (1970) 59; thickness on iron: Kruger & Yolken, Corrosion "
        "20 (1964) 29; worn as by Archard 1953, doi:10.1063/1.1721448; constants assumed"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "∂x/∂t = s [A exp(−x/x_0) − K p_s |v|/H],   x ≥ 0",
            "A = A_0 exp[−E/(k_B T)],   s = exp(−h_t/h_s)",
        ),
        "Oxide where no tribofilm covers the solids; T is the bulk temperature. It bears the share min(x/xc, 1) of "
        "their open part with a friction coefficient of its own; the steel in what is rubbed off counts as wear.",
        symbols={
            "x": "thickness of the oxide [m]",
            "x_0": "scale",
            "A_0": "prefactor",
            "E": "activation_energy",
            "K": "wear",
            "H": "hardness",
            "h_s": "thin",
        },
    )
    grows: ClassVar[bool] = True

    scale: float = parameter(
        "m", "x0, thickness of oxide that slows its growth by e", above=1e-11, most=1e-6, default=0.2e-9
    )
    prefactor: float = parameter(
        "m/s", "A0, rate of growth on bare solids without a barrier", least=0.0, most=1e6, default=2.5e-3
    )
    activation_energy: float = parameter(
        "J", "E, barrier of the growth, per molecule", least=0.0, most=1e-18, default=4.98e-20
    )
    wear: float = parameter("", "K, dimensionless wear coefficient of the oxide", least=0.0, most=1.0, default=1e-5)
    hardness: float = parameter("Pa", "H, hardness of the oxide", above=1e6, most=1e12, default=6e9)
    closed: float = parameter(
        "m", "xc, thickness from which on the oxide bears all of the open solid", above=0.0, most=1e-6, default=2e-9
    )
    friction: float = parameter(
        "", "friction coefficient of solids under a closed oxide", least=0.0, most=2.0, default=0.12
    )
    thin: float = parameter(
        "m", "h_s, tribofilm that leaves the share 1/e of the solid open", above=0.0, most=1e-6, default=10e-9
    )
    volume_ratio: float = parameter(
        "", "volume of oxide over that of the steel it is made of", least=0.1, most=10.0, default=2.14
    )

    def growth(self, temperature: float) -> float:
        return self.prefactor * math.exp(-self.activation_energy / (BOLTZMANN * temperature))

    def removal(self, pressure: Numbers, sliding_speed: Numbers) -> Numbers:
        return self.wear * pressure * abs(sliding_speed) / self.hardness

    def left_open(self, film: Numbers) -> Numbers:
        return exp(-film / self.thin)

    def cover(self, oxide: Numbers) -> Numbers:
        return minimum(oxide / self.closed, 1.0)

    def added_friction(self, bare: float, oxides: Numbers, films: Numbers) -> Numbers:
        """Return what oxides add to a friction coefficient, `bare` being that of bare solids.

        `oxides` and `films` are the mean covers of both bodies, 0 to 1: the oxide lies where no tribofilm does.
        """
        return (self.friction - bare) * oxides * (1.0 - films)

    def evolve(self, oxide: Numbers, growing: Numbers, rubbing: Numbers) -> tuple[Numbers, Numbers]:
        """Return the oxide [m], and what was rubbed off it [m], after both rates have added up to these [m].

        Exact for any of them that stand in a fixed ratio.
        """
        start = np.asarray(oxide / self.scale, np.float64)
        gain, loss = np.broadcast_arrays(np.asarray(growing / self.scale), np.asarray(rubbing / self.scale))
        some = np.where(loss > 0.0, loss, 1.0)
        mean = np.where(loss > 0.0, -np.expm1(-some) / some, 1.0)  # of exp(-loss) over the time
        with np.errstate(divide="ignore"):
            end = np.logaddexp(start - loss, np.log(gain * mean))
        bare = end <= 0.0  # reached on the way
        ratio = np.where(bare, np.minimum(gain / some, _BELOW_ONE), 0.0)
        until = np.where(bare, start + np.log1p(-ratio * np.exp(-start)) - np.log1p(-ratio), loss)
        rest = np.where(bare, np.maximum(loss - until, 0.0), 0.0)
        after = np.where(bare, 0.0, end)
        return self.scale * after, self.scale * (np.minimum(until, loss) + ratio * rest)


LAWS: tuple[type[Oxide], ...] = (NoOxide, Logarithmic)
