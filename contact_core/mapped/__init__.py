"""The level `map`: the regression level, corrected by a map of what deterministic solutions deviate from it by.

    map      the record of a map: arrays of numbers, its file, the scene that it belongs to
    query    what a map says of a contact: plain arithmetic on numbers
    fitting  a map from solved contacts: sparse polynomials, half widths by histories left out
    knot     histories of contacts at the deterministic and the regression level
    level    `advance` and the errors of the outputs

Imports run from the bottom of this list to its top. A step needs `map`, `query` and `level` alone.
"""

from .level import advance, errors_of, warm_up

__all__ = ["advance", "errors_of", "warm_up"]
