"""Variables of a running FMU of FMI 3.0: got and set by type, arrays as a whole."""

from ctypes import c_double, c_float
from math import prod
from typing import Any, NamedTuple

import numpy as np
from fmpy.fmi3 import FMU3Slave, fmi3ValueReference
from fmpy.model_description import ModelVariable
from numpy.typing import NDArray

from .instance import Reals
from .model import Element, Model


class Values:
    """Variables of any type, one at a time."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._starts: dict[str, list[Any]] = {}  # of arrays, with the elements set before the initialisation

    def begin(self, fmu: FMU3Slave) -> None:
        """Take the variables of an instance that has just been made."""
        self._fmu = fmu
        self.given = False  # whether the FMU gives values: not before it is being initialised

    def get(self, variable: ModelVariable) -> Any:
        """Return the value of a variable."""
        whole, place = self._place(variable)
        return self._values(whole)[place]

    def _values(self, variable: ModelVariable) -> list[Any]:
        """Return the value of a variable, or of an array those of all elements."""
        found = getattr(self._fmu, f"get{_access(variable)}")([variable.valueReference], prod(variable.shape))
        return list(found)

    def _place(self, variable: ModelVariable) -> Element:
        """Return the array in which a variable is got and set, or itself, and where it stands there."""
        return self._model.elements.get(variable.name, Element(variable, 0))

    def put(self, variable: ModelVariable, value: Any) -> None:
        """Set a variable; of an array all other elements stay."""
        whole, place = self._place(variable)
        values = self._before(whole) if whole.dimensions else [value]
        values[place] = value
        getattr(self._fmu, f"set{_access(variable)}")([variable.valueReference], values)

    def _before(self, array: ModelVariable) -> list[Any]:
        """Return the values of an array, which is set as a whole."""
        if self.given:
            return self._values(array)
        if array.name not in self._starts:
            self._starts[array.name] = self._model.starts(array)
        return self._starts[array.name]


class Shared:
    """Reals, also elements of arrays and of single precision, in memory that the FMU reads and writes."""

    def __init__(self, reals: Reals, model: Model) -> None:
        self._reals, self._parts = reals, _parts(reals, model)

    def complete(self, fmu: FMU3Slave) -> None:
        """Get the other elements of their arrays, which are set as a whole."""
        for part in self._parts:
            if not part.alone:
                part.call(fmu, "Get")

    def put(self, fmu: FMU3Slave) -> None:
        """Give the FMU their values."""
        for part in self._parts:
            if part.values is not self._reals.values:
                part.values[part.own] = self._reals.values[part.places]
            part.call(fmu, "Set")

    def get(self, fmu: FMU3Slave) -> None:
        """Take their values from the FMU."""
        for part in self._parts:
            part.call(fmu, "Get")
            if part.values is not self._reals.values:
                self._reals.values[part.places] = part.values[part.own]


class _Part(NamedTuple):
    """Variables of one type: where they stand among Reals, and the memory that the FMU reads and writes.

    Of an array it has all elements; own: where in it the variables stand; alone: whether there are no others.
    """

    type: str
    places: NDArray[np.intp] | slice
    own: NDArray[np.intp] | slice
    alone: bool
    references: Any
    values: NDArray[Any]
    buffer: Any

    def call(self, fmu: FMU3Slave, what: str) -> None:
        """Call the function of the FMU that gets or sets them."""
        function = getattr(fmu, f"fmi3{what}{self.type}")
        function(fmu.component, self.references, len(self.references), self.buffer, len(self.values))


def _parts(reals: Reals, model: Model) -> list[_Part]:
    """Return the Reals by type: those of Float64 alone as they are, arrays and any other in memory of its own."""
    types = [model.variables[name].type for name in reals.names]
    if set(types) <= {"Float64"} and not model.elements.keys() & set(reals.names):
        every = slice(None)
        return [_Part("Float64", every, every, True, reals.references, reals.values, reals.buffer)] if types else []
    found = []
    for name, of_c in (("Float64", c_double), ("Float32", c_float)):
        places = np.flatnonzero([own == name for own in types])
        if len(places):
            found.append(_of_type(name, of_c, places, [reals.names[n] for n in places], model))
    return found


def _of_type(name: str, of_c: Any, places: NDArray[np.intp], names: list[str], model: Model) -> _Part:
    """Return the Reals of one type, and with those that are elements of arrays the other elements."""
    at = [model.elements.get(own, Element(model.variables[own], 0)) for own in names]
    first, count = dict[int, int](), 0
    for whole, _ in at:
        if whole.valueReference not in first:
            first[whole.valueReference] = count
            count += prod(whole.shape)
    own = np.array([first[whole.valueReference] + place for whole, place in at])
    values = np.zeros(count, of_c)
    references = (fmi3ValueReference * len(first))(*first)
    return _Part(name, places, own, count == len(names), references, values, (of_c * count).from_buffer(values.data))


def _access(variable: ModelVariable) -> str:
    """Return the type by which a variable is got and set."""
    return "Int64" if variable.type == "Enumeration" else str(variable.type)
