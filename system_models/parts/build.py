"""Build a component's FMU: model description, resources and pythonfmu's binaries, in one zip."""

from pathlib import Path

from fmu_src import packages
from fmu_src.build import binaries, pack
from fmu_src.describe import Model, xml

from . import resources
from .part import Part
from .variables import variables


def build(part: Part, out: Path, duration: float = 1.0, step_size: float = 1e-2) -> Path:
    """Write the FMU of a component to `out` and return it; `duration` and `step_size` [s] are proposals to its host.

    It runs in hosts that are Python themselves. The same arguments and versions give the same bytes. Raises SceneError
    if the component's numbers cannot be used, OSError if the file cannot be written.
    """
    resources.check(part)
    experiment = {"startTime": 0.0, "stopTime": duration, "stepSize": step_size}
    model = Model(part.name, resources.guid(part), part.text, experiment)
    return pack(
        {
            "modelDescription.xml": xml(model, variables(part), "embedded"),
            "documentation/externalDependencies.txt": packages.external_dependencies("embedded"),
            **{f"documentation/licenses/{name}": text for name, text in packages.licences("embedded").items()},
            **{f"resources/{name}": data for name, data in resources.files(part).items()},
            **binaries("embedded", part.name),
        },
        out,
    )
