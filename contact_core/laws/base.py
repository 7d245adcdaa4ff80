"""Protocols of the laws, one per slot, so that nothing asks which law a scene has chosen.

Load sharing has no Protocol: its laws are `load_sharing.FittedSharing` with other constants.
"""

from collections.abc import Hashable
from dataclasses import Field
from typing import Any, ClassVar, NamedTuple, Protocol

from ..arrays import Array
from ..kernels.load_cycle import Cycle
from .elementary import Numbers
from .equations import Equations
from .temperatures import Rubbing, Temperatures

Pair = tuple[float, float]  # of body 1 and 2
Inputs = tuple[float | None, float | None]  # of body 1 and 2; None: not given


class Model(Protocol):
    """A record that a scene chooses by its name: a law, a geometry or a film."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    name: ClassVar[str]  # as `model` in a scene
    source: ClassVar[str]  # citation, or "assumed"; empty if the law does nothing


class Law(Model, Protocol):
    """A law: a frozen dataclass."""

    equations: ClassVar[Equations]  # for documentation


class Viscosity(Law, Hashable, Protocol):
    """Viscosity of the oil."""

    @property
    def error(self) -> str:
        """Sentence on constants that contradict each other, or an empty text."""

    def __call__(self, pressure: Numbers, temperature: Numbers) -> Numbers:
        """Return the viscosity [Pa s] at pressures [Pa] and temperatures [K]."""


class Density(Law, Hashable, Protocol):
    """Density of the oil."""

    def __call__(self, pressure: Array) -> Array:
        """Return the density over that at p = 0, at pressures [Pa]."""


class Rheology(Law, Hashable, Protocol):
    """Shear stress of the film."""

    thins: ClassVar[bool]  # the viscosity falls with the stress

    @property
    def inlet_thinning(self) -> Equations | None:
        """Equations of `film_factor`; None: no formula is known."""

    @property
    def limiting_coefficient(self) -> float:
        """Limiting shear stress over pressure at 40 degC; 0: no limit."""

    @property
    def limiting_fall(self) -> float:
        """Relative fall of the limiting shear stress with temperature [1/K]."""

    def __call__(self, newtonian: Array, pressure: Array) -> Array:
        """Return the shear stress [Pa] for that of a Newtonian oil, under a pressure [Pa]."""

    def slopes(self, newtonian: Array, pressure: Array) -> tuple[Array, Array]:
        """Return the derivatives of the stress by `newtonian` and by pressure."""

    def limiting_left(self, temperature: Numbers) -> Numbers:
        """Return the limiting stress at temperatures [K] over that at 40 degC."""

    def ease(self, stress: Array) -> Array:
        """Return the shear rate at a stress [Pa] over that of a Newtonian oil."""

    def film_factor(self, newtonian_film: float, speed: float, viscosity: float, slide_roll_ratio: float) -> float:
        """Return the central film thickness over that of a Newtonian oil [m], 1 without a formula."""


class Supply(Law, Protocol):
    """Oil before the contact."""

    starves: ClassVar[bool]  # the film may be thinner than in a flooded contact

    @property
    def layer(self) -> float | None:
        """Oil on both surfaces together before the contact [m]; None: all that the contact can take."""

    @property
    def inlet(self) -> float | None:
        """Distance of the inlet meniscus before the centre [m]; None: beyond the grid."""

    def film(self, flooded: float, half_width: float, radius: float, resistance: float) -> float:
        """Return the central film thickness [m] of smooth bodies.

        Parameters
        ----------
        flooded
            Central film thickness of the flooded contact [m].
        half_width
            Half width of Hertz's contact along x [m].
        radius
            Radius of combined curvature along x [m].
        resistance
            Resistance to side flow, see `reference.supplied_film`.

        """

    def reach(self, half_width: float, radius: float) -> float:
        """Return how far before the centre [m] the inlet is full, by Hertz's half width and the radius along x [m]."""


