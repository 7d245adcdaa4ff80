"""Records of a scene: solids, lubricant, and the control of the evolution over time."""

from dataclasses import dataclass, field

from ..laws.base import Density, DoubleLayer, Rheology, Supply, Viscosity
from ..laws.double_layer import NoDoubleLayer
from ..laws.elementary import Numbers
from ..laws.supply import Flooded
from ..quantities import parameter

ACCURACY = "control.accuracy"
CHOSEN = (  # fields that it chooses where a scene does not give them
    "film.points",
    "film.domain",
    "film.tolerance",
    "control.change",
    "control.mixed_instants",
    "control.dry_instants",
)
POISSON = 0.3  # of the solids, assumed: E' alone does not give it


@dataclass(frozen=True)
class Solids:
    """Elasticity of the pair."""

    reduced_modulus: float = parameter(
        "Pa", "E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2]", above=1e3, most=1e13, quantity="Stress"
    )
    film_modulus: float | None = parameter(
        "Pa",
        "Young's modulus of the tribofilm, which gives way as a thin layer; not given: as rigid as its solid",
        above=1e6,
        most=1e13,
        default=None,
        quantity="Stress",
    )
    film_poisson_ratio: float = parameter("", "Poisson's ratio of the tribofilm", least=0.0, most=0.45, default=0.3)

    @property
    def own_modulus(self) -> float:
        """Oedometric modulus [Pa] of the solids, taken as alike."""
        return self.reduced_modulus * (1.0 - POISSON) ** 2 / (1.0 - 2.0 * POISSON)

    @property
    def film_give(self) -> float:
        """Depth per pressure and thickness [1/Pa] by which a tribofilm gives way more than as much of the solids.

        A layer that is thin against the contact cannot spread: a pressure p thins it by p h / M, M being its
        oedometric modulus E (1 - v) / [(1 + v) (1 - 2 v)] (Johnson, Contact Mechanics, 1985,
        doi:10.1017/CBO9781139171731, section 5.8).
        """
        if self.film_modulus is None:
            return 0.0
        v = self.film_poisson_ratio
        return (1.0 + v) * (1.0 - 2.0 * v) / ((1.0 - v) * self.film_modulus) - 1.0 / self.own_modulus


@dataclass(frozen=True)
class Lubricant:
    """The oil."""

    viscosity: Viscosity
    density: Density
    rheology: Rheology
    conductivity: float = parameter(
        "W/(m K)", "thermal conductivity of the oil at p = 0", least=1e-3, most=10.0, default=0.14
    )
    conductivity_rise: float = parameter(
        "1/Pa", "relative rise of the conductivity with pressure at p = 0", least=0.0, most=1e-8, default=0.0
    )
    conductivity_bend: float = parameter(
        "1/Pa", "how the rise of the conductivity falls with pressure", least=0.0, most=1e-8, default=0.0
    )
    flow: str = parameter(
        "",
        "what Reynolds' equation sees: newtonian, the viscosity at the inlet's temperature; local, that of the local "
        "temperature, thinned by the local shear",
        choices=("newtonian", "local"),
        default="newtonian",
    )
    cavitation: str = parameter(
        "",
        "where oil would be under tension: reynolds, it has no pressure and its gap counts as full; mass_conserving, "
        "the gap holds what flows in, and is full where that is more than it can hold",
        choices=("reynolds", "mass_conserving"),
        default="reynolds",
    )
    supply: Supply = field(default=Flooded())
    double_layer: DoubleLayer = field(default=NoDoubleLayer())

    def conductivity_under(self, pressure: Numbers) -> Numbers:
        """Return the thermal conductivity [W/(m K)] at pressures [Pa].

        k (1 + c p/(1 + b p)): Larsson & Andersson, Proc. IMechE J 214 (2000) 337.
        """
        if self.conductivity_rise == 0.0:
            return self.conductivity
        rise = self.conductivity_rise * pressure / (1.0 + self.conductivity_bend * pressure)
        return self.conductivity * (1.0 + rise)


@dataclass(frozen=True)
class Control:
    """Division of the evolution over time into blocks, in each of which the contact is solved at a few instants."""

    change: float = parameter(
        "m", "largest change of film or wear in a block, as rms over the track", least=1e-11, most=1e-6
    )
    input_change: float = parameter("", "relative change of an input that asks for a new solution", least=0.0, most=1.0)
    driver: str = parameter(
        "",
        "contact whose pressures drive tribofilm and wear: with the film between the bodies, or dry",
        choices=("mixed", "dry"),
        default="mixed",
    )
    dry_instants: int = parameter("", "instants of a block driven dry", least=1, most=1000, default=3)
    mixed_instants: int = parameter(
        "",
        "way of the oil in a block driven by mixed lubrication, in nodes; 0: a twentieth of a pass",
        least=0,
        most=1000,
        default=0,
    )
    nodes_per_instant: float = parameter(
        "",
        "way of the oil from instant to instant of a mixed block, in nodes; less where bodies slide past each other by "
        "more than half a correlation length in it",
        above=0.0,
        most=1.0,
        default=1.0,
    )
    longest: float = parameter("s", "longest block", above=0.0, most=1e9, default=120.0)
    inputs: str = parameter(
        "",
        "film after a change of load, speeds or radii: quasi_steady, settled at once; transient, the last film, which "
        "follows the change",
        choices=("quasi_steady", "transient"),
        default="quasi_steady",
    )
    accuracy: float | None = parameter(
        "",
        "half width (95 %) asked for of the error of friction_coefficient and h_c, relative, and of "
        "contact_load_ratio: chooses grid, tolerance, blocks and instants that the scene does not give",
        above=0.0,
        most=1.0,
        shapes_arrays=True,
        default=None,
    )
