"""The variables of an FMU in order of value references: inputs, parameters and outputs of a scene, time."""

import math
import sys
from dataclasses import Field, dataclass
from typing import Any, Literal

from contact_core.quantities import DIFFERENCE, INPUTS, LEVELS, OUTPUTS, Quantity, measured
from contact_core.scene import OperatingPoint, Scene, tunables, units

Kind = Literal["Real", "Integer", "Boolean", "String"]
Causality = Literal["input", "parameter", "output", "independent"]
Variability = Literal["continuous", "discrete", "fixed", "tunable"]
Value = float | int | bool | str

FIDELITY, SEED, INITIAL_STATE = "fidelity", "seed", "initial_state"
TIME = "time"
SPECIAL = (FIDELITY, SEED, INITIAL_STATE)  # parameters that are not numbers of the scene
ZERO: dict[Kind, Value] = {"Real": 0.0, "Integer": 0, "Boolean": False, "String": ""}

# display units, the largest first
_READ_IN = {
    "Pa": ("GPa", "MPa"),
    "Pa s": ("mPa s",),
    "Pa^-1": ("GPa^-1",),
    "m": ("mm", "um", "nm"),
    "m2/s": ("mm2/s",),
}


@dataclass(frozen=True)
class Variable:
    """One variable of an FMU, in SI units; its position in `variables` is its value reference."""

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
    quantity: str = ""  # kind of quantity: see contact_core.quantities.measured
    levels: tuple[str, ...] = LEVELS  # levels that fill an output
    direct: tuple[str, ...] = ()  # inputs on which an output depends without delay
    at_start: tuple[str, ...] | None = None  # further inputs on which its first value depends; None: all

    @property
    def relative(self) -> bool:
        """True for a difference, to which no offset between units applies."""
        return self.quantity == DIFFERENCE

    @property
    def has_start(self) -> bool:
        """True if a host can set the variable and the description gives its start value."""
        return self.causality in ("input", "parameter")

    @property
    def variability(self) -> Variability:
        """FMI's variability; only a Real is continuous."""
        if self.causality == "parameter":
            return "tunable" if self.name == FIDELITY and self.minimum < self.maximum else "fixed"
        return "continuous" if self.kind == "Real" else "discrete"


CLOCK = Variable(
    TIME, "simulation time at the last communication point", "Real", "independent", 0.0, "s", quantity=measured("s")
)


def variables(scene: Scene) -> tuple[Variable, ...]:
    """Return inputs, parameters and outputs of a scene's FMU, and time; index + 1 is the index of the description.

    Outputs that the level of the scene does not compute, and quantities that its geometry does not have, are absent.
    """
    lacks = scene.geometry.lacks
    return (
        *(of_quantity(q, "input", _start(scene, q.name)) for q in INPUTS if q.name not in lacks),
        *(of_number(name, value, field) for name, (value, field) in tunables(scene).items()),
        Variable(
            FIDELITY,
            "fidelity level from the next step on: 1 regression, 2 deterministic, 3 auto, 4 map",
            "Integer",  # as an Enumeration, libcosim and ecos would leave it out, and silently not set it
            "parameter",
            fidelity_of(scene.film.fidelity),
            minimum=1,
            maximum=len(LEVELS),
        ),
        Variable(
            SEED,
            "number of the realisation of both rough surfaces; 0: those of surface_1.seed and surface_2.seed",
            "Integer",
            "parameter",
            0,
            minimum=0,
            maximum=2**31 - 1,
        ),
        Variable(
            INITIAL_STATE,
            "file with a stored contact state (ContactState.to_bytes) to start from; empty: fresh surfaces",
            "String",
            "parameter",
            "",
        ),
        *(
            of_quantity(q, "output", ZERO[q.kind])
            for q in OUTPUTS
            if scene.film.fidelity in q.levels and q.name not in lacks
        ),
        CLOCK,
    )


def first_point(scene: Scene) -> OperatingPoint:
    """Return the operating point of the start values of a scene's FMU."""
    return OperatingPoint(**{v.name: float(v.start) for v in variables(scene) if v.causality == "input"})


def fidelity_of(level: str) -> int:
    """Return the value of the parameter `fidelity` for a level."""
    return LEVELS.index(level) + 1


def _start(scene: Scene, name: str) -> float:
    """Return the start value of an input: the operation's; else the geometry's radius or the oil's temperature."""
    value = getattr(scene.operation, name)
    return float(getattr(scene.geometry, name, scene.operation.temperature) if value is None else value)


def of_quantity(
    q: Quantity,
    causality: Causality,
    start: Value,
    direct: tuple[str, ...] = (),
    at_start: tuple[str, ...] | None = None,
) -> Variable:
    """Return the variable of an input or output."""
    return Variable(
        q.name,
        q.text,
        q.kind,
        causality,
        start,
        unit=q.unit,
        display=q.display,
        nominal=q.nominal if q.kind == "Real" else None,
        minimum=q.minimum,
        maximum=q.maximum,
        quantity=q.quantity,
        levels=q.levels,
        direct=direct,
        at_start=at_start,
    )


def of_number(name: str, value: float | int, field: "Field[Any]") -> Variable:
    """Return the parameter for a number of a scene or component.

    FMI has closed ranges only: a range that excludes its lower bound begins with the next number that hosts can read.
    """
    above, least, most = (field.metadata[key] for key in ("above", "least", "most"))
    low = _next(above) if above is not None else least if least is not None else -math.inf
    kind: Kind = "Integer" if isinstance(value, int) else "Real"
    unit, quantity = field.metadata["unit"], field.metadata["quantity"]
    magnitude = _magnitude(value, most)
    return Variable(
        name,
        field.metadata["text"],
        kind,
        "parameter",
        value,
        unit=unit,
        display=_read_in(unit, quantity, magnitude),
        nominal=magnitude if kind == "Real" else None,
        minimum=low,
        maximum=math.inf if most is None else most,
        quantity=quantity,
    )


def _next(bound: float) -> float:
    """Return the least number above a bound; above 0, the least that every host can read."""
    return sys.float_info.min if bound == 0.0 else math.nextafter(bound, math.inf)


def _magnitude(value: float, most: float | None) -> float:
    """Return the nominal of a parameter: its value; for zero, a thousandth of its maximum."""
    return abs(value) or 1e-3 * (1e3 if most is None else most)


def _read_in(unit: str, quantity: str, magnitude: float) -> str:
    """Return the display unit of a parameter: the largest in which its magnitude is at least one."""
    if unit == "K":
        return "" if quantity == DIFFERENCE else "degC"
    listed = _READ_IN.get(unit, ("",))
    return next((name for name in listed if magnitude >= units.unit(name)[0] * (1.0 - 1e-9)), listed[-1])
