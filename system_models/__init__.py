"""Systems around the contact's FMU, and the command `tribofmu`.

    duty           load, speeds and temperature against time: constant, steps, or a CSV; duty_table: a CSV
    driven_contact   drives the FMU of a contact through a duty, with fmpy
    checkpoint     the point a run has reached, on disk: a killed run goes on from there
    results        the run as an xarray Dataset, as netCDF and as CSV
    report         the printed table and the overview picture
    stribeck       rubs a contact and sweeps the speed at given times; stribeck_report: its table and picture
    check/         a verdict per rule on an FMU, anybody's
    master/        couples FMUs, anybody's, and controls its own error
    cosim_command  simulates a system of FMUs from a TOML file; cosim_report: its tables and picture
    machine/       ball on disc, ball bearing, gear pair: from a TOML file to a simulation, its pictures and its report
    parts/         components of machines that are no contacts
    bearing/, gear/   what a ball bearing and a pair of spur gears are
    cli            the command line; console: what its commands share

A system sees the contact only through its scene, the quantities and the FMU; the Stribeck curves and the states that
are solved again, which go back to one state again and again, use the core itself. In a ball-on-disc scene body 1 is the
ball and body 2 the disc.
"""
