"""Safety against scuffing: flash temperature (ISO/TS 6336-20) and integral temperature (ISO/TS 6336-21).

The numbers are those of their forerunners ISO/TR 13989-1 and -2 (2000). Those of part 1 have been looked up in a
program that quotes its equations; those of part 2 are from memory, checked by what must agree: torques of the test, and
the flash temperature of its gears. Formulas are in degC; there is no extra for short contact times.
"""

import math
from typing import NamedTuple

import numpy as np

from contact_core.kernels.arrays import Array
from contact_core.laws.viscosity import kinematic_viscosity
from contact_core.quantities import CELSIUS

from .geometry import SpurGearPair
from .sharing import mean_stiffness
from .textbook import michaelis
from .working import Working

_THERMOELASTIC = 50.0  # X_M [K N^-0.75 s^0.5 m^-0.5 mm]: steel of 206 GPa, B_M = 435 N / (mm^0.5 m^0.5 s^0.5 K)
_STEEL = 206e9 / (1.0 - 0.3**2)  # Pa, E_r of it
_TORQUE = 3.726  # N m: torque of load stage k of A/8.3/90 is that times k^2; from memory
_HEAT, _WEIGHT = 0.7, 1.5  # C_1 and C_2 of the integral temperature; from memory


class Flash(NamedTuple):
    """Flash temperature method; arrays [n] at `Working.places`."""

    bulk: float  # theta_M [K]
    temperature: Array  # theta_B [K]
    limit: float  # theta_S [K]
    safety: float  # S_B


class Integral(NamedTuple):
    """Integral temperature method."""

    bulk: float  # theta_M [K]
    temperature: float  # theta_int [K]
    limit: float  # theta_intS [K]
    safety: float  # S_intS = theta_intS / theta_int, in degC


def margin(limit: float, hottest: float, oil: float) -> float:
    """Return S_B, the rise [K] over the oil that is allowed, over that which there is; infinite if there is none."""
    return (limit - oil) / (hottest - oil) if hottest > oil else math.inf


def by_flash(working: Working) -> Flash:
    """Return the flash temperature method: theta_M = theta_oil + 0.47 X_S theta_flm, theta_B = theta_M + theta_fl.

    S_B = (theta_S - theta_oil) / (max theta_B - theta_oil), theta_fl = 2.52 mu (X_M / 50) X_J (X w)^0.75 (n_1 / 60)^0.5
    |sqrt(rho_1) - sqrt(rho_2 / u)| / rho^0.25 (N/mm, rpm, mm), theta_S = 80 + (0.85 + 1.4 X_W) X_L S^2, S being the
    load stage of A/8.3/90.
    """
    rise = flash(working)
    bulk = working.oil + 0.47 * working.rating.supply_factor * working.mean(rise)
    temperature, limit = bulk + rise, scuffing_temperature(working)
    return Flash(bulk, temperature, limit, margin(limit, float(temperature.max()), working.oil))


def scuffing_temperature(working: Working) -> float:
    """Return theta_S [K], 80 + (0.85 + 1.4 X_W) X_L S^2 degC, S being the stage at which the oil fails A/8.3/90."""
    rating = working.rating
    welding = 0.85 + 1.4 * rating.structural_factor
    return CELSIUS + 80.0 + welding * oil_factor(working) * rating.scuffing_stage**2


def oil_factor(working: Working) -> float:
    """Return X_L of part 1, that of the kind of oil times eta^-0.05, mPa s at the oil's temperature."""
    return working.rating.oil_factor * (1e3 * working.oil_viscosity) ** -0.05


def mean_friction(working: Working) -> float:
    """Return mu_m of part 1, 0.060 [w / (v_sum rho)]^0.2 X_L Ra^0.25, in N/mm, m/s, mm and um."""
    pair = working.pair
    reduced = 1e3 * pair.pitch_point * (1.0 - pair.pitch_point / pair.line_length)
    intensity = _line_load(working) / (2.0 * working.speed * pair.pitch_point * reduced)
    return 0.060 * intensity**0.2 * oil_factor(working) * (1e6 * working.ra) ** 0.25


def flash(working: Working) -> Array:
    """Return theta_fl [K], 2.52 mu X_M/50 X_J (X w)^0.75 sqrt(n1/60) |sqrt rho1 - sqrt(rho2/u)| / rho^0.25.

    In N/mm, rpm and mm; X is the share of the load, w = F_t / b. It is Blok's for the force along the line of action,
    within 4 %.
    """
    pair, share = working.pair, working.load / working.force
    first, second = 1e3 * working.places, 1e3 * (pair.line_length - working.places)
    turns = working.speed / (2.0 * math.pi)
    slid = np.abs(np.sqrt(first) - np.sqrt(second / pair.ratio)) / (1e3 * working.radius) ** 0.25
    stiff = (pair.reduced_modulus / _STEEL) ** 0.25
    heat = mean_friction(working) * stiff * approach_factor(working) * (share * _line_load(working)) ** 0.75
    return 2.52 * heat * math.sqrt(turns) * slid


def approach_factor(working: Working) -> Array:
    """Return X_J >= 1 where teeth approach, before C: 1 + (C_eff - C_a2) / 50 (g / g_alpha)^3, in um.

    g is the distance to C, g_alpha the path, C_a2 the relief of the wheel's tip.
    """
    pair = working.pair
    before = np.maximum(pair.pitch_point - working.places, 0.0) / (pair.end - pair.start)
    lacking = 1e6 * (best_relief(working) - working.sharing.relief_2)
    return np.maximum(1.0 + lacking / 50.0 * before**3, 1.0)


