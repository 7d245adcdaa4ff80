"""TEMPORARY placeholder while the real module is written: same signature, toy numbers, so that the FMU can be plumbed."""
from dataclasses import replace
import numpy as np
from .scene import Scene, OperatingPoint
from .state import ContactState, Outputs, frozen
def advance(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Advance by dt [s] under a held operating point; dt = 0 evaluates. Raises OperatingPointError / ConvergenceError."""
    op.check()
    b1, b2 = state.bodies
    b1 = replace(b1, wear=frozen(b1.wear + 1e-12*dt*np.sin(np.arange(b1.wear.size)).reshape(b1.wear.shape)), cycles=b1.cycles+abs(op.speed_1)*dt/scene.geometry.track_length_1, travel=b1.travel+op.speed_1*dt)
    out = Outputs(friction_force=-0.1*op.load*np.sign(op.sliding_speed), friction_coefficient=0.1 if op.load else 0.0, h_c=1e-8*(1+state.time/7200), tribofilm_1=float(b1.wear.std()), load_cycles_1=b1.cycles, temperature_1=op.temperature, temperature_2=op.temperature, suggested_step=60.0)
    new = replace(state, time=state.time+dt, bodies=(b1,b2), solved_for=op, outputs=out)
    return new, out
