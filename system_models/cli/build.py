"""The command `tribofmu build`: the FMU of a scene."""

import argparse

from fmu_src.package import command

from .scenes import refuse_machine


def add_arguments(parser: argparse.ArgumentParser) -> None:
    command.add_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Build the FMU and return the exit code."""
    refuse_machine(arguments.scene)
    return command.run(arguments)
