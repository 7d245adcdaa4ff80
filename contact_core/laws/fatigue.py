"""Damage of the solids by load cycles: each takes its share of a life, and at a sum of 1 the material fails.

The sum over cycles of unlike stress is Palmgren's and Miner's: Miner, J. Appl. Mech. 12 (1945) A159,
doi:10.1115/1.4009458. A cycle takes at most all of a life: lines of lives end at one cycle.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..kernels.load_cycle import Cycle
from ..quantities import parameter
from .base import Fatigue
from .equations import Equations

_MISES = 3.0**0.5  # von Mises stress over sqrt(J2)


@dataclass(frozen=True)
class NoFatigue:
    """Load cycles leave the solids as they are."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("D = 0",),
        symbols={
            "D": "damage; the material fails at 1 [1]",
        },
        left_out="Fatigue: load cycles damage nothing, and no micropits break out.",
    )
    damages: ClassVar[bool] = False

    def per_cycle(self, cycle: Cycle) -> Array:
        """Return 0: no cycle damages."""
        return np.zeros_like(cycle.shear)


@dataclass(frozen=True)
class Basquin:
    """A line of lives over the von Mises amplitude of the cycle, whatever its mean stress.

    The amplitude is sqrt(3) times the radius of the smallest sphere around the deviators of the cycle, in alternating
    tension the amplitude of the tension.
    """

    name: ClassVar[str] = "basquin"
    source: ClassVar[str] = (
        "Basquin, Proc. ASTM 10 (1910) 625; amplitude: Bernasconi, Int. J. Fatigue 24 (2002) 649, "
        "doi:10.1016/S0142-1123(01)00181-5; sum: Miner 1945, doi:10.1115/1.4009458"
    )
    equations: ClassVar[Equations] = Equations(
        ("D = Σ 1/N,   N = N_{ref} (S_{ref}/S)^m", "S = √3 √J_{2,a} > S_{limit}"),
        "√J_{2,a} is the radius of the smallest sphere around the deviators of a cycle. Material fails at D = 1.",
        symbols={
            "D": "damage; the material fails at 1 [1]",
            "N": "cycles to failure [1]",
            "N_{ref}": "reference_cycles",
            "S_{ref}": "reference_stress",
            "S": "von Mises amplitude of the cycle [Pa]",
            "m": "life_exponent",
            "S_{limit}": "endurance_limit",
            "J_{2,a}": "square of the radius of the smallest sphere around the deviators of a cycle [Pa2]",
        },
    )
    damages: ClassVar[bool] = True

    reference_stress: float = parameter(
        "Pa", "S_ref, von Mises amplitude that fails after the reference cycles", above=1e5, most=1e11
    )
    life_exponent: float = parameter("", "m, exponent of the line of lives", least=1.0, most=50.0)
    reference_cycles: float = parameter(
        "", "N_ref, cycles to failure at the reference stress", least=1.0, most=1e15, default=1e7
    )
    endurance_limit: float = parameter(
        "Pa", "S_limit, von Mises amplitude up to which nothing counts", least=0.0, most=1e11, default=0.0
    )

    def per_cycle(self, cycle: Cycle) -> Array:
        """Return the damage by one cycle, 0 to 1."""
        stress = _MISES * cycle.shear
        fails = self.reference_cycles ** (1.0 / self.life_exponent)  # at the first cycle, over the reference stress
        ratio = np.minimum(stress / self.reference_stress, fails)
        share = np.minimum(ratio**self.life_exponent / self.reference_cycles, 1.0)
        return np.where(stress > self.endurance_limit, share, 0.0)


