"""Theories of rough contacts and closed forms of wavy ones, in the units of `periodic_contact`: 1/q, sigma, q sigma E*."""

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import erf

from benchmarks.surfaces.periodic_contact import Band

GAMMA = 0.45  # of Persson's theory: share of the elastic energy that partial contact leaves


def westergaard(mean: float) -> tuple[float, float]:
    """Return contact share and mean gap of a wave cos x under a mean pressure below that of full contact, 1/2.

    2 a / lambda = (2 / pi) asin (p / p*)^(1/2), p* = pi E* amplitude / lambda (Johnson, Contact Mechanics, 1985,
    doi:10.1017/CBO9781139171731, section 13.2). The gap integrates the compliance of a row of cracks,
    d gap / dp = (amplitude / p*) ln(p / p*), from the amplitude at first touch.
    """
    ratio = mean / 0.5
    return 2.0 / np.pi * float(np.arcsin(np.sqrt(ratio))), 1.0 - ratio + ratio * float(np.log(ratio))


def light_eggbox(mean: float) -> float:
    """Return the contact share of cos x cos y under a small mean pressure: Hertz's contact at each crest.

    pi (3 p / (8 pi p*))^(2/3), p* = 2^(1/2) / 2 here (Johnson, Greenwood & Higginson, Int. J. Mech. Sci. 27 (1985) 383,
    doi:10.1016/0020-7403(85)90029-3).
    """
    return float(np.pi * (3.0 * mean / (8.0 * np.pi * np.sqrt(0.5))) ** (2.0 / 3.0))


def persson_area(band: Band, mean: float) -> float:
    """Return erf(2^(1/2) p / (E* slope)): Persson, J. Chem. Phys. 115 (2001) 3840, doi:10.1063/1.1388626."""
    return float(erf(np.sqrt(2.0) * mean / band.slope))


def persson_gap(band: Band, mean: float) -> float:
    """Return the mean gap by Persson's theory with the energy factor of Yang & Persson (arXiv:0803.4146).

    Almqvist, Campana, Prodanov & Persson (arXiv:1102.5412) state the double integral.
    """
    power = 1.0 - 2.0 * (1.0 + band.hurst)  # of q C(q)
    scale = quad(lambda q: q**power, 1.0, band.breadth)[0]  # 2 pi times the factor of C

    def density(x: float) -> float:
        """Return q^2 C(q) w(q) times the inner integral; q = 1 + x^2 takes the singularity of w away."""
        q = 1.0 + x * x
        half = quad(lambda k: k ** (power + 2.0), 1.0, q)[0] / (2.0 * scale)  # pi int q^3 C
        w = 1.0 / np.sqrt(half)
        inner = quad(
            lambda t: (GAMMA + 3.0 * (1.0 - GAMMA) * erf(t) ** 2) * np.exp(-t * t) / t, w * mean, np.inf, limit=200
        )[0]
        return q ** (power + 1.0) / (2.0 * np.pi * scale) * w * inner * 2.0 * x

    return float(np.sqrt(np.pi) * quad(density, 1e-6, np.sqrt(band.breadth - 1.0), limit=200)[0])


def greenwood_tripp_gap(band: Band, mean: float) -> float:
    """Return the distance of the mean planes of two like bodies of Greenwood & Tripp.

    Source: Greenwood & Tripp, Proc. IMechE 185 (1970) 625, doi:10.1243/PIME_PROC_1970_185_069_02.

    Each body has half of the variance. Summits by the moments of the spectrum (Nayak, J. Lubr. Technol. 93 (1971) 398,
    doi:10.1115/1.3451608).
    """
    m0, m2, m4 = 0.5, 0.25 * band.moment(2), 0.5 * 0.375 * band.moment(4)  # of profiles of one body
    alpha = m0 * m4 / m2**2
    summits = m4 / m2 / (6.0 * np.pi * np.sqrt(3.0))
    radius = 0.375 * np.sqrt(np.pi / m4)
    sigma = np.sqrt(2.0 * m0 * (1.0 - 0.8968 / alpha))
    lift = 2.0 * 4.0 * np.sqrt(m0 / (np.pi * alpha))  # of the summits' mean plane over the bodies', both together
    factor = 16.0 * np.sqrt(2.0) / 15.0 * np.pi * (summits * radius * sigma) ** 2 * np.sqrt(sigma / radius)

    def excess(gap: float) -> float:
        u = (gap - lift) / sigma
        f = quad(lambda s: (s - u) ** 2.5 * np.exp(-0.5 * s * s), u, u + 12.0 + abs(u))[0] / np.sqrt(2.0 * np.pi)
        return float(np.log(factor * f / mean))

    return float(brentq(excess, lift - 60.0 * sigma, lift + 6.0 * sigma))
