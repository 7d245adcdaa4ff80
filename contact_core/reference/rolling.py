"""Rolling in closed form: resistance by the oil's pressure flow, and how far dry bodies slip in contact."""

import math

from .hertz import hertz_point

_FULL = 1.0 / 3.0  # of the radius: as far before the centre a flooded inlet of a point is full


def rolling_line(
    load: float, entrainment_speed: float, viscosity: float, radius: float, reduced_modulus: float
) -> float:
    """Return the integral of (h/2) dp/dx per length [N/m] of a smooth, flooded line contact.

    The load per length [N/m] is above zero.

    With U = 2 eta0 u_e / (E' R), W = w / (E' R) and M = W / sqrt(U), it is E' R 1.42 sqrt(U W) / [1 + (0.966
    sqrt(M))^10]^0.1: that of rigid bodies for small M, 1.47 U^0.75 E' R, whatever the load, for large ones. Exact of
    rigid bodies is 1.470 in place of 1.42 (Martin's film). It is that of an inlet full for ever: of it, what lies
    beyond a distance X before the contact makes 12 eta0 u_e R / X.
    Source: Biboulet & Houpert, Proc. IMechE J 224 (2010) 765, doi:10.1243/13506501JET790, equations (40) to (42).
    """
    speed = 2.0 * viscosity * entrainment_speed / (reduced_modulus * radius)
    relative = load / (reduced_modulus * radius)
    stiffness = (1.4 / 1.45) ** 2 * relative * speed**-0.5
    return float(1.42 * (speed * relative) ** 0.5 * (1.0 + stiffness**5) ** -0.1 * reduced_modulus * radius)


def rolling_point(
    load: float,
    entrainment_speed: float,
    viscosity: float,
    radius_x: float,
    radius_y: float,
    reduced_modulus: float,
) -> float:
    """Return the integral of (h/2) dp/dx [N] over a smooth, flooded point contact, circular or wider across.

    The load [N] is above zero.

    With U = 2 eta0 u_e / (E' R_x), k = a / b, beta = E' a / (pi p_H R_x) and M = beta^(1/4) k W / (E' R_x^2) U^(-3/4)
    it is 2 b E' R_x U^(3/4) [(rigid - elastic) / (1 + M / 6.6) + elastic], rigid = 0.77 beta^(-1/3) k^0.12 U^(-1/12),
    elastic = 1.8 beta^(-1/4). It is that of an inlet full as far as the bodies are parabolas: the share of what lies
    far before the contact falls no faster than the logarithm of the distance.
    Source: Biboulet & Houpert, Proc. IMechE J 224 (2010) 777, doi:10.1243/13506501JET791, equations (30) to (32).
    """
    hertz = hertz_point(load, radius_x, radius_y, reduced_modulus)
    speed = 2.0 * viscosity * entrainment_speed / (reduced_modulus * radius_x)
    slim, beta = hertz.a / hertz.b, reduced_modulus * hertz.a / (math.pi * hertz.pressure_max * radius_x)
    stiffness = beta**0.25 * slim * load / (reduced_modulus * radius_x**2) * speed**-0.75
    rigid, elastic = 0.77 * beta ** (-1 / 3) * slim**0.12 * speed ** (-1 / 12), 1.8 * beta**-0.25
    share = (rigid - elastic) / (1.0 + stiffness / 6.6) + elastic
    return float(2.0 * hertz.b * reduced_modulus * radius_x * share * speed**0.75)


def rolling_beyond_line(entrainment_speed: float, viscosity: float, radius: float, distance: float) -> float:
    """Return what of `rolling_line` [N/m] lies beyond a distance [m] before the centre, where the gap is x^2 / (2 R).

    There the flow is that of the entrained oil alone, dp/dx = 12 eta0 u_e / h^2, and the integral 12 eta0 u_e R / x.
    """
    return 12.0 * viscosity * entrainment_speed * radius / distance


def rolling_beyond_point(
    entrainment_speed: float,
    viscosity: float,
    radius_x: float,
    radius_y: float,
    before: float,
    beside: float = math.inf,
) -> float:
    """Return the integral of (h/2) dp/dx [N] over the inlet of a point contact outside |x| < before, |y| < beside.

    Far from the contact the gap is h = x^2 / (2 R_x) + y^2 / (2 R_y) and the pressure 12 eta0 u_e |x| / [(3 + 2 k)
    h^2], k = R_x / R_y. The integral over x < 0 grows as the logarithm of the distance, so it ends at the gap of R_x /
    3 before the contact: with that it is what solved films lack of `rolling_point`. The term with 0.65 is a fit to the
    quadrature over the rectangle, within 1 % for beside sqrt(k) >= before.
    Source of the pressure: Kapitza, Zh. Tekh. Fiz. 25 (1955) 747; Brewe, Hamrock & Taylor, J. Lubr. Technol. 101
    (1979) 231, doi:10.1115/1.3453326.
    """
    slim = radius_x / radius_y
    sides = 0.65 / math.hypot(beside * math.sqrt(slim) / before, 1.2)
    decades = math.log(_FULL * radius_x / (2.0 * before)) + 1.0 - sides
    whole = 12.0 * math.pi * viscosity * entrainment_speed * radius_x / ((3.0 + 2.0 * slim) * math.sqrt(slim))
    return whole * max(decades, 0.0)


def slipping_share(creep: float, friction: float, half_width: float, radius: float) -> float:
    """Return the share of the contact's length in which dry bodies slip rather than stick, 0 to 1.

    `creep` is the sliding speed over the speed of rolling. With q = mu p where they slip, a contact of half width a [m]
    and combined radius R [m] slips on all of it from a creep of mu a / R on, and on the part creep R / (mu a) of it,
    behind, below that; a circle has its widest strip.
    Source: Carter 1926, doi:10.1098/rspa.1926.0100; strips: Haines & Ollerton 1963,
    doi:10.1243/PIME_PROC_1963_177_014_02; Johnson, Contact Mechanics, 1985, section 8.3.
    """
    full = friction * half_width / radius
    return min(abs(creep) / full, 1.0) if full > 0.0 else float(creep != 0.0)
