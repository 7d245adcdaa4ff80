"""The regression level over steps so short that differences of the surfaces are lost in rounding."""

import pytest

from contact_core import Scene, advance, initial_state
from tests.comparison import approx

MINUTES = 600.0  # s: the surfaces have changed much more since than they do in a short step
STORING = {
    "heat.bulk.model": "lumped",
    "heat.bulk.heat_capacity_1": "50 J/K",
    "heat.bulk.heat_capacity_2": "80 J/K",
    "heat.bulk.conductance_1": "0.5 W/K",
    "heat.bulk.conductance_2": "1.0 W/K",
}


@pytest.mark.parametrize("changes", [{}, STORING], ids=["", "bodies that store heat"])
def test_rates_and_the_suggested_step_do_not_depend_on_how_short_a_step_is(changes: dict[str, str]) -> None:
    scene = Scene.from_toml("mtm_zddp", changes).at_level("regression")
    point = scene.operation.point
    state, _ = advance(scene, point, initial_state(scene), MINUTES)
    _, expected = advance(scene, point, state, 1e-3)
    for size in (0.0, 1e-15, 1e-12, 1e-9, 1e-6):
        _, outputs = advance(scene, point, state, size)
        assert outputs.suggested_step == approx(expected.suggested_step, rel=0.01)
        assert outputs.wear_rate_1 == approx(expected.wear_rate_1, rel=0.01)
        assert outputs.wear_rate_2 == approx(expected.wear_rate_2, rel=0.01)
