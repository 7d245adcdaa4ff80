"""The complete description of one contact, and the point at which it works.

    scene       `Scene`: fields, TOML, checks
    fields      the fields of a scene, and the geometry and grid that follow from them
    records     solids, lubricant, control of the evolution over time
    surface     what all surfaces have; Gaussian roughness
    self_affine self-affine roughness
    heights     heights of a body from a file or an array; height_map: the array
    operation   operating points, and the duty of a scene
    case        a scene at an operating point, bound once per step
    defaults    what a scene that does not say otherwise has
    bases       families of base oils
    intervals   what a scene assumes, and between which values it may lie
    finishes    what a finish such as "ground" says of a surface
    hertz_grid  grid of a scene that gives none
    accuracy    grid, tolerance, blocks and instants for an accuracy that is asked for
    checks      what makes a scene or an operating point unusable
    plausibility  numbers that look like mistakes
    toml        TOML to records and back
    ensemble    several files or seeds of a surface, of which each makes a scene
    other_names  names that the field has for keys of a scene
    in_use      the laws that a scene uses, with their equations
    origins     where each value of a scene comes from
    problems    everything that is wrong with a table, in one refusal
    tunables    numbers that may be changed in a scene
    units       "1.26 GPa" to SI

A scene is checked when it is read; an operating point when it is bound in a case.
"""

from .case import Case, Side
from .defaults import Assumed, told
from .height_map import HeightStatistics, statistics_of
from .heights import Heights
from .operation import OperatingPoint, Operation, Step
from .records import Control, Lubricant, Solids
from .scene import Scene
from .self_affine import SelfAffine
from .surface import Surface
from .tunables import tunables, with_values
