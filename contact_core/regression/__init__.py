"""The regression level: film formulas, fitted curves of load sharing, and track means of both surfaces.

    surfaces       tribofilms, roughness and cover from the track means
    oil            friction and temperature of the oil
    smooth_film    film of the smooth bodies by formula
    load_sharing   how solids and oil share the load
    contact        film, friction, heat and derivatives of an operating point
    exposure       exposure, abrasion and wear of a track
    smooth_cycles  table of load cycles below smooth bodies
    near_surface   curves of what roughness adds to them
    stress         stresses and load cycles below a mean contact
    outputs        outputs and their errors
    fatigue        damage, pits and what they are on the track
    evolution      `advance`: the track means over time; `warm_up` loads packages before the first step of a process

Imports run from the bottom of this list to its top.
"""

from .evolution import advance, warm_up
from .outputs import errors_of
