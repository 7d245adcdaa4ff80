"""Rigid bodies that approach each other through oil of constant viscosity, the gap between them full of it.

With p = c / h^2 Reynolds' equation is met by every parabolic gap, h = h_0 + x^2 / (2 R_x) + y^2 / (2 R_y), so these
are exact for thin films, h_0 << R. Receding bodies have the same forces with the other sign, if the oil bears tension.
"""

import math


def squeeze_point(speed: float, gap: float, radius_x: float, radius_y: float, viscosity: float) -> float:
    """Return the force [N] that opposes an approach at a speed [m/s] at a smallest gap [m].

    Radii [m], viscosity eta [Pa s].

    12 pi eta V sqrt(R_x R_y) / [(1 / R_x + 1 / R_y) h_0]; of a ball on a plane 6 pi eta V R^2 / h_0.
    Source: ball: Brenner, Chem. Eng. Sci. 16 (1961) 242, doi:10.1016/0009-2509(61)80035-3, near the wall.
    """
    curvature = 1.0 / radius_x + 1.0 / radius_y
    return 12.0 * math.pi * viscosity * speed * math.sqrt(radius_x * radius_y) / (curvature * gap)


def squeeze_line(speed: float, gap: float, radius: float, viscosity: float) -> float:
    """Return the force per length [N/m] that opposes the approach of a cylinder to a plane.

    It is 3 sqrt(2) pi eta V (R / h_0)^1.5.
    """
    return 3.0 * math.sqrt(2.0) * math.pi * viscosity * speed * (radius / gap) ** 1.5
