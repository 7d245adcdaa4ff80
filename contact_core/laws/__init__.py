"""Physics in slots: one law per slot of a scene.

    base                Protocols: the attributes and methods of every law of a slot
    viscosity, density, rheology, supply, double_layer    the oil
    plasticity, boundary_friction, wear     the solids
    heat, bulk          temperatures in the contact, and of the bodies
    tribofilm/          growth and removal of the tribofilm
    oxide               oxide where no tribofilm covers the solids
    stress              stresses below the surfaces, and the fatigue limits beside them
    fatigue             damage of the solids by load cycles
    scuffing            risk of scuffing: the hottest spot against a critical temperature
    load_sharing        load on solids and oil at the regression level
    profile             ends of rollers
    asperity_layer      roughness below the grid: `microroughness` of a surface
    temperatures        records of the heat and the temperatures of a contact
    equations           text of a law's equations, for documentation
    symbols             what the symbols of these equations stand for
    offered             laws of other installed packages beside these
    elementary          elementary functions of numbers and arrays

Each law is a frozen dataclass with a `name`, its `source`, its `equations`, its parameters and array functions. A
slot's table in a scene says `model = "<name>"`; for a law without parameters the name alone is enough. A new law is one
class that follows the Protocol of its slot, and one entry in its module's LAWS, or an entry point of another package
(`offered`). A new tribofilm law is one file in `tribofilm`, one entry in its LAWS, and constants in
data/tribofilms.toml.
"""

from . import (
    boundary_friction,
    bulk,
    density,
    double_layer,
    fatigue,
    heat,
    load_sharing,
    oxide,
    plasticity,
    profile,
    rheology,
    scuffing,
    stress,
    supply,
    tribofilm,
    viscosity,
    wear,
)
from .base import Law

SLOTS: dict[str, tuple[type[Law], ...]] = {
    "viscosity": viscosity.LAWS,
    "density": density.LAWS,
    "rheology": rheology.LAWS,
    "supply": supply.LAWS,
    "double_layer": double_layer.LAWS,
    "plasticity": plasticity.LAWS,
    "boundary_friction": boundary_friction.LAWS,
    "heat": heat.LAWS,
    "bulk": bulk.LAWS,
    "tribofilm": tribofilm.LAWS,
    "wear": wear.LAWS,
    "oxide": oxide.LAWS,
    "stress": stress.LAWS,
    "fatigue": fatigue.LAWS,
    "scuffing": scuffing.LAWS,
    "sharing": load_sharing.LAWS,
    "profile": profile.LAWS,
}
