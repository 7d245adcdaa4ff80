"""Steps of the regression level, each contact corrected by the map of the scene."""

from .. import regression
from ..regression.contact import MeanContact
from ..regression.surfaces import Tribofilms
from ..scene import Case
from ..state import ContactState, Outputs, changed
from .map import map_of
from .query import ByMap, slopes

_BY = ("speed_1", "speed_2", "load", "temperature")


def advance(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s]. Raises SceneError if the scene has no map, or another one's."""
    by = ByMap(map_of(case.scene))
    last: list[tuple[Case, Tribofilms]] = []

    def contact_of(now: Case, tribofilms: Tribofilms) -> MeanContact:
        last[:] = [(now, tribofilms)]
        return by.contact(now, tribofilms)

    after, outputs = regression.advance(case, state, dt, contact_of)
    told = slopes(by.chart, *last[0])  # the outputs are of the last contact
    outputs = changed(outputs, **{f"dfriction_d{name}": slope for name, slope in zip(_BY, told, strict=True)})
    return changed(after, outputs=outputs), outputs
