"""Errors by cause at the end of a run: of one contact, of each one of a machine, and by the coupling of its parts."""

import json
from collections.abc import Iterator

import numpy as np

from contact_core.assumed import HEADS, assumed, told
from contact_core.errors import ContactError
from contact_core.state import Error
from fmu_src.html.markup import Raw, folded, heading, paragraph, section, table, text

from ..charts.half_widths import SHARES
from ..charts.units import stated, unit_for
from ..machines.assumed import ATTRIBUTE as WORTH
from ..machines.coupling_error import ATTRIBUTE as COUPLING
from ..run.panels import values
from .opened import Run

CAUSES = {  # in words, by field of `Error`
    "time": "steps in time",
    "sampling": "few instants",
    "grid": "grid",
    "iteration": "early stop",
    "curves": "fitted curves",
    "inlet": "cut inlet",
}
_SHOWN = (
    "friction_coefficient", "h_c", "lambda_ratio", "contact_load_ratio", "tribofilm_1", "tribofilm_2",
    "wear_depth_1", "wear_depth_2", "roughness_1", "roughness_2", "contact_area_ratio", "damage_1", "damage_2",
)  # fmt: skip
_WORDS = {
    "h_c": "central film thickness",
    "contact_load_ratio": "load carried by solids",
    "contact_area_ratio": "contact area",
}
_WORST = 8  # errors of the coupling listed


def sections(run: Run) -> str:
    words = paragraph(
        "A half width is that of a 95 % interval: with the causes named here, the true answer of the model lies within "
        "it in 19 of 20 cases. Causes count as independent: their squares add up. What the model leaves out is not "
        "in it; see “What was modelled”."
    )
    if run.of_contact:
        return section("errors", "Errors by cause", words, *_by_cause(run, ""), *_assumed(run))
    return section("errors", "Errors by cause", words, *_of_contacts(run), *_of_coupling(run), *_of_machine(run))


def _by_cause(run: Run, contact: str) -> Iterator[str]:
    """Yield a table of a contact's errors at the end by cause, with bars of their shares."""
    causes = run.causes.get(contact, {})
    names = [name for name in _SHOWN if name in causes and run.of(contact, name) in run.dataset]
    if not names:
        yield paragraph(
            "This result does not say its errors by cause: an older version has made it, or it had no checkpoint.",
            "quiet",
        )
        return
    used = [cause for cause in CAUSES if any(causes[name].get(cause, 0.0) > 0.0 for name in names)]
    rows = []
    for name in names:
        error, variable = Error(**causes[name]), run.dataset.variables[run.of(contact, name)]
        value = float(variable.values[-1])
        unit = unit_for(variable.attrs["units"], [value])
        halves = [unit.factor * getattr(error, cause) for cause in used]
        together = unit.factor * error.together
        relative = f"{abs(error.together / value):.0%}" if value and name not in SHARES else "–"
        rows.append(
            [
                named(name),
                stated(float(unit.of(value)), together),
                unit.name or "–",
                relative,
                *(f"{half:.2g}" if half else "–" for half in halves),
                Raw(_bar([(CAUSES[cause], half**2) for cause, half in zip(used, halves, strict=True)])),
            ]
        )
    heads = ["output", "at the end", "unit", "relative", *(CAUSES[cause] for cause in used), "shares of the square"]
    yield table(heads, rows, "numbers")
    yield paragraph(_causes_in_words(used), "quiet")


def _assumed(run: Run) -> Iterator[str]:
    """Yield a table of what the scene assumes and what that is worth at its own operating point."""
    if run.scene is None or not run.scene.intervals:
        return
    try:
        rows = told(run.scene.intervals, assumed(run.scene, run.scene.operation.point))
    except ContactError:  # the regression level has no answer there
        return
    yield heading("Beside them: what the scene assumes")
    yield paragraph(
        "Each value may lie anywhere between the two that are given. What that makes of friction, film, load on the "
        "solids, wear rate and growth of tribofilm at the scene's own operating point, on new surfaces, by the "
        "regression level."
    )
    yield table(list(HEADS), [list(row) for row in rows], "numbers")


