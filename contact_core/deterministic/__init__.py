"""The deterministic level: the contact is solved node by node at the instants of a block.

    instant            `solve`: one instant of a scene in a state, and its fields
    friction           shear of solids and oil, forces, power, derivatives at a held film
    oil_temperature    what heat and shear make of the oil, and how it then flows
    observed           outputs and range flags of one instant
    transient          consecutive instants: a film that remembers, begins or opens
    march              `march`, `run_cycle`: inputs that change within a run
    accumulator        sums over the instants of a block
    sampling           at which instants a block is solved
    growth_and_wear    exposure, tribofilm and wear of one body
    block              one block: due when, driven by what, followed by what
    changing_inputs    instants in place of blocks while inputs change
    outputs            outputs of a step, and how sure they are
    evolution          `advance`: blocks and what continues between them
    warming            what a process loads before its first step

Imports run from the bottom of this list to its top.
"""

from .evolution import advance
from .warming import warm_up

__all__ = ["advance", "warm_up"]
