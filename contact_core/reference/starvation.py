"""Starved films in closed form, over the flooded ones."""

import math

_SIDE_FLOW = 3.0  # resistance to side flow of circular contacts
_NEAREST = 1e-9  # least distance of a meniscus before Hertz's contact, in its half width


def supplied_film(flooded: float, supply: float, density: float = 1.0, resistance: float = _SIDE_FLOW) -> float:
    """Return the central film thickness [m] behind an even oil layer [m] on both surfaces together.

    h / h_flooded = r / (1 + r^g)^(1/g) with r = supply / (density h_flooded), density that at the centre relative to
    p = 0, g the resistance to side flow: about 3 for circular contacts (2 to 5), up to 15 for wide ellipses. It is
    infinite where none can flow there, of lines: what comes in goes through, up to the flooded film.

    Sources: Chevalier, Lubrecht, Cann, Colin & Dalmaz, J. Tribol. 120 (1998) 126, doi:10.1115/1.2834175; Damiens,
    Venner, Cann & Lubrecht, J. Tribol. 126 (2004) 105, doi:10.1115/1.1631020; g as in Lugt, Grease Lubrication in
    Rolling Bearings, Wiley 2013, chapter 9.
    """
    if flooded <= 0.0:
        return 0.0
    if resistance == math.inf:
        return min(supply / density, flooded)
    r = supply / (density * flooded)
    return flooded * r * float((1.0 + r**resistance) ** (-1.0 / resistance)) if r < 1e3 else flooded


def film_behind_meniscus(flooded: float, distance: float, half_width: float, radius: float) -> float:
    """Return the central film thickness [m] of a contact whose inlet is full from a distance [m] before its centre.

    h / h_flooded = [(m - 1) / (m* - 1)]^0.29 below m* = 1 + 3.06 [(R/a)^2 h_flooded/R]^0.58, with m = distance / a; a
    [m] is the half width of Hertz's contact and R [m] the radius along entrainment.

    Source: Hamrock & Dowson, J. Lubr. Technol. 99 (1977) 15, doi:10.1115/1.3453285.
    """
    enough = 3.06 * (flooded * radius / half_width**2) ** 0.58
    short = distance / half_width - 1.0
    if short >= enough:
        return flooded
    return flooded * float((max(short, _NEAREST) / enough) ** 0.29)
