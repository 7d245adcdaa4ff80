"""The C sources of a component's FMU, written from its Python."""

from typing import Any

from contact_core.errors import SceneError
from fmu_src.flavours import Version
from fmu_src.native import build as native
from fmu_src.native import keeping
from fmu_src.native.model import model_c
from fmu_src.native.names import c_name
from fmu_src.native.program import calling, header, source, translated
from fmu_src.native.tables import tables_h
from fmu_src.native.translate import Num, Untranslatable

from .part import Part, State, Values, start_values
from .resources import guid
from .scalars import INSTEAD
from .variables import variables

_CODE = ("contact_core", "fmu_src", "system_models")  # packages whose code writes the C
Found = tuple[State, dict[str, float]]


def first(part: Part, inputs: Values) -> Found:
    """Return the state at the start and its outputs."""
    state = part.initial(inputs)
    return state, part.outputs(state, inputs)


def step(part: Part, state: State, inputs: Values, dt: float) -> Found:
    """Return the state after a step of `dt` [s] >= 0, and the outputs."""
    after = part.advance(state, inputs, dt) if dt > 0.0 else state
    return after, part.outputs(after, inputs)


def sources(part: Part, fmi: Version = 2) -> dict[str, bytes]:
    """Return name and content of the sources. Raises SceneError if the component has no C."""
    token, states = guid(part, "native", fmi), guid(part, "native")
    try:
        texts = keeping.kept_texts(
            ("component", keeping.code_of(*_CODE, type(part).__module__.partition(".")[0]), states),
            lambda: _written(part),
        )
    except Untranslatable as error:
        raise SceneError(
            f"A {part.name} has no native FMU so far ({error}). Take flavour = 'isolated' for the components."
        ) from error
    texts |= {"tables.h": tables_h(), "model.c": model_c(variables(part), token, states, ranges=False)}
    return {**native.runtime(fmi), **{name: text.encode() for name, text in texts.items()}}


def _written(part: Part) -> dict[str, str]:
    names = {q.name: c_name(q.name) for q in (*part.inputs, *part.responses)}
    if len({*names.values()}) < len(names):
        raise SceneError(f"Variables of a {part.name} have one name in C: rename one.")
    inputs: dict[str, Any] = {q.name: Num(names[q.name]) for q in part.inputs}
    count = len(part.initial(start_values(part)))
    state: Any = tuple(Num(f"held_{k}") for k in range(count))
    begun, first_texts = translated(first, [part, inputs], INSTEAD)
    stepped, step_texts = translated(step, [part, state, inputs, Num("dt")], INSTEAD)
    known = [number.text for number in inputs.values()]

    def calls(head: str, entry: Any) -> str:
        after, given = entry.result
        sets = [(f"state->held_{k}", value) for k, value in enumerate(after)]
        return "\n".join(
            calling(head, entry, known, [*sets, *((f"out->{names[name]}", x) for name, x in given.items())])
        )

    begins = calls("contact_initialise(const contact_inputs *in, contact_state *state, contact_outputs *out,", begun)
    steps = calls(
        "contact_step(const contact_inputs *in, double dt, contact_state *state, contact_outputs *out,", stepped
    )
    table = variables(part)
    outputs = [q.name for q in part.responses]
    return {
        "contact.h": header(f"The component {part.name}.", table, [number.text for number in state], outputs),
        "first.c": source([*first_texts, begins]),
        "contact.c": source([*step_texts, steps, _NO_DERIVATIVES]),
    }


_NO_DERIVATIVES = """\
int contact_derivatives(const contact_inputs *in, const contact_state *state, contact_outputs *out,
    contact_message *why)
{
    (void)in, (void)state, (void)out, (void)why;
    return 0;
}"""