def best_relief(working: Working) -> float:
    """Return C_eff [m], tip relief that the teeth would bend by: F_t / (b cos alpha c_gamma)."""
    pair = working.pair
    bending = pair.face_width * math.cos(pair.pressure_angle) * mean_stiffness(pair)
    return working.tangential_force / bending


def by_integral(working: Working) -> Integral | None:
    """Return the integral temperature method; None for pairs that its contact ratio factor is not for.

    S_intS = theta_intS / theta_int; theta_flaint = X_eps theta_flaE, the flash temperature at the pinion's tip under
    the whole load times a factor of the contact ratios.

    theta_int = theta_M + 1.5 theta_flaint, theta_M = theta_oil + 0.7 X_S theta_flaint; the allowed one is the same sum
    for the test of the oil: theta_MT = 80 + 0.23 T X_L, theta_flaintT = 0.2 T (100 / nu_40)^0.02 X_L, T = 3.726 S^2.
    """
    share = contact_ratio_factor(*working.contact_ratios)
    if share is None:
        return None
    rating = working.rating
    rise = tip_flash(working) * share
    bulk = working.oil + _HEAT * rating.supply_factor * rise
    torque = _TORQUE * rating.scuffing_stage**2
    nu_40 = 1e6 * float(kinematic_viscosity(working.viscosity, CELSIUS + 40.0))
    tested = 0.2 * torque * (100.0 / nu_40) ** 0.02 * rating.oil_factor
    allowed = 80.0 + 0.23 * torque * rating.oil_factor + rating.structural_factor * _WEIGHT * tested
    temperature = bulk + _WEIGHT * rise
    return Integral(bulk, temperature, CELSIUS + allowed, allowed / (temperature - CELSIUS))


def tip_flash(working: Working) -> float:
    """Return theta_flaE [K], flash temperature at the pinion's tip if one pair of teeth carried all.

    mu X_M X_BE X_ab w^0.75 sqrt(v) / a^0.25 / (X_Q X_Ca) in N/mm, m/s and mm; the gears have run in, X_E = 1.
    """
    pair = working.pair
    factor, eta = working.rating.oil_factor, working.oil_viscosity
    friction = michaelis(pair, working.tangential_force, working.speed, eta, working.ra, factor)
    circle = 0.5 * working.speed * pair.teeth_1 * pair.module
    angle = pair.working_pressure_angle
    turned = 1.22 * math.sin(angle) ** 0.25 / math.sqrt(math.cos(angle))
    heat = friction * _THERMOELASTIC * (pair.reduced_modulus / _STEEL) ** 0.25 * _line_load(working) ** 0.75
    eased = _entry_factor(working) * _relief_factor(working)
    return heat * _tip_geometry(pair) * turned * math.sqrt(circle) / (1e3 * pair.centre_distance) ** 0.25 / eased


def contact_ratio_factor(first: float, second: float) -> float | None:
    """Return X_eps of the contact ratios after and before C: mean flash over that at the pinion's tip.

    None unless their sum is from 1 to 2 and both are above 0. Source: ISO/TR 13989-2, from memory.
    """
    total = first + second
    if not (1.0 <= total < 2.0 and first > 0.0 and second > 0.0):
        return None
    if first < 1.0 and second < 1.0:
        found = 0.70 * (first**2 + second**2) - 0.22 * total + 0.52 - 0.60 * first * second
    elif first >= 1.0:
        found = 0.18 * first**2 + 0.70 * second**2 + 0.82 * first - 0.52 * second - 0.30 * first * second
    else:
        found = 0.70 * first**2 + 0.18 * second**2 - 0.52 * first + 0.82 * second - 0.30 * first * second
    return found / (2.0 * total * first)


def _tip_geometry(pair: SpurGearPair) -> float:
    """Return X_BE, 0.51 sqrt(u + 1) [sqrt(1 + G) - sqrt(1 - G/u)] / [(1 + G) (u - G)]^0.25 at the pinion's tip."""
    u, tip = pair.ratio, pair.end / pair.pitch_point - 1.0
    slid = abs(math.sqrt(1.0 + tip) - math.sqrt(1.0 - tip / u))
    return 0.51 * math.sqrt(u + 1.0) * slid / ((1.0 + tip) * (u - tip)) ** 0.25


def _entry_factor(working: Working) -> float:
    """Return X_Q: 1 up to 1.5 times as much contact ratio before C as after it, 0.6 from 3 times on; from memory."""
    first, second = working.contact_ratios
    return min(max(1.4 - 4.0 / 15.0 * second / first, 0.6), 1.0)


def _relief_factor(working: Working) -> float:
    """Return X_Ca by the larger part of the contact ratio and the smaller relief, over C_eff; from memory."""
    most, sharing = max(working.contact_ratios), working.sharing
    eased = min(sharing.relief_1, sharing.relief_2, best_relief(working)) / best_relief(working)
    return 1.0 + (0.06 + 0.18 * eased) * most + (0.02 + 0.69 * eased) * most**2


def _line_load(working: Working) -> float:
    """Return w = F_t / b [N/mm]."""
    return 1e-3 * working.tangential_force / working.pair.face_width
