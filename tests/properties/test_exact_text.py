import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact_core import Scene
from contact_core.quantities import INPUTS, OUTPUTS
from contact_core.scene import tunables, units, with_values

SCENE = Scene.from_toml("mtm_zddp")
SI_UNITS = sorted(
    {q.unit for q in (*INPUTS, *OUTPUTS)} | {field.metadata["unit"] for _, field in tunables(SCENE).values()}
)
finite = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e307, max_value=1e307)


@pytest.mark.parametrize("si_unit", SI_UNITS)
@given(value=finite)
def test_any_number_survives_as_text_with_its_unit(si_unit, value):
    assert units.parse(f"{value!r} {si_unit}", si_unit, "field").hex() == value.hex()


@given(st.integers(-(10**9), 10**9), st.sampled_from([("um", -6), ("nm", -9), ("mm", -3), ("m", 0), ("km", 3)]))
def test_whole_numbers_of_a_prefixed_unit_are_the_nearest_float(number, unit):
    name, power = unit
    assert units.parse(f"{number} {name}", "m", "field") == float(f"{number}e{power}")


def inside(field) -> st.SearchStrategy[float]:
    bounds = field.metadata
    low = bounds["above"] if bounds["above"] is not None else bounds["least"]
    return st.floats(low, bounds["most"], exclude_min=bounds["above"] is not None)


# what no rule across the tables restricts
FREE = (
    "wear.bare",
    "lubricant.rheology.eyring_stress",
    "heat.diffusivity_1",
    "boundary_friction.slip_speed",
    "surface_1.rq",
)


@given(st.fixed_dictionaries({name: inside(tunables(SCENE)[name][1]) for name in FREE}))
def test_any_scene_survives_its_own_tables_bit_for_bit(values):
    scene = with_values(SCENE, values)
    assert Scene.from_dict(scene.to_dict()) == scene
