"""One instant of a contact."""
from dataclasses import dataclass
@dataclass(frozen=True)
class Transient:
    """x"""
    dt: float
@dataclass(frozen=True)
class ContactFields:
    """x"""
def solve(scene, op, state, transient=None): ...
