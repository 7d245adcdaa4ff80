"""An FMU as its modelDescription.xml has it, before anything runs."""

from collections.abc import Callable
from copy import copy
from functools import cached_property
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

import fmpy
import numpy as np
from fmpy.model_description import ModelDescription, ModelVariable, ValidationError
from lxml import etree

from . import attributes
from .archive import DESCRIPTION, opened
from .errors import CouplingError, FmuError
from .kinds import kind
from .printable import printable

MOST_ELEMENTS = 2**16  # of an array that is exchanged

_TRUE = ("true", "1")
# how a start value is read, by kind
_READ: dict[str, Callable[[str], Any]] = {"real": float, "integer": int, "boolean": _TRUE.__contains__}


class Element(NamedTuple):
    """Where an element of an array stands, counted row by row."""

    array: ModelVariable
    place: int


class Model:
    """An FMU for co-simulation, FMI 2.0 or 3.0.

    variables: by name, of an array its elements y[1,1], y[1,2], ...; one of more than MOST_ELEMENTS stands for itself.
    arrays: the names of the elements by that of the array. elements: where each stands.
    """

    def __init__(self, name: str, path: str | Path) -> None:
        self.name, self.path = name, Path(path)
        if not self.path.exists():
            raise CouplingError(f"The FMU '{path}' of '{name}' does not exist. Name an .fmu file.")
        try:
            with opened(self.path) as archive:
                root = archive.document(DESCRIPTION)
        except FmuError as error:
            raise FmuError(f"The FMU '{name}' cannot be read: {error}") from None
        self.description = _description(name, self.path, root)
        self.variables: dict[str, ModelVariable] = {v.name: v for v in self.description.modelVariables}
        self._complete(root)
        self.arrays: dict[str, list[str]] = {}
        self.elements: dict[str, Element] = {}
        for array in [v for v in self.variables.values() if v.dimensions and prod(v.shape) <= MOST_ELEMENTS]:
            self._take_apart(array)

    @property
    def fmi3(self) -> bool:
        """True for FMI 3.0, False for FMI 2.0."""
        return bool(self.description.fmiVersion.startswith("3"))

    @property
    def capabilities(self) -> Any:
        """Its flags for co-simulation."""
        return self.description.coSimulation

    @property
    def restores(self) -> bool:
        """True if it can go back to a saved state."""
        return bool(self.capabilities.canGetAndSetFMUstate)

    @property
    def serialises(self) -> bool:
        """True if a saved state can outlive the process."""
        return self.restores and bool(self.capabilities.canSerializeFMUstate)

    @property
    def verdict(self) -> ModelVariable | None:
        """The output by which an FMU of tribofmu says whether it could use its inputs."""
        variable = self.variables.get("valid")
        ours = str(self.description.generationTool or "").startswith("tribofmu")
        return variable if ours and variable and variable.causality == "output" else None

    @cached_property
    def dependencies(self) -> dict[str, frozenset[str]]:
        """The inputs that each output depends on directly; where it does not say, all of them."""
        inputs = frozenset(v.name for v in self.variables.values() if v.causality == "input")
        return self._declared(self.description.outputs, inputs)

    @property
    def declared_dependencies(self) -> dict[str, frozenset[str]]:
        """The same of those outputs that do say."""
        unknowns = [unknown for unknown in self.description.outputs if unknown.dependencies is None]
        silent = {name for unknown in unknowns for name in self._names(unknown.variable)}
        return {name: inputs for name, inputs in self.dependencies.items() if name not in silent}

    @cached_property
    def initial_dependencies(self) -> dict[str, frozenset[str]]:
        """The inputs that each output depends on while it is initialised; where it does not say, all of them."""
        inputs = frozenset(v.name for v in self.variables.values() if v.causality == "input")
        return self.dependencies | self._declared(self.description.initialUnknowns, inputs)

    def _complete(self, root: etree._Element) -> None:
        """Add attributes to the variables that fmpy leaves out, and those of their declared types."""
        for element in root.iterfind("ModelVariables/*"):
            typed = element if self.fmi3 else element.find("Real")
            if typed is None or element.get("name") not in self.variables:
                continue
            variable = self.variables[element.get("name", "")]
            variable.intermediateUpdate = typed.get("intermediateUpdate") in _TRUE
            if "relativeQuantity" in typed.attrib:
                variable.relativeQuantity = typed.get("relativeQuantity") in _TRUE
        for variable in self.variables.values():
            for name in ("unit", "nominal", "relativeQuantity"):
                if getattr(variable, name) is None and variable.declaredType is not None:
                    setattr(variable, name, getattr(variable.declaredType, name))

    def _take_apart(self, array: ModelVariable) -> None:
        """Put the elements of an array in its place."""
        del self.variables[array.name]
        names = [f"{array.name}[{','.join(str(i + 1) for i in index)}]" for index in np.ndindex(*array.shape)]
        for place, name in enumerate(names):
            if name in self.variables:
                raise CouplingError(
                    f"The FMU '{self.name}' has an array '{array.name}' and another variable '{name}', the name of "
                    "one of its elements. Export it with other names."
                )
            element = copy(array)
            element.name, element.dimensions, element.shape = name, [], ()
            self.variables[name], self.elements[name] = element, Element(array, place)
        self.arrays[array.name] = names

    def starts(self, array: ModelVariable) -> list[Any]:
        """Return the start values of all elements of an array. Raises CouplingError if its description lacks them."""
        count, read = len(self.arrays[array.name]), _READ.get(kind(array))
        found = [read(word) for word in (array.start or "").split()] if read else []
        if len(found) not in (1, count):
            raise CouplingError(
                f"An element of '{self.name}.{array.name}' cannot be set before the initialisation, because the start "
                f"values of the other {count - 1} are not known: start = {array.start!r}. Leave it out, or export the "
                "FMU with a start value of every element."
            )
        return found if len(found) == count else found * count

    def _declared(self, unknowns: list[Any], inputs: frozenset[str]) -> dict[str, frozenset[str]]:
        return {
            name: inputs
            if unknown.dependencies is None
            else inputs & {own for known in unknown.dependencies for own in self._names(known)}
            for unknown in unknowns
            for name in self._names(unknown.variable)
        }

    def _names(self, variable: ModelVariable) -> list[str]:
        """Return the name of a variable, or of an array those of its elements."""
        return self.arrays.get(variable.name, [variable.name])


