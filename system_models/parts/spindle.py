"""A spindle of a rig: a body on a servo motor, which holds its surface speed."""

from dataclasses import dataclass
from typing import ClassVar

from contact_core.quantities import parameter

from . import linear
from .part import Input, Output, Part, State, Values


@dataclass(frozen=True)
class Spindle(Part):
    """Body 1 of a contact: J omega' = T + R (F - F_r), T = J b (y - 2 omega + omega_s), y' = b (omega_s - omega).

    The servo's gains make both poles -b: the speed follows its setpoint as omega' = b (omega_s - omega) would, and
    a force moves it by R F / (J b) exp(-1) at most, after the time 1/b, and not for long.
    """

    name: ClassVar[str] = "Spindle"
    text: ClassVar[str] = "Ball or disc of a rig on a servo motor that holds its surface speed"
    sign: ClassVar[float] = 1.0  # of the friction force on this body, over that on body 1

    radius: float = parameter("m", "R, from the axis to the contact", least=1e-5, most=10.0)
    inertia: float = parameter("kg m2", "J, moment of inertia of motor, shaft and body", least=1e-9, most=1e6)
    bandwidth: float = parameter(
        "rad/s", "b, bandwidth of the servo", least=1e-3, most=1e5, quantity="AngularFrequency"
    )

    @property
    def inputs(self) -> tuple[Input, ...]:
        return (
            Input("surface_speed_setpoint", "u_s", "m/s", "surface speed to hold", minimum=-100.0, maximum=100.0),
            Input("friction_force", "F", "N", "friction force on body 1 of the contact"),
            Input("rolling_resistance", "F_r", "N", "resistance to rolling, against the surface speed", nominal=0.1),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        by = ("surface_speed_setpoint",)
        return (
            Output("surface_speed", "u", "m/s", "surface speed of the body at the contact"),
            Output("torque", "T", "N m", "torque of the motor", nominal=0.1, direct=by),
            Output("power", "P", "W", "power that the motor gives", direct=by),
        )

    @property
    def at_start(self) -> tuple[str, ...]:
        return ("surface_speed_setpoint", "friction_force", "rolling_resistance")

    def initial(self, inputs: Values) -> State:
        """Return speed w and memory y of the servo [rad/s]: settled."""
        setpoint = inputs["surface_speed_setpoint"] / self.radius
        return (setpoint, setpoint - self._acceleration(inputs) / self.bandwidth)

    def advance(self, state: State, inputs: Values, step: float) -> State:
        b = self.bandwidth
        setpoint = inputs["surface_speed_setpoint"] / self.radius
        matrix, entry = ((-2.0 * b, b), (-b, 0.0)), ((b, 1.0), (b, 0.0))
        return linear.advance(matrix, entry, state, (setpoint, self._acceleration(inputs)), step)

    def _acceleration(self, inputs: Values) -> float:
        """Return the acceleration of the body by the contact [rad/s2]."""
        friction = self.sign * inputs["friction_force"]
        return self.radius * (friction - inputs["rolling_resistance"]) / self.inertia

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        speed, memory = state
        setpoint = inputs["surface_speed_setpoint"] / self.radius
        torque = self.inertia * self.bandwidth * (memory - 2.0 * speed + setpoint)
        return {"surface_speed": speed * self.radius, "torque": torque, "power": torque * speed}


@dataclass(frozen=True)
class OppositeSpindle(Spindle):
    """Body 2 of a contact, on which the opposite friction force acts: J w' = T - R (F + F_r), the rest alike."""

    sign: ClassVar[float] = -1.0
