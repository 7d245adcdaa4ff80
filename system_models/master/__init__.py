"""A master for co-simulation: couples anybody's FMUs and controls its own error.

    system        what is coupled: FMUs, connections, parameters, schedules, events, power bonds
    reading       a system and how to simulate it, from TOML
    model         an FMU as its modelDescription.xml has it
    unit_checks   the factor from one variable's unit to another's, or a refusal
    simulate      the time loop: fixed or error-controlled communication steps, events
    stepping      one communication step, of a size or as large as the tolerance allows
    events        finds the moment of an event within a step
    coupled       the running FMUs of a system: exchange, advance, save, restore
    initial       consistent initial values
    hold          inputs over a step as polynomials: extrapolated or interpolated
    iteration     fixed point, Aitken, interface quasi-Newton
    control       error norm and step size
    slave         a running FMU: FMI 2; slave_fmi3: FMI 3
    recorder      rows, and the Dataset made of them
    saving        what a checkpoint holds
    ssp           export as SSP 1.0

Inside, FMUs are sorted by name and connections by target, so no result depends on the order in which they are given.
"""

from .errors import CouplingError
from .simulate import simulate
from .ssp import export_ssp
from .system import Connection, System

__all__ = ["Connection", "CouplingError", "System", "export_ssp", "simulate"]
