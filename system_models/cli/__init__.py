"""The command `tribofmu`, a module for each of its commands.

    main        the table of commands
    listing     list: what is shipped
    new         new: a commented scene to start from
    explain     explain: laws, numbers and their sources, what is left out, what to trust
    surface_file surface-file: a measured surface made ready for a scene
    surfaces    surfaces: what a grid shows of the surfaces
    run         run: a contact or a machine through its duty; contact: one contact; machine: a machine
    ensemble    a scene with several surfaces through its duty
    report      report: a run as one HTML page
    compare     compare: runs beside each other, with their error bands
    stribeck    stribeck: Stribeck curves
    sweep       sweep: a scene with many values of its keys
    fit         fit: constants of a scene from measured numbers
    log         log: a duty and data of a rig's text log
    map         map: a scene's map for film.correction = "map"
    validate    validate: verdicts against measurements and published numbers
    build       build: the FMU of a scene
    check       check: verdicts on an FMU
    cosim       cosim: a system of FMUs
    docs        docs: the pages of the documentation
    pages       names of the pages of the documentation, the one that explains an error
    scenes      the scene and duty that commands are given
    listener    prints what runs tell
    progress    bars that say how far a long command is
    overwriting  --force, and files that are there already
    alive       keeps the bar moving while one solution takes long and kernels compile
    console     notes, the folder of the results, --set

Every module is light to import: what a command needs is loaded when it runs.
"""
