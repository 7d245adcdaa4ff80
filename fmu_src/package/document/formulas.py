"""The section of equations: every record of the scene carries its own."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

from contact_core.laws.equations import Equations
from contact_core.scene import Scene
from contact_core.scene.in_use import InUse, in_use

from ...html.markup import equation, heading, paragraph, source, table


def equations(scene: Scene) -> Iterator[str]:
    """Yield the equations of level, shape and laws, with sources, and the options of the scene."""
    film = scene.film
    for shown in film.governing(scene.geometry, scene.lubricant):
        yield from _titled(shown)
    yield from _formula(Equations((), source=film.source))
    yield from _titled(film.friction)
    for used in in_use(scene):
        yield from _law(used)
    yield heading("Options, fixed when the FMU was built")
    yield table(("option", "choice", "meaning"), _options(scene))


def _titled(shown: Equations) -> Iterator[str]:
    yield heading(shown.title)
    yield from _formula(shown)


def _formula(shown: Equations, note: str = "", origin: str = "") -> Iterator[str]:
    yield from map(equation, shown.lines)
    if note or shown.note:
        yield paragraph(note or shown.note)
    if origin or shown.source:
        yield source(origin or shown.source)


def _law(used: InUse) -> Iterator[str]:
    yield heading(f"{used.path}: {used.law.name}")
    yield from _formula(used.equations, used.notes, used.law.source)
    for option, choice, shown in used.chosen:
        if shown.lines:
            yield heading(f"{used.path}.{option}: {choice}")
            yield from _formula(shown)


def _options(record: Any, path: str = "") -> Iterator[tuple[str, str, str]]:
    for f in fields(record):
        part: Any = getattr(record, f.name)
        if is_dataclass(part):
            yield from _options(part, f"{path}{f.name}.")
        elif f.metadata.get("choices"):
            yield f"{path}{f.name}", part, f.metadata["text"]
