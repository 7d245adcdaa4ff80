"""The equations of all laws, levels and shapes, and those of closed forms and machines, as a page.

python -m docs._extensions.equations > docs/equations.md
"""

import inspect
import re
from collections.abc import Iterator
from dataclasses import fields
from types import SimpleNamespace
from typing import Any

from contact_core.film import FILMS
from contact_core.laws import SLOTS
from contact_core.laws.asperity_layer import AsperityLayer
from contact_core.laws.equations import Equations
from contact_core.laws.symbols import explained
from contact_core.scene import SelfAffine, Surface
from contact_core.scene.records import Lubricant
from contact_core.shapes import GEOMETRIES
from docs._extensions.formulas import sections
from docs._extensions.latex import latex
from fmu_src.html.markup import inline

_DOI = re.compile(r"doi:(10\.\d+/[^\s,;]+)")
# heading and key of the slot in a scene
_SLOTS = {
    "viscosity": ("Viscosity", "lubricant.viscosity"),
    "density": ("Density", "lubricant.density"),
    "rheology": ("Shear of the film", "lubricant.rheology"),
    "supply": ("Supply of oil", "lubricant.supply"),
    "double_layer": ("Electric double layers", "lubricant.double_layer"),
    "plasticity": ("Hardness", "plasticity"),
    "boundary_friction": ("Friction of solids", "boundary_friction"),
    "heat": ("Temperatures in the contact", "heat"),
    "bulk": ("Bulk temperatures", "heat.bulk"),
    "tribofilm": ("Tribofilm", "tribofilm"),
    "wear": ("Wear", "wear"),
    "oxide": ("Oxide", "oxide"),
    "stress": ("Stresses below the surfaces", "stress"),
    "fatigue": ("Fatigue", "fatigue"),
    "scuffing": ("Scuffing", "scuffing"),
    "sharing": ("Load sharing at the regression level", "film.sharing"),
    "profile": ("Profiles of rollers", "geometry.profile"),
}
_OF_SHAPE = ("deformation", "load_balance", "smooth_film", "rolling")
_INTRODUCTION = """# Equations

Every law that a scene may choose: its equations, symbols, units and source, and what a contact does without where it
is off. Behind them stand formulas of [Hertz's contacts](#hertzs-contacts), [films](#films-of-smooth-bodies),
[bearings](#ball-bearings), [gears](#gears), [cams](#cams) and [other parts](#parts-of-machines), as the functions that
compute them state them.
The page is written from the code (`python -m docs._extensions.equations > docs/equations.md`), and tests hold the
laws against the equations as they stand here. `tribofmu explain SCENE` shows those of one scene, with its numbers. What
goes beyond laws, methods and outputs, is in [physics](physics.md); symbols that laws share are in the
[glossary](glossary.md#symbols). All is in SI.
"""


def page() -> str:
    """Return the page: Markdown, equations in blocks of LaTeX, symbols as HTML."""
    lines = [_INTRODUCTION]
    lines += ["## Bodies: `geometry.model`", ""]
    for geometry in GEOMETRIES:
        lines += [*_law(geometry), *_titled(geometry, *(getattr(geometry, name) for name in _OF_SHAPE))]
    lines += ["## Roughness: `surface_1.model`, `surface_2.model`", "", *_law(Surface), *_law(SelfAffine)]
    lines += ["## Roughness below the grid: `surface_1.microroughness`", "", *_law(AsperityLayer)]
    lines += ["## Film: `film.model`", "", *_films()]
    for slot, laws in SLOTS.items():
        title, key = _SLOTS[slot]
        lines += [f"## {title}: `{key}.model`", ""]
        for law in laws:
            lines += _law(law)
    lines += sections()
    return "\n".join(lines).rstrip() + "\n"


def _law(law: Any) -> Iterator[str]:
    """Yield the section of a law: what it is, equations, symbols, what it leaves out, source and place."""
    yield f"### `{law.name}`"
    yield ""
    yield _summary(law)
    yield ""
    yield from _equations(law.equations, law)
    for option, choices in law.equations.options.items():
        for choice, shown in choices.items():
            if shown.lines:
                yield f'With `{option} = "{choice}"`:'
                yield ""
                yield from _equations(shown, law)
            elif shown.note:
                yield f"- {shown.note}"
        yield ""
    if thinning := getattr(law, "inlet_thinning", None):
        yield from _titled(law, thinning)
    yield f"{_source(law.source)} `{law.__module__.replace('.', '/')}.py`, `{law.__name__}`".strip()
    yield ""


def _summary(law: Any) -> str:
    """Return what the first line of a class's docstring says of it."""
    return _plain((inspect.getdoc(law) or "").partition("\n")[0].partition(" Methods as in")[0])


def _titled(law: Any, *shown: Equations) -> Iterator[str]:
    for each in shown:
        yield f"{each.title}:"
        yield ""
        yield from _equations(each, law)


def _equations(shown: Equations, law: Any) -> Iterator[str]:
    for line in shown.lines:
        yield f"```math\n{latex(line)}\n```"
        yield ""
    if shown.note:
        yield _plain(shown.note)
        yield ""
    own = [s for s in explained(shown, law) if s.field or s.symbol in shown.symbols]
    if own:
        yield "| symbol | unit | meaning | field |"
        yield "|---|---|---|---|"
        for s in own:
            yield f"| {inline(s.symbol)} | {s.unit or '1'} | {_plain(s.text)} | {f'`{s.field}`' if s.field else ''} |"
        yield ""
    if shown.left_out:
        yield f"Left out: {shown.left_out}"
        yield ""
    if shown.source:
        yield _source(shown.source)
        yield ""


def _films() -> Iterator[str]:
    """Yield the equations of the levels that differ, of a circular contact; those of shapes are above."""
    above = {shown.title for geometry in GEOMETRIES for shown in (getattr(geometry, name) for name in _OF_SHAPE)}
    choices = next(f.metadata["choices"] for f in fields(Lubricant) if f.name == "cavitation")
    told: set[tuple[str, ...]] = set()
    for film in FILMS:
        yield f"### `{film.name}`"
        yield ""
        yield _summary(film)
        yield ""
        for shown in (*_governing(film, choices), film.friction):
            if shown.title not in above and shown.lines not in told:
                told.add(shown.lines)
                yield from _titled(film, shown)
        yield f"{_source(film.source)} `{film.__module__.replace('.', '/')}.py`, `{film.__name__}`"
        yield ""


def _governing(film: Any, cavitations: tuple[str, ...]) -> Iterator[Equations]:
    criteria = next((f.metadata["choices"] for f in fields(film) if f.name == "criterion"), ("",))
    for criterion in criteria:
        options = {"criterion": criterion} if criterion else {}
        needed = {name: value for name, value in (("points", 65), ("domain", 1e-3), ("floor", 1e-9))}
        for cavitation in cavitations:
            oil = SimpleNamespace(cavitation=cavitation, flow="newtonian")
            yield from film(**needed, **options).governing(GEOMETRIES[0], oil)


def _source(text: str) -> str:
    """Return a source with links to its DOIs, or an empty text."""
    words, *rest = _DOI.split(text)
    linked = _plain(words)
    for doi, following in zip(rest[::2], rest[1::2], strict=True):
        linked += f"[doi:{doi}](https://doi.org/{doi}){_plain(following)}"
    return f"Source: {linked}." if text else ""


def _plain(text: str) -> str:
    """Return text in which Markdown marks nothing up."""
    return text.replace("*", r"\*").replace("|", r"\|")


if __name__ == "__main__":
    print(page(), end="")
