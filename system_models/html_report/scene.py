"""The scene as it was run, and what was modelled and what was not."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

from contact_core.errors import SceneError
from contact_core.laws import SLOTS
from contact_core.scene import Scene
from contact_core.scene.units import parse
from fmu_src.html.markup import Raw, bullets, equation, folded, heading, paragraph, section, source, table, text

from ..charts.units import unit_for
from ..explain import left_out
from .opened import Run

_SYMBOL = "equations"  # what every law has


class Slot(NamedTuple):
    """A law in use, or one that does nothing."""

    path: str
    law: Any

    @property
    def active(self) -> bool:
        """False for a slot of physics that is switched off: its law has no source, as it says nothing."""
        return bool(self.law.source) or self.path.rpartition(".")[2] not in SLOTS

    @property
    def words(self) -> str:
        """What the law does, in a sentence."""
        sentence = (type(self.law).__doc__ or "").splitlines()[0].split(". ")[0]
        return sentence if sentence.endswith(".") else f"{sentence}."


def sections(run: Run) -> str:
    """Return both sections."""
    if run.machine:
        return _of_machine(run)
    if not run.of_contact:
        return ""
    given = section(
        "scene", "The scene as it was run", _name(run.scene_table), *_tables(run.scene_table), *_assumed(run)
    )
    return given + modelled(run.scene)


def modelled(scene: Scene | None) -> str:
    """Return what was modelled and what was not, with sources; nothing if the scene cannot be made again."""
    if scene is None:
        return ""
    on = [each for each in (Slot("film", scene.film), *_slots(scene)) if each.active]
    rows = [
        [
            each.path,
            each.law.name,
            each.words,
            Raw(source(each.law.source).replace("Source: ", "", 1) if each.law.source else "–"),
        ]
        for each in on
    ]
    without = [[each.key, each.value or "–", each.cost] for each in left_out.of(scene)]
    warnings = scene.warnings()
    return section(
        "modelled",
        "What was modelled, and what was not",
        table(["part of the model", "law", "in short", "source"], rows, "laws"),
        folded("Equations", *(_equations(each) for each in on)),
        heading("Left out"),
        table(["part of the model", "choice", "what is left out, and what that costs"], without, "laws"),
        *((heading("Not resolved well"), bullets(warnings)) if warnings else ()),
    )


def _slots(record: Any, path: str = "") -> Iterator[Slot]:
    """Yield every law of a record and of the records in it."""
    for f in fields(record):
        part: Any = getattr(record, f.name)
        if hasattr(part, _SYMBOL) and f.name != "film":
            yield Slot(f"{path}{f.name}", part)
        if is_dataclass(part):
            yield from _slots(part, f"{path}{f.name}.")


def _equations(slot: Slot) -> str:
    shown = getattr(slot.law, _SYMBOL, None)
    if shown is None or not shown.lines:
        return ""
    note = paragraph(shown.note, "quiet") if shown.note else ""
    return f"<h4>{text(slot.path)}: {text(slot.law.name)}</h4>{''.join(map(equation, shown.lines))}{note}"


def _name(table_: Mapping[str, Any]) -> str:
    return paragraph(f"{table_['name']}: {table_['description']}")


def _tables(scene: Mapping[str, Any]) -> Iterator[str]:
    """Yield the tables of a scene, the duty and the bodies first."""
    first = ("operation", "geometry", "solids", "surface_1", "surface_2", "lubricant")
    names = [*first, *(name for name in scene if name not in first)]
    blocks = []
    for name in names:
        if isinstance(scene.get(name), Mapping):
            rows = list(_rows(scene[name]))
            blocks.append(f"<div>{table([name.replace('_', ' '), ''], rows, 'given')}</div>")
    yield f'<div class="given-tables">{"".join(blocks)}</div>'


def _rows(part: Mapping[str, Any], path: str = "") -> Iterator[list[object]]:
    for key, value in part.items():
        if isinstance(value, Mapping):
            yield from _rows(value, f"{path}{key}.")
        elif isinstance(value, list):
            if value:
                yield [f"{path}{key}", f"{len(value)} entries"]
        elif value != "":
            yield [f"{path}{key}", readable(value)]


def readable(value: object) -> str:
    """Return a value of a scene as people write it: "8e-06 m" is "8 µm"."""
    if isinstance(value, float):
        return f"{value:.6g}"
    if not isinstance(value, str):
        return str(value)
    number, _, si = value.partition(" ")
    try:
        found = parse(value, si, "")
    except (SceneError, ValueError):
        return value
    unit = unit_for(si, [found])
    return f"{float(unit.of(found)):.6g} {unit.name}".rstrip() if number else value


_ASSUMED = {  # kinds of `Assumed`: in words
    "assumed": "physics",
    "numerical": "of how it is solved",
    "off": "switched off",
}


def _assumed(run: Run) -> Iterator[str]:
    """Yield the values that the scene has left to defaults."""
    yield heading("Assumed: what the scene does not say")
    if run.assumed is None:
        yield paragraph("This result does not say it: an older version has made it.", "quiet")
    elif not run.assumed:
        yield paragraph("Nothing: the scene gives every value itself.")
    else:
        rows = [[each.key, _ASSUMED.get(each.kind, each.kind), each.value or "–", each.why] for each in run.assumed]
        yield table(["key", "kind", "value taken", "why"], rows, "laws")


def _of_machine(run: Run) -> str:
    """Return both sections of a machine: its parts, and the laws of its contacts' scene."""
    assert run.machine is not None
    assembly = run.machine.assembly
    scenes: dict[str, tuple[Scene, list[str]]] = {}
    for name, contact in assembly.contacts.items():
        scenes.setdefault(repr(contact.scene.to_dict()), (contact.scene, []))[1].append(name)
    rows = [
        [name, type(part).__name__, (type(part).__doc__ or "").splitlines()[0]] for name, part in assembly.parts.items()
    ]
    tables = []
    for scene, names in scenes.values():
        table_ = scene.to_dict()
        tables.append(folded(f"Scene of {', '.join(names)}", _name(table_), *_tables(table_)))
    given = section(
        "scene",
        "The machine as it was run",
        table(["part", "kind", "what it is"], rows),
        *tables,
        *_assumed(run),
    )
    return given + modelled(next(iter(scenes.values()))[0])
