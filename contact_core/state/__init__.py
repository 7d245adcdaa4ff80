"""Everything that can change the next answer, frozen, and what a step gives back.

    state              `ContactState` with its bodies and track means, as records and as bytes
    outputs            `Outputs`, `Error` of an output by its causes, and `RangeFlag`
    trends             outputs without their noise, errors of time steps and of sampling
    solved             deterministic solutions that correct the regression level
    below              tractions, load cycles and damage below the surfaces
    classes            damage by classes of points, at the regression level
    parts              the number of parts of one step, which is bounded
    storage            records of numbers and arrays as bytes and back
    bulk_temperature   temperatures of the bodies from the heat of the contact, for both levels

Records are frozen: a step returns new ones.
"""

from .below import Below
from .classes import Classes
from .outputs import (
    Error,
    Outputs,
    RangeFlag,
    flag_of_errors,
    flag_of_pits,
    flag_of_scuffing,
    flag_of_wear,
    flags_of_tribofilm,
)
from .solved import Solved
from .state import Body, ContactState, Mean, changed, initial_state
