"""The section of equations: every record of the scene carries its own."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

from contact_core.laws.equations import Equations
from contact_core.scene import Scene

from .markup import equation, paragraph, source, table


def equations(scene: Scene) -> Iterator[str]:
    """Yield the equations of level, shape and laws, with sources, and the options of the scene."""
    yield paragraph("The laws of this scene, each with its source. The table of parameters explains their symbols.")
    film = scene.film
    for shown in film.governing(scene.geometry, scene.lubricant):
        yield from _titled(shown)
    yield from _formula(Equations((), source=film.source))
    yield from _titled(film.friction)
    yield from _laws(scene)
    yield "<h3>Options, fixed when the FMU was built</h3>"
    yield table(("option", "choice", "meaning"), _options(scene))


def _titled(shown: Equations) -> Iterator[str]:
    yield f"<h3>{shown.title}</h3>"
    yield from _formula(shown)


def _formula(shown: Equations, note: str = "", origin: str = "") -> Iterator[str]:
    yield from map(equation, shown.lines)
    if note or shown.note:
        yield paragraph(note or shown.note)
    if origin or shown.source:
        yield source(origin or shown.source)


def _laws(record: Any, path: str = "") -> Iterator[str]:
    """Yield equations and source of every law of a record, and of the options that it is used with."""
    for f in fields(record):
        part: Any = getattr(record, f.name)
        if hasattr(part, "equations"):
            yield from _law(part, f"{path}{f.name}")
        if is_dataclass(part):
            yield from _laws(part, f"{path}{f.name}.")


def _law(law: Any, path: str) -> Iterator[str]:
    own: Equations = law.equations
    choices = {option: getattr(law, option) for option in own.options}
    chosen = {option: known[choices[option]] for option, known in own.options.items() if choices[option] in known}
    notes = [own.note, *(text.note for text in chosen.values() if not text.lines)]
    yield f"<h3>{path}: {law.name}</h3>"
    yield from _formula(own, " ".join(filter(None, notes)), law.source)
    for option, shown in chosen.items():
        if shown.lines:
            yield f"<h3>{path}.{option}: {choices[option]}</h3>"
            yield from _formula(shown)


def _options(record: Any, path: str = "") -> Iterator[tuple[str, str, str]]:
    for f in fields(record):
        part: Any = getattr(record, f.name)
        if is_dataclass(part):
            yield from _options(part, f"{path}{f.name}.")
        elif f.metadata.get("choices"):
            yield f"{path}{f.name}", part, f.metadata["text"]