@dataclass(frozen=True)
class DangVan:
    """Woehler's line over Dang Van's stress: shear of the cycle and hydrostatic stress together.

    The stress falls by the same amount for each factor e of the life. It is weighed by limits of the table `stress`;
    under pressure alone it is below zero, and nothing counts.
    """

    name: ClassVar[str] = "dang_van"
    source: ClassVar[str] = (
        "Morales-Espejel & Brizmer, Tribol. Trans. 54 (2011) 625, doi:10.1080/10402004.2011.587633, equations 9 to 11; "
        "criterion: Dang Van, ASTM STP 1191 (1993) 120; sum: Miner 1945, doi:10.1115/1.4009458"
    )
    equations: ClassVar[Equations] = Equations(
        ("D = Σ 1/N,   S = S_1 − B ln N", "S = max_t[τ(t) + 3 (t_{-1}/b_{-1} − 1/2) σ_h(t)] > S_{limit}"),
        "τ is the largest shear of the deviator less the centre of the smallest sphere around the cycle's deviators, "
        "σ_h the hydrostatic stress, tension positive. Material fails at D = 1.",
        symbols={
            "D": "damage; the material fails at 1 [1]",
            "N": "cycles to failure [1]",
            "S": "Dang Van's stress [Pa]",
            "S_1": "single_strength",
            "B": "strength_drop",
            "S_{limit}": "torsion_endurance",
            "t_{-1}": "fatigue limit in torsion, stress.torsion_limit [Pa]",
            "b_{-1}": "fatigue limit in bending, stress.bending_limit [Pa]",
        },
    )
    damages: ClassVar[bool] = True

    single_strength: float = parameter(
        "Pa", "S_1, amplitude in alternating torsion at which the line ends at one cycle", above=1e6, most=1e11
    )
    strength_drop: float = parameter(
        "Pa", "B, by how much the amplitude falls for each factor e of the life", above=1e4, most=1e10
    )
    torsion_endurance: float = parameter(
        "Pa", "S_limit, Dang Van's stress up to which nothing counts", least=0.0, most=1e11, default=0.0
    )

    def per_cycle(self, cycle: Cycle) -> Array:
        """Return the damage by one cycle, 0 to 1."""
        share = np.exp(np.minimum((cycle.dang_van - self.single_strength) / self.strength_drop, 0.0))
        return np.where(cycle.dang_van > self.torsion_endurance, share, 0.0)


@dataclass(frozen=True)
class Morrow:
    """Plastic work per cycle, as on the cyclic stress-strain curve at the von Mises amplitude of the elastic stress.

    At the exponent 1 the work up to failure is the same for all amplitudes. Asperities that the elastic stress takes
    beyond the curve's range are damaged more than they would be: there is no relief by flow.
    """

    name: ClassVar[str] = "morrow"
    source: ClassVar[str] = (
        "Morrow, Cyclic plastic strain energy and fatigue of metals, ASTM STP 378 (1965) 45 (from memory); amplitude: "
        "Bernasconi, Int. J. Fatigue 24 (2002) 649, doi:10.1016/S0142-1123(01)00181-5; sum: Miner 1945, "
        "doi:10.1115/1.4009458"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "D = Σ 1/N,   2 N = (W_f/ΔW)^e",
            "ΔW = 4 (1 − n)/(1 + n) S (S/K)^{1/n},   S = √3 √J_{2,a}",
        ),
        "√J_{2,a} is the radius of the smallest sphere around the deviators of a cycle. With strain lives σ_f (2N)^b/E "
        "+ ε_f (2N)^c: W_f = 4 σ_f ε_f (c − b)/(c + b) and e = −1/(b + c).",
        symbols={
            "D": "damage; the material fails at 1 [1]",
            "N": "cycles to failure [1]",
            "W_f": "failure_work",
            "ΔW": "plastic work per cycle [J/m3]",
            "e": "work_exponent",
            "n": "cyclic_hardening",
            "S": "von Mises amplitude of the cycle [Pa]",
            "K": "cyclic_strength",
            "J_{2,a}": "square of the radius of the smallest sphere around the deviators of a cycle [Pa2]",
        },
    )
    damages: ClassVar[bool] = True

    cyclic_strength: float = parameter("Pa", "K, stress amplitude at a plastic strain of 1", above=1e6, most=1e11)
    cyclic_hardening: float = parameter("", "n, exponent of the cyclic stress-strain curve", least=0.02, most=0.9)
    failure_work: float = parameter(
        "J/m3", "W_f, plastic work per cycle that fails after half a cycle", above=1e3, most=1e12
    )
    work_exponent: float = parameter("", "e, exponent of lives over the work per cycle", least=0.5, most=5.0)

    def per_cycle(self, cycle: Cycle) -> Array:
        """Return the damage by one cycle, 0 to 1."""
        n, stress = self.cyclic_hardening, _MISES * cycle.shear
        with np.errstate(divide="ignore"):
            strain = (np.log(stress) - np.log(self.cyclic_strength)) / n
            work = np.log(4.0 * (1.0 - n) / (1.0 + n)) + np.log(stress) + strain
        return np.exp(np.minimum(np.log(2.0) + self.work_exponent * (work - np.log(self.failure_work)), 0.0))


LAWS: tuple[type[Fatigue], ...] = (NoFatigue, Basquin, DangVan, Morrow)
