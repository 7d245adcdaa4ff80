"""A lubricated contact of two rough, moving bodies: film, friction, tribofilm and wear.

A `Scene` (what the contact is) and an `OperatingPoint` (load, speeds, temperature) go in; `Outputs` and a new, frozen
`ContactState` come out. Two levels answer behind one door, `advance`: one solves the contact, the other estimates it,
and a correction may move the estimate. Where to find what:

    advance          checks once, binds scene and operating point in a `Case`, hands over to the level
    deterministic/   the level that solves the contact node by node
    regression/      the level of film formulas and fitted curves, microseconds a step
    assumed          what the assumptions of a scene are worth, by the regression level
    corrections/     what moves friction, h_c and W_c of the regression level: deterministic blocks, or a map
    surfaces/        roughness, body-fixed patches, track means, profiles
    state/           `ContactState`, `Outputs`, `RangeFlag`, trends, storage
    scene/           `Scene`, `OperatingPoint`, `Case`, checks, TOML, units
    calls/           point_contact, line_contact, dry_contact, subsurface_stress: one call each, without a scene
    film/            fluid and solid pressure of one instant: table of algorithms, units, grids, error estimate
    shapes/          points, lines, rollers: gap, Hertz's contact, film by formula; one file each
    laws/            viscosity, density, rheology, supply of oil, double layers, plasticity, boundary friction, heat,
                     bulk temperature, tribofilm, wear, oxide, stress, fatigue, scuffing, load sharing, profiles: one
                     class per law
    kernels/         numba and FFT: arrays in, arrays out
    reference/       closed forms: Hertz, films of points and lines, starvation, rolling, heat, tribofilm
    quantities       names, symbols, units, signs and ranges of every input and output
    entry_points     what other installed packages offer
    errors of answers  of calls film/estimate.py; of marches deterministic/solution_error.py by film/grid_error.py and
                     state/trends.py; of the regression level regression/outputs.py
    progress         what a long step is doing, for those who wait
    errors           what can go wrong, each message with a way out
    data/            named oils, solids and tribofilms, and the shipped scenes

Imports run one way: errors, progress, quantities <- kernels <- entry_points, reference <- laws <- shapes <- film <-
scene <- state, calls <- surfaces <- deterministic, regression <- corrections <- advance, assumed. The two levels do not
import each other. Everything inside is SI; heights are metres above a body's mean plane, positive toward the other
body; arrays are [ny, nx], x along entrainment.
"""

from .advance import advance, uncertainty, warm_up
from .assumed import Assumption, assumed
from .calls.dry_contact import DryContact, dry_contact
from .calls.line_contact import LineContact, line_contact
from .calls.options import ContactOptions
from .calls.point_contact import PointContact, point_contact
from .calls.subsurface_stress import SubsurfaceStress, graded_depths, subsurface_stress
from .deterministic.instant import ContactFields, Transient, solve
from .deterministic.march import Moment, march, run_cycle
from .deterministic.transient import parted
from .errors import ContactError, ConvergenceError, FilmTooWideError, OperatingPointError, SceneError, StateError
from .laws.profile import Logarithmic, Measured, Rounded
from .scene import OperatingPoint, Scene
from .scene.toml import shipped_scenes
from .state import ContactState, Error, Outputs, RangeFlag, initial_state
from .surfaces.profiles import Track, track_of

__version__ = "0.1.0"

__all__ = [
    "Assumption",
    "ContactError",
    "ContactFields",
    "ContactOptions",
    "ContactState",
    "ConvergenceError",
    "DryContact",
    "Error",
    "FilmTooWideError",
    "LineContact",
    "Logarithmic",
    "Measured",
    "Moment",
    "OperatingPoint",
    "OperatingPointError",
    "Outputs",
    "PointContact",
    "RangeFlag",
    "Rounded",
    "Scene",
    "SceneError",
    "StateError",
    "SubsurfaceStress",
    "Track",
    "Transient",
    "advance",
    "assumed",
    "dry_contact",
    "graded_depths",
    "initial_state",
    "line_contact",
    "march",
    "parted",
    "point_contact",
    "run_cycle",
    "shipped_scenes",
    "solve",
    "subsurface_stress",
    "track_of",
    "uncertainty",
    "warm_up",
]
