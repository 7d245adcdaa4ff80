"""Errors of FMUs and of systems of them."""

from contact_core.errors import ContactError


class CouplingError(ContactError):
    """An FMU that cannot be used, or a system that cannot be coupled or simulated as asked."""


class FmuError(CouplingError):
    """A file that cannot be read or unpacked as an FMU."""


class NotFiniteError(CouplingError):
    """An output that is not finite after a step; a shorter step may help."""
