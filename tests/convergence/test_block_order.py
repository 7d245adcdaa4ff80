"""Time steps of the evolution are of first order; the sampling error of the dose falls with the instants."""

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, advance, initial_state
from contact_core.deterministic.accumulator import Accumulator
from contact_core.deterministic.sampling import sample_dry
from contact_core.scene import Case

CHEAP = {
    "film.points": "33",
    "surface_1.correlation_length": "16 um",
    "surface_2.correlation_length": "16 um",
    "film.tolerance": "1e-3",
    "control.driver": "dry",
    "tribofilm.model": "none",
}


def test_wear_of_smooth_bodies_converges_with_first_order_in_the_blocks():
    smooth = CHEAP | {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "control.dry_instants": "1", "wear.bare": "1e-4"}
    found = []
    for longest in (120.0, 60.0, 30.0):
        scene = Scene.from_toml("azam_case_a", smooth | {"control.longest": f"{longest} s", "control.change": "1 um"})
        state, out = advance(scene, scene.operation.point, initial_state(scene), 3600.0)
        assert out.blocks_dry >= 3600.0 / longest
        found.append(state.bodies[0].wear.mean(axis=1).max())
    steps = np.abs(np.diff(found))
    assert found[-1] > 1e-7
    assert np.log2(steps[0] / steps[1]) == approx(1.0, abs=0.3)


@pytest.mark.long
def test_the_dose_of_a_smooth_body_evens_out_with_the_instants():
    """Faster than by the square root of their number: their offsets are of low discrepancy."""
    spread = []
    for instants in (8, 128):
        scene = Scene.from_toml("azam_case_a", CHEAP | {"surface_1.rq": "0 nm", "control.dry_instants": str(instants)})
        state = initial_state(scene)
        sweep = Accumulator.before(state)
        sample_dry(Case(scene, scene.operation.point), state, sweep, same=True)
        middle = sweep.pressures[0][14:19] / instants
        spread.append(float((middle.std(axis=1) / middle.mean(axis=1)).mean()))
    assert spread[0] / spread[1] > 2.0 * np.sqrt(16.0)
    assert spread[1] < 0.06
