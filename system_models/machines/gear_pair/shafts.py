"""The rotation of both shafts of a gear pair, as a component."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from contact_core.errors import SceneError
from contact_core.kernels.arrays import Array
from contact_core.quantities import parameter

from ...parts.linear import exponential
from ...parts.part import Input, Output, Part, State, Values
from .geometry import SpurGearPair


@dataclass(frozen=True, kw_only=True)
class GearShafts(Part):
    """Two inertias and the teeth between them, a spring and a damper along the line of action.

    J1 omega_1' = T_drive + k (omega_drive - omega_1) + M_f1 - r_b1 F,
    J2 omega_2' = r_b2 F - T_brake + M_f2 - D omega_2,
    F = K delta + C delta',  delta' = r_b1 omega_1 - r_b2 omega_2,  C = 2 zeta sqrt(K m),  1/m = r_b1^2/J1 + r_b2^2/J2.
    Steps are exact under held inputs. Deflected teeth ring for some 1 / (zeta sqrt(K/m)), milliseconds; a much longer
    step ends at the force that moves both shafts alike. The stiffness is the mean of a mesh cycle
    (`sharing.mean_stiffness` times the face width), and the teeth never part: backlash is left out.

    A drive gives a torque, or a speed to the other end of a slipping coupling k. A torque that falls with speed makes
    long steps overshoot if it is held over them; that of the coupling is part of the exact step.
    """

    name: ClassVar[str] = "GearShafts"
    text: ClassVar[str] = "Rotation of the two shafts of a spur gear pair, with elastic teeth between them"

    pair: SpurGearPair
    inertia_1: float = parameter("kg m2", "inertia that turns with the pinion", above=0.0, most=1e6)
    inertia_2: float = parameter("kg m2", "inertia that turns with the wheel", above=0.0, most=1e6)
    stiffness: float = parameter("N/m", "stiffness of the teeth along the line of action", above=0.0, most=1e12)
    damping_ratio: float = parameter(
        "", "damping of the teeth, 1 is critical; assumed", above=0.0, most=10.0, default=0.1
    )
    coupling: float = parameter("N m s/rad", "k, torque of the coupling by its slip", least=0.0, most=1e9, default=0.0)
    drag: float = parameter("N m s/rad", "D, torque on the wheel per speed", least=0.0, most=1e6, default=0.0)
    start_speed: float = parameter(
        "rad/s", "angular speed of the pinion at the start", least=-1e5, most=1e5, default=0.0
    )

    def check(self) -> None:
        wrong = [*self.pair.wrong()]
        if wrong:
            raise SceneError(" ".join(wrong))

    @property
    def inputs(self) -> tuple[Input, ...]:
        turns = "torque of friction and rolling on the {}, the way it turns"
        return (
            Input("drive_torque", "T_drive", "N m", "torque that drives the pinion", nominal=100.0),
            Input("speed_drive", "w_drive", "rad/s", "speed of the coupling's other end", nominal=100.0, display="rpm"),
            Input("brake_torque", "T_brake", "N m", "torque that brakes the wheel", nominal=100.0),
            Input("friction_torque_1", "M_f1", "N m", turns.format("pinion"), nominal=1.0),
            Input("friction_torque_2", "M_f2", "N m", turns.format("wheel"), nominal=1.0),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        return (
            Output("speed_1", "omega_1", "rad/s", "angular speed of the pinion", nominal=100.0),
            Output(
                "speed_2", "omega_2", "rad/s", "angular speed of the wheel, positive as the gears turn", nominal=100.0
            ),
            Output("mesh_torque", "T_1", "N m", "torque of the pinion that the teeth transmit", nominal=100.0),
            Output(
                "transmission_error",
                "delta",
                "m",
                "deflection of the teeth along the line of action",
                nominal=1e-5,
                display="um",
            ),
            Output("torque_coupling", "T_k", "N m", "torque that comes through the coupling", nominal=100.0,
                   direct=("speed_drive",)),
        )  # fmt: skip

    @property
    def at_start(self) -> tuple[str, ...]:
        return ("drive_torque", "speed_drive", "brake_torque")

    def initial(self, inputs: Values) -> State:
        """Return both shafts at the start speed, the teeth deflected as after ringing; without friction."""
        first, second = self.start_speed, self.start_speed / self.pair.ratio
        torque_1 = inputs["drive_torque"] + self.coupling * (inputs["speed_drive"] - first)
        torque_2 = -inputs["brake_torque"] - self.drag * second
        pull, brake = (
            torque_1 * self.pair.base_radius_1 / self.inertia_1,
            torque_2 * self.pair.base_radius_2 / self.inertia_2,
        )
        return first, second, self._mass * (pull - brake) / self.stiffness

    def advance(self, state: State, inputs: Values, step: float) -> State:
        """Return speeds [rad/s] of pinion and wheel, deflection [m]."""
        scale = np.array([self.pair.base_radius_1, self.pair.base_radius_2, self._frequency])
        kept, pushed = _step(self, step)
        after = kept @ (scale * state) + pushed @ self._outer(inputs)
        return tuple((after / scale).tolist())

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        speed_1, speed_2, deflection = state
        closing = self.pair.base_radius_1 * speed_1 - self.pair.base_radius_2 * speed_2
        force = self.stiffness * deflection + self._damping * closing
        return {
            "speed_1": speed_1,
            "speed_2": speed_2,
            "mesh_torque": self.pair.base_radius_1 * force,
            "transmission_error": deflection,
            "torque_coupling": self.coupling * (inputs["speed_drive"] - speed_1),
        }

    def _outer(self, inputs: Values) -> tuple[float, float]:
        """Return torques [N m] on pinion and wheel, positive as they turn, beside those of teeth and of damping."""
        first = inputs["drive_torque"] + self.coupling * inputs["speed_drive"] + inputs["friction_torque_1"]
        return first, inputs["friction_torque_2"] - inputs["brake_torque"]

    @property
    def _mass(self) -> float:
        """Mass of the two shafts against each other, on the line of action [kg]."""
        return 1.0 / (self.pair.base_radius_1**2 / self.inertia_1 + self.pair.base_radius_2**2 / self.inertia_2)

    @property
    def _frequency(self) -> float:
        """Angular frequency of the undamped teeth [rad/s]."""
        return math.sqrt(self.stiffness / self._mass)

    @property
    def _damping(self) -> float:
        return 2.0 * self.damping_ratio * math.sqrt(self.stiffness * self._mass)  # [N s/m]


@lru_cache(maxsize=64)
def _step(shafts: GearShafts, step: float) -> tuple[Array, Array]:
    """Return matrices of a step [s] for r_b1 w1, r_b2 w2 and frequency times deflection [m/s], and outer torques.

    All three are of one size; the block matrix of Van Loan 1978, doi:10.1109/TAC.1978.1101743, gives both.
    """
    found = exponential(_rates(shafts) * step)
    return found[:3, :3], found[:3, 3:]


def _rates(shafts: GearShafts) -> Array:
    """Return the matrix of the rates of change, with the outer torques as its last columns."""
    levers = np.array([shafts.pair.base_radius_1, shafts.pair.base_radius_2])
    inertias, drags = np.array([shafts.inertia_1, shafts.inertia_2]), np.array([shafts.coupling, shafts.drag])
    rates = np.zeros((5, 5))
    rates[:2, :2] = -np.diag(drags / inertias)
    force = np.array([shafts._damping, -shafts._damping, shafts.stiffness / shafts._frequency])
    rates[:2, :3] += np.outer(levers**2 / inertias * (-1.0, 1.0), force)
    rates[2, :2] = shafts._frequency, -shafts._frequency
    rates[:2, 3:] = np.diag(levers / inertias)
    return rates
