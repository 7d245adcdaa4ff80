"""The native flavour: an FMU in C99 for one scene, without Python.

    files      the files of an FMU: all sources, and the libraries built from them
    program    the step of one scene, and contact.c, contact.h and slopes.c written from it
    calls      contact.h, and its functions, which call what was written
    translate  from Python to C99, with everything known of a scene put in
    tables     tables.h: numbers of the elementary functions
    model      writes model.c, the tables of a scene's variables
    level      the level of a scene that has none without a solver
    built_in   variables as hosts see them: parameters with one value
    names      names of variables in C
    keeping    what takes long to make is kept for later runs
    build      the sources that every FMU shares, and libraries by zig or gcc

Sources that every FMU shares: instance.c (order of calls, steps), values.c (variables), states.c (saved states),
derivatives.c (derivatives by inputs), log.c (log), elementary.h (exp, log, powers), elementary_arrays.h (two of them
at a time); fmi2.c, fmi3.c and fmi3_absent.c pass the calls of FMI on to them. With stresses also normal.h (quantiles).
Generated for a scene: contact.c, slopes.c and contact.h (the equations; `contact_step` is `program.step`, written by
`calls.calling`), tracks.c (track lengths, in which contacts of the same equations may differ), tables.h and model.c.
"""
