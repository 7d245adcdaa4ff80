"""Runs one contact through its duty, for `tribofmu run`."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError

from .console import folder_of
from .scenes import chosen, contact_of, microroughness, settings_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contact_core.scene import Scene


def run(arguments: argparse.Namespace) -> int:
    """Run the contact of a scene and return the exit code."""
    from ..runs import run_contact
    from .listener import CONSOLE

    settings = settings_of(arguments)
    scene, duty, _, assumed = contact_of(arguments, settings)
    done = run_contact(
        scene,
        folder_of(arguments.out, Path(arguments.scene).stem),
        duty,
        fields=_times(arguments.fields),
        assumed=assumed,
        about=about(scene, arguments.scene, settings),
        resume=arguments.resume,
        force=arguments.force,
        listener=CONSOLE,
    )
    return done.exit_code


def _times(given: str | None) -> int | None:
    """Return at how many times --fields keeps maps. Raises ContactError for a value that cannot be used."""
    if given is None:
        return None
    if not given.strip().isdecimal():
        raise ContactError(f"--fields = '{given}' must be a whole number of times, at least 1, such as --fields 5.")
    return int(given)


def about(scene: "Scene", source: str, settings: "Mapping[str, str]") -> list[str]:
    """Return lines on what a scene's accuracy has chosen, and on its roughness below the grid."""
    layers = microroughness(scene, source, settings)
    return [*chosen(scene), *(f"Body {body}: {text}." for body, text in enumerate(layers, 1))]
