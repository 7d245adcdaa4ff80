"""A contact of the regression level moved by what it deviates by from a solved one, and all that follows from that."""

from typing import NamedTuple

from ..regression.contact import MeanContact
from ..scene import Case


class Deviation(NamedTuple):
    """What a correction says of a contact of the regression level."""

    friction: float  # factor on friction
    film: float  # factor on h_c
    load_ratio: float  # contact_load_ratio


def exact(case: Case, contact: MeanContact) -> bool:
    """Return True where the regression level has no error to correct: no load, smooth bodies."""
    smooth = case.scene.surface_1.smooth and case.scene.surface_2.smooth
    return not case.loaded or contact.sigma == 0.0 or smooth


def moved(contact: MeanContact, found: Deviation, bulk: float) -> MeanContact:
    """Return the contact moved by a deviation; `bulk` is the temperature [K] of the warmer body.

    Friction of the solids keeps its law and the real area its pressure: both follow the load ratio, as far as all of
    the friction goes. The oil has the rest. Power, heat and temperatures follow friction.
    """
    share = found.load_ratio / contact.load_ratio if contact.load_ratio > 0.0 else 1.0
    friction, law = found.friction, share * contact.solid
    force = friction * (contact.solid + contact.fluid)
    solid = law if abs(law) < abs(force) else force
    oil = abs((force - solid) / contact.fluid) if contact.fluid != 0.0 else 1.0
    by_speed_1, by_speed_2, by_load, by_temperature = contact.derivatives
    return contact._replace(
        gap=found.film * contact.gap,
        load_ratio=found.load_ratio,
        area_ratio=share * contact.area_ratio,
        solid=solid,
        fluid=force - solid,
        derivatives=(friction * by_speed_1, friction * by_speed_2, friction * by_load, friction * by_temperature),
        fluid_shear=oil * contact.fluid_shear,
        rise=friction * contact.rise,
        power=friction * contact.power,
        into_1=friction * contact.into_1,
        spin_torque=friction * contact.spin_torque,
        hottest=bulk + friction * (contact.hottest - bulk),
    )
