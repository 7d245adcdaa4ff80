"""Where the numbers come from: sources, versions, digests, and how to get them again."""

import json
import platform
from collections.abc import Iterator
from datetime import UTC, datetime
from importlib.metadata import version

import contact_core
from fmu_src.html.markup import folded, heading, paragraph, section, table

from .opened import Run

_PACKAGES = ("numpy", "scipy", "numba", "xarray", "netCDF4", "fmpy")


def sections(run: Run) -> str:
    return section("origin", "Versions and digests", *_digests(run), *_versions(run), *_again(run))


def _digests(run: Run) -> Iterator[str]:
    rows = [[name, digest] for name, digest in run.files.items()]
    if run.scene:
        rows.append(["scene (bodies and grid)", run.scene.digest()])
    if "duty" in run.dataset.attrs:
        rows.append(["duty", run.dataset.attrs["duty"]])
    yield table(["file or record", "SHA-256 or fingerprint"], rows, "digests")
    fmus = json.loads(run.dataset.attrs.get("simulation_json", "{}")).get("sha256", {})
    if fmus:
        yield folded(f"FMUs of the simulation ({len(fmus)})", table(["FMU", "SHA-256"], fmus.items(), "digests"))


def _versions(run: Run) -> Iterator[str]:
    attributes = run.dataset.attrs
    simulated = json.loads(attributes.get("simulation_json", "{}")).get("versions", {})
    made = attributes.get("tribofmu_version") or simulated.get("tribofmu", "not recorded")
    rows = [["tribofmu that made the result", made]]
    rows += [[f"{name} that made the result", each] for name, each in simulated.items() if name != "tribofmu"]
    rows.append(["tribofmu that made this page", contact_core.__version__])
    rows += [[f"{name} of this page", version(name)] for name in _PACKAGES]
    rows.append(["Python of this page", platform.python_version()])
    rows.append(["page written (UTC)", datetime.now(UTC).strftime("%Y-%m-%d %H:%M")])
    yield heading("Versions")
    yield table(["what", "version"], rows, "digests")


def _again(run: Run) -> Iterator[str]:
    yield heading("The numbers themselves")
    yield paragraph(
        "result.nc has every row and every map in SI units, with a text, a unit and the half width of the error for "
        "each variable; result.csv has the rows. In Python: xarray.open_dataset('result.nc')."
    )
    if run.of_contact:
        yield paragraph(
            "The whole scene is in the attribute scene_json; contact_core.Scene.from_dict(json.loads(...)) "
            "makes it again."
        )
