"""Check an FMU, anybody's: a verdict per rule, with its evidence.

    package    the file, opened
    static     rules that need the file only; binaries: what a shared library asks of its host
    deep       rules that run the FMU, each in processes of its own, watched for crashes and hangs, within a budget
    stages     the entry of such a process
    answers    rules on what the FMU answers; reference: on the results that it carries
    calls      rules on calls that a host should not make
    hosts      rules on what the FMU does to its host; confine: where it may write
    instance   one instance of the FMU, its calls written down; rows: outputs of runs, side by side
    start      the start values of a run, where they are not the FMU's own
    report     the printed table

What can be run is FMI 2.0 co-simulation. Of other FMUs the static rules that fit are answered.
"""
