"""A master for co-simulation: couples anybody's FMUs and controls its own error.

What it couples:

    system        FMUs, connections, parameters, schedules, events, power bonds; reading: from TOML; ssp: to SSP 1.0
    model         an FMU as its modelDescription.xml has it; unit_checks: from one variable's unit to another's
    settings      how to simulate, and what the FMUs must be able to do for it

How it runs:

    simulate      the time loop; recorder: rows, and the Dataset made of them; saving: what a checkpoint holds
    interrupt     Ctrl-C waits for the end of a step
    stepping      a communication step of a given size; controlled: as large as a tolerance allows
    events        the moment of an event within a step
    coupled       the running FMUs of a system: exchange, advance, save, restore
    slave         a running FMU of FMI 2; slave_fmi3: of FMI 3; start: starts those of a system
    initial       consistent initial values

Numerics, which know no FMU:

    hold          inputs over a step as polynomials; richardson: the error of its halves
    iteration     fixed point, Aitken, quasi_newton; secant: the last, of one value
    control       error norm and step size
    wiring        what sets what, as arrays; sequence: who steps when; linear: correction by derivatives

Inside, FMUs are sorted by name and connections by target, so no result depends on the order in which they are given.
"""

from .errors import CouplingError
from .simulate import simulate
from .ssp import export_ssp
from .system import Connection, System

__all__ = ["Connection", "CouplingError", "System", "export_ssp", "simulate"]
