"""A motor that holds a speed: a PI controller with a ramp and a torque limit."""

import math
from dataclasses import dataclass
from typing import ClassVar

from contact_core.quantities import parameter

from .part import Input, Output, Part, State, Values


@dataclass(frozen=True)
class Drive(Part):
    """T = K (r - w) + I within the limit, I' = K (r - w) / T_i within the limit, r' at most the ramp.

    r is the reference, which follows the setpoint. The integral part I stops at the torque limit, so that it does not
    wind up while the motor cannot follow.
    """

    name: ClassVar[str] = "Drive"
    text: ClassVar[str] = "Speed-controlled motor: proportional-integral, with a ramp and a torque limit"

    proportional_gain: float = parameter("N m s/rad", "K, torque by speed error", least=1e-9, most=1e6)
    integral_time: float = parameter(
        "s", "T_i, time in which the integral part doubles the answer", least=1e-4, most=1e6
    )
    torque_limit: float = parameter("N m", "largest torque, either way", above=0.0, most=1e7)
    ramp: float = parameter("rad/s2", "largest change of the reference with time", above=0.0, most=1e7)

    @property
    def inputs(self) -> tuple[Input, ...]:
        """What the speed should be and what it is."""
        return (
            Input("speed_setpoint", "w_s", "rad/s", "speed to reach and hold", nominal=100.0, display="rpm"),
            Input("speed", "w", "rad/s", "measured speed", nominal=100.0, display="rpm"),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        """Torque, its derivative, and power."""
        by = ("speed",)
        return (
            Output("torque", "T", "N m", "torque of the motor", nominal=10.0, direct=by),
            Output("power", "P", "W", "torque times speed: power given to the shaft", nominal=1e3, direct=by),
            Output(
                "dtorque_dspeed",
                "dT/dw",
                "N m s/rad",
                "derivative of torque by speed, at a held integral part",
                direct=by,
            ),
        )

    @property
    def at_start(self) -> tuple[str, ...]:
        """What decides the first state."""
        return ("speed",)

    def initial(self, inputs: Values) -> State:
        """Reference [rad/s], at first the speed there is, and integral part [N m]."""
        return (inputs["speed"], 0.0)

    def advance(self, state: State, inputs: Values, step: float) -> State:
        """Exact: the reference is on a ramp and then at the setpoint."""
        reference, integral = state
        setpoint, speed = inputs["speed_setpoint"], inputs["speed"]
        change = setpoint - reference
        ramp_time = abs(change) / self.ramp
        reached = setpoint if ramp_time <= step else reference + math.copysign(self.ramp * step, change)
        integral = self._integrated(integral, reference - speed, reached - speed, min(ramp_time, step))
        integral = self._integrated(integral, reached - speed, reached - speed, max(step - ramp_time, 0.0))
        return (reached, integral)

    def _integrated(self, integral: float, first: float, last: float, time: float) -> float:
        """The integral part after a time in which the speed error goes from `first` to `last` on a line."""
        if first * last < 0.0:  # the integral part turns on the way, and can meet the limit before and after
            turn = time * first / (first - last)
            return self._integrated(self._integrated(integral, first, 0.0, turn), 0.0, last, time - turn)
        gained = self.proportional_gain / self.integral_time * 0.5 * (first + last) * time
        return self._limited(integral + gained)

    def _limited(self, torque: float) -> float:
        return min(max(torque, -self.torque_limit), self.torque_limit)

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        """Torque at the speed there is, its power and its derivative."""
        reference, integral = state
        wanted = self.proportional_gain * (reference - inputs["speed"]) + integral
        torque = self._limited(wanted)
        return {
            "torque": torque,
            "power": torque * inputs["speed"],
            "dtorque_dspeed": -self.proportional_gain if torque == wanted else 0.0,
        }
