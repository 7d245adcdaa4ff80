"""What corrects a contact of the regression level: what it deviates by, the error that is left, and what follows.

A correction says how friction, h_c and W_c deviate at a case and a contact, and with which errors. All else of the
contact follows from that, whichever correction it is.
"""

from typing import NamedTuple, Protocol

from ..regression.contact import MeanContact, Stated
from ..regression.outputs import half_widths
from ..scene import Case
from ..state import RangeFlag

CORRECTED = {  # output, and the output that states its error
    "friction_coefficient": "error_friction",
    "h_c": "error_film",
    "contact_load_ratio": "error_load_ratio",
}
UNSURE = RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK | RangeFlag.DOMAIN_EDGE  # of blocks that judge nothing

Three = tuple[float, float, float]  # in the order of `CORRECTED`


class Deviation(NamedTuple):
    """What a correction says of a contact of the regression level."""

    friction: float  # factor on friction
    film: float  # factor on h_c
    load_ratio: float  # contact_load_ratio


class Correction(Protocol):
    """What corrects contacts of the regression level."""

    def at(self, case: Case, contact: MeanContact, stated: Three) -> tuple[Deviation, Stated] | None:
        """Return what a contact deviates by and the errors that are left; None where nothing is known.

        `stated`: half widths (95 %) that the regression level states: of friction and h_c relative, of W_c absolute.
        """


def exact(case: Case, contact: MeanContact) -> bool:
    """Return True where the regression level has no error to correct: no load, smooth bodies."""
    smooth = case.scene.surface_1.smooth and case.scene.surface_2.smooth
    return not case.loaded or contact.sigma == 0.0 or smooth


def corrected(by: Correction, case: Case, contact: MeanContact) -> MeanContact:
    """Return a contact of the regression level, corrected, with the errors that are left.

    Where that level is exact, and where nothing is known, it stands as it is.
    """
    raw = half_widths(case, contact)
    own = (raw["error_friction"], raw["error_film"], raw["error_load_ratio"])
    if exact(case, contact):
        return contact._replace(stated=Stated(*own, 1.0))
    found = by.at(case, contact, own)
    if found is None:
        return contact
    deviation, stated = found
    return moved(contact, deviation, max(case.op.bodies))._replace(stated=stated)


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
