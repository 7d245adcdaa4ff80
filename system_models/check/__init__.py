"""Check an FMU, anybody's: a verdict per rule, with its evidence.

    package    the file, opened
    static     rules that need the file only; binaries: what a shared library asks of its host
    deep       rules that run the FMU, each in processes of its own, watched for crashes and hangs
    stages     what happens in such a process; instance: one instance of the FMU, its calls written down
    report     the printed table

What can be run is FMI 2.0 co-simulation. Of other FMUs the static rules that fit are answered.
"""
