"""Check any FMU: a verdict per rule, with its evidence.

    package      the file, opened; variables: attributes of its variables
    static       the table of rules that need the file only; those on the archive and the files in it
    model_rules  rules on the model description; unit_rules: on its units; binaries: on the libraries
    deep         rules that run the FMU, each in processes of its own, watched for crashes and hangs, within a budget
    stages       the entry of such a process
    answers      rules on the answers of the FMU; derivatives: on those that it gives itself
    reference    rules on the results that it carries; related: files that its manifest names
    calls        rules on calls that a host should not make
    hosts        rules on the effects of the FMU on its host; confine: the folders that it may write to
    instance     one instance of the FMU, its calls written down; library: its library, whatever the version of FMI
    rows         outputs of runs, side by side
    start        the start values of a run, where they are not the FMU's own
    verdict      verdicts and answers; report: the printed table

Co-simulation of FMI 2.0 and 3.0 is run. For other FMUs the static rules that apply are answered.
"""
