"""Textbook values to compare a gear mesh with: loss factors, mean friction, flash temperature.

The loss of a mesh is P_V = P_a H_V mu_mz: transmitted power, loss factor of the geometry, mean coefficient of friction.
"""

import math

from contact_core.kernels.arrays import Array

from .geometry import SpurGearPair
from .path import Numbers, Stations, radius


def ohlendorf(pair: SpurGearPair) -> float:
    """Return the loss factor H_V = pi (u + 1) / (z1 u) (1 - e + e1^2 + e2^2), e1 and e2 contact ratios after, before C.

    That of rigid sharing if a single pair of teeth carries at C, as it does in FZG's type C, not in type A.
    Source: Ohlendorf, Verlustleistung und Erwaermung von Stirnradern, Diss. TU Muenchen 1958.
    """
    after = (pair.end - pair.pitch_point) / pair.base_pitch
    before = (pair.pitch_point - pair.start) / pair.base_pitch
    share = 1.0 - pair.contact_ratio + after**2 + before**2
    return math.pi * (pair.ratio + 1.0) / (pair.teeth_1 * pair.ratio) * share


def loss_factor(pair: SpurGearPair, places: Stations, share: Array) -> float:
    """Return H_V = 1/p_b integral of (F_N / F_bt) (|v_g| / v_tb) along the path of contact, as a sum over stations.

    share F_N / F_bt [n] is the part of the force that the pair of teeth at each station carries.
    Source: Niemann & Winter, Maschinenelemente II, 1989, section 21.11.
    """
    return float((places.stretch * share * sliding_share(pair, places.position)).sum()) / pair.base_pitch


def sliding_share(pair: SpurGearPair, position: Numbers) -> Numbers:
    """Return the sliding speed at a position [m] over the speed along the line of action."""
    return (1.0 + 1.0 / pair.ratio) * abs(position - pair.pitch_point) / pair.base_radius_1


def schlenk(
    pair: SpurGearPair, force: float, speed_1: float, viscosity: float, ra: float, oil_factor: float = 1.0
) -> float:
    """Return the mean coefficient of friction of a mesh, 0.048 [(F_bt / b) / (v_sum rho)]^0.2 eta^-0.05 Ra^0.25 X_L.

    force F_bt [N]; speed_1 of the pinion [rad/s] > 0; viscosity [Pa s] at the oil's temperature; ra [m], arithmetic
    mean roughness, averaged over both flanks. v_sum and rho are sum of surface speeds and radius of curvature at C.
    oil_factor X_L: 1 for mineral oils. Fitted in N/mm, m/s, mm, mPa s and um. ISO/TR 14179-2 has the same form.
    Source: Schlenk, Diss. TU Muenchen 1994; Fernandes, Marques, Martins & Seabra, Tribol. Int. 88 (2015) 306, find X_L
    of 0.846 for a mineral oil, 0.650 for a polyalphaolefin and an ester, 0.585 for a polyglycol.
    """
    return (
        0.048 * _intensity(pair, force, speed_1) ** 0.2 * (1e3 * viscosity) ** -0.05 * (1e6 * ra) ** 0.25 * oil_factor
    )


def michaelis(
    pair: SpurGearPair, force: float, speed_1: float, viscosity: float, ra: float, oil_factor: float = 1.0
) -> float:
    """Return the mean coefficient of friction of a mesh, 0.045 [(F / b) / (v_sum rho)]^0.2 eta^-0.05 X_R X_L.

    ISO/TR 13989-1 has 0.060 [w / (v_sum rho)]^0.2 X_L Ra^0.25.

    X_R = 2.2 (Ra / rho)^0.25; arguments and units as of `schlenk`, Ra in um over rho in mm.
    Source: Michaelis, Diss. TU Muenchen 1987, as in ISO/TS 6336-22 and ISO/TS 6336-21; from memory.
    """
    return (
        0.045
        * _intensity(pair, force, speed_1) ** 0.2
        * (1e3 * viscosity) ** -0.05
        * oil_factor
        * (2.2 * (1e3 * ra / _radius_at_pitch(pair)) ** 0.25)
    )


def iso_14179_1(pair: SpurGearPair, torque: float, speed_1: float, kinematic_viscosity: float) -> float:
    """Return the mean coefficient of friction of a mesh, nu^-0.223 K^-0.40 / (3.239 V^0.70).

    K = T_1 (z_1 + z_2) / (2 b r_w1^2 z_2).

    torque [N m] and speed_1 [rad/s] of the pinion, both > 0; kinematic_viscosity [m2/s] at the oil's temperature. V is
    the speed of the pitch circles, K the load intensity; fitted in mm2/s, N/mm2, m/s. Meant for 2 < V <= 25 m/s and
    1.4 < K <= 14 N/mm2. Source: ISO/TR 14179-1:2001 (the method of AGMA), section 7.
    """
    speed, intensity = speed_1 * pair.pitch_radius_1, 1e-6 * load_intensity(pair, torque)
    return (1e6 * kinematic_viscosity) ** -0.223 * intensity**-0.40 / (3.239 * speed**0.70)


def load_intensity(pair: SpurGearPair, torque: float) -> float:
    """Return K = T1 (z1 + z2) / (2 b r_w1^2 z2) [Pa] under a torque of the pinion [N m]. Source: as `iso_14179_1`."""
    teeth = (pair.teeth_1 + pair.teeth_2) / pair.teeth_2
    return torque * teeth / (2.0 * pair.face_width * pair.pitch_radius_1**2)


def _intensity(pair: SpurGearPair, force: float, speed_1: float) -> float:
    """Return force per width over speed and radius at C, in N/mm, m/s and mm."""
    return 1e-3 * force / pair.face_width / (_sum_speed(pair, speed_1) * 1e3 * _radius_at_pitch(pair))


def _sum_speed(pair: SpurGearPair, speed_1: float) -> float:
    """Return the sum of both surface speeds at C [m/s]."""
    return 2.0 * speed_1 * pair.pitch_point


def _radius_at_pitch(pair: SpurGearPair) -> float:
    return float(radius(pair, pair.pitch_point))
