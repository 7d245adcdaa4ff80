"""Equations of a law as text, for documentation.

Notation: Unicode; `_` and `^` start an index or exponent of one character, or of several in braces: `h_c`, `x^{1/2}`.
Equations that share a line stand three spaces apart. `fmu_src.package.document.markup` turns a line into HTML,
the page of equations into LaTeX.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Protocol


@dataclass(frozen=True)
class Equations:
    """Equations of a law, film or shape: one line each, with a note on their symbols."""

    lines: tuple[str, ...]
    note: str = ""
    title: str = ""  # where the class that carries them does not name them
    source: str = ""  # where it is not that of the class
    options: Mapping[str, Mapping[str, "Equations"]] = field(default_factory=dict)  # by option of the law and choice
    symbols: Mapping[str, str] = field(
        default_factory=dict
    )  # its own: field of the law, or "text [unit]", see `symbols`
    left_out: str = ""  # what a contact with this law does without, and what that costs


class OfShape(Protocol):
    """Equations that a kind of contact has in addition to its gap: see `geometry`."""

    deformation: ClassVar[Equations]
    load_balance: ClassVar[Equations]
    smooth_film: ClassVar[Equations]
    rolling: ClassVar[Equations]
