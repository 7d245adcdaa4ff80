"""Bulk temperatures of the bodies between two solutions, from the heat of the contact."""

from dataclasses import replace

from ..scene import Case
from .outputs import Outputs

NO_TIME = 1e-9  # s: shorter than any block


def power_loss(case: Case, outputs: Outputs) -> float:
    """Return the frictional power [W]."""
    return max(0.0, -outputs.friction_force * case.op.sliding_speed - outputs.spin_torque * case.op.spin)


def heat_flows(case: Case, outputs: Outputs) -> tuple[float, float]:
    """Return the heat [W] that the contact puts into each body: together all of the power."""
    return outputs.heat_flow_1, power_loss(case, outputs) - outputs.heat_flow_1


def temperatures_after(case: Case, outputs: Outputs, step: float) -> tuple[float, float]:
    """Return the bulk temperatures [K] after `step` [s] of the present heat flows."""
    op = case.op
    return case.scene.heat.bulk.after(op.bodies, heat_flows(case, outputs), op.temperature, step)


def cool_time(case: Case, outputs: Outputs, longest: float) -> float:
    """Return a time [s], at most `longest`, in which the bodies' temperatures change the oil too little to matter."""
    step = longest
    while step > NO_TIME:
        first, second = temperatures_after(case, outputs, step)
        warm = Case(case.scene, replace(case.op, body_temperature_1=first, body_temperature_2=second))
        if not warm.differs_from(case.op):
            break
        step *= 0.5
    return step
