"""The mesh of a spur gear pair as a component: torque and speeds out to the stations, friction and heat back."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from contact_core.errors import SceneError
from contact_core.kernels.arrays import Array

from ...parts.part import Input, Output, Part, State, Values, indexed, of_contact
from .geometry import SpurGearPair, fixed
from .path import Stations, radius, stations_of, surface_speeds, track_lengths
from .sharing import Sharing, loads
from .textbook import loss_factor, ohlendorf

# outputs of contacts that the mesh receives and inputs of contacts that it sends, with typical values in SI
RECEIVED = {
    "friction_force": 50.0,
    "power_loss": 100.0,
    "rolling_resistance": 1.0,
    "flash_temperature_rise": 10.0,
    "heat_flow_1": 50.0,
    "heat_flow_2": 50.0,
}
SENT = {"load": 1000.0, "speed_1": 1.0, "speed_2": 1.0}
_CAUSE = {"load": "torque", "speed_1": "speed_1", "speed_2": "speed_2"}
_IDLE = 1.0  # N: a force between the teeth of which ratios say nothing
_RESTING = 1e-9  # W: power below which gears stand, and a ratio to it says nothing


def flank(k: int) -> str:
    """Return the name of the contact at a station, counted from 1 at the pinion's root."""
    return f"flank_{k:02d}"


@dataclass(frozen=True)
class Station:
    """Data with which the contact at a station is built: all but load and speeds."""

    position: float  # on the line of action, from T1 [m]
    radius_x: float  # [m]
    face_width: float  # [m]
    track_length_1: float  # [m]
    track_length_2: float  # [m]
    weight: float  # pairs of teeth, on average, in the stretch of the path that the station stands for


