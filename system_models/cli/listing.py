"""The command `tribofmu list`: names the shipped scenes and machines."""

import argparse

from contact_core.scene.toml import shipped_scenes

from ..machines import files


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command: none."""


def run(arguments: argparse.Namespace) -> int:
    """Print name and description of everything that is shipped."""
    shipped = shipped_scenes() | files.shipped()
    width = max(map(len, shipped))
    for name, description in shipped.items():
        print(f"{name:{width}}  {description}")
    return 0
