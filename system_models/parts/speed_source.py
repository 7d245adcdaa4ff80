"""A motor that is stronger than all it drives."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

from contact_core.quantities import parameter

from .part import Input, Output, Part, State, Values


@dataclass(frozen=True)
class SpeedSource(Part):
    """|w'| <= ramp on the way to the setpoint, whatever the torque."""

    name: ClassVar[str] = "SpeedSource"
    text: ClassVar[str] = "Motor that goes to a speed on a ramp and holds it, whatever the torque"

    ramp: float = parameter("rad/s2", "change of the speed with time", above=0.0, most=1e7)

    @property
    def inputs(self) -> tuple[Input, ...]:
        return (
            Input("speed_setpoint", "w_s", "rad/s", "speed to reach and hold", nominal=100.0, display="rpm"),
            Input("torque", "T", "N m", "torque that is taken from the motor", nominal=10.0),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        return (
            Output("speed", "w", "rad/s", "speed of the motor", nominal=100.0, display="rpm"),
            Output(
                "power", "P", "W", "torque times speed: power that the motor gives", nominal=1e3, direct=("torque",)
            ),
        )

    def with_arrivals(self, course: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
        """Return times [s] and setpoints [rad/s], each again when the speed arrives there, where the torque jumps."""
        steps = [*course]
        found, speed = [], steps[0][1]
        for (time, setpoint), (end, _) in pairwise([*steps, (math.inf, 0.0)]):
            change = setpoint - speed
            arrival = time + abs(change) / self.ramp
            found.append((time, setpoint))
            if time < arrival < end:
                found.append((arrival, setpoint))
            speed = setpoint if arrival <= end else speed + math.copysign(self.ramp * (end - time), change)
        return found

    @property
    def at_start(self) -> tuple[str, ...]:
        return ("speed_setpoint",)

    def initial(self, inputs: Values) -> State:
        """Return speed [rad/s]: at the setpoint."""
        return (inputs["speed_setpoint"],)

    def advance(self, state: State, inputs: Values, step: float) -> State:
        (speed,) = state
        change = inputs["speed_setpoint"] - speed
        if abs(change) <= self.ramp * step:
            return (inputs["speed_setpoint"],)
        return (speed + math.copysign(self.ramp * step, change),)

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        (speed,) = state
        return {"speed": speed, "power": inputs["torque"] * speed}
