"""A model's variables as a table, and modelDescription.xml for FMI 2.0 and 3.0 from it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import accumulate
from math import prod
from typing import Any
from xml.etree import ElementTree as ET

# base units: exponents, factor, offset
UNITS: dict[str, dict[str, float]] = {
    "1": {},
    "m": {"m": 1},
    "mm": {"m": 1, "factor": 1e-3},
    "s": {"s": 1},
    "kg": {"kg": 1},
    "K": {"K": 1},
    "degC": {"K": 1, "offset": 273.15},
    "m/s": {"m": 1, "s": -1},
    "m/s2": {"m": 1, "s": -2},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
    "N.s2/m2": {"kg": 1, "m": -1},
    "rad/s": {"s": -1, "rad": 1},
    "1/s": {"s": -1},
}
FMI3_TYPES = {"Real": "Float64", "Integer": "Int32", "Boolean": "Boolean", "String": "String"}


@dataclass(frozen=True)
class Variable:
    """One variable; `needs` are the inputs and parameters an output depends on, at one instant."""

    name: str
    causality: str
    unit: str | None = None
    start: Any = None
    nominal: float | None = None
    minimum: float | None = None
    maximum: float | None = None
    kind: str = "Real"
    needs: tuple[str, ...] = ()
    text: str = ""
    shape: tuple[int, ...] = ()  # of an array, in FMI 3

    @property
    def size(self) -> int:
        return prod(self.shape)

    @property
    def starts(self) -> list[Any]:
        """Start values of all elements."""
        return list(self.start) if isinstance(self.start, tuple) else [self.start] * self.size

    @property
    def variability(self) -> str:
        if self.causality == "parameter":
            return "fixed"
        return "continuous" if self.kind == "Real" else "discrete"


def parameter(name: str, unit: str | None, start: Any, **more: Any) -> Variable:
    if isinstance(start, float) and start != 0.0:
        more.setdefault("nominal", abs(start))
    return Variable(name, "parameter", unit, start, **more)


def inlet(name: str, unit: str | None, nominal: float | None = None, start: Any = 0.0, **more: Any) -> Variable:
    return Variable(name, "input", unit, start, nominal, **more)


def output(
    name: str, unit: str | None, nominal: float | None = None, needs: tuple[str, ...] = (), **more: Any
) -> Variable:
    return Variable(name, "output", unit, None, nominal, needs=needs, **more)


@dataclass(frozen=True)
class Model:
    """A C source with its table, and what it can do beyond the minimum.

    `memory` counts the doubles it remembers; `header` is C text for variables.h; `slopes`: outputs have a first
    derivative; `partials`: outputs have derivatives to inputs; `events`: has the event mode of FMI 3; `early`: may end
    a step early.
    """

    source: str
    variables: tuple[Variable, ...]
    memory: int = 0
    header: str = ""
    slopes: bool = False
    partials: bool = False
    events: bool = False
    early: bool = False
    text: str = ""

    def __post_init__(self) -> None:
        order = {"parameter": 0, "input": 1, "output": 2}
        ranked = sorted(self.variables, key=lambda v: (v.kind == "String", order[v.causality]))
        object.__setattr__(self, "variables", tuple(ranked))

    @property
    def references(self) -> list[int]:
        """Value references: the elements of an array count as numbers of their own."""
        return list(accumulate((v.size for v in self.variables), initial=0))

    def starting(self, start: dict[str, Any]) -> Model:
        """The same model with other start values."""
        unknown = set(start) - {v.name for v in self.variables if v.causality != "output"}
        if unknown:
            raise ValueError(f"no parameter or input of the model is called {sorted(unknown)}")
        return replace(self, variables=tuple(replace(v, start=start.get(v.name, v.start)) for v in self.variables))


@dataclass(frozen=True)
class Variant:
    """The switches that any model has."""

    fmi: int = 2
    rollback: bool = True
    interpolates: bool = True
    dependencies: bool = True
    intermediate: bool = False
    start: dict[str, Any] = field(default_factory=dict)


def describe(name: str, token: str, model: Model, variant: Variant) -> bytes:
    """modelDescription.xml."""
    root = (_fmi2 if variant.fmi == 2 else _fmi3)(name, token, model, variant)
    ET.indent(root)
    return ET.tostring(root, encoding="utf-8", xml_declaration=True)


def _text(value: Any) -> str:
    if isinstance(value, tuple):
        return " ".join(map(_text, value))
    return str(value).lower() if isinstance(value, bool) else str(value)


def _element(parent: ET.Element, tag: str, **attributes: Any) -> ET.Element:
    return ET.SubElement(parent, tag, {key: _text(value) for key, value in attributes.items() if value is not None})


def _units(root: ET.Element, model: Model) -> None:
    used = {v.unit for v in model.variables if v.unit is not None}
    if not used:
        return
    definitions = _element(root, "UnitDefinitions")
    for unit in sorted(used):
        _element(_element(definitions, "Unit", name=unit), "BaseUnit", **UNITS[unit])


def _quantity(v: Variable) -> dict[str, Any]:
    """Attributes of a variable's type, the start value apart."""
    if v.kind != "Real":
        return {}
    return {"unit": v.unit, "nominal": v.nominal, "min": v.minimum, "max": v.maximum}