def _of_machine(run: Run) -> Iterator[str]:
    """Yield a table of what a machine assumes and what that is worth in one state of its duty."""
    found = json.loads(run.dataset.attrs.get(WORTH, "{}"))
    if found:
        head, *rows = found["rows"]
        yield heading("Beside them: what the machine assumes")
        yield paragraph(f"Each value may lie anywhere between the two that are given. {found['where']}")
        yield table(head, rows, "numbers")


_MEANING = {
    "time": "steps in time: blocks of the evolution that are not infinitely short",
    "sampling": "few instants: each block is solved at a few instants of passing roughness",
    "grid": "grid: the distance of its nodes",
    "iteration": "early stop: solutions are stopped at film.tolerance, and contacts begin and end between instants",
    "curves": "fitted curves: the regression level's distance from the deterministic level",
    "inlet": "cut inlet: film.domain ends within the inlet, which leaves the film too thin",
}


def _causes_in_words(used: list[str]) -> str:
    return f"{'; '.join(_MEANING[cause] for cause in used)}.".capitalize() if used else ""


def _bar(parts: list[tuple[str, float]]) -> str:
    total = sum(share for _, share in parts) or 1.0
    pieces = "".join(
        f'<span class="part part-{k}" style="width:{100.0 * share / total:.1f}%" '
        f'title="{text(name)}: {share / total:.0%}">{text(name) if share > 0.3 * total else ""}</span>'
        for k, (name, share) in enumerate(parts)
        if share > 0.0
    )
    return f'<span class="bar">{pieces}</span>'


def named(name: str) -> str:
    """Return the name of an output in words."""
    stem, body = (name[:-2], f", body {name[-1]}") if name[-2:] in ("_1", "_2") else (name, "")
    return _WORDS.get(stem, stem.replace("_", " ")) + body


def _of_contacts(run: Run) -> Iterator[str]:
    """Yield a table of the errors that the contacts state at the end."""
    if not run.contacts:
        return
    yield heading("At the end, as each contact states it")
    kinds = {"error_friction": "friction", "error_film": "film thickness", "error_wear": "wear"}
    rows = []
    for contact in run.contacts:
        last = [_relative(run, contact, key) for key in kinds]
        rows.append([contact, *last, _largest_causes(run, contact)])
    heads = ["contact", *kinds.values(), "mostly by"]
    yield table(heads, rows, "numbers", "Half widths relative to the value; “–”: none is stated")
    known = [contact for contact in run.contacts if run.causes.get(contact)]
    parts = [part for contact in known for part in (heading(f"Contact {contact}"), *_by_cause(run, contact))]
    if parts:
        yield folded("The causes of each output's error, contact by contact", *parts)


def _relative(run: Run, contact: str, key: str) -> str:
    """Return the relative half width of an error at the end as text."""
    name = run.of(contact, key)
    if name not in run.dataset:
        return "–"
    half = float(run.dataset.variables[name].values[-1])
    return f"{half:.0%}" if np.isfinite(half) else "not known"


def _largest_causes(run: Run, contact: str) -> str:
    """Return the causes that are the largest one of some output of a contact, in words."""
    parts = run.causes.get(contact, {}).values()
    found = dict.fromkeys(max(each, key=lambda cause: each[cause]) for each in parts if each)
    return ", ".join(CAUSES[cause] for cause in found) or "not recorded"


def _of_coupling(run: Run) -> Iterator[str]:
    """Yield the largest errors by the communication steps, if the run was checked with double steps."""
    found = []
    for name in map(str, run.dataset.data_vars):
        error = run.dataset.variables[name].attrs.get(COUPLING)
        largest = float(np.abs(values(run.dataset, name)).max()) if error is not None else 0.0
        if error is not None and largest > 0.0:
            found.append((float(error) / largest, name, float(error), run.dataset.variables[name].attrs["units"]))
    yield heading("By the coupling of the parts")
    if not found:
        yield paragraph(
            "Not checked: a machine's run without --unchecked simulates once more with double steps, and says so.",
            "quiet",
        )
        return
    found.sort(reverse=True)
    middle = float(np.median([share for share, *_ in found]))
    yield paragraph(
        f"From a simulation with double steps, relative to the largest value of each output: {middle:.2g} in the "
        f"middle of {len(found)} outputs. The largest:"
    )
    rows = [[name, f"{share:.2%}", f"{error:.3g}", unit] for share, name, error, unit in found[:_WORST]]
    yield table(["output", "relative", "error", "unit"], rows, "numbers")
