"""Machines of contacts and parts, from TOML to a report.

Each kind is a folder with its wiring, own parts, report and shipped files; `registry` lists them. The rest:

    registry        the table of kinds; kind: what a kind must provide
    files           which machines are shipped
    reading         a TOML file as an Assembly; tables: its tables as records
    timeline        the duty of a machine
    assembly        a machine's contacts, parts, connections and schedule; builds the FMUs
    plausibility    numbers that look like mistakes
    report          costs, levels, invalid rows, stored heat
    trust           what to trust of a run: lines before it on the most loaded contacts, and after it
    assumed         what the assumptions of a machine are worth: half widths of its results
    causes          errors of contacts at the end of a run, by their causes
    resolve         contact states of a finished run, solved again deterministically
    corrected       friction, film and W_c of a run corrected by these states
    coupling_error  the error that the communication steps cause
    export          a machine for tools that import SSP

Parts that several kinds use are in `parts`, the time loop is in `master`.
"""
