"""Temperature rise under moving sources of heat."""

import numpy as np
import scipy  # its parts are loaded at their first use


def jaeger_circle(peclet: float) -> tuple[float, float]:
    """Return largest and mean steady rise of a half space moving at a speed u under a circle of uniform flux q.

    In units of q r / K, K conductivity; peclet = u r / (2 k) >= 0, k diffusivity. At rest 1 and 8 / (3 pi). By
    quadrature of Jaeger's point source, in polar coordinates around the point that is warmed.
    Source: Jaeger, Proc. R. Soc. N. S. W. 76 (1942) 203.
    """
    quad, minimize_scalar = scipy.integrate.quad, scipy.optimize.minimize_scalar

    def mean_part(distance: float) -> float:  # weighted by what a circle shares with its copy at this distance
        shared = 2.0 * np.arccos(0.5 * distance) - 0.5 * distance * np.sqrt(4.0 - distance**2)
        return float(shared * scipy.special.i0e(peclet * distance))

    def rise(x: float) -> float:  # on the axis, at x downstream of the centre
        def part(angle: float) -> float:  # between upstream and the direction to the source
            reach = x * np.cos(angle) + np.sqrt(max(1.0 - (x * np.sin(angle)) ** 2, 0.0))
            rate = 2.0 * peclet * np.sin(0.5 * angle) ** 2
            return float(-np.expm1(-rate * reach) / rate if rate * reach > 1e-12 else reach)

        narrow = min(4.0 / np.sqrt(1.0 + peclet), 3.0)
        return float(quad(part, 0.0, np.pi, points=[narrow], limit=400, epsabs=0.0, epsrel=1e-10)[0]) / np.pi

    mean = quad(mean_part, 0.0, 2.0, limit=400, epsabs=0.0, epsrel=1e-10)[0] / np.pi
    found = minimize_scalar(lambda x: -rise(x), bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-7})
    return float(-found.fun), float(mean)


def tian_kennedy_circle(peclet: float) -> tuple[float, float]:
    """Return the rises of `jaeger_circle` by formulas that are exact at rest and at high speed.

    In q r / K: largest 2 / sqrt[pi (1.273 + Pe)], mean 1.22 / sqrt[pi (0.6575 + Pe)].

    Source: Tian & Kennedy, J. Tribol. 116 (1994) 167, doi:10.1115/1.2927035.
    """
    return float(2.0 / np.sqrt(np.pi * (1.273 + peclet))), float(1.22 / np.sqrt(np.pi * (0.6575 + peclet)))
