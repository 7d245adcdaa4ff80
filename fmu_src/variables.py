"""The variables of the FMU: inputs, parameters and outputs of a scene, in order of their value references."""

import math
from dataclasses import Field, dataclass
from typing import Any, Literal

from contact_core.quantities import INPUTS, OUTPUTS, Quantity
from contact_core.scene import Scene, tunables

Kind = Literal["Real", "Integer", "Boolean", "String"]
Causality = Literal["input", "parameter", "output"]
Value = float | int | bool | str

INITIAL_STATE = "initial_state"
ZERO: dict[Kind, Value] = {"Real": 0.0, "Integer": 0, "Boolean": False, "String": ""}


@dataclass(frozen=True)
class Variable:
    """One variable of the FMU, in SI; its position in `variables` is its value reference."""

    name: str
    text: str
    kind: Kind
    causality: Causality
    start: Value  # outputs: their value until they are computed
    unit: str = ""
    display: str = ""
    nominal: float | None = None
    minimum: float = -math.inf
    maximum: float = math.inf
    relative: bool = False


def variables(scene: Scene) -> tuple[Variable, ...]:
    """Inputs, parameters and outputs of a scene's FMU. Index + 1 is the index of the model description.

    What the scene's level cannot tell is absent.
    """
    return (
        *(_quantity(q, "input", _start(scene, q.name)) for q in INPUTS),
        *(_parameter(name, value, field) for name, (value, field) in tunables(scene).items()),
        Variable(
            INITIAL_STATE,
            "file with a stored contact state (ContactState.to_bytes) to start from; empty: fresh surfaces",
            "String",
            "parameter",
            "",
        ),
        *(_quantity(q, "output", ZERO[q.kind]) for q in OUTPUTS if scene.film.name in q.levels),
    )


def _start(scene: Scene, name: str) -> float:
    """Start value of an input; a body's temperature is the oil's if the scene says nothing else."""
    value = getattr(scene.operation, name)
    return float(scene.operation.temperature if value is None else value)


def _quantity(q: Quantity, causality: Causality, start: Value) -> Variable:
    nominal = q.nominal if q.kind == "Real" else None
    return Variable(
        q.name, q.text, q.kind, causality, start, q.unit, q.display, nominal, q.minimum, q.maximum, q.relative
    )


def _parameter(name: str, value: float | int, field: "Field[Any]") -> Variable:
    """A number of the scene. FMI knows closed ranges only: the bound of `above` is in, refused when used."""
    above, least, most = (field.metadata[key] for key in ("above", "least", "most"))
    low = above if above is not None else least if least is not None else -math.inf
    return Variable(
        name,
        field.metadata["text"],
        "Integer" if isinstance(value, int) else "Real",
        "parameter",
        value,
        unit=field.metadata["unit"],
        minimum=low,
        maximum=math.inf if most is None else most,
    )
