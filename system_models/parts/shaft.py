"""A rigid shaft: inertia, a torque that drives and one that resists."""

import math
from dataclasses import dataclass
from typing import ClassVar

from contact_core.quantities import parameter

from . import linear
from .part import Input, Output, Part, State, Values


@dataclass(frozen=True)
class Shaft(Part):
    """J omega' = T_drive + k (omega_drive - omega) - T_resisting - c omega.

    A drive gives a torque, or a speed to the other end of a slipping coupling k; with a speed, any step is stable. At
    omega = 0 the resisting torque only holds: the shaft stands until the drive is stronger, so resistance cannot turn
    it round, however long the step.
    """

    name: ClassVar[str] = "Shaft"
    text: ClassVar[str] = "Rigid shaft with inertia and viscous damping; sticks where the resisting torque holds it"

    inertia: float = parameter("kg m2", "J, moment of inertia of all that turns with it", least=1e-9, most=1e6)
    damping: float = parameter("N m s/rad", "c, viscous damping", least=0.0, most=1e6, default=0.0)
    coupling: float = parameter("N m s/rad", "k, torque of the coupling by its slip", least=0.0, most=1e9, default=0.0)
    initial_speed: float = parameter("rad/s", "w at the start", least=-1e5, most=1e5, default=0.0)

    @property
    def inputs(self) -> tuple[Input, ...]:
        return (
            Input("torque_drive", "T_d", "N m", "torque that drives: accelerates a positive speed", nominal=10.0),
            Input("speed_drive", "w_d", "rad/s", "speed of the coupling's other end", nominal=100.0, display="rpm"),
            Input("torque_resisting", "T_r", "N m", "torque that resists: brakes a positive speed", nominal=10.0),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        return (
            Output("speed", "w", "rad/s", "angular speed", nominal=100.0, display="rpm"),
            Output("revolutions", "N", "1", "revolutions since the start, backward ones negative", nominal=1e3),
            Output(
                "torque_coupling",
                "T_k",
                "N m",
                "torque that comes through the coupling",
                nominal=10.0,
                direct=("speed_drive",),
            ),
        )

    def initial(self, inputs: Values) -> State:
        """Return speed [rad/s] and angle [rad]."""
        return (self.initial_speed, 0.0)

    def advance(self, state: State, inputs: Values, step: float) -> State:
        """Return the exact state after the step, with the moment of standstill where there is one."""
        speed, _ = state
        drive = inputs["torque_drive"] + self.coupling * inputs["speed_drive"]  # at standstill
        resisting = inputs["torque_resisting"]
        until_standstill = self._until_standstill(speed, drive - resisting)
        if until_standstill >= step:
            return self._free(state, drive - resisting, step)
        _, angle = self._free(state, drive - resisting, until_standstill) if until_standstill else state
        if abs(drive) <= abs(resisting):
            return (0.0, angle)
        return self._free((0.0, angle), drive - resisting, step - until_standstill)

    def _until_standstill(self, speed: float, torque: float) -> float:
        """Return time [s] after which the shaft stands under a net torque at standstill [N m]; inf if it does not."""
        if speed == 0.0:
            return 0.0
        if speed * torque >= 0.0:
            return math.inf
        slowing = -self.inertia * speed / torque  # without damping
        rate = (self.damping + self.coupling) * slowing / self.inertia
        if rate == math.inf:  # a torque that hardly differs from 0
            return math.inf
        return slowing * (math.log1p(rate) / rate if rate > 0.0 else 1.0)

    def _free(self, state: State, torque: float, step: float) -> State:
        matrix = ((-(self.damping + self.coupling) / self.inertia, 0.0), (1.0, 0.0))
        return linear.advance(matrix, ((1.0 / self.inertia,), (0.0,)), state, (torque,), step)

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        speed, angle = state
        torque = self.coupling * (inputs["speed_drive"] - speed)
        return {"speed": speed, "revolutions": angle / (2.0 * math.pi), "torque_coupling": torque}
