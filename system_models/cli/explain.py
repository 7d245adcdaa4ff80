"""The command `tribofmu explain`: what a scene, or the contact of a machine, is made of, and how sure it is."""

import argparse
import shutil
from dataclasses import replace
from typing import TYPE_CHECKING

from ..machines import files
from .console import add_settings

if TYPE_CHECKING:
    from ..explain.model import Explanation


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", metavar="NAME", help="a shipped scene or machine (`tribofmu list`), or the path of a .toml file"
    )
    add_settings(
        parser,
        "change values of the scene, e.g. heat.model=field lubricant.set=m100; of a machine's contact "
        "contact.heat.model=field",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print laws, equations, values with their sources, what is left out, and what to trust; return 0."""
    from ..explain.terminal import render

    settings, name = dict(arguments.settings), arguments.scene
    explanation = _contact(name, settings) if files.is_machine(name) else _scene(name, settings)
    print(render(explanation, shutil.get_terminal_size((100, 24)).columns))
    return 0


def _scene(name: str, settings: dict[str, str]) -> "Explanation":
    """Return the explanation of a scene; of an ensemble that of its first member, which says so."""
    from contact_core.scene.ensemble import members
    from contact_core.scene.toml import given

    from ..explain.scene import explain

    found = members(given(name, settings)[0])
    if found is None:
        return explain(name, settings)
    explanation = explain(name, settings | dict(found.settings[0]))
    about = f"{found.text} `tribofmu run` runs each and gives their mean with its band; this is the first of them."
    return replace(explanation, about=f"{about} {explanation.about}".rstrip())


def _contact(name: str, settings: dict[str, str]) -> "Explanation":
    """Return the explanation of the contact of a machine, with what all of the machine assumes."""
    from ..explain.scene import explain
    from ..machines import assumed
    from ..machines.reading import assemble, duty_of, read
    from ..machines.registry import kinds
    from ..machines.tables import contact_of

    machine = read(name, settings)
    scene, changes = contact_of(machine.table)
    explanation = explain(scene, changes)
    worth = assumed.worth(kinds()[machine.kind], assemble(machine), duty_of(machine))
    return replace(
        explanation,
        name=machine.name,
        description=str(machine.table["description"]),
        about=f"The contact of this machine is the scene {scene}, with what the machine's file sets. Loads, speeds, "
        "radii and temperatures of each contact are the machine's; those below are the scene's. "
        f"{explanation.about}",
        trust=(*explanation.trust, *([assumed.where(worth)] if worth else [])),
        assumed=tuple(assumed.table(worth)) if worth else (),
        commands=((f"tribofmu run {name}", "the machine, with its errors"),),
    )
