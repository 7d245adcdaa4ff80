"""Build a component's FMU: its description for hosts, and the component itself."""

import inspect
from pathlib import Path

from fmu_src.flavours import Flavour, Version
from fmu_src.html.markup import paragraph, printed, section, table
from fmu_src.html.page import whole
from fmu_src.native.built_in import built_in
from fmu_src.native.files import binaries
from fmu_src.package.build import check, pack
from fmu_src.package.compiled import SOURCES, build_description
from fmu_src.package.describe import Model
from fmu_src.variables import Variable

from . import native, resources
from .part import Part
from .variables import variables


def build(
    part: Part,
    out: Path,
    flavour: Flavour = "isolated",
    *,
    fmi: Version = 2,
    python: str | None = None,
    duration: float = 1.0,
    step_size: float = 1e-2,
    here: bool = False,
) -> Path:
    """Write the FMU of a component to `out` and return it. The same arguments and versions give the same bytes.

    `flavour`, `fmi` and `python`: as for a contact, see `fmu_src.package.build`. `duration` and `step_size` [s] are
    proposals to its host; `here`: a native FMU for this platform only. Raises SceneError if the component's numbers
    cannot be used, it has no C or the flavour not this version of FMI, OSError if the file cannot be written or there
    is no compiler.
    """
    check(flavour, fmi)
    resources.check(part)
    listed = built_in(variables(part)) if flavour == "native" else variables(part)
    experiment = {"startTime": 0.0, "stopTime": duration, "stepSize": step_size}
    own = {
        "documentation/index.html": _page(part, listed).encode(),
        **_files(part, flavour, fmi, here),
    }
    model = Model(part.name, resources.guid(part, flavour, fmi), part.text, experiment)
    return pack(model, listed, own, out, flavour, python, fmi)


def _files(part: Part, flavour: Flavour, fmi: Version, here: bool) -> dict[str, bytes]:
    """Return name and content of what makes the component run."""
    if flavour != "native":
        return {f"resources/{name}": data for name, data in resources.files(part).items()}
    sources = native.sources(part, fmi)
    libraries = binaries(sources, fmi, part.name, here)
    if fmi == 3:
        sources["buildDescription.xml"] = build_description(sources, part.name)
    return {f"{SOURCES}{name}": data for name, data in sources.items()} | libraries


def _page(part: Part, listed: tuple[Variable, ...]) -> str:
    """Return the documentation: the docstring of the class with its equations, and the variables."""
    rows = ([v.name, v.causality, v.unit or "1", v.start if v.has_start else "", v.text] for v in listed)
    about = paragraph(part.text) + printed((inspect.getdoc(type(part)) or "").splitlines())
    variables_ = section("variables", "Variables", table(("variable", "causality", "unit", "start", "meaning"), rows))
    return whole(part.name, "Part of a machine", about + variables_)
