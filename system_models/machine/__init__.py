"""Machines of contacts and components, from TOML to a report.

    files        which are shipped, in `systems/`; reading: a TOML as an Assembly
    assembly     a machine's contacts, components, connections and schedule
    ball_on_disc, ball_bearing, gear_pair   the kinds of machines: what each of them consists of (`assemble`);
                 `<kind>_report`, what each of them says: tables and pictures
    timeline     the duty of a machine
    command      what `tribofmu run` does with one; report: its costs
    resolve      contact states of a finished run, solved again deterministically
    coupling_error   what its communication steps do to its outputs
    export       for tools that import SSP

Components are in `parts`, bearings and gears as such in `bearing` and `gear`, the time loop in `master`.
"""
