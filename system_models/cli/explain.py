"""The command `tribofmu explain`: what a scene is made of, and how sure it is."""

import argparse
import shutil

from .console import add_settings
from .scenes import refuse_machine


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("scene", metavar="NAME", help="a shipped scene (`tribofmu list`), or the path of a .toml file")
    add_settings(parser, "change values of the scene, e.g. heat.model=field lubricant.set=m100")


def run(arguments: argparse.Namespace) -> int:
    """Print laws, equations, values with their sources, what is left out, and what to trust; return 0."""
    from ..explain.scene import explain
    from ..explain.terminal import render

    refuse_machine(arguments.scene)
    explanation = explain(arguments.scene, dict(arguments.settings))
    print(render(explanation, shutil.get_terminal_size((100, 24)).columns))
    return 0
