"""The contact core as an FMU (FMI 2.0 co-simulation): `MixedContact`.

    build       build: scene -> FMU file; main: the command line
    variables   the FMU's variables, one per value reference, from the quantity table and the scene
    describe    modelDescription.xml
    document    documentation/index.html; from markup (HTML), equations, drawings, measured (errors and costs)
    evidence    reference data: a short run to replay
    packages    what the FMU needs from outside, and licences
    icon        model.png
    resources   what lies in the FMU for the slave: scene, versions, the script that pythonfmu's binary loads
    slave       the guarded slave: callbacks in, contact_core.advance out; no physics
    loader      what pythonfmu's binary leaves behind, tidied up
    snapshot    the FMU's state as a frozen record and as bytes

The FMU is thin: it carries its scene, the physics comes from the installed contact_core of the same version.
"""

from .build import build

__all__ = ["build"]
