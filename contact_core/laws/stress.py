"""Stresses below the surfaces: where and how often they are sampled, and the fatigue limits that they are held against.

The stresses themselves are those of `kernels.subsurface`; the cycles that they make of `kernels.load_cycle`.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..kernels.damage import faces_of
from ..kernels.load_cycle import Cycle
from ..quantities import parameter
from .base import Stress
from .equations import Equations

OF_STRESS = ("von_mises_max", "von_mises_depth", "near_surface_share", "dang_van_ratio", "crossland_ratio")

_UNIT = 1e9  # Pa
_RISK = 31.0 / 3.0  # power of a stress in the risk that a volume fails: Lundberg & Palmgren 1947
_FIRST = 0.5  # depth of the first layer over the spacing of the nodes; shorter waves lie nearer to the surface
_BOUNDS = (1.0, 2.0)  # of the limit in bending over that in torsion, between which Dang Van's slope is 0 or more


@dataclass(frozen=True)
class NoStress:
    """Nothing is known of what lies below the surfaces."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("σ = ?",),
        symbols={
            "σ": "stress below the surfaces [Pa]",
        },
        left_out="Stresses below the surfaces: von_mises_max and the fatigue ratios are zero, whatever the load.",
    )
    samples: ClassVar[bool] = False
    error: ClassVar[str] = ""
    instants: ClassVar[int] = 0
    near_surface: ClassVar[float] = 0.0
    opens_pits: ClassVar[bool] = False
    torsion_limit: ClassVar[float] = 1.0  # of nothing
    dang_van_slope: ClassVar[float] = 0.0
    crossland_slope: ClassVar[float] = 0.0

    def depths(self, spacing: float, half_width: float) -> Array:
        """Return no depths."""
        return np.empty(0)

    def residual_stress(self) -> Array:
        """Return no stress [Pa], [6]."""
        return np.zeros(6)


@dataclass(frozen=True)
class HalfSpace:
    """Stresses of an elastic half space under the pressure and shear of some instants of a pass.

    Two ratios tell how near the largest cycle of a pass is to the fatigue limits t in alternating torsion and b in
    alternating bending: Dang Van's largest tau + a_D p_h over t, a_D = 3 (t/b - 1/2), and Crossland's
    sqrt(J_2,a) + a_C max p_h over t, a_C = 3 t/b - sqrt(3). p_h is the hydrostatic stress, tension positive.
    """

    name: ClassVar[str] = "half_space"
    source: ClassVar[str] = (
        "Dang Van, Biaxial/Multiaxial Fatigue, ASTM STP 1191 (1993) 120, doi:10.1520/STP24799S; Crossland, Proc. Int. "
        "Conf. Fatigue of Metals, IMechE 1956, p. 138 (from memory); limits by default: of hardened 52100, "
        "Morales-Espejel & Brizmer 2011, doi:10.1080/10402004.2011.587633"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "R_D = max_t[τ(t) + 3 (t_{-1}/b_{-1} − 1/2) p_h(t)]/t_{-1}",
            "R_C = [√J_{2,a} + (3 t_{-1}/b_{-1} − √3) max_t p_h(t)]/t_{-1}",
        ),
        "p_h = tr σ/3, tension positive; τ is the largest shear stress about the middle of the cycle of the deviator, "
        "√J_{2,a} the radius of the smallest sphere around that cycle. Unloaded, σ is the residual stress.",
        symbols={
            "R_D": "dang_van_ratio [1]",
            "R_C": "crossland_ratio [1]",
            "t_{-1}": "torsion_limit",
            "b_{-1}": "bending_limit",
            "p_h": "hydrostatic stress, tension positive [Pa]",
            "J_{2,a}": "square of the radius of the smallest sphere around the deviators of a cycle [Pa2]",
        },
    )
    samples: ClassVar[bool] = True

    layers: int = parameter("", "depths at which stresses are sampled", least=2, most=64, default=8, shapes_arrays=True)
    deepest: float = parameter(
        "",
        "deepest of them, over the half width along x of Hertz's contact at the scene's load; the first lies half a "
        "node deep",
        above=0.0,
        most=10.0,
        default=1.0,
        shapes_arrays=True,
    )
    instants: int = parameter(
        "", "instants that stand for a pass of a surface point", least=2, most=512, default=8, shapes_arrays=True
    )
    near_surface: float = parameter(
        "", "depth over that half width down to which a stress is near the surface", above=0.0, most=1.0, default=0.1
    )
    pits: str = parameter(
        "",
        "micropits: counted, with their depth, while the surface stays as it is; open, holes in the surface, beside "
        "which more presses",
        choices=("counted", "open"),
        default="counted",
    )
    torsion_limit: float = parameter(
        "Pa",
        "fatigue limit in alternating torsion, amplitude",
        above=1e6,
        most=1e11,
        default=361.4e6,
        quantity="Stress",
    )
    bending_limit: float = parameter(
        "Pa",
        "fatigue limit in alternating bending, amplitude",
        above=1e6,
        most=1e11,
        default=625.9e6,
        quantity="Stress",
    )
    residual: float = parameter(
        "Pa",
        "residual stress along the surface in every direction, tension positive",
        least=-1e10,
        most=1e10,
        default=0.0,
        quantity="Stress",
    )

    @property
    def error(self) -> str:
        ratio = self.bending_limit / self.torsion_limit
        if _BOUNDS[0] <= ratio <= _BOUNDS[1]:
            return ""
        return (
            f"stress.bending_limit = {self.bending_limit:g} Pa is {ratio:.3g} times stress.torsion_limit = "
            f"{self.torsion_limit:g} Pa; of metals it is {_BOUNDS[0]:g} to {_BOUNDS[1]:g} times that. Change one."
        )

    @property
    def opens_pits(self) -> bool:
        return self.pits == "open"

    @property
    def dang_van_slope(self) -> float:
        return 3.0 * (self.torsion_limit / self.bending_limit - 0.5)

    @property
    def crossland_slope(self) -> float:
        return 3.0 * self.torsion_limit / self.bending_limit - 3.0**0.5

    def depths(self, spacing: float, half_width: float) -> Array:
        from ..kernels.subsurface import graded  # loads the compiler

        return graded(_FIRST * spacing, self.deepest * half_width, self.layers)

    def residual_stress(self) -> Array:
        """Return the residual stress [Pa], [6]: xx, yy, zz, yz, xz, xy."""
        return np.array([self.residual, self.residual, 0.0, 0.0, 0.0, 0.0])


def risk(shear: Array) -> Array:
    """Return the risk that a volume fails at an amplitude of shear [Pa], up to a factor."""
    found: Array = (shear * (1.0 / _UNIT)) ** _RISK
    return found


def share_down_to(depth: float, risks: Array, depths: Array) -> float:
    """Return the share of a risk down to a depth [m], of the mean `risks` of the layers at `depths` [m].

    A layer reaches halfway to its neighbours; the last one ends where it lies.
    """
    by_layer = risks * np.diff(np.append(faces_of(depths)[:-1], depths[-1]))
    total = float(by_layer.sum())
    return float(by_layer[depths <= depth].sum()) / total if total > 0.0 else 0.0


def ratios(law: Stress, cycle: Cycle) -> tuple[float, float]:
    """Return Dang Van's and Crossland's largest stress of load cycles over the fatigue limit in torsion, at least 0."""
    crossland = cycle.shear + law.crossland_slope * cycle.hydrostatic
    first, second = (max(0.0, float(stress.max())) / law.torsion_limit for stress in (cycle.dang_van, crossland))
    return first, second


LAWS: tuple[type[Stress], ...] = (NoStress, HalfSpace)
