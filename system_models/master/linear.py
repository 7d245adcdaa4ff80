"""The linear correction: outputs that belong to other inputs than they should are moved by their derivatives.

An FMU without derivatives of its inputs holds their mean over a step, and many, like a contact, answer for what was
held: y belongs to the mean. Where it gives D = dy/du as outputs, y + D (u_end - u_mean) belongs to the end of the step.
There, the inputs u that go with all outputs are others than those that were extrapolated, u0: y = y0 + D (u - u0),
u = L y (Andersson, C., Methods and Tools for Co-Simulation of Dynamic Systems with the FMI, Lund 2016).
"""

import numpy as np

from contact_core.arrays import Array

from ..fmu.errors import CouplingError
from .system import System
from .wiring import Wiring


class Correction:
    """The derivatives that a system's FMUs give as outputs, of its coupled variables."""

    def __init__(self, system: System, wiring: Wiring) -> None:
        known = [(of, by, port) for (of, by), port in system.derivatives.items() if by in wiring.input_place]
        self.owners = {port.model.name for _, _, port in known}
        self._of = np.array([wiring.output_place[of] for of, _, _ in known], dtype=np.intp)
        self._by = np.array([wiring.input_place[by] for _, by, _ in known], dtype=np.intp)
        self._slope = np.array([wiring.output_place[port.name] for _, _, port in known], dtype=np.intp)
        self._wiring = wiring

    def move(self, outputs: Array, change: Array) -> None:
        """Move the outputs by a change [all inputs] of the inputs that they belong to."""
        np.add.at(outputs, self._of, outputs[self._slope] * change[self._by])

    def settle(self, outputs: Array, held: Array) -> None:
        """Correct the outputs, which belong to the inputs `held`, for the present inputs."""
        wiring = self._wiring
        slopes = np.zeros((len(outputs), len(held)))
        np.add.at(slopes, (self._of, self._by), outputs[self._slope])
        loop = wiring.factor[:, None] * slopes[wiring.source]
        try:
            change = np.linalg.solve(np.eye(len(held)) - loop, wiring.inputs_from(outputs) - held)
        except np.linalg.LinAlgError:
            raise CouplingError("The derivatives of the system's outputs close a loop that has no solution.") from None
        self.move(outputs, np.asarray(change, dtype=float))
