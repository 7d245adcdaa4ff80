"""Steps of the regression level, each contact corrected by the map of the scene."""

from .. import regression
from ..regression.contact import MeanContact, evaluate
from ..regression.surfaces import Tribofilms
from ..scene import Case
from ..state import ContactState, Outputs, changed
from .map import map_of
from .query import corrected, slopes


def advance(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s]. Raises SceneError if the scene has no map, or another one's."""
    chart = map_of(case.scene)
    last: list[tuple[Case, Tribofilms]] = []

    def contact_of(now: Case, tribofilms: Tribofilms) -> MeanContact:
        last[:] = [(now, tribofilms)]
        return corrected(chart, now, evaluate(now, tribofilms, derivatives=False))

    after, outputs = regression.advance(case, state, dt, contact_of)
    by_speed_1, by_speed_2, by_load, by_temperature = slopes(chart, *last[0])  # the outputs are of the last contact
    outputs = changed(
        outputs,
        dfriction_dspeed_1=by_speed_1,
        dfriction_dspeed_2=by_speed_2,
        dfriction_dload=by_load,
        dfriction_dtemperature=by_temperature,
    )
    return changed(after, outputs=outputs), outputs
