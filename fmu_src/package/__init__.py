"""Build an FMU: everything that happens when a package is made.

    command     the command line that builds an FMU
    build       the FMU file of a scene, or of the files of any model
    describe    what the descriptions of both versions of FMI share
    fmi2, fmi3  modelDescription.xml of FMI 2.0 and of FMI 3.0
    usable      ranges of inputs that a scene can use
    terminals   terminalsAndIcons.xml of FMI 3.0
    compiled    sources and libraries of native FMUs, buildDescription.xml
    document    documentation/index.html
    evidence    reference data: a short run to replay
    licences    required packages, their licences and environment variables

Nothing here is loaded when an FMU runs.
"""