def _description(name: str, path: Path, root: etree._Element) -> ModelDescription:
    version = root.get("fmiVersion", "")
    if version != "2.0" and not version.startswith("3."):
        raise CouplingError(
            f"The FMU '{path}' of '{name}' is of FMI {printable(version) or '(no version)'}, which is not "
            "supported; FMI 2.0 and 3.0 are. Export it anew."
        )
    try:
        attributes.check(root, version.startswith("3."))
        description = fmpy.read_model_description(str(path), validate=False)
    except Exception as error:
        raise CouplingError(
            f"The FMU '{path}' of '{name}' cannot be read: {_reason(error)} Export it anew; `tribofmu check` says more."
        ) from None
    if description.coSimulation is None:
        raise CouplingError(
            f"The FMU '{path}' of '{name}' is made for model exchange only: it brings no solver of its own. "
            "Export it for co-simulation."
        )
    if {"/", "\\"} & set(library := str(description.coSimulation.modelIdentifier)):
        raise CouplingError(
            f"The FMU '{path}' of '{name}' names '{library}' as its library, a path and no name. Export it anew."
        )
    return description


def _reason(error: Exception) -> str:
    """Return why a description is not read: errors of Python itself name no cause that a user could know."""
    said = type(error) is Exception or isinstance(error, (FmuError, ValidationError))
    return printable(str(error)) if said else "its modelDescription.xml breaks the rules of FMI."
