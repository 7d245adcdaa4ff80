"""Temperatures of the surfaces and of the film between them, and the heat flows into the bodies.

All laws answer to `temperatures` of a `Rubbing`.
"""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from ..kernels.arrays import Array, Mask
from ..kernels.moving_source import MovingSurface, partition
from ..quantities import parameter
from .base import Bulk, Heat
from .bulk import OilBulk
from .elementary import Numbers, sqrt
from .equations import Equations
from .temperatures import Rubbing, Temperatures

Pair = tuple[float, float]

_AS_THE_OIL = OilBulk()
_CREEP = 1e-3  # Peclet number
_MATCHED = 1e-6  # mismatch up to which temperatures count as solved; the solver aims at 1e-7


def _flat(bodies: Pair, into_1: float, into_2: float) -> Temperatures:
    """Return surfaces with the temperatures of their bodies."""
    return Temperatures(*bodies, 0.5 * (bodies[0] + bodies[1]), into_1, into_2, 0.0, True)


def _spots(solid: Mask, *, periodic: bool) -> tuple[NDArray[np.int32], int]:
    """Return the number of the connected set of each node, from 1 (0: none), and their count."""
    spots, count = scipy.ndimage.label(solid)
    meeting = (spots[0] > 0) & (spots[-1] > 0)
    if not (periodic and meeting.any()):
        return spots, count
    links = (np.ones(int(meeting.sum())), (spots[0][meeting], spots[-1][meeting]))
    joined = scipy.sparse.coo_array(links, shape=(count + 1, count + 1))
    found, numbers = scipy.sparse.csgraph.connected_components(joined, directed=False)
    order = (numbers - numbers[0]) % found  # nodes outside spots keep 0
    return order[spots].astype(spots.dtype), found - 1


# of a source on a circle and on a strip: rise fast, and what stands beside the Peclet number or the logarithm at rest.
# Mean rise under an even source; largest under one spread like Hertz's pressure, exact at rest and fast
_EVEN, _HOTTEST = (1.22, 0.6575), (2.3210, 1.2355)
_STRIP_EVEN, _STRIP_HOTTEST = (9.0 / 32.0 * math.pi, 0.5), (0.5 * math.pi / 1.9702**2, 0.5 + math.log(2.0))


def _conductance(
    radius: Numbers, speed: Numbers, conductivity: float, diffusivity: float, source: Pair = _EVEN
) -> Numbers:
    """Return the heat flux per rise [W/(m2 K)] under a source on a moving circle.

    It has a `radius` [m] and moves at `speed` [m/s]. `source`: mean rise of an even one (Tian & Kennedy 1994,
    doi:10.1115/1.2927035), or largest of one like Hertz's pressure, joined likewise: up to 1.1 % too cool.
    """
    fast, rest = source
    moving = sqrt(rest + abs(speed) * radius / (2.0 * diffusivity))
    return math.sqrt(math.pi) / (fast * radius) * conductivity * moving


def _strip_conductance(
    a: Numbers, b: float, speed: Numbers, conductivity: float, diffusivity: float, source: Pair = _STRIP_EVEN
) -> Numbers:
    """Return the heat flux per rise [W/(m2 K)] under a source on a moving strip.

    The strip is |x| < a, |y| < b [m], b >> a, and moves along x at `speed`. Mean rise of an even source: at rest
    pi K / {2 a [ln(2 b / a) + 1/2]}, fast 3/4 K sqrt(pi u / (2 k a)), both from Jaeger's sources; between them as Tian
    & Kennedy join those of a circle, up to 11 % too cool. Largest of a source like Hertz's pressure: likewise.
    """
    moving, beside = source
    rest = 0.5 * math.pi / (a * (np.log(2.0 * b / a) + beside))
    return conductivity * sqrt(rest * rest + moving * abs(speed) / (diffusivity * a))


def _conductivity(body: int) -> Any:
    return parameter("W/(m K)", f"thermal conductivity of body {body}", least=1e-3, most=1e4)


def _diffusivity(body: int) -> Any:
    return parameter("m2/s", f"thermal diffusivity of body {body}", least=1e-9, most=1.0, quantity="ThermalDiffusivity")


def _inlet_shear() -> Any:
    text = "thinning of the film by shear heating in the inlet"
    return parameter("", text, choices=("none", "gupta"), default="none")


