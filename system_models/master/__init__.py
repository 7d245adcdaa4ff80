"""A master for co-simulation: couples any FMUs and controls its own error.

The system:

    system        FMUs, connections, parameters, schedules, events, power bonds; reading: from TOML; ssp: to SSP 1.0
    unit_checks   conversion from the unit of one variable to that of another
    settings      the options of a simulation, and what they require of the FMUs; reach: the connections they act on

The simulation:

    simulate      the time loop; recorder: rows, and the Dataset made of them; saving: contents of a checkpoint
    interrupt     Ctrl-C waits for the end of a step
    stepping      a communication step of a given size; controlled: as large as a tolerance allows
    events        the time of an event within a step
    coupled       the running FMUs of a system: exchange, advance, save, restore
    passed_on     connections to inputs that are set when their values change
    magnitudes    magnitudes of outputs, by which tolerances are relative
    initial       consistent initial values
    wiring        connections as arrays; sequence: order of the FMUs; linear: correction by derivatives

Inside, FMUs are sorted by name and connections by target, so no result depends on the order in which they are given.
"""

from ..fmu.errors import CouplingError
from .simulate import simulate
from .ssp import export_ssp
from .system import Connection, System

__all__ = ["Connection", "CouplingError", "System", "export_ssp", "simulate"]
