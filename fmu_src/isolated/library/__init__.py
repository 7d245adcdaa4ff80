"""The library of isolated FMUs: C sources, binaries and their build.

    start       the script that the library runs in Python; copied into the FMU
    build       builds binaries/ from the sources
    image       reads imports and exports of a library

Sources: fmi2.c (functions of FMI 2.0: each finds its instance), instance.c (an instance on the host's side: requests,
states, worker), state.c (saved states), channel_*.c (a worker's process and the messages to it, by platform),
python_*.c (the interpreter, by platform), resources.c (folders of the FMU).
"""
