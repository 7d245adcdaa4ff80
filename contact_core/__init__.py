"""A lubricated contact of two rough, moving bodies: film, friction, tribofilm and wear.

A `Scene` (what the contact is) and an `OperatingPoint` (load, speeds, temperature) go in; `Outputs` and a new, frozen
`ContactState` come out. Where to find what:

    quantities   names, symbols, units, signs and averages of every input and output; ranges of every parameter
    constants    of nature
    units        "1.26 GPa" to SI, at the border
    shapes       undeformed bodies: points, lines, rollers; their gap, Hertz's contact, film by formula
    geometry     their records in a scene
    scene        Scene, its checks, OperatingPoint, Operation (the duty)
    reading      TOML to records and back, with did-you-mean
    state        ContactState, Outputs, RangeFlag, serialisation
    surfaces     roughness: generation and statistics
    laws/        viscosity, density, rheology, supply of oil, plasticity, boundary friction, heat, bulk temperature,
                 tribofilm, wear, load sharing of the fast level
    film/        fluid and solid pressure of one instant: units, grids, the table of algorithms (routes), error estimate
    kernels/     numba and FFT: arrays in, arrays out
    point_contact, line_contact, dry_contact   one call each, without a scene; call: what they share
    friction     shear of solids and oil, forces, power, derivatives at a held film
    oil          what heat and shear make of the oil, and how it then flows
    patches      body-fixed surfaces: what they are now, where they lie under the contact
    contact      solve: one instant of a scene in a state
    following    one instant after another: what moves on, what film it starts from
    sweep        what a block's instants add up to
    block        when and at which instants the contact is solved, and by which driver
    march        load, speeds and radii that change within a run: instant after instant, and cycles of them
    evolution    tribofilm and wear between two solutions, in closed form
    trends       outputs without their noise, errors of time steps and of sampling
    means        the fast level: the means of both surfaces over time
    mean_contact   one instant of it: film from a formula, friction from fitted curves, derivatives
    mean_oil, mean_surfaces, mean_outputs   its oil, what the means say of the surfaces, what it can tell
    folding      from patches to means and back
    advance      advance: the evolution over time; uncertainty: how sure its outputs are
    warming      warm_up: loads what the first steps of a scene need
    tracks       the rubbed surfaces as they are, for profiles and pictures
    reference/   closed forms: Hertz, films of points and lines, starvation, heat, wear
    data/        named oils, solids and tribofilms, and the shipped scenes
    storage      records of numbers and arrays as bytes and back
    errors       what can go wrong, each message with a way out

Imports run one way: kernels <- laws <- film <- friction <- oil <- patches <- evolution <- contact <- following
<- sweep <- block <- march, advance; of the fast level, means stands beside block, mean_outputs beside sweep and
mean_contact beside contact.
Everything inside is SI; heights are metres above a body's mean plane, positive toward the other body; arrays are
[ny, nx], x along entrainment.
"""

from .advance import advance, uncertainty
from .calls.dry_contact import DryContact, dry_contact
from .calls.line_contact import LineContact, line_contact
from .calls.point_contact import PointContact, point_contact
from .calls.warm_up import warm_up
from .deterministic.instant import ContactFields, Transient, solve
from .deterministic.march import Moment, march, run_cycle
from .deterministic.transient import parted
from .errors import ContactError, ConvergenceError, FilmTooWideError, OperatingPointError, SceneError, StateError
from .laws.profile import Logarithmic, Rounded
from .scene import OperatingPoint, Scene
from .scene.toml import shipped_scenes
from .state import ContactState, Outputs, RangeFlag, initial_state
from .surfaces.profiles import Track, track_of

__version__ = "0.1.0"

__all__ = [
    "ContactError",
    "ContactFields",
    "ContactState",
    "ConvergenceError",
    "DryContact",
    "FilmTooWideError",
    "LineContact",
    "Logarithmic",
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
    "Track",
    "Transient",
    "advance",
    "dry_contact",
    "initial_state",
    "line_contact",
    "march",
    "parted",
    "point_contact",
    "run_cycle",
    "shipped_scenes",
    "solve",
    "track_of",
    "uncertainty",
    "warm_up",
]
