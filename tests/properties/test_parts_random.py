"""Components take any inputs and any steps, and how a step is split changes nothing."""

import math

import pytest
from comparison import approx
from component_examples import EXAMPLES
from hypothesis import given
from hypothesis import strategies as st

WIDEST = {
    "K": (220.0, 480.0),
    "W": (-2e3, 2e3),
    "N m": (-60.0, 60.0),
    "rad/s": (-400.0, 400.0),
    "m/s": (-4.0, 4.0),
    "N": (-90.0, 90.0),
}


@pytest.mark.parametrize("name", EXAMPLES)
@given(data=st.data())
def test_any_inputs_give_finite_outputs_however_a_step_is_split(name, data):
    part, _ = EXAMPLES[name]

    def drawn() -> dict[str, float]:
        spans = {i.name: (max(i.minimum, WIDEST[i.unit][0]), min(i.maximum, WIDEST[i.unit][1])) for i in part.inputs}
        return {name: data.draw(st.floats(*span), label=name) for name, span in spans.items()}

    state = part.initial(drawn())
    for _ in range(3):
        inputs = drawn()
        step = 10.0 ** data.draw(st.floats(-4.0, math.log10(600.0)), label="log step")
        early = step * data.draw(st.floats(0.001, 0.999), label="split")
        split = part.advance(part.advance(state, inputs, early), inputs, step - early)
        state = part.advance(state, inputs, step)
        assert split == approx(state, rel=1e-9, abs=1e-6)
        assert all(math.isfinite(value) for value in part.outputs(state, inputs).values())
