"""What is made of the statements of a C function before they are printed."""

from . import code
from .declarations import declared
from .paired import paired
from .rolled import rolled
from .units import Unit


def arranged(unit: Unit, block: code.Block, live: set[str]) -> code.Block:
    """Return a block without what is never used, with loops over nodes, powers in pairs and late declarations.

    `live` are the names used after it.
    """
    return declared(paired(unit, rolled(unit, code.pruned(block, live))))
