"""Laws that other installed packages offer, by entry points of the group `tribofmu.laws.` and the slot.

Name: that of the law; value: its class, such as mcewen = "my_oil:McEwen" in the group tribofmu.laws.viscosity.
"""

from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

from ..entry_points import offered
from ..errors import SceneError
from . import SLOTS, base
from .base import Law

_GROUP = "tribofmu.laws."


def laws_of(slot: str) -> tuple[type[Law], ...]:
    """Return the laws of a slot, those of other packages last; none if there is no such slot.

    Raises SceneError if a package offers what cannot be used as a law.
    """
    return (*SLOTS.get(slot, ()), *of_others().get(slot, ()))


@cache
def of_others() -> dict[str, tuple[type[Law], ...]]:
    """Return the laws that other packages offer, by slot; searched once in a process. May raise SceneError."""
    found = {}
    for group, laws in offered(_GROUP).items():
        slot = group.removeprefix(_GROUP)
        if slot not in SLOTS:
            raise SceneError(f"A package offers laws as {group}, but laws have no slot '{slot}'. Known are {_known()}.")
        for name, law in laws.items():
            _check(slot, name, law)
        found[slot] = tuple(laws.values())
    return found


def _protocol(slot: str) -> type:
    """Return what a law of a slot must have: the Protocol of its name, of load sharing only what all laws have."""
    found: type = getattr(base, slot.title().replace("_", ""), Law)
    return found


def _known() -> str:
    return ", ".join(f"{_GROUP}{slot}" for slot in SLOTS)


def _check(slot: str, name: str, law: Any) -> None:
    """Raise SceneError if `law` cannot be used as the law `name` of a slot."""
    place = f"The law '{name}' of {_GROUP}{slot}"
    if not (isinstance(law, type) and is_dataclass(law)):
        raise SceneError(f"{place} must be a frozen dataclass, not {law!r}.")
    if missing := lacking(slot, law):
        raise SceneError(
            f"{place} has no {', '.join(missing)}. contact_core/laws/base.py says what each is: "
            f"{_protocol(slot).__name__}."
        )
    if law.name != name:  # type: ignore[attr-defined]
        raise SceneError(f"{place} calls itself '{law.name}'. Give both the same name.")  # type: ignore[attr-defined]
    if name in {own.name for own in SLOTS[slot]}:
        raise SceneError(f"{place} has the name of a law of tribofmu. Choose another one.")


def lacking(slot: str, law: type) -> list[str]:
    """Return the attributes and methods that a law of the slot must have and this class has not."""
    asked = {
        name
        for part in _protocol(slot).__mro__
        if part.__module__ == base.__name__
        for name in (*vars(part), *vars(part).get("__annotations__", {}))
        if not name.startswith("_") or name == "__call__"
    }
    given = {f.name for f in fields(law)}.union(*(vars(part) for part in law.__mro__))
    return sorted(asked - given)
