"""The scene and duty that commands are given."""

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.scene import Scene

from .console import add_settings, refuse_empty

if TYPE_CHECKING:
    from ..run.duty import Duty


def add_scene(command: argparse.ArgumentParser) -> None:
    """Add the arguments that name the contact and the folder of the results."""
    command.add_argument("scene", metavar="NAME", help="a shipped name (`tribofmu list`), or the path of a .toml file")
    command.add_argument("--out", metavar="DIR", help="folder of the results (default: results/NAME)")
    command.add_argument("--grid", metavar="N", help="nodes along x and y: replaces film.points")
    add_settings(command, "change values of the scene or machine, e.g. tribofilm.model=none surface_2.rq='50 nm'")


def contact(arguments: argparse.Namespace) -> "tuple[Scene, Duty]":
    """Return the scene, large enough for its duty, and the duty."""
    from ..run.duty import Duty

    scene = Scene.from_toml(arguments.scene, _overrides(arguments))
    duty = Duty.of_scene(scene, _folder_of_duty(arguments))
    return duty.sized(scene), duty


def warn(scene: Scene) -> None:
    """Print the warnings of a scene on stderr."""
    for warning in scene.warnings():
        print(f"tribofmu: warning: {warning}", file=sys.stderr)


def _overrides(arguments: argparse.Namespace) -> dict[str, str]:
    refuse_empty(arguments)
    settings = dict(arguments.settings)
    if getattr(arguments, "hours", None):
        settings["operation.duration"] = f"{arguments.hours} h"
    if arguments.grid:
        settings["film.points"] = arguments.grid
    if getattr(arguments, "duty", None):
        settings["operation.file"] = arguments.duty
    return settings


def _folder_of_duty(arguments: argparse.Namespace) -> Path:
    """Return the folder of a duty file: the working folder, or that of the scene's file."""
    if getattr(arguments, "duty", None) or not arguments.scene.endswith(".toml"):
        return Path()
    return Path(arguments.scene).parent
