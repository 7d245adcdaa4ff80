"""A brake that loads a shaft."""

import math
from dataclasses import dataclass
from typing import ClassVar

from contact_core.quantities import parameter

from .part import Input, Output, Part, State, Values


@dataclass(frozen=True)
class Brake(Part):
    """T = M tanh(omega / omega_0), T_r M' = M_setpoint - M: against the motion, and continuous through standstill."""

    name: ClassVar[str] = "Brake"
    text: ClassVar[str] = "Brake whose torque follows a setpoint and opposes the motion"

    rise_time: float = parameter("s", "T_r, time constant of the torque", least=1e-4, most=1e6, default=0.1)
    standstill_speed: float = parameter(
        "rad/s", "w_0, speed below which the torque fades", least=1e-6, most=1e3, default=0.1
    )

    @property
    def inputs(self) -> tuple[Input, ...]:
        return (
            Input("torque_setpoint", "M_s", "N m", "braking torque to reach", nominal=10.0, minimum=0.0),
            Input("speed", "w", "rad/s", "angular speed of the shaft", nominal=100.0, display="rpm"),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        by = ("speed",)
        return (
            Output(
                "torque", "T", "N m", "braking torque: resists where the speed is positive", nominal=10.0, direct=by
            ),
            Output(
                "power", "P", "W", "torque times speed: power taken from the shaft", nominal=1e3, minimum=0.0, direct=by
            ),
            Output("dtorque_dspeed", "dT/dw", "N m s/rad", "derivative of torque by speed", direct=by),
        )

    @property
    def at_start(self) -> tuple[str, ...]:
        return ("torque_setpoint",)

    def initial(self, inputs: Values) -> State:
        """Return the strength M [N m] as it is set at the start."""
        return (inputs["torque_setpoint"],)

    def advance(self, state: State, inputs: Values, step: float) -> State:
        (strength,) = state
        return (strength - (inputs["torque_setpoint"] - strength) * math.expm1(-step / self.rise_time),)

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        (strength,) = state
        share = math.tanh(inputs["speed"] / self.standstill_speed)
        return {
            "torque": strength * share,
            "power": strength * share * inputs["speed"],
            "dtorque_dspeed": strength * (1.0 - share**2) / self.standstill_speed,
        }
