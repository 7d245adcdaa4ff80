"""Physics in slots: each law is a frozen dataclass with a `name`, its `source`, its `equations` (for
documentation), its parameters and array functions.

A slot's table in a scene says `model = "<name>"`; for a law without parameters the name alone will do. A new law is one
class and one entry in its module's LAWS; it has what the Protocol of its slot in `base` asks for. A new tribofilm law is
one file in `tribofilm`, one entry in its LAWS, and constants in data/tribofilms.toml.
"""

from . import (
    boundary_friction,
    bulk,
    density,
    heat,
    load_sharing,
    plasticity,
    profile,
    rheology,
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
    "plasticity": plasticity.LAWS,
    "boundary_friction": boundary_friction.LAWS,
    "heat": heat.LAWS,
    "bulk": bulk.LAWS,
    "tribofilm": tribofilm.LAWS,
    "wear": wear.LAWS,
    "sharing": load_sharing.LAWS,
    "profile": profile.LAWS,
}
