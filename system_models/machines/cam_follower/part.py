"""Cam and follower as a component: speed of the cam to the contacts at its stations, their friction and heat back."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from contact_core.errors import SceneError
from contact_core.kernels.arrays import Array
from contact_core.quantities import parameter

from ...parts.part import Input, Output, Part, State, Values, indexed, of_contact
from .profile import CamProfile, Station

# outputs of contacts that the cam receives and inputs of contacts that it sends, with typical values in SI
RECEIVED = {
    "friction_force": 10.0,
    "power_loss": 10.0,
    "rolling_resistance": 1.0,
    "heat_flow_1": 10.0,
    "heat_flow_2": 10.0,
}
SENT = {"load": 500.0, "speed_1": 1.0, "speed_2": 1.0, "radius_x": 0.01}


def contact_name(k: int, count: int) -> str:
    """Return the name of the contact at a station, counted from 1 as the event goes; the last is the base circle."""
    return "base_circle" if k > count else f"angle_{k:02d}"


@dataclass(frozen=True, kw_only=True)
class CamFollower(Part):
    """A cam, and a follower with a flat face that a spring holds on it; contacts at stations over the cam's angle.

    R = r + s + s'', W = F_0 + k s + m w^2 s'', k being the stiffness of the spring, r the base circle, m the moving
    mass (Dowson, Taylor & Zhu 1992).

    s is the lift over the angle of the cam, s' and s'' are its derivatives [m per rad, m per rad2], h = r + s, and w
    is the angular speed of the cam. With x along the face of the follower and x = 0 above the axis of the cam, the
    contact is at x = s' and moves with w s''. There the surface of the cam has the speed -w h along x, that of the
    follower none. Both speeds relative to the contact are counted in the direction of -x: u_1 = w (h + s'') of the
    cam, u_2 = w s'' of the follower, negative around the nose. The radius of the cam is R = r + s + s'', so that
    u_1 = w R. The entrainment is w (r + s + 2 s'') / 2, the sliding u_1 - u_2 = w (r + s) (D. Dowson, C.M. Taylor
    & G. Zhu, J. Phys. D: Appl. Phys. 25 (1992) A313).

    The load is W = F_0 + k s + m w^2 s'', with the spring's preload F_0 and stiffness k and the reciprocating mass m.
    Where that is negative the follower would leave the cam; it is taken as zero, and load_least is negative. Weight,
    friction of the guide, elasticity of the train and changes of w within a turn are left out.

    A contact answers as if the cam stayed at its station, with the load, speeds and radius it has there in passing. So
    the squeeze film is neglected, which keeps a film where the entrainment passes through zero. The contact's
    share of a turn is the weight of its power, torque and heat in the means over a turn. Friction resists the cam with
    the torque -F (r + s), and the rolling resistance F_r with F_r (u_1 + u_2) / w, so that friction_torque times w is
    power_loss. The torque W s' of the load averages to zero over a turn and is left out. A point of the follower
    that the contact stands on (u_2 = 0, as below the base circle) is taken to be loaded all the time: its wear is an
    upper bound.
    """

    name: ClassVar[str] = "CamFollower"
    text: ClassVar[str] = "Cam and flat-faced follower: loads and speeds of contacts over its turn, mean loss and heat"

    lobe: CamProfile
    stations: int = parameter(
        "", "contacts over the event, beside that of the base circle", least=3, most=99, default=21, shapes_arrays=True
    )
    preload: float = parameter("N", "F_0, force of the spring on the base circle", least=0.0, most=1e5)
    stiffness: float = parameter("N/m", "k, stiffness of the spring", least=0.0, most=1e8)
    mass: float = parameter("kg", "m, mass that moves with the follower", least=0.0, most=100.0)

    def check(self) -> None:
        wrong = [*self.lobe.wrong()]
        if wrong:
            raise SceneError(" ".join(wrong))

    @cached_property
    def contacts(self) -> tuple[Station, ...]:
        """Stations of the contacts: over the event, then the base circle."""
        return self.lobe.stations(self.stations)

    @cached_property
    def _places(self) -> dict[str, Array]:
        return {name: np.array([getattr(s, name) for s in self.contacts]) for name in Station._fields}

    @property
    def _numbers(self) -> range:
        return range(1, self.stations + 2)

    def _all(self, name: str) -> tuple[str, ...]:
        return tuple(indexed(name, k) for k in self._numbers)

    @property
    def inputs(self) -> tuple[Input, ...]:
        return (
            Input("speed", "w", "rad/s", "angular speed of the cam", nominal=100.0, display="rpm"),
            *(Input(**_at_station(name, k, nominal)) for name, nominal in RECEIVED.items() for k in self._numbers),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        friction, loss, rolling, heat_1, heat_2 = map(self._all, RECEIVED)
        speed = ("speed",)

        def mean(name: str, symbol: str, unit: str, nominal: float, direct: tuple[str, ...], text: str) -> Output:
            return Output(name, symbol, unit, text, nominal=nominal, direct=direct)

        return (
            *(
                Output(**_at_station(name, k, nominal), direct=() if name == "radius_x" else speed)
                for name, nominal in SENT.items()
                for k in self._numbers
            ),
            mean("friction_torque", "M", "N m", 0.1, friction + rolling, "mean torque that resists the cam's speed"),
            mean("power_loss", "P", "W", 10.0, speed + loss + rolling, "mean loss of sliding and rolling"),
            mean("power_rolling", "P_r", "W", 1.0, speed + rolling, "mean loss of rolling"),
            mean("heat_flow_1", "Q_1", "W", 10.0, heat_1, "mean heat of sliding into the cam"),
            mean("heat_flow_2", "Q_2", "W", 10.0, heat_2, "mean heat of sliding into the follower"),
            mean("load_least", "W_min", "N", 100.0, speed, "least load of the stations, negative where none is left"),
        )

    def initial(self, inputs: Values) -> State:
        return ()

    def advance(self, state: State, inputs: Values, step: float) -> State:
        return ()

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        place, speed = self._places, inputs["speed"]
        found = {name: np.array([inputs[key] for key in self._all(name)]) for name in RECEIVED}
        load = self.preload + self.stiffness * place["lift"] + self.mass * speed**2 * place["lift_second"]
        sums = place["radius_x"] + place["lift_second"]  # (u_1 + u_2) / w [m]
        rows = {
            "load": np.maximum(load, 0.0),
            "speed_1": speed * place["radius_x"],  # u_1 = w R, with R = r + s + s''
            "speed_2": speed * place["lift_second"],
            "radius_x": place["radius_x"],
        }
        rolling = self._mean(found["rolling_resistance"] * sums)
        sliding = self._mean(-found["friction_force"] * (self.lobe.base_radius + place["lift"]))
        return {
            **{
                key: float(value) for name, row in rows.items() for key, value in zip(self._all(name), row, strict=True)
            },
            "friction_torque": sliding + rolling,
            "power_loss": self._mean(found["power_loss"]) + speed * rolling,
            "power_rolling": speed * rolling,
            "heat_flow_1": self._mean(found["heat_flow_1"]),
            "heat_flow_2": self._mean(found["heat_flow_2"]),
            "load_least": float(load.min()),
        }

    def _mean(self, values: Array) -> float:
        """Return the mean over a turn of values [n] at the stations."""
        return float((self._places["weight"] * values).sum())

    def track_lengths(self, station: Station, least: float) -> tuple[float, float]:
        """Return the track lengths [m] of cam and follower, `least` [m] at least: travel past the contact in a turn.

        On the follower the contact may reverse within the angles of a station, so their mean travel counts.
        """
        turn = 2.0 * math.pi
        return max(turn * station.radius_x, least), max(turn * station.travel, least)


def _at_station(name: str, k: int, nominal: float) -> dict[str, Any]:
    return of_contact(name, indexed(name, k), f"station {k}", nominal)
