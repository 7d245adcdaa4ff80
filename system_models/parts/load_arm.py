"""A loading arm: a weight that always lies on the contact, and a load that follows a setpoint."""

from dataclasses import dataclass
from typing import ClassVar

from contact_core.quantities import parameter

from . import linear
from .part import Input, Output, Part, State, Values


@dataclass(frozen=True)
class LoadArm(Part):
    """W = W_0 + L, L'' + 2 D f L' + f^2 L = f^2 L_setpoint; the arm lifts off rather than pull."""

    name: ClassVar[str] = "LoadArm"
    text: ClassVar[str] = "Loading arm: dead weight, and a load that follows its setpoint"

    natural_frequency: float = parameter(
        "rad/s", "f, natural frequency", least=1e-3, most=1e5, default=20.0, quantity="AngularFrequency"
    )
    damping_ratio: float = parameter(
        "", "D, damping ratio; 1: as fast as it can be without swinging", least=0.0, most=100.0, default=1.0
    )
    dead_weight: float = parameter("N", "W_0, load without any setting", least=0.0, most=1e5, default=0.0)

    @property
    def inputs(self) -> tuple[Input, ...]:
        return (
            Input(
                "load_setpoint",
                "L_s",
                "N",
                "load to reach, beside the dead weight",
                nominal=50.0,
                minimum=0.0,
                maximum=1e5,
            ),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        return (Output("load", "W", "N", "load on the contact", nominal=50.0, minimum=0.0),)

    @property
    def at_start(self) -> tuple[str, ...]:
        return ("load_setpoint",)

    def initial(self, inputs: Values) -> State:
        """Return L and L'/f [N], settled."""
        return (inputs["load_setpoint"], 0.0)

    def advance(self, state: State, inputs: Values, step: float) -> State:
        f, damping = self.natural_frequency, 2.0 * self.damping_ratio * self.natural_frequency
        return linear.advance(((0.0, f), (-f, -damping)), ((0.0,), (f,)), state, (inputs["load_setpoint"],), step)

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        return {"load": max(self.dead_weight + state[0], 0.0)}
