"""Rows of a simulation at its communication points, and the Dataset made of them."""

from array import array
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..store.results import to_dataset
from .coupled import Coupled, Outcome
from .system import Port

Row = tuple[float, list[Any], tuple[float, ...]]

STATISTICS = {
    "master.step_size": ("s", "communication step that ends here"),
    "master.iterations": ("1", "passes through the FMUs of a loop in this step, at most"),
    "master.residual": ("1", "of the iteration over its tolerance: up to 1 it has converged"),
    "master.error": ("1", "estimated error of this step over the allowed error; 0 without error control"),
}


class Recorder:
    """Collects the recorded variables and how each step went."""

    def __init__(self, coupled: Coupled, ports: Sequence[Port]) -> None:
        self._coupled, self._ports = coupled, ports
        self._places = [coupled.wiring.output_place[p.name] if p.kind == "real" else None for p in ports]
        bonds = {
            f"bond.{bond.name}": ("W", "power out of one FMU less power into the other")
            for bond in coupled.system.bonds
        }
        self._extras = STATISTICS | bonds
        self._times = array("d")
        # of integers numpy finds the type, but for those that may be above all of Int64
        types = ("d" if p.kind == "real" else "Q" if p.variable.type == "UInt64" else None for p in ports)
        self._columns: list[Any] = [array(each) if each else [] for each in types]
        self._statistics = [array("d") for _ in self._extras]

    def row(self, size: float, outcome: Outcome, error: float = 0.0) -> Row:
        outputs = self._coupled.outputs
        values = [
            outputs[place] if place is not None else self._coupled.get(port)
            for place, port in zip(self._places, self._ports, strict=True)
        ]
        statistics = (size, outcome.iterations, outcome.residual, error, *self._coupled.power_residuals())
        return self._coupled.time, values, statistics

    def start(self) -> Row:
        return self.row(0.0, Outcome(0, 0.0))

    def add(self, row: Row) -> None:
        time, values, statistics = row
        self._times.append(time)
        for column, value in zip(self._columns, values, strict=True):
            column.append(value)
        for column, value in zip(self._statistics, statistics, strict=True):
            column.append(value)

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self._times)

    def table(self, first: int) -> NDArray[np.void]:
        """Return the rows from `first` on as records, exactly."""
        columns = {"time": self._times, **self._named()}
        arrays = {name: np.asarray(column[first:]) for name, column in columns.items()}
        table = np.empty(self.count - first, np.dtype([(name, values.dtype) for name, values in arrays.items()]))
        for name, values in arrays.items():
            table[name] = values
        return table

    def restore(self, table: NDArray[np.void]) -> None:
        """Begin with rows that `table` gave."""
        self._times = array("d", table["time"])
        for name, column in self._named().items():
            column.extend(table[name].tolist())

    def dataset(self, attributes: Mapping[str, Any]) -> xr.Dataset:
        """Return all rows, along `time`."""
        units = {port.name: port.variable.unit or "1" for port in self._ports}
        texts = {port.name: port.variable.description or port.name for port in self._ports}
        units |= {name: unit for name, (unit, _) in self._extras.items()}
        texts |= {name: text for name, (_, text) in self._extras.items()}
        return to_dataset(self._times, self._named(), units, texts).assign_attrs(attributes)

    def _named(self) -> dict[str, Any]:
        names = [*(port.name for port in self._ports), *self._extras]
        return dict(zip(names, [*self._columns, *self._statistics], strict=True))
