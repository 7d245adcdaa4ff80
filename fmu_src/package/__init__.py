"""Build an FMU: everything that happens when a package is made.

    command     the command line that builds an FMU
    build       the FMU file of a scene, or of the files of any model
    describe    modelDescription.xml
    document    documentation/index.html
    evidence    reference data: a short run to replay
    licences    required packages, their licences and environment variables
    icon        model.png

Nothing here is loaded when an FMU runs.
"""