class Hardening(NamedTuple):
    """Pressures at which tribofilms yield, and how they harden. Arrays of one shape."""

    first: Array  # above it the thicker film yields [Pa]
    second: Array  # above it both films do, up to the hardness of the solids [Pa]
    slope: float  # depth per pressure, of each of the two [m/Pa]


class DoubleLayer(Law, Protocol):
    """Apparent viscosity of films between charged surfaces."""

    acts: ClassVar[bool]  # the viscosity depends on the gap

    def __call__(self, gap: Array, temperature: float) -> Array:
        """Return the apparent viscosity over that without charges, 1 or more, at gaps [m] and a temperature [K]."""


class Plasticity(Law, Protocol):
    """Largest pressure that the bodies bear."""

    @property
    def error(self) -> str:
        """Sentence on constants that contradict each other, or an empty text."""

    @property
    def hardness(self) -> float:
        """Hardness of the bare solids [Pa]."""

    @property
    def indentation(self) -> str:
        """Plastic depth that hardens the tribofilms: a choice of the scene."""

    @property
    def remembers(self) -> bool:
        """True if the depth of instants before counts."""

    @property
    def iterated(self) -> bool:
        """True if the depth of an instant itself counts: `hardening` is part of its solution."""

    def limit(self, film_1: Array, film_2: Array, depth: Array | float, full_thickness: float) -> Array:
        """Return the largest pressure [Pa] between tribofilms [m] that a plastic `depth` [m] has pressed in."""

    def hardening(self, film_1: Array, film_2: Array, depth: Array | float, full_thickness: float) -> Hardening:
        """Return how tribofilms [m] yield above `limit`, and harden as they are pressed in."""

    def shares(self, film_1: Array, film_2: Array, depth: Array | float, overlap: Array) -> tuple[Array, Array]:
        """Return the parts of an overlap [m], pressed in after a `depth` [m], that body 1 and body 2 take."""

    def under(self, cover: Numbers) -> Numbers:
        """Return the hardness [Pa] under a tribofilm of `cover` (0 to 1) of its full thickness."""