def _fmi2(name: str, token: str, model: Model, variant: Variant) -> ET.Element:
    root = ET.Element("fmiModelDescription", fmiVersion="2.0", modelName=name, guid=token, description=model.text)
    _element(
        root,
        "CoSimulation",
        modelIdentifier=name,
        canHandleVariableCommunicationStepSize=True,
        canInterpolateInputs=variant.interpolates,
        maxOutputDerivativeOrder=int(model.slopes),
        canGetAndSetFMUstate=variant.rollback,
        canSerializeFMUstate=variant.rollback,
        providesDirectionalDerivative=model.partials,
    )
    _units(root, model)
    variables = _element(root, "ModelVariables")
    for reference, v in enumerate(model.variables):
        scalar = _element(
            variables,
            "ScalarVariable",
            name=v.name,
            valueReference=reference,
            description=v.text or None,
            causality=v.causality,
            variability=v.variability,
            initial={"parameter": "exact", "input": None, "output": "calculated"}[v.causality],
        )
        _element(scalar, v.kind, start=v.start, **_quantity(v))
    structure = _element(root, "ModelStructure")
    unknowns = [i for i, v in enumerate(model.variables) if v.causality == "output"]
    for group in ("Outputs", "InitialUnknowns") if unknowns else ():
        parent = _element(structure, group)
        for i in unknowns:
            known = _dependencies(model, i, group == "InitialUnknowns")
            listed = " ".join(str(k + 1) for k in known) if variant.dependencies else None
            _element(parent, "Unknown", index=i + 1, dependencies=listed)
    return root


def _fmi3(name: str, token: str, model: Model, variant: Variant) -> ET.Element:
    root = ET.Element(
        "fmiModelDescription", fmiVersion="3.0", modelName=name, instantiationToken=token, description=model.text
    )
    _element(
        root,
        "CoSimulation",
        modelIdentifier=name,
        canGetAndSetFMUState=variant.rollback,
        canSerializeFMUState=variant.rollback,
        providesDirectionalDerivatives=model.partials,
        canHandleVariableCommunicationStepSize=True,
        maxOutputDerivativeOrder=int(model.slopes),
        mightReturnEarlyFromDoStep=model.early,
        hasEventMode=model.events,
        providesIntermediateUpdate=variant.intermediate,
    )
    _units(root, model)
    variables = _element(root, "ModelVariables")
    references = model.references
    for reference, v in zip(references, model.variables, strict=False):
        typed = _element(
            variables,
            FMI3_TYPES[v.kind],
            name=v.name,
            valueReference=reference,
            description=v.text or None,
            causality=v.causality,
            variability=v.variability,
            initial={"parameter": "exact", "input": None, "output": "calculated"}[v.causality],
            start=None if v.kind == "String" else v.start,
            intermediateUpdate=True if variant.intermediate and v.causality == "input" and v.kind == "Real" else None,
            **_quantity(v),
        )
        if v.kind == "String" and v.start is not None:
            _element(typed, "Start", value=v.start)
        for length in v.shape:
            _element(typed, "Dimension", start=length)
    _element(
        variables,
        "Float64",
        name="time",
        valueReference=references[-1],
        causality="independent",
        variability="continuous",
    )
    structure = _element(root, "ModelStructure")
    for group in ("Output", "InitialUnknown"):
        for i, v in enumerate(model.variables):
            if v.causality == "output":
                known = _dependencies(model, i, group == "InitialUnknown")
                listed = " ".join(str(references[k]) for k in known) if variant.dependencies else None
                _element(structure, group, valueReference=references[i], dependencies=listed)
    return root


def _dependencies(model: Model, unknown: int, initial: bool) -> list[int]:
    """Positions of what an output depends on: inputs, and while the model initialises also parameters."""
    needs = model.variables[unknown].needs
    wanted = ("input", "parameter") if initial else ("input",)
    return [i for i, v in enumerate(model.variables) if v.name in needs and v.causality in wanted]
