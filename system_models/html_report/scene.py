"""The scene as it was run, and what was modelled and what was not."""

from collections.abc import Iterator, Mapping
from typing import Any

from contact_core.errors import SceneError
from contact_core.laws import SLOTS
from contact_core.scene import Scene
from contact_core.scene.in_use import InUse, in_use
from contact_core.scene.units import parse
from fmu_src.html.markup import Raw, bullets, folded, heading, linked, paragraph, section, table
from fmu_src.package.document.formulas import equations

from ..charts.units import unit_for
from ..explain import left_out
from .opened import Run


def sections(run: Run) -> str:
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
    laws = [InUse("film", scene.film, ()), *(used for used in in_use(scene) if used.path != "film")]
    on = [used for used in laws if used.law.source or used.path.rpartition(".")[2] not in SLOTS]
    rows = [[used.path, used.law.name, _words(used.law), _source(used.law)] for used in on]
    without = [[each.key, each.value or "–", each.cost] for each in left_out.of(scene)]
    warnings = scene.warnings()
    return section(
        "modelled",
        "What was modelled, and what was not",
        table(["part of the model", "law", "in short", "source"], rows, "laws"),
        folded("Equations", *equations(scene)),
        heading("Left out"),
        table(["part of the model", "choice", "what is left out, and what that costs"], without, "laws"),
        *((heading("Not resolved well"), bullets(warnings)) if warnings else ()),
    )


def _words(law: Any) -> str:
    """Return what a law does, in a sentence."""
    sentence = (type(law).__doc__ or "").splitlines()[0].split(". ")[0]
    return sentence if sentence.endswith(".") else f"{sentence}."


def _source(law: Any) -> str:
    return Raw(linked(law.source) if law.source else "–")


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
        "scene", "The machine as it was run", table(["part", "kind", "what it is"], rows), *tables, *_assumed(run)
    )
    return given + modelled(next(iter(scenes.values()))[0])
