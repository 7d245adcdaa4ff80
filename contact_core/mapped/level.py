"""Steps of the level `map`: those of the regression level, each contact corrected by the map of the scene."""

from .. import regression
from ..amended import kept, wear_error
from ..correction import CORRECTED
from ..regression.contact import MeanContact, evaluate
from ..regression.outputs import half_widths
from ..regression.surfaces import Tribofilms
from ..scene import Case, Scene
from ..state import ContactState, Error, Outputs, RangeFlag, changed, flag_of_errors
from .map import Map, map_of
from .query import corrected, half_widths_of, here, told

_FRICTION, _FILM, _LOAD = CORRECTED.values()  # outputs that state errors


def advance(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s]. Raises SceneError if the scene has no map, or another one's."""
    chart, contacts = map_of(case.scene), _Last()

    def contact_of(now: Case, tribofilms: Tribofilms) -> MeanContact:
        contacts.case, contacts.contact = now, evaluate(now, tribofilms)
        return corrected(chart, now, contacts.contact)

    after, outputs = regression.advance(case, state, dt, contact_of)
    outputs = stated(chart, contacts.case, contacts.contact, outputs)
    return changed(after, outputs=outputs), outputs


class _Last:
    """The contact of the regression level that the outputs are of."""

    case: Case
    contact: MeanContact


def stated(chart: Map, case: Case, contact: MeanContact, outputs: Outputs) -> Outputs:
    """Return the outputs of a step with the errors that the map leaves of its last contact, as it was uncorrected."""
    if kept(case, contact):
        return outputs
    raw = half_widths(case, contact)
    place = here(chart, case, contact)
    friction, film, load = half_widths_of(chart, place, (raw[_FRICTION], raw[_FILM], raw[_LOAD]))
    ratio = told(chart, place, contact.load_ratio).load_ratio
    wear = wear_error(outputs.error_wear, raw[_LOAD], contact.load_ratio, load, ratio)
    errors = {_FRICTION: friction, _FILM: film, _LOAD: load, "error_wear": wear}
    outside = RangeFlag.OUTSIDE_FIT if place.trust < 1.0 else RangeFlag(0)
    unsure = flag_of_errors(errors, case.scene.control.accuracy)
    flags = outputs.range_flags & ~int(RangeFlag.UNSURE) | int(outside) | int(unsure)
    return changed(outputs, **errors, range_flags=flags)


def warm_up(case: Case, state: ContactState) -> None:
    """Load what the first steps need."""
    regression.warm_up(case, state)


def errors_of(scene: Scene, state: ContactState) -> dict[str, Error]:
    """Return the errors of the outputs by name, each in the unit of its output; all by curves and map."""
    return regression.errors_of(scene, state)
