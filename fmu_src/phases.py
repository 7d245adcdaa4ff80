"""Phases in the life of an FMU instance."""

from enum import StrEnum


class Phase(StrEnum):
    """Phase in the life of an FMU instance."""

    NEW = "new"
    UNSETTLED = "unsettled"  # in initialisation mode, outputs older than what they depend on
    SETTLED = "settled"  # in initialisation mode, outputs up to date
    STEPPING = "stepping"
