"""What a master can refuse."""

from contact_core.errors import ContactError


class CouplingError(ContactError):
    """A system that cannot be coupled or simulated as asked."""
