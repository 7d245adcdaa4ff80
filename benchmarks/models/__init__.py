"""FMUs for tests of a co-simulation master: C compiled by gcc for FMI 2 and FMI 3, and one by pythonfmu.

    from benchmarks.models import build
    path = build("mass_1_force", folder, fmi=2, rollback=False, start={"k": 20.0})

`build.build` says which switches any model has; MODELS lists the names. Parameters are fixed: they are set before the
initialisation ends. Unless a name says otherwise, quantities are in SI units.

Linear systems, exact for inputs that are polynomials of degree two over the step (`linear.linear` makes more of them:
build("linear", folder, variables=..., A=..., B=..., C=..., D=..., starts=...)); all give the first derivative of their
outputs, and directional derivatives:

====================  =====================  ===========  ==========================================================
name                  inputs                 outputs      parameters
====================  =====================  ===========  ==========================================================
mass_1_force          F                      x, v         m, k, d, x0 = 1, v0: mass on spring and damper
mass_2_spring         x1, v1                 F, x, v      m, k, d, kc, dc, x0 = 0, v0; F acts on mass 1, feedthrough
mass_1_displacement   x_other, v_other       x, v         m, k, d, kc, dc, x0 = 1, v0
mass_2_displacement   x_other, v_other       x, v         m, k, d, kc, dc, x0 = 0, v0
wheel_force           road = 0.1, F          x, v         m = 40, kw = 150e3, x0, v0
chassis_spring        x_wheel, v_wheel       F, x, v      m = 400, k = d = 0, kc = 15e3, dc = 1e3, x0, v0; F on wheel
wheel_displacement    road, x_other, v_other x, v         m, kw, kc, dc, x0, v0
chassis_displacement  x_other, v_other       x, v         m, k, d, kc, dc, x0, v0
point_mass            F                      x, v         m = 1e-3, F0 = 300, x0, v0: m x'' = F0 - F
block                 F                      x, v, u      m, k = 50, d, v_belt = 0.1, x0, v0: u = v - v_belt
====================  =====================  ===========  ==========================================================

Laws without memory, their outputs all feedthrough (directional derivatives of F and y):

contact_point   x, v -> F, dF_dx, dF_dv, in_contact (Boolean); F_ref = 300, x_ref = 1.0795e-6, c = 50.
                F = F_ref (x / x_ref)^1.5 + c v where x > 0, never below zero. With point_mass: the stiff contact.
friction        u -> F, dF_du; N, mu_s, mu_d, u_s, u_r = 0.01. With block: stick-slip, period about 1.1 s.
drag            u -> F, dF_du; F = -c u - q u |u| with c = 1, q = 2, worked out in a step from u as it was held: the
                outputs depend on no input directly, and so stand for the middle of a step, like a contact's.
gain            u -> y = a u + b + c u^2; build("gain", folder, a=, b=, c=, unit_u=, unit_y=).
millimetre      gain with u in mm and y in N, a = 10. celsius, kelvin: in degC and K. mismatch: both in s.
echo            real_in, integer_in, boolean_in, string_in -> real_out, ...
arrays          FMI 3: u [3] -> y with y' = u; z [2, 2] = gains u, column by column; counted = counts + 1 [3], Integer;
                flagged = not flags [2, 2], Boolean.

Models that misbehave; all but the last two integrate y' = u from y0, exactly:

discard         takes no step above h_max = 0.1; with `partial=True` it stops after h_max (FMI 3: as an early return).
terminator      ends the simulation at t_end = 0.5 (FMI 2: Discard and Terminated; FMI 3: terminateSimulation).
early           y jumps by `jump` = 1 at each multiple of `period` = 0.25, counted by events (Integer). FMI 3: event
                mode; it returns early at an event if it is allowed to, and otherwise goes on to the end of the step.
nan             y is no number after t_nan = 0.5.
failing         doStep is an error, with a message, if it ends after t_fail = 0.5.
registrar       takes no step once the library has been unloaded and loaded again.
locker          makes its instances under a lock that a child forked meanwhile never gets.
bouncer         h, v, bounces (Integer); g, e = 0.7, h0 = 1, v0: a ball, its bounces inside the step.
tooth           tooth (Integer), stiffness, which changes with the tooth by k a; period = 0.1.

python_mass     mass_1_force by pythonfmu, FMI 2, exact for a held force; no derivatives of inputs.

In FMI 2, derivatives of inputs hold for the step that follows and are forgotten after it: the inputs then stand at the
polynomial's value at the end of the step, and so do outputs with feedthrough, until the inputs are set again. A model
checks its master: a step that does not start where the last one ended, one beyond the stop time (FMI 2), a fixed
parameter set late, an output set, and a step before a pending event is handled are errors with a message. exact.py has
the solutions of the coupled systems.
"""

from .build import build
from .catalogue import MODELS

__all__ = ["MODELS", "build"]