@dataclass(frozen=True, kw_only=True)
class GearMesh(Part):
    """Contacts at stations along the path of contact, each standing for a stretch of it.

    A contact answers as if a pair of teeth stayed at its station, with the radius, speeds and load it has there in
    passing; its track lengths say how rarely a flank point is there. On average stretch / base pitch pairs of teeth are
    in a stretch. That is the weight of a station's forces, powers and heat in the means over a mesh cycle,
    P = sum stretch_k / p_b P_k = 1/p_b integral P(s) ds, and of its wear volume in that of all teeth together; wear
    depths need none. A torque of either sign loads the same flanks, as if the teeth had one side only.
    """

    name: ClassVar[str] = "GearMesh"
    text: ClassVar[str] = (
        "Mesh of a spur gear pair: loads and speeds of contacts along its path, their mean loss and heat"
    )

    pair: SpurGearPair
    load_sharing: Sharing = field(default_factory=Sharing)
    stations: int = fixed("", "contacts along the path", least=3, most=9999, default=21)

    def check(self) -> None:
        wrong = [*self.pair.wrong()] or [*self.load_sharing.wrong(self.pair)]
        if wrong:
            raise SceneError(" ".join(wrong))
        stations_of(self.pair, self.stations)

    @cached_property
    def contacts(self) -> tuple[Station, ...]:
        """Data of the contacts, in order."""
        position = self._places.position
        width = np.full(self.stations, self.pair.face_width)
        columns = position, radius(self.pair, position), width, *track_lengths(self.pair, position), self._weights
        return tuple(Station(*map(float, row)) for row in zip(*columns, strict=True))

    @cached_property
    def _places(self) -> Stations:
        return stations_of(self.pair, self.stations)

    @cached_property
    def _weights(self) -> Array:
        return self._places.stretch / self.pair.base_pitch

    def _all(self, name: str) -> tuple[str, ...]:
        return tuple(indexed(name, k) for k in range(1, self.stations + 1))

    @property
    def inputs(self) -> tuple[Input, ...]:
        hot: dict[str, Any] = {"nominal": 350.0, "display": "degC", "start": 363.15}
        return (
            Input("torque", "T_1", "N m", "torque of the pinion that the teeth transmit", nominal=100.0),
            Input("speed_1", "omega_1", "rad/s", "angular speed of the pinion", nominal=100.0),
            Input(
                "speed_2", "omega_2", "rad/s", "angular speed of the wheel, positive as the gears turn", nominal=100.0
            ),
            Input("body_temperature_1", "T_b1", "K", "bulk temperature of the pinion", **hot),
            Input("body_temperature_2", "T_b2", "K", "bulk temperature of the wheel", **hot),
            *(Input(**_at_station(name, k, nominal)) for name, nominal in RECEIVED.items() for k in self._numbers),
        )

    @property
    def responses(self) -> tuple[Output, ...]:
        friction, loss, rolling, flash, heat_1, heat_2 = map(self._all, RECEIVED)
        torque, speeds, bulk = ("torque",), ("speed_1", "speed_2"), ("body_temperature_1", "body_temperature_2")
        power = (*torque, "speed_1")

        def mean(name: str, symbol: str, unit: str, nominal: float, direct: tuple[str, ...], text: str) -> Output:
            return Output(name, symbol, unit, text, nominal=nominal, direct=direct)

        return (
            *(
                Output(**_at_station(name, k, nominal), direct=(_CAUSE[name],))
                for name, nominal in SENT.items()
                for k in self._numbers
            ),
            *(
                Output(name, "T_c", "K", f"mean of the bulk temperatures and flash; station {k}", nominal=350.0,
                       display="degC", direct=(*bulk, flash[k - 1]))
                for k, name in enumerate(self._all("contact_temperature"), 1)
            ),
            mean("normal_force", "F_bt", "N", 1000.0, torque, "force along the line of action"),
            mean("friction_torque_1", "M_f1", "N m", 1.0, friction + rolling,
                 "torque of friction and rolling on the pinion, the way it turns"),
            mean("friction_torque_2", "M_f2", "N m", 1.0, friction + rolling,
                 "torque of friction and rolling on the wheel, the way it turns"),
            mean("power_loss", "P_V", "W", 100.0, speeds + loss + rolling, "loss of sliding and rolling"),
            mean("power_rolling", "P_VR", "W", 10.0, speeds + rolling, "loss of rolling"),
            mean("power_transmitted", "P_a", "W", 1e4, power, "power that the pinion gives"),
            mean("heat_flow_1", "Q_1", "W", 50.0, heat_1, "heat of sliding into the pinion"),
            mean("heat_flow_2", "Q_2", "W", 50.0, heat_2, "heat of sliding into the wheel"),
            mean("friction_coefficient", "mu_mz", "1", 0.1, power + loss,
                 f"sliding loss over power times Ohlendorf's loss factor, 0 below {_IDLE:g} N or {_RESTING:g} W"),
            mean("friction_coefficient_mean", "mu_m", "1", 0.1, torque + friction,
                 f"mean friction force over mean load, 0 below {_IDLE:g} N"),
            mean("loss_factor", "H_V", "1", 0.1, torque,
                 f"loss factor under the loads as they are, 0 below {_IDLE:g} N"),
            Output("flash_temperature_rise", "dT_f", "K", "largest of the stations", nominal=10.0, relative=True,
                   direct=flash),
        )  # fmt: skip

    @property
    def _numbers(self) -> range:
        return range(1, self.stations + 1)

    def initial(self, inputs: Values) -> State:
        return ()

    def advance(self, state: State, inputs: Values, step: float) -> State:
        return ()

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        found = {name: np.array([inputs[key] for key in self._all(name)]) for name in RECEIVED}
        place, flash = self._places.position, found["flash_temperature_rise"]
        force, power = abs(inputs["torque"]) / self.pair.base_radius_1, inputs["torque"] * inputs["speed_1"]
        load = loads(self.pair, self.load_sharing, force, place)
        u1, u2 = surface_speeds(self.pair, place, inputs["speed_1"], inputs["speed_2"])
        bulk = 0.5 * (inputs["body_temperature_1"] + inputs["body_temperature_2"])
        rows = {"load": load, "speed_1": u1, "speed_2": u2, "contact_temperature": bulk + flash}
        friction, resistance = found["friction_force"], found["rolling_resistance"]
        sliding, rolling = self._mean(found["power_loss"]), self._mean(resistance * (u1 + u2))
        return {
            **{
                key: float(value) for name, row in rows.items() for key, value in zip(self._all(name), row, strict=True)
            },
            "normal_force": force,
            # both forces lie across the line of action, T1 and T2 are the feet of the axes on it
            "friction_torque_1": self._mean((friction - resistance) * place),
            "friction_torque_2": self._mean((-friction - resistance) * (self.pair.line_length - place)),
            "power_loss": sliding + rolling,
            "power_rolling": rolling,
            "power_transmitted": power,
            "heat_flow_1": self._mean(found["heat_flow_1"]),
            "heat_flow_2": self._mean(found["heat_flow_2"]),
            **self._ratios(force, load, sliding, abs(power), np.abs(friction)),
            "flash_temperature_rise": float(flash.max()),
        }

    def _ratios(self, force: float, load: Array, sliding: float, power: float, friction: Array) -> dict[str, float]:
        """Return coefficients of friction and loss factor."""
        if force < _IDLE:
            return {"friction_coefficient": 0.0, "friction_coefficient_mean": 0.0, "loss_factor": 0.0}
        return {
            "friction_coefficient": sliding / (power * ohlendorf(self.pair)) if power > _RESTING else 0.0,
            "friction_coefficient_mean": self._mean(friction) / self._mean(load),
            "loss_factor": loss_factor(self.pair, self._places, load / force),
        }

    def _mean(self, values: Array) -> float:
        """Return the sum over all pairs in contact, averaged over a mesh cycle, of values [n] at the stations."""
        return float((self._weights * values).sum())


def _at_station(name: str, k: int, nominal: float) -> dict[str, Any]:
    return of_contact(name, indexed(name, k), f"station {k}", nominal)
