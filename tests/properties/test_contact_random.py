"""Any operating point of a machine: what comes out is finite, within the hardness and carries the load."""

import math
from dataclasses import asdict

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from contact_core import ConvergenceError, OperatingPoint, Scene, advance, initial_state, solve
from contact_core.reference import SmoothContact, nijenbanning_venner_moes

HARDY = {"tribofilm.beyond_fit": "extrapolate"}
SMALL = {
    "film.points": "33",
    "surface_1.correlation_length": "16 um",
    "surface_2.correlation_length": "16 um",
    "film.iterations": "100",
}


def logarithmic(low, high):
    return st.floats(math.log10(low), math.log10(high)).map(lambda exponent: 10.0**exponent)


def signed(magnitude):
    return st.builds(math.copysign, st.one_of(st.just(0.0), magnitude), st.sampled_from([1.0, -1.0]))


@st.composite
def operating_points(draw):
    entrainment = draw(signed(logarithmic(1e-8, 30.0)))
    slip = draw(st.sampled_from([-2.0, -0.1, 0.0, 0.02, 0.5, 2.0, 2.5]))
    load, temperature = draw(logarithmic(1e-3, 120.0)), draw(st.floats(280.0, 420.0))
    return OperatingPoint(load, entrainment * (1.0 + 0.5 * slip), entrainment * (1.0 - 0.5 * slip), temperature)


def roughness():
    return st.sampled_from(["0 nm", "5 nm", "127 nm", "800 nm"])


def formula_film(scene, op):
    oil, geometry = scene.lubricant.viscosity, scene.geometry
    return nijenbanning_venner_moes(
        SmoothContact(
            load=op.load,
            entrainment_speed=abs(op.entrainment_speed),
            viscosity=float(oil(np.zeros(1), op.temperature)[0]),
            pressure_coefficient=oil.pressure_coefficient,
            radius_x=geometry.radius_x,
            radius_y=geometry.radius_y,
            reduced_modulus=scene.solids.reduced_modulus,
        )
    )


@given(operating_points(), roughness())
def test_an_instant_is_finite_bounded_and_carries_its_load(op, rq):
    scene = Scene.from_toml("azam_case_a", SMALL | {"surface_2.rq": rq})
    try:
        fields = solve(scene, op, initial_state(scene))
    except ConvergenceError as error:  # only a film that clears the roughness may be too thick to solve
        assert "oil film of about" in str(error)
        assert formula_film(scene, op) > 2.0 * math.hypot(scene.surface_1.rq, scene.surface_2.rq)
        return
    for name in (
        "pressure",
        "fluid_pressure",
        "solid_pressure",
        "gap",
        "fluid_shear",
        "solid_shear",
        "overlap",
    ):
        assert np.isfinite(getattr(fields, name)).all(), name
    assert fields.pressure.min() >= 0.0
    assert fields.fluid_pressure.min() >= 0.0
    assert fields.solid_pressure.min() >= -1e-9 * fields.pressure.max()
    assert fields.pressure.max() <= scene.plasticity.hardness * (1.0 + 1e-12)
    assert fields.gap.min() >= scene.film.floor * (1.0 - 1e-9)
    carried = fields.pressure.sum() * scene.film.spacing**2
    assert abs(carried / op.load + fields.load_beyond - 1.0) < 1e-3
    assert -1e-9 <= fields.load_beyond < 0.3 + 1e-3
    assert abs(fields.load_error) < 1e-3
    assert fields.route in {"dry", "mixed", "fallback"}
    assert not (fields.route == "fallback" and fields.converged)
    if fields.converged and fields.route == "mixed":
        assert fields.pressure_change < scene.film.tolerance
    if op.entrainment_speed == 0.0:
        assert fields.route == "dry"


@settings(max_examples=6)
@given(operating_points(), operating_points(), st.floats(0.0, 20.0))
def test_two_steps_in_a_row_give_finite_outputs_and_only_grow_wear(first, second, dt):
    scene = Scene.from_toml("azam_case_a", SMALL | HARDY | {"control.change": "50 nm", "film.iterations": "20"})
    try:
        state, before = advance(scene, first, initial_state(scene), dt)
        state, after = advance(scene, second, state, dt)
    except ConvergenceError as error:
        assert "oil film of about" in str(error)
        return
    for outputs in (before, after):
        assert all(math.isfinite(value) for value in asdict(outputs).values())
        assert outputs.power_loss >= 0.0
        assert 0.0 <= outputs.contact_load_ratio <= 1.0 + 1e-9
        assert outputs.pressure_max <= scene.plasticity.hardness * (1.0 + 1e-12)
    assert after.wear_volume_1 >= before.wear_volume_1
    assert after.load_cycles_2 >= before.load_cycles_2
    assert math.isclose(state.time, 2.0 * dt)
