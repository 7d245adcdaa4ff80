"""One component of each kind with inputs that take it through what it can do."""

from system_models.parts.brake import Brake
from system_models.parts.load_arm import LoadArm
from system_models.parts.part import Part, State, Values
from system_models.parts.shaft import Shaft
from system_models.parts.speed_source import SpeedSource
from system_models.parts.spindle import Spindle
from system_models.parts.thermal import Link, Node, ThermalNetwork, Thermostat

NETWORK = ThermalNetwork(
    nodes=(Node("oil", 2e3, 300.0), Node("housing", 8e3, 295.0), Node("ring", 40.0, 310.0, heat_flows=2)),
    links=(Link("ring", "oil", 20.0), Link("oil", "housing", 50.0), Link("ambient", "housing", 6.0)),
)
BATH = ThermalNetwork(
    nodes=(Node("oil", 60.0, 298.0), Node("bath", 900.0, 298.0)),
    links=(Link("oil", "bath", 4.0), Link("bath", "ambient", 0.8), Link("oil", "ambient", 0.2)),
    thermostats=(Thermostat("bath", setpoint=353.15, gain=40.0, heating=120.0, cooling=15.0),),
)

EXAMPLES: dict[str, tuple[Part, dict[str, float]]] = {
    "speed_source": (SpeedSource(20.0), {"speed_setpoint": -30.0, "torque": 3.0}),
    "shaft": (
        Shaft(0.02, 0.01, initial_speed=12.0),
        {"torque_drive": 0.3, "torque_resisting": 0.5, "speed_drive": 0.0},
    ),
    "coupled_shaft": (
        Shaft(0.02, 0.0, coupling=3.0, initial_speed=-5.0),
        {"torque_drive": 0.0, "torque_resisting": 0.5, "speed_drive": 80.0},
    ),
    "brake": (Brake(0.3, 0.05), {"torque_setpoint": 8.0, "speed": 0.04}),
    "spindle": (
        Spindle(0.0095, 1e-4, 60.0),
        {"surface_speed_setpoint": 1.5, "friction_force": -4.0, "rolling_resistance": 0.2},
    ),
    "load_arm": (LoadArm(8.0, 0.3, 5.0), {"load_setpoint": 50.0}),
    "network": (
        NETWORK,
        {
            "heat_oil": 200.0,
            "heat_housing": -30.0,
            "heat_ring[1]": 90.0,
            "heat_ring[2]": 10.0,
            "temperature_ambient": 288.0,
        },
    ),
    "bath": (BATH, {"heat_oil": 5.0, "heat_bath": 0.0, "temperature_ambient": 295.0, "setpoint_bath": 330.0}),
}


def marched(part: Part, state: State, inputs: Values, step: float, count: int) -> State:
    """The state after `count` equal steps."""
    for _ in range(count):
        state = part.advance(state, inputs, step)
    return state
