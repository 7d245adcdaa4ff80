"""Units of the outputs against what defines them, and nominals against what the shipped scenes give."""

import math
from collections.abc import Iterator
from dataclasses import replace

import pytest

from contact_core import OperatingPoint, Outputs, Scene, advance, initial_state
from contact_core.quantities import INPUTS, OF_CALLER, OUTPUTS, Quantity
from contact_core.scene import units

BASES = {
    "load": "N",
    **dict.fromkeys(("speed_1", "speed_2"), "m/s"),
    **dict.fromkeys(("temperature", "body_temperature_1", "body_temperature_2"), "K"),
    "spin": "rad/s",
    **dict.fromkeys(("radius_x", "radius_y"), "m"),
}
# outputs, pairs by their common name, as products of inputs and of outputs; with several each must have the unit
DEFINED = {
    **dict.fromkeys(("friction_force", "friction_solid", "friction_fluid"), ("load",)),
    "friction_coefficient": ("friction_force load^-1",),
    "rolling_resistance": ("h_c pressure_max radius_x",),
    "spin_torque": ("friction_force radius_x", "power_loss spin^-1"),
    "power_loss": ("friction_force speed_1", "spin_torque spin"),
    "dfriction_dspeed": ("friction_force speed_1^-1",),
    "dfriction_dload": ("friction_force load^-1",),
    "dfriction_dtemperature": ("friction_force temperature^-1",),
    "wear_rate": ("wear_volume_1 suggested_step^-1",),
    "wear_volume": ("wear_depth_1 radius_x^2", "wear_rate_1 suggested_step"),
    **dict.fromkeys(("wear_depth", "approach", "h_c", "h_central", "h_min"), ("radius_x",)),
    **dict.fromkeys(("tribofilm", "tribofilm_roughness", "tribofilm_covered", "tribofilm_upper"), ("radius_x",)),
    **dict.fromkeys(("tribofilm_grown", "tribofilm_removed", "oxide"), ("radius_x",)),
    **dict.fromkeys(("roughness", "roughness_ra", "roughness_raw"), ("radius_x",)),
    **dict.fromkeys(("lambda_ratio", "lambda_conventional"), ("h_c roughness_1^-1",)),
    "pressure_max": ("load radius_x^-2",),
    **dict.fromkeys(("temperature", "flash_temperature_rise", "contact_temperature_max"), ("temperature",)),
    "scuffing_ratio": ("contact_temperature_max temperature^-1",),
    "heat_flow": ("power_loss", "friction_force speed_1"),
    "suggested_step": ("radius_x speed_1^-1",),
    "load_cycles": ("speed_1 suggested_step radius_x^-1",),
    **dict.fromkeys(("contact_load_ratio", "contact_load_ratio_disc"), ("friction_solid load^-1",)),
    **dict.fromkeys(("contact_area_ratio", "contact_area_ratio_disc", "coverage"), ("radius_x radius_y^-1",)),
    "error_friction": ("friction_coefficient friction_coefficient^-1",),
    "error_rolling": ("rolling_resistance rolling_resistance^-1",),
    "error_film": ("h_c h_c^-1",),
    "error_tribofilm": ("tribofilm_1 tribofilm_1^-1",),
    "error_load_ratio": ("contact_load_ratio",),
    **dict.fromkeys(("von_mises_max",), ("pressure_max", "load radius_x^-2")),
    **dict.fromkeys(("von_mises_depth", "profile_loss"), ("radius_x",)),
    **dict.fromkeys(("dang_van_ratio", "crossland_ratio"), ("von_mises_max pressure_max^-1",)),
    **dict.fromkeys(("near_surface_share", "damage", "micropitted_area"), ("load_cycles_1",)),
    "error_damage": ("damage_1 damage_1^-1",),
    "error_wear": ("wear_depth_1 wear_depth_1^-1",),
    **dict.fromkeys(("unconverged", "blocks_dry", "blocks_mixed", "blocks_fallback"), ("load_cycles_1",)),
}
UNITS = {q.name: q.unit for q in (*INPUTS, *OUTPUTS)}
REALS = [q for q in OUTPUTS if q.kind == "Real"]


def dimension(product: str) -> tuple[int, ...]:
    """Exponents of m, kg, s and K of a product such as "a b^-1"; an angle is a number."""
    total = [0, 0, 0, 0]
    for factor in product.split():
        name, _, power = factor.partition("^")
        for axis in range(4):
            total[axis] += int(power or 1) * units.unit(UNITS[name])[1][axis]
    return tuple(total)


def test_the_inputs_have_the_units_that_all_others_follow_from():
    assert {q.name: q.unit for q in INPUTS} == BASES


@pytest.mark.parametrize("quantity", REALS, ids=lambda q: q.name)
def test_an_output_has_the_unit_of_what_defines_it(quantity: Quantity) -> None:
    defined = DEFINED.get(quantity.name) or DEFINED.get(quantity.name[:-2])
    assert defined, f"Add '{quantity.name}' to DEFINED."
    factor, (*exponents, radian) = units.unit(quantity.unit)
    assert (factor, radian) == (1.0, 0)
    assert {dimension(product) for product in defined} == {tuple(exponents)}


# what happens in shipped scenes

SPINNING = 30.0  # rad/s, for a torque to come about
COARSE = {
    "film.points": "17",
    "film.floor": "10 nm",
    "surface_1.correlation_length": "50 um",
    "surface_2.correlation_length": "50 um",
}
TIRED = COARSE | {  # a softer steel than any, so that it breaks out in so short a run
    "stress.model": "half_space",
    "fatigue.model": "basquin",
    "fatigue.reference_stress": "300 MPa",
    "stress.near_surface": "0.5",
    "fatigue.reference_cycles": "2000",
    "fatigue.life_exponent": "9",
}
# in so short a run, or on so coarse a grid, or without the law
NEVER = {
    "unconverged",
    "blocks_dry",
    "blocks_mixed",
    "blocks_fallback",
    "oxide_1",
    "oxide_2",
    "micropitted_area_2",
    "scuffing_ratio",
}


def run(scene: Scene, steps: int = 2) -> Iterator[Outputs]:
    point: OperatingPoint = scene.operation.point
    if "spin" not in scene.geometry.lacks:
        point = replace(point, spin=SPINNING)
    state = initial_state(scene)
    for step in [0.0, *[scene.operation.interval] * steps]:
        state, outputs = advance(scene, point, state, step)
        yield outputs


@pytest.fixture(scope="module")
def largest() -> dict[str, float]:
    """The largest magnitude of each output over shipped scenes, at the regression level and on a coarse grid."""
    scenes = [Scene.from_toml(name).at_level("regression") for name in ("azam_case_a", "mtm_zddp", "fzg_flank")]
    scenes += [Scene.from_toml("mtm_zddp", given) for given in (COARSE, TIRED)]
    found = [row for scene in scenes for row in run(scene)]
    return {q.name: max(abs(getattr(row, q.name)) for row in found) for q in REALS if q.name not in OF_CALLER}


@pytest.mark.parametrize("quantity", REALS, ids=lambda q: q.name)
def test_a_nominal_is_within_three_decades_of_what_shipped_scenes_give(
    quantity: Quantity, largest: dict[str, float]
) -> None:
    if quantity.name not in NEVER:
        assert abs(math.log10(largest[quantity.name] / quantity.nominal)) <= 3.0
