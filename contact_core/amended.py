"""A contact of the regression level with friction, film and W_c from elsewhere, and all that follows from them."""

from .regression.contact import MeanContact
from .scene import Case


def kept(case: Case, contact: MeanContact) -> bool:
    """Return True where there is nothing to correct, or no friction by which to tell where a contact lies."""
    return contact.solid + contact.fluid == 0.0 or exact(case, contact)


def exact(case: Case, contact: MeanContact) -> bool:
    """Return True where the regression level has no error to correct: no load, smooth bodies."""
    smooth = case.scene.surface_1.smooth and case.scene.surface_2.smooth
    return not case.loaded or contact.sigma == 0.0 or smooth


def amended(contact: MeanContact, friction: float, gap: float, load_ratio: float, bulk: float) -> MeanContact:
    """Return the contact with `friction` times its friction, another gap [m] and another load ratio.

    The real area follows the load ratio; power, heat and temperatures follow friction. `bulk` is the temperature [K] of
    the warmer body.
    """
    share = load_ratio / contact.load_ratio if contact.load_ratio > 0.0 else 1.0
    by_speed_1, by_speed_2, by_load, by_temperature = contact.derivatives
    return contact._replace(
        gap=gap,
        load_ratio=load_ratio,
        area_ratio=share * contact.area_ratio,
        solid=friction * contact.solid,
        fluid=friction * contact.fluid,
        derivatives=(friction * by_speed_1, friction * by_speed_2, friction * by_load, friction * by_temperature),
        power=friction * contact.power,
        into_1=friction * contact.into_1,
        spin_torque=friction * contact.spin_torque,
        hottest=bulk + friction * (contact.hottest - bulk),
    )


def wear_error(stated: float, raw_error: float, raw_ratio: float, error: float, ratio: float) -> float:
    """Return the relative error of wear, as narrow as that of the load ratio that makes it; never wider than `stated`.

    `raw_ratio` and `raw_error` are the contact_load_ratio of the regression level and its half width, `ratio` and
    `error` those of the corrected one.
    """
    narrower = error / raw_error if raw_error > 0.0 else 1.0
    share = raw_ratio / ratio if ratio > 0.0 else 1.0
    return stated * min(narrower * share, 1.0)
