"""What every component keeps to."""

import math

import pytest
from comparison import approx
from component_examples import EXAMPLES, marched

from contact_core.quantities import out_of_range
from contact_core.scene import units

STEPS = (1e-4, 0.03, 1.0, 47.0, 600.0)


@pytest.mark.parametrize("name", EXAMPLES)
@pytest.mark.parametrize("step", STEPS)
def test_seven_steps_under_held_inputs_are_one(name, step):
    part, inputs = EXAMPLES[name]
    start = part.initial({variable.name: variable.start for variable in part.inputs})
    once = part.advance(start, inputs, step)
    assert once != start
    assert marched(part, start, inputs, step / 7, 7) == approx(once, rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_long_time_ends_where_held_inputs_lead(name):
    part, inputs = EXAMPLES[name]
    state = marched(part, part.initial(inputs), inputs, 600.0, 100)
    for variable in part.responses:
        assert math.isfinite(part.outputs(state, inputs)[variable.name])


@pytest.mark.parametrize("name", EXAMPLES)
def test_outputs_are_those_declared_and_look_only_at_the_inputs_that_they_name(name):
    part, inputs = EXAMPLES[name]
    state = part.advance(part.initial(inputs), inputs, 0.02)
    values = part.outputs(state, inputs)
    assert list(values) == [variable.name for variable in part.responses]
    for changed in inputs:
        others = part.outputs(state, inputs | {changed: inputs[changed] + 0.01})
        moved = {variable for variable in values if others[variable] != values[variable]}
        assert moved <= {variable.name for variable in part.responses if changed in variable.direct}


@pytest.mark.parametrize("name", EXAMPLES)
def test_parameters_are_in_range_and_units_known(name):
    part, inputs = EXAMPLES[name]
    part.check()
    assert not list(out_of_range(part, ""))
    assert set(inputs) == {variable.name for variable in part.inputs}
    for variable in (*part.inputs, *part.responses):
        _, dimension = units.unit(variable.unit)
        assert variable.display in ("", "degC") or units.unit(variable.display)[1] == dimension


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_derivative_is_that_of_its_output(name):
    part, inputs = EXAMPLES[name]
    state = part.advance(part.initial(inputs), inputs, 0.4)
    for variable in part.responses:
        of, _, by = variable.name.removeprefix("d").partition("_d")
        if not (variable.name.startswith("d") and by):
            continue
        low, high = (part.outputs(state, inputs | {by: inputs[by] + change})[of] for change in (-1e-5, 1e-5))
        assert part.outputs(state, inputs)[variable.name] == approx((high - low) / 2e-5, rel=1e-5)
