"""What a master can refuse."""

from contact_core.errors import ContactError


class CouplingError(ContactError):
    """A system that cannot be coupled or simulated as asked."""


class NotFiniteError(CouplingError):
    """An output that is no finite number after a step: a shorter one may do better."""
