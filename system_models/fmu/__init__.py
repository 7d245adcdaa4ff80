"""A running FMU of FMI 2.0 or 3.0, on the host's side.

    archive    the file of an FMU, read within bounds; printable: its names and messages for a terminal
    model      an FMU as its modelDescription.xml has it; attributes: what is refused in it
    instance   a running FMU: the common part of both versions of FMI
    fmi2, fmi3 the running FMU of each version; values: variables of FMI 3.0 by type, arrays as a whole
    kinds      kinds of variables, by type and variability
    loading    unpacks FMUs; library: loads their libraries
    start      starts an instance of each of several FMUs
    messages   messages of FMUs go to `logging`
    errors     errors of FMUs and of systems of them

The master runs `Instance`s; `check` calls the library of FMI 2.0 itself, to write down every call before it is made.
"""
