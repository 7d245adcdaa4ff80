"""The linear correction: outputs that an FMU has computed from extrapolated inputs, moved to the inputs as they are.

An FMU that gives the derivatives D of outputs by inputs lets the master solve y = y0 + D (u - u0), u = L y at a
communication point: u0 are the inputs at the end of the step as they were held, y0 the outputs computed from them
(Andersson, C., Methods and Tools for Co-Simulation of Dynamic Systems with the FMI, Lund 2016, linear correction).
"""

import numpy as np
from numpy.typing import NDArray

from .system import System
from .wiring import Wiring


class Correction:
    """The derivatives that a system's FMUs give as outputs, of its coupled variables."""

    def __init__(self, system: System, wiring: Wiring) -> None:
        known = [(of, by, port) for (of, by), port in system.derivatives.items() if by in wiring.input_place]
        self._of = np.array([wiring.output_place[of] for of, _, _ in known], dtype=np.intp)
        self._by = np.array([wiring.input_place[by] for _, by, _ in known], dtype=np.intp)
        self._slope = np.array([wiring.output_place[port.name] for _, _, port in known], dtype=np.intp)
        self._wiring = wiring

    def __bool__(self) -> bool:
        return bool(len(self._of))

    def apply(self, outputs: NDArray[np.float64], held: NDArray[np.float64]) -> None:
        """Correct the outputs, which stand for the inputs `held`."""
        slopes = outputs[self._slope]
        feedthrough = np.zeros((len(outputs), len(held)))
        np.add.at(feedthrough, (self._of, self._by), slopes)
        change = self._wiring.told(outputs) - held
        loop = self._wiring.factor[:, None] * feedthrough[self._wiring.source]
        outputs += feedthrough @ np.linalg.solve(np.eye(len(held)) - loop, change)
