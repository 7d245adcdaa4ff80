"""Options that calls of a point and a line share: their names, choices and defaults."""

import inspect

import pytest

from contact_core import ContactOptions, OperatingPointError, line_contact, point_contact

OIL = {"speed_1": 1.0, "speed_2": 1.0, "viscosity": 0.01, "pressure_viscosity": 1e-8, "reduced_modulus": 2e11}
CALLS = [(point_contact, OIL | {"load": 10.0, "radius_x": 0.01}), (line_contact, OIL | {"load": 1e5, "radius": 0.01})]


@pytest.mark.unit
@pytest.mark.parametrize(("call", "given"), CALLS)
def test_an_unknown_option_is_refused_with_the_nearest_name(call, given):
    with pytest.raises(TypeError, match=r"no argument 'hieghts_1'\. Did you mean 'heights_1'\?"):
        call(**given, hieghts_1=[[0.0]])
    with pytest.raises(TypeError, match=r"no argument 'domian'\. Did you mean 'domain'\?"):
        call(**given, domian=None)


@pytest.mark.unit
@pytest.mark.parametrize(("call", "given"), CALLS)
def test_a_choice_that_is_none_is_refused_with_the_nearest_one(call, given):
    with pytest.raises(OperatingPointError, match=r"viscosity_law = 'roeland' is not one of .* 'roelands'"):
        call(**given, viscosity_law="roeland")


@pytest.mark.unit
@pytest.mark.parametrize(("call", "given"), CALLS)
def test_signature_and_help_name_every_option(call, given):
    shown = inspect.signature(call).parameters
    assert set(ContactOptions.__annotations__) | set(given) <= set(shown)
    assert shown["floor"].default == 1e-9
    assert shown["cavitation"].default == "reynolds"
    assert set(ContactOptions.__annotations__) <= set(ContactOptions.__doc__.replace(",", " ").split())
