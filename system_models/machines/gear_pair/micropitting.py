"""Safety against micropitting by ISO/TS 6336-22 (before: ISO/TR 15144-1): film over roughness, along the path.

Formulas from memory, as the standard could not be looked up. What could be checked: the film is that of Dowson &
Higginson 1966, the flash temperature Blok's of 1937 within 2 %, H_V Ohlendorf's. The pressure coefficient at 38 degC is
the oil's own, which comes before the standard's estimate for oils without one. Loads: method A, as the machine shares
them; all else: method B. Meant for contact ratios below 2.
"""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from contact_core.kernels.arrays import Array
from contact_core.laws.base import Viscosity

from .geometry import FZG_C, FZG_STAGES
from .sharing import Sharing
from .textbook import michaelis
from .working import Working

EFFUSIVITY = 435.0 * math.sqrt(1000.0)  # B_M of case-hardened steel [W s^0.5 / (m2 K)]; ISO/TR 13989-1, annex A.3
_COOL = 311.0  # K, 38 degC as in the formula of the pressure coefficient
_SMALL = 1e6  # Pa, over which the pressure coefficient is taken
MARGIN = 1.4  # between the film that the test gears fail with and that which gears may have

# The test of FVA 54/7 (GF-C/8.3/90): FZG type C, lever of 0.35 m, oil jet at 90 degC. Ra: of its drawing, from memory
TEST_LEVER = 0.35  # m
TEST_STAGES = FZG_STAGES[TEST_LEVER]
TEST_SPEED = 2250.0 * math.pi / 30.0
TEST_OIL = 363.15
TEST_RA = 0.5e-6
_JET = 1.2


class Films(NamedTuple):
    """Along the path of contact; arrays [n] at `Working.places` but for bulk."""

    bulk: float  # theta_M [K]
    temperature: Array  # theta_B, bulk and flash [K]
    film: Array  # h_Y [m]
    ratio: Array  # lambda_GF,Y = h_Y / Ra

    @property
    def least(self) -> float:
        """lambda_GF,min."""
        return float(self.ratio.min())


def films(working: Working) -> Films:
    """Return temperatures and films of a gear pair at work.

    h_Y = 1.6 rho G_M^0.6 U_Y^0.7 W_Y^-0.13 S_GF,Y^0.22 with G_M = alpha E_r, U_Y = eta v_sum / (2 E_r rho),
    W_Y = 2 pi p^2 / E_r^2 at the bulk temperature; S_GF,Y = alpha eta at the contact temperature over that at the
    bulk temperature, for the heat of sliding.
    """
    friction = mean_friction(working)
    bulk = bulk_temperature(working, friction)
    temperature = bulk + flash(working, friction)
    modulus, (u1, u2), law = working.pair.reduced_modulus, working.speeds, working.viscosity
    bulks, free = np.full_like(temperature, bulk), np.zeros_like(temperature)  # [K], and pressure [Pa]
    alpha, eta = pressure_coefficient(law, bulks), law(free, bulks)
    sliding = pressure_coefficient(law, temperature) * law(free, temperature) / (alpha * eta)
    speed = eta * (u1 + u2) / (2.0 * modulus * working.radius)
    load = 2.0 * math.pi * (working.pressure / modulus) ** 2
    with np.errstate(divide="ignore"):  # without load the film has no end
        film = 1.6 * working.radius * (alpha * modulus) ** 0.6 * speed**0.7 * load**-0.13 * sliding**0.22
    return Films(bulk, temperature, film, film / working.ra)


def mean_friction(working: Working) -> float:
    """Return mu_m, for the force along the line of action."""
    factor = working.rating.oil_factor
    return michaelis(working.pair, working.force, working.speed, working.oil_viscosity, working.ra, factor)


def bulk_temperature(working: Working, friction: float) -> float:
    """Return theta_M [K], theta_oil + 7400 [P mu H_V / (a b)]^0.72 X_S / 1.2, with P in kW, a and b in mm."""
    area = 1e6 * working.pair.centre_distance * working.pair.face_width
    return working.oil + 7400.0 * (1e-3 * working.lost * friction / area) ** 0.72 * working.rating.supply_factor / 1.2


def flash(working: Working, friction: float) -> Array:
    """Return theta_fl [K], 0.5 sqrt(pi) mu p |u1 - u2| sqrt(8 rho p / E_r) / [B_M (sqrt u1 + sqrt u2)]."""
    u1, u2 = working.speeds
    width = np.sqrt(8.0 * working.radius * working.pressure / working.pair.reduced_modulus)
    rubbing = friction * working.pressure * np.abs(np.sqrt(u1) - np.sqrt(u2))  # |u1 - u2| / (sqrt u1 + sqrt u2)
    return 0.5 * math.sqrt(math.pi) * rubbing * width / EFFUSIVITY


def pressure_coefficient(law: Viscosity, temperature: Array) -> Array:
    """Return alpha [1/Pa], alpha_38 [1 + 516 (1/T - 1/311)]; alpha_38 is d ln eta / dp of the oil's law at p = 0."""
    own = math.log(float(law(_SMALL, _COOL)) / float(law(0.0, _COOL))) / _SMALL
    return own * (1.0 + 516.0 * (1.0 / temperature - 1.0 / _COOL))


def reference_test(working: Working, stage: int) -> Working:
    """Return the test gears of FVA 54/7 with the oil at a load stage, with elastic teeth."""
    rating = replace(working.rating, supply_factor=_JET)
    torque = TEST_STAGES[stage - 1]
    return Working(FZG_C, Sharing("elastic"), torque, TEST_SPEED, TEST_OIL, working.viscosity, TEST_RA, rating)


def limit(working: Working, before: int = 0) -> float:
    """Return lambda_GFT, the ratio with which the oil fails in the test; or that some load stages before."""
    return films(reference_test(working, working.rating.micropitting_stage - before)).least


def safety(ratio: float, failing: float, material_factor: float) -> float:
    """Return S_lambda of a least ratio: over lambda_GFP, 1.4 W_W times the ratio with which the oil fails the test.

    S_lambda = min(h_Y / Ra) / (1.4 W_W lambda_GFT); bulk temperature theta_M = theta_oil + 7400 [P mu H_V / (a b)]^0.72
    X_S / 1.2 (kW, mm). lambda_GFT is the least h_Y / Ra of the test gears at the load stage at which the oil fails.
    """
    return ratio / (MARGIN * material_factor * failing)


def gf_class(failed: int | None) -> str:
    """Return the class of FVA 54/7 of an oil that fails at a load stage, or at none up to 10.

    It fails if the mean deviation of the profile exceeds 7.5 um after 16 h (from memory, as the classes).
    """
    if failed is None or failed >= 10:
        return "high"
    return "medium" if failed >= 8 else "low"
