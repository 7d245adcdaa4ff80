"""The page of one run."""

from fmu_src.html.page import whole

from ..charts.svg import script
from . import ensemble, errors, histories, machine, maps, origin, scene, summary, trust
from .opened import Run

_SHORT = {  # in the navigation, where the heading of a section is long
    "maps": "Maps", "profiles": "Profiles", "errors": "Errors", "scene": "As run", "modelled": "What was modelled",
    "machine": "Machine", "origin": "Versions", "ensemble": "Ensemble",
}  # fmt: skip


def page(run: Run) -> str:
    """Return the page of a run as HTML that needs no other file."""
    body = "".join(
        (
            summary.summary(run),
            ensemble.sections(run),
            histories.sections(run),
            maps.sections(run),
            machine.sections(run),
            errors.sections(run),
            trust.sections(run),
            scene.sections(run),
            origin.sections(run),
        )
    )
    kind = "Report of a contact" if run.of_contact else "Report of a machine"
    return dressed(run.title, kind, body)


def dressed(title: str, kind: str, body: str) -> str:
    """Return a page around sections of results, with the script that draws maps and reads charts."""
    return whole(title, kind, body, script(), _SHORT)
