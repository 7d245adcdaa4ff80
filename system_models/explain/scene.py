"""The explanation of a scene: every law that it uses, every value, and where each is from."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from contact_core.laws.equations import Equations
from contact_core.laws.symbols import Symbol, explained
from contact_core.scene import Scene
from contact_core.scene.in_use import InUse, in_use
from contact_core.scene.origins import Origin, about, origins

from . import left_out, trust
from .model import Explanation, Part, Section, Value
from .wording import written

# title, and the tables of a scene that it holds
SECTIONS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("Contact", ("geometry",)),
    ("Bodies", ("solids", "surface_1", "surface_2", "plasticity")),
    ("Oil", ("lubricant",)),
    ("Film", ("film",)),
    ("Friction", ("boundary_friction",)),
    ("Heat", ("heat", "scuffing")),
    ("Tribofilm", ("tribofilm", "oxide")),
    ("Wear", ("wear", "stress", "fatigue")),
    ("Numerics", ("control",)),
    ("Duty", ("operation",)),
)
_NUMERICAL = frozenset(
    f"film.{name}" for name in ("points", "domain", "width", "tolerance", "iterations", "fft", "flux")
)


def explain(source: str | Path, overrides: Mapping[str, str] | None = None) -> Explanation:
    """Return the explanation of a scene as `Scene.from_toml` reads it, with the same arguments and errors."""
    scene = Scene.from_toml(source, overrides)
    found = origins(source, scene.to_dict(), overrides)
    sections = (_section(title, tables, scene, found) for title, tables in SECTIONS)
    return Explanation(
        scene.name,
        scene.description,
        about(source),
        trust.summary(scene),
        tuple(section for section in sections if section.parts),
        tuple(left_out.of(scene)),
        tuple(trust.sentences(scene)),
        tuple(trust.assumptions(scene)),
        tuple(trust.validity(scene)),
        tuple(trust.commands(str(source), scene)),
    )


def _section(title: str, tables: tuple[str, ...], scene: Scene, found: Mapping[str, Origin]) -> Section:
    used = {law.path: law for law in in_use(scene)}
    parts: list[Part] = []
    for table in tables:
        parts += _parts(table, getattr(scene, table), used, found)
    if title == "Film":
        governing = [_titled(shown, scene.film) for shown in scene.film.governing(scene.geometry, scene.lubricant)]
        parts = [*governing, *parts]
    if title == "Friction":
        parts = [*parts, _titled(scene.film.friction, scene.film)]
    if title == "Numerics":
        grid = _values("film", scene.film, {}, found)
        parts = [_table("film", tuple(v for v in grid if v.key in _NUMERICAL)), *parts]
    return Section(title, tuple(parts))


def _parts(path: str, record: Any, used: Mapping[str, InUse], found: Mapping[str, Origin]) -> Iterator[Part]:
    """Yield the part of a record, unless it is a law that only leaves something out, and those of the records in it."""
    law = used.get(path)
    if law is None or law.law.source or not law.equations.left_out:
        yield _part(path, record, law, found)
    for f in fields(record):
        part = getattr(record, f.name)
        if is_dataclass(part):
            yield from _parts(f"{path}.{f.name}", part, used, found)


def _part(path: str, record: Any, law: InUse | None, found: Mapping[str, Origin]) -> Part:
    choice = found.get(f"{path}.model")
    symbols = tuple(_symbols(law)) if law else ()
    values = _values(path, record, {s.field: s.symbol for s in symbols if s.field}, found)
    told = tuple(v for v in values if v.key not in _NUMERICAL)
    if law is None:
        name = getattr(record, "name", "") if choice else ""
        return Part(path, name, choice, (), "", getattr(record, "source", ""), told, ())
    options = (chosen.equations for chosen in law.chosen if chosen.equations.lines)
    return Part(path, law.law.name, choice, (law.equations, *options), law.notes, law.law.source, told, symbols)


def _table(title: str, values: tuple[Value, ...]) -> Part:
    return Part(title, "", None, (), "", "", values, ())


def _titled(shown: Equations, film: Any) -> Part:
    return Part(shown.title, "", None, (shown,), shown.note, shown.source, (), tuple(explained(shown, film)))


def _symbols(law: InUse) -> Iterator[Symbol]:
    seen = set()
    for shown in (law.equations, *(chosen.equations for chosen in law.chosen)):
        for symbol in explained(shown, law.law):
            if symbol.symbol not in seen:
                seen.add(symbol.symbol)
                yield symbol


def _values(path: str, record: Any, symbols: Mapping[str, str], found: Mapping[str, Origin]) -> Iterator[Value]:
    """Yield the values of a record that the scene's table has, but for those of records in it."""
    for f in fields(record):
        key, value = f"{path}.{f.name}", getattr(record, f.name)
        if key in found:
            said = f.metadata
            yield Value(key, symbols.get(f.name, ""), written(value, said, found[key]), said["text"], found[key])
