"""A ball bearing as a component: forces and speed out to the classes of its contacts, friction and heat back."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from contact_core.errors import ContactError
from contact_core.kernels.arrays import Array
from contact_core.quantities import parameter

from ...parts.part import Input, Output, Part, State, Values, indexed, of_contact
from .equilibrium import Equilibrium, RingLoads, solve
from .geometry import RACES, BallBearingGeometry, Race, RaceName
from .kinematics import Motion, motion
from .load_classes import Classes, classify, track_lengths

_FORCE: dict[str, Any] = {"unit": "N", "nominal": 1000.0, "minimum": -1e6, "maximum": 1e6}
_MOMENT: dict[str, Any] = {"unit": "N m", "nominal": 10.0, "minimum": -1e5, "maximum": 1e5}
_SHAFT = (
    Input("force_x", "F_x", text="axial force of the shaft on the inner ring", **_FORCE),
    Input("force_y", "F_y", text="radial force of the shaft on the inner ring, along y", **_FORCE),
    Input("force_z", "F_z", text="radial force of the shaft on the inner ring, along z", **_FORCE),
    Input("moment_y", "M_y", text="moment of the shaft on the inner ring about y", **_MOMENT),
    Input("moment_z", "M_z", text="moment of the shaft on the inner ring about z", **_MOMENT),
    Input("speed", "omega", "rad/s", "angular speed of the inner ring about x; the outer one is at rest",
          nominal=100.0, minimum=-1e4, maximum=1e4, display="rpm"),
)  # fmt: skip
_BY_LOAD = tuple(q.name for q in _SHAFT)

# outputs of contacts that the bearing receives and inputs of contacts that it sends, with typical values in SI
RECEIVED = {
    "friction_force": 1.0,
    "spin_torque": 1e-3,
    "rolling_resistance": 0.1,
    "heat_flow_1": 1.0,
    "heat_flow_2": 1.0,
}
SENT = {"load": 100.0, "speed_1": 1.0, "speed_2": 1.0, "spin": 100.0, "radius_x": 0.01}


def contact_name(race: RaceName, level: int) -> str:
    """Return the name of the contact of a load class: of the inner or outer race, 1 for the lightest class."""
    return f"{race}_{level}"


class LoadClass(NamedTuple):
    """Data with which the contact of a load class is built."""

    race: RaceName
    level: int  # from 1, the lightest
    load: float  # at the design load [N]
    balls: float  # that it stands for, likewise
    speed_1: float  # [m/s]
    speed_2: float
    radius_x: float  # [m]
    radius_y: float
    track_length_1: float  # [m]
    track_length_2: float

    @property
    def name(self) -> str:
        return contact_name(self.race, self.level)


@dataclass(frozen=True, kw_only=True)
class BallBearing(Part):
    """A single-row ball bearing at rest under its loads at every instant, its contacts in classes by load.

    Body 1 of each contact is the ball, body 2 the ring. Every class gives its load, speeds, spin and radius, and how
    many balls it stands for (see `load_classes`); every contact gives its friction and heat back.

    The torque is that of virtual power, sum count (|F| s + |M_s| w_s + |F_r| 2 u) with sliding s, spin w_s and
    entrainment u per angular speed of the shaft. These are geometry: it does not divide by the speed, follows a change
    of speed before the contacts do, and always resists. Below the speed `standstill` it goes over to the torque that
    the Coulomb friction `friction_at_rest` holds, sum count mu load sqrt(s^2 + (lever w_s)^2), which the contacts,
    whose friction fades where nothing slides, cannot give; at rest it is given as positive, and only holds.

    All power that the shaft loses becomes heat of balls, rings, and, where the contacts do not put it into them, oil.
    """

    name: ClassVar[str] = "BallBearing"
    text: ClassVar[str] = "Ball bearing: load distribution, motion of its contacts by classes, their torque and heat"

    dimensions: BallBearingGeometry
    levels: int = parameter("", "classes of load on each race", least=1, most=50, default=3, shapes_arrays=True)
    first_ball: float = parameter("rad", "azimuth of ball 1 from y towards z", least=-7.0, most=7.0, default=0.0)
    tilt_stiffness: float = parameter(
        "N m/rad", "moment of the shaft against tilt of the inner ring", least=0.0, most=1e9, default=0.0
    )
    friction_at_rest: float = parameter("", "friction coefficient at standstill", least=0.0, most=1.0, default=0.1)
    standstill: float = parameter(
        "rad/s", "speed below which friction goes over to that at rest", above=0.0, most=10.0, default=0.1
    )

    def check(self) -> None:
        self.dimensions.check()

    @property
    def inputs(self) -> tuple[Input, ...]:
        return (
            *_SHAFT,
            *(
                Input(**_of_class(name, race, k, nominal))
                for race in RACES
                for name, nominal in RECEIVED.items()
                for k in self._numbers
            ),
        )

    @property
    def responses(self) -> tuple[Output, ...]:

        def row(name: str, symbol: str, unit: str, nominal: float, text: str, *, by: tuple[str, ...] = _BY_LOAD,
                display: str = "") -> Output:  # fmt: skip
            return Output(name, symbol, unit, text, nominal=nominal, direct=by, display=display)

        rubbed = ("friction_force", "spin_torque", "rolling_resistance")
        friction = (*_BY_LOAD, *(key for name in rubbed for key in self._all(name)))
        heat = {race: tuple(indexed(f"heat_flow_2_{race}", k) for k in self._numbers) for race in RACES}
        into_balls = self._all("heat_flow_1")
        return (
            *(output for race in RACES for output in self._given_to(race)),
            row("friction_torque", "M", "N m", 0.1, "torque that resists the shaft's speed", by=friction),
            row("power_loss", "P", "W", 10.0, "friction_torque times speed", by=friction),
            row("heat_flow_balls", "Q_b", "W", 10.0, "heat into all balls", by=(*_BY_LOAD, *into_balls)),
            row("heat_flow_inner", "Q_i", "W", 10.0, "heat into the inner ring", by=(*_BY_LOAD, *heat["inner"])),
            row("heat_flow_outer", "Q_o", "W", 10.0, "heat into the outer ring", by=(*_BY_LOAD, *heat["outer"])),
            row("heat_flow_oil", "Q_oil", "W", 10.0, "power_loss less the heat into balls and rings",
                 by=(*friction, *into_balls, *heat["inner"], *heat["outer"])),
            row("cage_speed", "omega_c", "rad/s", 100.0, "angular speed of the cage", display="rpm"),
            row("load_max", "Q_max", "N", 1000.0, "largest load of a contact"),
            row("pressure_max", "p_max", "Pa", 1e9, "largest pressure of a contact, after Hertz", display="GPa"),
            row("contact_angle_inner", "alpha_i", "rad", 0.1, "largest contact angle of a loaded ball, inner race"),
            row("contact_angle_outer", "alpha_o", "rad", 0.1, "largest contact angle of a loaded ball, outer race"),
            *(
                row(f"displacement_{axis}", f"delta_{axis}", "m", 1e-5, f"of inner ring along {axis}", display="um")
                for axis in "xyz"
            ),
            *(row(f"tilt_{axis}", f"theta_{axis}", "rad", 1e-4, f"of the inner ring about {axis}") for axis in "yz"),
            row("residual", "r", "1", 1e-6, "largest force out of balance over the largest force, at least 1 N"),
            row("unconverged", "", "1", 1.0, "1 where the forces do not balance, else 0"),
            *(
                row(indexed(f"load_ball_{race}", j), "Q_j", "N", 100.0, f"load of ball {j} on the {race} race")
                for race in RACES
                for j in range(1, self.dimensions.balls + 1)
            ),
        )  # fmt: skip

    def _given_to(self, race: RaceName) -> Iterator[Output]:
        """Yield the outputs for the load classes of a race, and the numbers of balls that they stand for."""
        for name, nominal in SENT.items():
            for k in self._numbers:
                yield Output(**_of_class(name, race, k, nominal), direct=_BY_LOAD)
        for k in self._numbers:
            text = f"balls in class {k} of the {race} race"
            yield Output(indexed(f"count_{race}", k), "Z_k", "1", text, direct=_BY_LOAD)

    @property
    def _numbers(self) -> range:
        return range(1, self.levels + 1)

    def _all(self, name: str) -> tuple[str, ...]:
        return tuple(indexed(f"{name}_{race}", k) for race in RACES for k in self._numbers)

    def designs(self, loads: RingLoads, speed: float) -> tuple[LoadClass, ...]:
        """Return the data of the contacts of all load classes, inner race first, for a design load and speed."""
        rest, found = self._at(loads, speed), []
        for race, classes in self._classes(rest):
            shape, moving = self.dimensions.race(race), motion(self.dimensions, rest, race)
            ways = track_lengths(self.dimensions, shape, classes.count, moving)
            rows = np.stack([classes.load, classes.count, speed * classes.ball, speed * classes.ring, classes.radius_x])
            for k, (row, way) in enumerate(zip(rows.T.tolist(), ways, strict=True), 1):
                load, balls, ball, ring, radius = row
                found.append(LoadClass(race, k, load, balls, ball, ring, radius, shape.radius_y, *way))
        return tuple(found)

    def initial(self, inputs: Values) -> State:
        """Return the start of the search for the next equilibrium, as `equilibrium.solve` takes it."""
        return self._solved(None, inputs).start

    def advance(self, state: State, inputs: Values, step: float) -> State:
        """Return the start of the next search: nothing else remains of the past."""
        return self._solved(state, inputs).start

    def _solved(self, state: State | None, inputs: Values) -> Equilibrium:
        for q in _SHAFT:
            if not q.minimum <= inputs[q.name] <= q.maximum:
                raise ContactError(
                    f"{q.name} = {inputs[q.name]:g} {q.unit} must be from {q.minimum:g} to {q.maximum:g} {q.unit}. "
                    f"Change what sets the {q.text}."
                )
        *loads, speed = (inputs[name] for name in _BY_LOAD)
        return self._at(RingLoads(*loads), speed, state)

    def _at(self, loads: RingLoads, speed: float, start: State | None = None) -> Equilibrium:
        return solve(self.dimensions, loads, speed, start, self.first_ball, self.tilt_stiffness)

    def _classes(self, rest: Equilibrium) -> list[tuple[RaceName, Classes]]:
        loads: dict[RaceName, Array] = {"inner": rest.load_inner, "outer": rest.load_outer}
        return [(race, self._of_race(race, loads[race], motion(self.dimensions, rest, race))) for race in RACES]

    def _of_race(self, race: RaceName, loads: Array, moving: Motion) -> Classes:
        return classify(self.dimensions, self.dimensions.race(race), loads, moving, self.levels)

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        rest, speed = self._solved(state, inputs), inputs["speed"]
        classes = dict(self._classes(rest))
        torque = self._torque(classes, inputs, speed)
        received = {race: self._received(race, inputs) for race in RACES}
        into_balls = sum(float(classes[race].count @ received[race]["heat_flow_1"]) for race in RACES)
        into_inner, into_outer = (float(classes[race].count @ received[race]["heat_flow_2"]) for race in RACES)
        power = torque * speed
        return {
            **self._given(classes, speed),
            "friction_torque": torque,
            "power_loss": power,
            "heat_flow_balls": into_balls,
            "heat_flow_inner": into_inner,
            "heat_flow_outer": into_outer,
            "heat_flow_oil": power - into_balls - into_inner - into_outer,
            **self._whole(rest, speed),
        }

    def _received(self, race: RaceName, inputs: Values) -> dict[str, Array]:
        return {name: np.array([inputs[indexed(f"{name}_{race}", k)] for k in self._numbers]) for name in RECEIVED}

    def _torque(self, classes: dict[RaceName, Classes], inputs: Values, speed: float) -> float:
        """Return the friction torque on the shaft, positive where it resists a positive speed [N m]."""
        moving = at_rest = 0.0
        for race, c in classes.items():
            received = {name: np.abs(values) for name, values in self._received(race, inputs).items()}
            sliding, lever = np.abs(c.sliding), self.dimensions.race(race).spin_lever * np.cbrt(c.load)
            force = received["friction_force"] * sliding + received["spin_torque"] * c.spin
            moving += float(c.count @ (force + 2.0 * received["rolling_resistance"] * c.entrainment))
            at_rest += self.friction_at_rest * float(c.count @ (c.load * np.hypot(sliding, lever * c.spin)))
        part = min(abs(speed) / self.standstill, 1.0)
        torque = part * moving + (1.0 - part) * at_rest
        return torque if speed >= 0.0 else -torque

    def _given(self, classes: dict[RaceName, Classes], speed: float) -> dict[str, float]:
        """Return the values for each load class, and the number of balls that it stands for."""
        found = {}
        for race, c in classes.items():
            rows = {
                "load": c.load,
                "speed_1": speed * c.ball,
                "speed_2": speed * c.ring,
                "spin": speed * c.spin,
                "radius_x": c.radius_x,
                "count": c.count,
            }
            for name, row in rows.items():
                found.update({indexed(f"{name}_{race}", k): x for k, x in enumerate(row.tolist(), 1)})
        return found

    def _whole(self, rest: Equilibrium, speed: float) -> dict[str, float]:
        driven, inner, outer = rest.load_inner > 0.0, self.dimensions.inner, self.dimensions.outer
        largest = float(rest.load_inner.max()), float(rest.load_outer.max())
        pressures = [pressure(race, load) for race, load in zip((inner, outer), largest, strict=True)]
        return {
            "cage_speed": rest.cage * speed,
            "load_max": max(largest),
            "pressure_max": max(pressures),
            "contact_angle_inner": float(np.abs(rest.angle_inner).max(where=driven, initial=0.0)),
            "contact_angle_outer": float(np.abs(rest.angle_outer).max(where=rest.load_outer > 0.0, initial=0.0)),
            **{f"displacement_{axis}": value for axis, value in zip("xyz", rest.displacement, strict=True)},
            **{f"tilt_{axis}": value for axis, value in zip("yz", rest.tilt, strict=True)},
            "residual": rest.residual,
            "unconverged": 0.0 if rest.converged else 1.0,
            **{indexed("load_ball_inner", j): load for j, load in enumerate(rest.load_inner.tolist(), 1)},
            **{indexed("load_ball_outer", j): load for j, load in enumerate(rest.load_outer.tolist(), 1)},
        }


def pressure(race: Race, load: float) -> float:
    """Return the largest pressure [Pa] of a contact under a load [N] >= 0."""
    return race.unit.pressure_max * race.unit.growth(load)[0]


def _of_class(name: str, race: RaceName, k: int, nominal: float) -> dict[str, Any]:
    return of_contact(name, indexed(f"{name}_{race}", k), f"class {k} of the {race} race", nominal)
