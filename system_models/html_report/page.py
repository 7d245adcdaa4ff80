"""The page of one run."""

import re
from importlib.resources import files
from string import Template

from . import ensemble, errors, histories, machine, maps, origin, scene, summary, trust
from .markup import text
from .opened import Run

_HEADING = re.compile(r'<section id="([\w-]+)"><h2>(.*?)</h2>')

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
    return whole(run.title, kind, body)


def whole(title: str, kind: str, body: str) -> str:
    """Return a page around sections: head, style, navigation and script."""
    here = files(__package__)
    links = "".join(f'<a href="#{name}">{_SHORT.get(name, words)}</a>' for name, words in _HEADING.findall(body))
    return Template(here.joinpath("page.html").read_text("utf-8")).substitute(
        title=text(title),
        kind=text(kind),
        links=links,
        body=body,
        style=here.joinpath("style.css").read_text("utf-8"),
        script=here.joinpath("viewer.js").read_text("utf-8"),
    )
