"""The contact core as an FMU (FMI 2.0 or 3.0 co-simulation): `MixedContact`.

    package     build time: description, documentation, licences, the file
    runtime     inside the FMU: the slave of a contact, its resources and its state
    isolated    the isolated flavour: library in C, supervisor and worker processes
    native      the native flavour: an FMU in C99 for one scene, without Python
    variables   the FMU's variables, one per value reference, from the quantity table and the scene
    phases      phases in the life of an instance
    html        pages that need no other file
    flavours    names of the flavours, and versions of FMI

Imports run one way: package -> native -> runtime, isolated -> variables, phases, flavours, html. The FMU is thin: it
carries its scene; the physics comes from the installed contact_core of the same version. A native FMU alone carries the
physics itself, as C sources.
"""


def __getattr__(name: str) -> object:
    if name == "slave":  # imported by the script in embedded FMUs of earlier builds
        raise ImportError("This FMU was built with an earlier tribofmu. Build it again.")
    raise AttributeError(name)
