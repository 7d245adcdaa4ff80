"""Everything that can change the next answer, frozen, and what a step gives back.

    state              `ContactState` with its bodies and track means, as records and as bytes
    outputs            `Outputs` and `RangeFlag`
    trends             outputs without their noise, errors of time steps and of sampling
    storage            records of numbers and arrays as bytes and back
    bulk_temperature   temperatures of the bodies from the heat of the contact, for both levels

Records are frozen: a step returns new ones.
"""

from .outputs import Outputs, RangeFlag
from .state import Body, ContactState, Mean, changed, initial_state

__all__ = ["Body", "ContactState", "Mean", "Outputs", "RangeFlag", "changed", "initial_state"]