_INLET_SHEAR = {
    "gupta": Equations(
        (
            "φ = [1 − 13.2 (p_H/E′) Q^{0.42}]/[1 + 0.213 (1 + 2.23 |S|^{0.83}) Q^{0.64}]",
            "Q = η_0 β u_e^2/k,   S = (u_1 − u_2)/u_e",
        ),
        "Shear warms the oil in the inlet: the film is φ of the isothermal one; β is −d ln η/dT there, k the oil's "
        "conductivity.",
        source="Gupta, Cheng, Zhu, Forster & Schrand 1992, doi:10.1080/10402009208982117",
        symbols={
            "φ": "film thickness over that of an isothermal inlet [1]",
            "S": "slide-to-roll ratio [1]",
            "β": "−d ln η/dT in the inlet [1/K]",
            "k": "conductivity of the oil, lubricant.conductivity [W/(m K)]",
        },
    ),
}


@dataclass(frozen=True)
class NoHeat:
    """The surfaces have the temperatures of their bodies, and these share the heat in halves."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("T = T_{bulk},   Q_1 = Q_2 = P/2",),
        "The surfaces have the temperatures of their bodies.",
        symbols={
            "Q_1": "heat that the contact puts into body 1 [W]",
            "Q_2": "heat that the contact puts into body 2 [W]",
        },
        left_out=(
            "Heat of friction: surfaces and oil stay at the temperature of the bodies. Hot spots grow tribofilm no "
            "faster, and sliding films rub too much: in a full film of an MTM contact (1.15 GPa, oil of 20 mPa s) by "
            "10 % at 1 m/s of sliding, by 30 % at 3 m/s."
        ),
    )
    inlet_shear: ClassVar[str] = "none"
    warms_film: ClassVar[bool] = False  # the oil in the contact is at another temperature than in the inlet

    bulk: Bulk = _AS_THE_OIL

    def spot_rise(self, radius: Numbers, shear: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the flash temperature rise [K] of spots: 0."""
        return 0.0

    def spot_share(self, radius: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the share of the heat of spots that goes into body 1: a half."""
        return 0.5

    def conductances(self, radius: Array, speeds: tuple[Array, Array], *, hottest: bool = False) -> tuple[Array, Array]:
        """Return the heat flux per rise [W/(m2 K)]: infinite, no surface is warmer than its body."""
        return np.full_like(radius, np.inf), np.full_like(radius, np.inf)

    def strip_conductances(
        self, a: Array, b: float, speeds: tuple[Array, Array], *, hottest: bool = False
    ) -> tuple[Array, Array]:
        """Return the heat flux per rise [W/(m2 K)]: infinite, as on a circle."""
        return self.conductances(a, speeds)

    def temperatures(self, rubbing: Rubbing) -> Temperatures:
        """Return the temperatures and the heat flows. Makes no array."""
        half = 0.5 * rubbing.total
        return _flat(rubbing.bodies, half, half)


@dataclass(frozen=True)
class _Conductors:
    """Two bodies that conduct heat."""

    conductivity_1: float = _conductivity(1)
    conductivity_2: float = _conductivity(2)
    diffusivity_1: float = _diffusivity(1)
    diffusivity_2: float = _diffusivity(2)
    inlet_shear: str = _inlet_shear()
    bulk: Bulk = _AS_THE_OIL

    def conductances(self, radius: Array, speeds: tuple[Array, Array], *, hottest: bool = False) -> tuple[Array, Array]:
        """Return the heat flux per mean rise [W/(m2 K)] into each body under an even source on a circle [m].

        `hottest`: mean flux per largest rise, under a source spread like Hertz's pressure. A body at rest counts as one
        that creeps at a Peclet number of 1e-3, so that the conductance has no kink there.
        """
        source = _HOTTEST if hottest else _EVEN
        first, second = (
            _conductance(
                radius, np.hypot(speed, _CREEP * 2.0 * diffusivity / radius), conductivity, diffusivity, source
            )
            for speed, conductivity, diffusivity in self._moving(speeds)
        )
        return first, second

    def strip_conductances(
        self, a: Array, b: float, speeds: tuple[Array, Array], *, hottest: bool = False
    ) -> tuple[Array, Array]:
        source = _STRIP_HOTTEST if hottest else _STRIP_EVEN
        first, second = (
            _strip_conductance(a, b, np.hypot(speed, _CREEP * 2.0 * diffusivity / a), conductivity, diffusivity, source)
            for speed, conductivity, diffusivity in self._moving(speeds)
        )
        return first, second

    def _moving(self, speeds: tuple[Array, Array]) -> tuple[tuple[Array, float, float], ...]:
        """Return speed, conductivity and diffusivity of each body."""
        return (
            (speeds[0], self.conductivity_1, self.diffusivity_1),
            (speeds[1], self.conductivity_2, self.diffusivity_2),
        )


@dataclass(frozen=True)
class FlashTemperature(_Conductors):
    """Average rise over circular spots that move at the sliding speed over both bodies.

    Azam's equation (5-7), the Tian-Kennedy average for a uniform source:
    dT = 1.22 r q / { sqrt(pi) [ K1 sqrt(0.6575 + u_s r/(2 k1)) + K2 sqrt(0.6575 + u_s r/(2 k2)) ] }, q = tau u_s.
    The equation takes u_s for both bodies; `TemperatureField` takes each body's own speed. A spot is a connected set of
    contact nodes, r the radius of the circle of its area. The two terms in brackets also say how the bodies share its
    heat; the heat of the oil goes to them in halves, and the film has the mean temperature of the bodies.
    """

    name: ClassVar[str] = "flash"
    source: ClassVar[str] = "Tian & Kennedy 1994, doi:10.1115/1.2927035"
    equations: ClassVar[Equations] = Equations(
        (
            "ΔT = 1.22 r q/{√π [K_1 (0.6575 + Pe_1)^{1/2} + K_2 (0.6575 + Pe_2)^{1/2}]}",
            "q = τ |u_1 − u_2|,   Pe_i = |u_1 − u_2| r/(2 κ_i)",
        ),
        "The mean rise of a contact spot of radius r; K and κ are conductivity and diffusivity of the bodies.",
        options={"inlet_shear": _INLET_SHEAR},
        symbols={
            "ΔT": "mean rise of a spot of solid contact [K]",
            "r": "radius of the circle of the spot's area [m]",
            "K_1": "conductivity_1",
            "K_2": "conductivity_2",
            "κ_i": "diffusivity of body i, diffusivity_1 and diffusivity_2 [m2/s]",
            "Pe_1": "Péclet number of body 1 [1]",
            "Pe_2": "Péclet number of body 2 [1]",
        },
        left_out=(
            "Warming of the oil in the contact: only spots of solid contact are warmer than their bodies. Sliding "
            "films rub too much: in a full film of an MTM contact (1.15 GPa, oil of 20 mPa s) by 10 % at 1 m/s of "
            "sliding, by 30 % at 3 m/s; model = 'field' warms them."
        ),
    )
    warms_film: ClassVar[bool] = False

    def spot_rise(self, radius: Numbers, shear: Numbers, sliding_speed: Numbers) -> Numbers:
        into_1, into_2 = self._conduction(radius, sliding_speed)
        return abs(shear * sliding_speed) / (into_1 + into_2)

    def spot_share(self, radius: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the share of the heat of spots of `radius` [m] that goes into body 1."""
        into_1, into_2 = self._conduction(radius, sliding_speed)
        return into_1 / (into_1 + into_2)

    def temperatures(self, rubbing: Rubbing) -> Temperatures:
        """Return the temperatures and the heat flows."""
        total, bodies, solid = rubbing.total, rubbing.bodies, rubbing.solid
        if total == 0.0 or not solid.any():
            return _flat(bodies, 0.5 * total, 0.5 * total)
        spots, count = _spots(solid, periodic=rubbing.face is not None)
        nodes = np.bincount(spots.ravel(), minlength=count + 1)[1:]
        heat = np.bincount(spots.ravel(), rubbing.dissipation.ravel(), count + 1)[1:]
        into_1, into_2 = self._conduction(
            np.sqrt(nodes * rubbing.spacing**2 / np.pi), rubbing.speeds[0] - rubbing.speeds[1]
        )
        rise = heat / nodes / (into_1 + into_2)
        beyond = float((heat * (into_1 / (into_1 + into_2) - 0.5)).sum()) * rubbing.spacing**2
        on_nodes = np.append(0.0, rise)[spots]
        surface_1 = bodies[0] + on_nodes
        return Temperatures(
            surface_1=surface_1,
            surface_2=surface_1 if bodies[0] == bodies[1] else bodies[1] + on_nodes,
            film=0.5 * (bodies[0] + bodies[1]),
            into_1=0.5 * total + beyond,
            into_2=0.5 * total - beyond,
            flash_rise=float((rise * nodes).sum() / nodes.sum()),
            solved=True,
        )

    def _conduction(self, radius: Numbers, sliding_speed: Numbers) -> tuple[Numbers, Numbers]:
        """Return the heat flux per mean rise of a spot [W/(m2 K)] into each body."""
        first = _conductance(radius, sliding_speed, self.conductivity_1, self.diffusivity_1)
        return first, _conductance(radius, sliding_speed, self.conductivity_2, self.diffusivity_2)


@dataclass(frozen=True)
class TemperatureField(_Conductors):
    """Steady temperature of both surfaces node by node, each moving at its own speed through the heat it takes up.

    The film dissipates evenly over its thickness and conducts across it, so the surfaces' temperatures fit its own at
    every node; where solids touch the gap is the film's floor, which conducts so well that they are nearly equal. Only
    nodes under pressure conduct. Around them the gap may not be full of oil, and the heat that bodies of different
    temperature exchange there would depend on where the grid ends. Such nodes give the heat of their oil to the bodies
    in halves. Steady means that the source is fixed in the contact while the surfaces pass.
    """

    name: ClassVar[str] = "field"
    source: ClassVar[str] = "Jaeger, Proc. R. Soc. N. S. W. 76 (1942) 203; Carslaw & Jaeger 1959, section 10.7"
    equations: ClassVar[Equations] = Equations(
        (
            "T_i = T_{bulk,i} + G_i ∗ q_i,   q_1 + q_2 = q = τ |v|",
            "q_1 = q/2 + (k/h) (T_2 − T_1)",
        ),
        "G is the steady rise under a source that moves at the body's own speed, ∗ the sum over "
        "all nodes; the film conducts across its thickness.",
        options={"inlet_shear": _INLET_SHEAR},
        symbols={
            "T_i": "temperature of the surface of body i [K]",
            "T_1": "temperature of the surface of body 1 [K]",
            "T_2": "temperature of the surface of body 2 [K]",
            "G_i": (
                "steady rise per heat of a source that moves at the body's own speed, by its conductivity and "
                "diffusivity [K m2/W]"
            ),
            "q_i": "heat per area into body i [W/m2]",
            "q_1": "heat per area into body 1 [W/m2]",
            "q_2": "heat per area into body 2 [W/m2]",
            "k": "conductivity of the oil, lubricant.conductivity [W/(m K)]",
        },
    )
    warms_film: ClassVar[bool] = True

    def spot_rise(self, radius: Numbers, shear: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the flash temperature rise [K] of spots: 0, the law has nodes and no spots."""
        return 0.0

    def spot_share(self, radius: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the share of the heat of spots that goes into body 1: a half, the law has no spots."""
        return 0.5

    def temperatures(self, rubbing: Rubbing) -> Temperatures:
        """Return the temperatures and the heat flows."""
        bodies, solid, spacing = rubbing.bodies, rubbing.solid, rubbing.spacing
        difference = bodies[1] - bodies[0]
        if not rubbing.dissipation.any() and (difference == 0.0 or not rubbing.inside.any()):
            return _flat(bodies, 0.0, 0.0)
        shape = (rubbing.gap.shape[0], rubbing.gap.shape[1])
        surfaces = (
            MovingSurface(shape, spacing, self.conductivity_1, self.diffusivity_1, rubbing.speeds[0], rubbing.face),
            MovingSurface(shape, spacing, self.conductivity_2, self.diffusivity_2, rubbing.speeds[1], rubbing.face),
        )
        resistance = rubbing.gap / rubbing.oil_conductivity
        found = partition(rubbing.dissipation, resistance, rubbing.inside, difference, surfaces)
        surface_1, surface_2 = bodies[0] + found.rise_1, bodies[1] + found.rise_2
        rise = 0.5 * (found.rise_1 + found.rise_2)
        return Temperatures(
            surface_1=surface_1,
            surface_2=surface_2,
            film=0.5 * (surface_1 + surface_2) + rubbing.dissipation * resistance / 12.0,
            into_1=float(found.into_1.sum()) * spacing**2,
            into_2=float(found.into_2.sum()) * spacing**2,
            flash_rise=float(rise[solid].mean()) if solid.any() else 0.0,
            solved=found.mismatch <= _MATCHED,
        )


LAWS: tuple[type[Heat], ...] = (NoHeat, FlashTemperature, TemperatureField)
