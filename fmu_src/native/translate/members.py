"""Members of the structs that C functions return: those that nothing reads are left out in a second translation."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from .results import fields_of
from .values import Num, replaced

_UNREAD = "unread_"  # stands, with a number, for a member that nothing reads in the end


class Members:
    """Which members are read; `reads`: of the structs of functions, where that is known."""

    def __init__(self, reads: Mapping[Any, set[str]]) -> None:
        self._reads = reads
        self._unread: list[tuple[Any, str]] = []  # what a function is made from, and a member that nothing reads
        self.keys: dict[str, Any] = {}  # what the functions are made from, by their names

    def wanted(self, texts: Sequence[str], entries: Sequence[str]) -> dict[Any, set[str]]:
        """Return the members that anything reads of the structs of functions, by what these are; of `entries` all."""
        found: dict[Any, set[str]] = {}
        for text in texts:
            for name in re.findall(r"(?<=[;{}])\n +(\w+)\(", text):  # calls whose results nothing reads
                if name in self.keys:
                    found.setdefault(self.keys[name], set())
            for struct, name in re.findall(r"const struct (\w+)\s+(\w+)\s+=", text):
                if struct in self.keys:
                    found.setdefault(self.keys[struct], set()).update(re.findall(rf"\b{name}\.(\w+)", text))
        for entry in entries:
            found.pop(self.keys.get(entry), None)
        return found

    def missed(self, texts: Sequence[str]) -> list[tuple[Any, str]]:
        """Return what a function is made from and the member, of members marked as unread that texts read after all."""
        return [self._unread[int(place)] for text in texts for place in set(re.findall(rf"\b{_UNREAD}(\d+)", text))]

    def marked(self, name: str, template: Any, names: list[str]) -> Any:
        """Return the form of a result in which members that nobody reads are marked."""
        if self.keys[name] not in self._reads:
            return template
        fields, key = iter(fields_of(template, names)), self.keys[name]

        def unread(hole: Num) -> Num:
            field = next(fields)
            if hole.text or "[" in hole.kind or field in self._reads[key]:
                return hole
            self._unread.append((key, field))
            return Num(f"{_UNREAD}{len(self._unread) - 1}", hole.kind)

        return replaced(template, unread)
