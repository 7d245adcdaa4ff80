"""The native flavour: an FMU in C99 for one scene, without Python.

    files     the files of an FMU: all sources, and the libraries built from them
    model     writes model.c, the tables of a scene's variables
    build     the sources that every FMU shares, and libraries by zig or gcc

Sources that every FMU shares: instance.c (order of calls, steps), values.c (variables), states.c (saved states),
derivatives.c (derivatives by inputs), log.c (log); fmi2.c, fmi3.c and fmi3_absent.c pass the calls of FMI on to them.
Generated for a scene: contact.c, contact.h (the equations) and model.c.
"""
