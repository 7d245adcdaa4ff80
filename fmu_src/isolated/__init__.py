"""Isolated FMUs: the model runs in a process of its own, started by a library in C.

    library     the library in C: fmi2.c -> instance.c -> channel_*.c
    supervisor  the process that imports the model once and forks a worker for every instance (Linux)
    worker      the process of one instance: the library's messages in, calls of the slave, answers out
    message     layout of the messages
    channels    interface of a channel; Pipe, the one on Windows
    shared_memory   the channel on Linux

The worker knows only pythonfmu's interface of a slave, no contact.
"""
