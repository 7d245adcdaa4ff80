"""Systems around the contact's FMU, and the command `tribofmu`.

Each package imports only from those below it:

    cli/        the command line, a file per command
    runs/       runs of contacts, machines and other systems: simulated, checked, judged, one call each
    html_report/ results as HTML pages: of one run, and of several beside each other
    check/      checks any FMU: a verdict per rule
    machines/   kinds of machines, a folder each: ball on disc, ball bearing, gear pair, cam and follower
    sweep/      many runs of one scene: plan, points, sensitivity, report
    validation/ answers beside measurements, published numbers, closed forms and a thesis
    explain/    what a scene is made of: laws, numbers and their sources
    run/        one contact through its duty, Stribeck curves, and what simulations report
    master/     couples any FMUs and controls its own error
    parts/      components of machines that have no contact
    instruments/ files of instruments: measured surfaces, logs of rigs
    fmu/        a running FMU of FMI 2.0 or 3.0 on the host's side
    charts/     charts as records, drawn as SVG or by matplotlib; units that people read
    numerics/   extrapolation, iteration and error control of the master, on arrays
    store/      checkpoints and results on disk

A system sees the contact only through its scene, the quantities and the FMU. The Stribeck curves and the states that
are solved again return to one state repeatedly and use the core itself. In a ball-on-disc scene body 1 is the ball and
body 2 the disc.
"""
