"""The page: its sections in order."""

from contact_core.scene import Scene

from ...flavours import Flavour, Version
from ...html.markup import paragraph, section
from ...html.page import whole
from ...runtime.resources import MODEL
from . import contact, formulas, interface

_SYMBOLS = "The laws of this scene, each with its source. The table of parameters explains their symbols."


def documentation(scene: Scene, flavour: Flavour, reference: bool, fmi: Version = 2) -> bytes:
    """Return the page of a scene's FMU, UTF-8; `reference`: the FMU carries reference data."""
    sections = {
        "contact": ("The contact", contact.data(scene, flavour)),
        "signs": ("Signs and directions", contact.signs(scene)),
        "equations": ("Equations", [paragraph(_SYMBOLS), *formulas.equations(scene)]),
        "validity": ("Range of validity", contact.validity(scene)),
        "errors": ("Errors of the outputs", contact.errors(scene)),
        "assumed": ("What is assumed, and what it is worth", contact.assumptions(scene)),
        "steps": ("Steps", contact.steps(scene)),
        "status": ("Status, valid and range_flags", interface.status(flavour, fmi)),
        "variables": ("Variables", interface.variable_tables(scene, flavour)),
        "state": ("State", interface.state(flavour, fmi)),
        "log": ("Log", interface.log(flavour, fmi)),
        "needs": ("Requirements", interface.requirements(flavour)),
        "check": ("Check", interface.check(reference)),
        "licence": ("Licence", interface.licence(flavour, fmi)),
    }
    body = "".join(section(name, title, *parts) for name, (title, parts) in sections.items())
    short = {"assumed": "What is assumed", "status": "Status"}
    return whole(
        f"{MODEL}: {scene.name}", "Model of a contact", paragraph(scene.description) + body, short=short
    ).encode()
