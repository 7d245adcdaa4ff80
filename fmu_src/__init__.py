"""The contact core as an FMU (FMI 2.0 co-simulation): `MixedContact`.

    command     the command line that builds an FMU
    flavours    their names
    build       build: scene -> FMU file; pack: the files of any model -> FMU file
    variables   the FMU's variables, one per value reference, from the quantity table and the scene
    describe    modelDescription.xml
    document    documentation/index.html; from markup (HTML), equations, drawings, measured (errors and costs)
    evidence    reference data: a short run to replay
    packages    what the FMU needs from outside, and licences
    icon        model.png
    resources   what lies in the FMU for the slave: scene, versions, the script that makes the slave
    guarded     a slave that raises nothing to its host; slave: the contact's, callbacks in, contact_core.advance out
    snapshot    the FMU's state as a frozen record and as bytes

Embedded, pythonfmu's binary runs the slave inside its host:

    loader      what that binary leaves behind, tidied up

Isolated, a library of our own lets another process run it:

    native/     the library: fmi2.c -> instance.c -> channel_*.c; message.h: what is said; build.py: how it is made
    supervisor  the process that imports the model once and forks a worker for every instance (Linux)
    worker      the process of one instance: the library's messages in, calls of the slave, answers out

The FMU is thin: it carries its scene, the physics comes from the installed contact_core of the same version.
"""