class BoundaryFriction(Law, Protocol):
    """Friction where solids touch."""

    @property
    def bare(self) -> float:
        """Friction coefficient of bare solids."""

    @property
    def slip_speed(self) -> float:
        """Sliding speed [m/s] over which friction changes sign."""

    def coefficient(self, cover: Numbers) -> Numbers:
        """Return the friction coefficient under tribofilms of a mean cover, 0 to 1."""

    def __call__(self, solid_pressure: Numbers, cover: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the shear stress [Pa] with the sign of the sliding speed [m/s]."""

    def grip(self, sliding_speed: Numbers) -> Numbers:
        """Return the share of full friction at a sliding speed [m/s], with its sign."""

    def grip_slope(self, sliding_speed: Numbers) -> Numbers:
        """Return the derivative of `grip` by the sliding speed [s/m]."""

    def slope(self, solid_pressure: Numbers, cover: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the derivative of the shear stress by the sliding speed [Pa s/m]."""


class Bulk(Law, Protocol):
    """Bulk temperatures of the two bodies."""

    follows_oil: ClassVar[bool]  # the bodies have the temperature of the oil
    from_inputs: ClassVar[bool]  # the inputs give the temperatures
    stores_heat: ClassVar[bool]  # the bodies warm over time

    def bodies(self, oil: float, inputs: Inputs, stored: Pair | None) -> Pair:
        """Return the bulk temperatures [K] for an oil temperature, inputs and stored temperatures [K]."""

    def after(self, temperatures: Pair, heat: Pair, oil: float, dt: float) -> Pair:
        """Return the bulk temperatures [K] after `dt` [s] under heat flows [W] into the bodies."""


class Heat(Law, Protocol):
    """Temperatures of the surfaces and the film."""

    warms_film: ClassVar[bool]  # the oil in the contact is at another temperature than in the inlet

    @property
    def inlet_shear(self) -> str:
        """Thinning of the film by shear heating in the inlet: "none" or "gupta"."""

    @property
    def bulk(self) -> Bulk:
        """Law of the bulk temperatures."""

    def temperatures(self, rubbing: Rubbing) -> Temperatures:
        """Return the temperatures of the contact, and where its heat goes."""

    def spot_rise(self, radius: Numbers, shear: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the flash temperature rise [K] of spots of `radius` [m] under a mean |shear stress| [Pa].

        0 where the law has no spots.
        """

    def conductances(self, radius: Array, speeds: tuple[Array, Array], *, hottest: bool = False) -> tuple[Array, Array]:
        """Return the heat flux per mean rise [W/(m2 K)] into each body under an even source on a circle [m].

        `hottest`: mean flux per largest rise, under a source spread like Hertz's pressure.
        """

    def strip_conductances(
        self, a: Array, b: float, speeds: tuple[Array, Array], *, hottest: bool = False
    ) -> tuple[Array, Array]:
        """Return the same for a strip of half width a and half length b [m]."""


class Tribofilm(Law, Protocol):
    """Growth and removal of the tribofilm. `growth` and `removal` [m] are its internal variables."""

    abrades: ClassVar[bool]  # rubbing removes the film at a rate of its own, `abrasion`
    takes_abrasion: ClassVar[bool]  # `evolve` heeds `abraded`, whatever law it is by

    @property
    def full_thickness(self) -> float:
        """Thickness without removal [m]."""

    @property
    def dose(self) -> str:
        """Rule for the mean exposure of a pass, see `tribofilm.doses`."""

    @property
    def most_exposure(self) -> float:
        """Largest exposure per test time that the supply of additive allows."""

    def exposure(self, solid_pressure: Numbers, shear: Numbers, sliding_speed: float, temperature: Numbers) -> Numbers:
        """Return the exposure of nodes under solid pressure and total |shear stress| [Pa], at a temperature [K]."""

    def abrasion(self, solid_pressure: Array, sliding_speed: float | Array, position: Array | None) -> Array:
        """Return the rate of removal [1/s]; `position` is |y| / b, None: far from the edges of the track."""

    def evolve(
        self, growth: Array, removal: Array, exposed: Array, abraded: Array, temperature: float
    ) -> tuple[Array, Array]:
        """Return both variables [m] after an exposure and an abrasion, each times its test time.

        `temperature` [K] is that of the surface: the bulk's and the mean flash rise.
        """

    def formed(
        self, growth: Array, removal: Array, after: Array, exposed: Array, abraded: Array, temperature: float
    ) -> Array:
        """Return the film formed [m] while `evolve` took the first variable from `growth` to `after`."""

    def covers(self, temperature: float) -> bool:
        """Return True if the constants hold at a bulk temperature [K]."""

    def refusal(self, temperature: float) -> str:
        """Return why the law does not hold at a bulk temperature [K], or an empty text."""


class Wear(Law, Protocol):
    """Removal of the solids."""

    wears: ClassVar[bool]
    wears_film: ClassVar[bool]  # rubbing takes tribofilm, at the rate `film_removal`

    @property
    def of_sliding(self) -> bool:
        """True if the relative sliding of the bodies wears them; else each one's own speed does."""

    def coefficient(self, cover: Numbers, full_thickness: float) -> Numbers:
        """Return the dimensionless wear coefficient of the solid under a tribofilm of `cover` (0 to 1) of a full one.

        `full_thickness` [m] is the full one's.
        """

    def film_removal(
        self,
        pressure: Numbers,
        speeds: tuple[float | Array, float],
        body: int,
        film_hardness: float,
        full_thickness: float,
    ) -> Numbers:
        """Return the rate [1/s] at which rubbing takes tribofilm under a solid pressure [Pa], in proportion to it."""

    def slide(self, speeds: tuple[float | Array, float], body: int) -> Numbers:
        """Return the speed [m/s] that wears body 1 (`body` = 0) or 2 (1) at surface speeds [m/s]."""

    def rate(
        self,
        pressure: Array,
        cover: Array,
        speeds: tuple[float | Array, float],
        body: int,
        hardness: float,
        full_thickness: float,
    ) -> Array:
        """Return the wear depth per second [m/s] of the solid under a solid pressure [Pa]."""


class Oxide(Law, Protocol):
    """Oxide on the solids where no tribofilm covers them."""

    grows: ClassVar[bool]

    @property
    def friction(self) -> float:
        """Friction coefficient of solids under a closed oxide."""

    @property
    def volume_ratio(self) -> float:
        """Volume of oxide over that of the steel it is made of."""

    def growth(self, temperature: float) -> float:
        """Return the rate [m/s] at which a bare solid oxidises at a temperature [K]."""

    def removal(self, pressure: Numbers, sliding_speed: Numbers) -> Numbers:
        """Return the rate [m/s] at which rubbing takes oxide under a solid pressure [Pa]; 0 where there is none."""

    def left_open(self, film: Numbers) -> Numbers:
        """Return the share of a solid that a tribofilm [m] leaves to oxidation and rubbing, 0 to 1."""

    def cover(self, oxide: Numbers) -> Numbers:
        """Return the share of the open solid that an oxide [m] bears, 0 to 1."""

    def added_friction(self, bare: float, oxides: Numbers, films: Numbers) -> Numbers:
        """Return what oxides add to a friction coefficient, `bare` being that of bare solids.

        `oxides` and `films` are the mean covers of both bodies, 0 to 1.
        """

    def evolve(self, oxide: Numbers, growing: Numbers, rubbing: Numbers) -> tuple[Numbers, Numbers]:
        """Return the oxide [m], and what was rubbed off it [m], after both rates have added up to these [m]."""


class Stress(Law, Protocol):
    """Sampling of the stresses below the surfaces."""

    samples: ClassVar[bool]  # stresses are computed at all

    @property
    def error(self) -> str:
        """Sentence on constants that contradict each other, or an empty text."""

    @property
    def instants(self) -> int:
        """Instants that stand for a pass of a surface point."""

    @property
    def near_surface(self) -> float:
        """Depth over Hertz's half width down to which a stress is near the surface."""

    @property
    def opens_pits(self) -> bool:
        """True if what breaks out changes the surface."""

    @property
    def torsion_limit(self) -> float:
        """Fatigue limit in alternating torsion [Pa]."""

    @property
    def dang_van_slope(self) -> float:
        """Weight of the hydrostatic stress in Dang Van's criterion."""

    @property
    def crossland_slope(self) -> float:
        """Weight of the hydrostatic stress in Crossland's criterion."""

    def depths(self, spacing: float, half_width: float) -> Array:
        """Return the depths of the layers [m] on a grid of a spacing [m] under a half width [m] along x."""

    def residual_stress(self) -> Array:
        """Return the stress without a load [Pa], [6]: xx, yy, zz, yz, xz, xy, tension positive."""


class Fatigue(Law, Protocol):
    """Damage of the solids by load cycles."""

    damages: ClassVar[bool]

    def per_cycle(self, cycle: Cycle) -> Array:
        """Return the damage by one load cycle, 0 to 1: it adds up, and at 1 the material fails."""


class Scuffing(Law, Protocol):
    """Risk of scuffing."""

    judges: ClassVar[bool]  # a temperature is critical

    def ratio(self, contact: float, oil: float) -> float:
        """Return the risk at the largest temperature of the surfaces and that of the oil [K]: above 1 they scuff.

        At least 0, and 0 where nothing is judged.
        """


class Profile(Law, Protocol):
    """Ends of a roller."""

    def drop(self, y: Array, length: float) -> Array:
        """Return the material taken away [m] at y [m] from the middle of a face; inf beyond its ends."""
