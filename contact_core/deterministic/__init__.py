"""The deterministic level: the contact is solved node by node at the instants of a block.

    instant            `solve`: one instant of a scene in a state, and its fields
    friction           shear of solids and oil, forces, power, derivatives at a held film
    oil_temperature    temperature of the oil by heat and shear, and its flow at that temperature
    rolling            rolling resistance: the couple of the oil, and what of it lies beyond the grid
    observed           outputs and range flags of one instant
    transient          consecutive instants: a film that depends on the one before, begins or opens
    present            the instant that a run is at, and its fields
    march              `march`, `run_cycle`: consecutive instants while inputs change within a run
    subsurface         stresses below the surfaces, by the instants of a pass
    accumulator        sums over the instants of a block
    sampling           choice of the instants at which a block is solved
    growth_and_wear    exposure, tribofilm and wear of one body
    damage             damage by load cycles, and what breaks out
    resting            wear of bodies at rest, which conform to the other one
    block              one block: when it is due, which contacts drive it
    changing_inputs    instants in place of blocks while inputs change
    solution_error     errors by the grid and by iterations that stop early
    outputs            outputs of a step and their errors
    evolution          `advance`: the sequence of blocks, and evolution between them
    warming            loads compiled kernels before the first step of a process

Imports run from the bottom of this list to its top.
"""

from .evolution import advance
from .outputs import errors_of
from .warming import warm_up

__all__ = ["advance", "errors_of", "warm_up"]
