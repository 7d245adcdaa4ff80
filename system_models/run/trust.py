"""What to trust of a run: lines before it on the contact, and after it on columns, errors and limits."""

import math
import shutil
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from contact_core.film.inlet_loss import inlets_before, inlets_for
from contact_core.film.lengths import inlet_length
from contact_core.quantities import UNSOLVED
from contact_core.scene import Case, OperatingPoint, Scene
from contact_core.scene.hertz_grid import POINTS
from contact_core.state import Error

from . import assumed, flags, grown, verdict
from .duty import Duty

_MOST_POINTS = 200  # of a duty that are looked at
_MIXED, _FULL = 1.0, 3.0  # lambda of handbooks, from which on lubrication is called mixed, and full film
_DECIDES = 2.0  # lambda below which roughness below the grid decides on friction
_FEW = 8.0  # nodes across the contact, below which RangeFlag.FEW_NODES is raised
_WIDE, _WAVES = 5.0, 8.0  # half widths of the contact and correlation lengths, that a domain should have
_MISSING, _LEFT = 0.06, 0.02  # missing parts of the film: more than the first is printed, the way out leaves the second
_ROUND = 0.01  # relative difference of the contact's half widths up to which one is printed
_SHORT, _LONG = 60, 120  # columns of text

_LEGEND = {  # heading of the table: its meaning
    "h_c": "mean film over the inner 2/3 of the contact",
    "lambda": "h_c / present roughness, not that of handbooks",
    "tribofilm, wear": "means over the track of body 1, 2",
    "A_c, W_c": "the solids' share of Hertz's area, of the load",
}


def before(scene: Scene, duty: Duty) -> list[str]:
    """Return lines on the contact of a duty: pressure, size, motion, film of smooth bodies, regime, grid."""
    cases = [Case.bind(scene, op) for op in _some(duty.points) if op.load > 0.0]
    if not cases:
        return ["Contact: no load, the bodies just touch."]
    return wrapped(*described(cases), *_grid(scene, cases), *_inlet(scene, cases), *_below_the_grid(scene, cases))


def described(cases: Sequence[Case]) -> list[str]:
    """Return sentences on contacts under load: pressure and size, motion, film of smooth bodies and regime."""
    return [_contact(cases), _motion(cases), _film(cases)]


def _some(points: Sequence[OperatingPoint]) -> list[OperatingPoint]:
    """Return at most so many different points, evenly spread, with those of least and most load and speed."""
    different = list(dict.fromkeys(points))
    step = max(1, math.ceil(len(different) / _MOST_POINTS))
    ends = (f(different, key=key) for f in (min, max) for key in (_load, _speed))
    return [*different[::step], *ends]


def _load(op: OperatingPoint) -> float:
    return op.load


def _speed(op: OperatingPoint) -> float:
    return abs(op.entrainment_speed)


def _contact(cases: Sequence[Case]) -> str:
    shapes = [case.hertz for case in cases]
    size = f"half width {span((1e6 * h.a for h in shapes), 'um')}"
    if not cases[0].shape.periodic and any(abs(h.b / h.a - 1.0) > _ROUND for h in shapes):
        along, across = (span(1e6 * getattr(h, axis) for h in shapes) for axis in "ab")
        size = f"half widths {along} um along, {across} um across"
    largest, mean = (span(1e-9 * getattr(h, name) for h in shapes) for name in ("pressure_max", "pressure_mean"))
    return f"Contact: Hertz pressure {largest} GPa (mean {mean} GPa), {size}."


def _motion(cases: Sequence[Case]) -> str:
    ratios = [100.0 * case.op.sliding_speed / case.op.entrainment_speed for case in cases if case.entrained]
    slides = f"slide-to-roll ratio {span(ratios, '%')}" if ratios else "which brings no oil in"
    return f"Motion: entrainment speed {span((case.op.entrainment_speed for case in cases), 'm/s')}, {slides}."


def _film(cases: Sequence[Case]) -> str:
    films = [case.conventional_film for case in cases]
    rough = math.hypot(*(side.surface.rms for side in cases[0].sides))
    if not any(films):
        return "Film: none by formula, as nothing brings oil in: dry contact."
    text = f"Film: {span((1e9 * film for film in films), 'nm')} by formula for smooth bodies"
    if rough == 0.0:
        return f"{text}, as these are: full film."
    ratios = [film / rough for film in films]
    return (
        f"{text}; roughness {1e9 * rough:.3g} nm; so lambda of handbooks is {span(ratios)}: by its limits "
        f"{regime(min(ratios), max(ratios))}."
    )


def regime(least: float, most: float) -> str:
    """Return the lubrication regime in a word, or from one to another."""
    first, last = (_word(ratio) for ratio in (least, most))
    return first if first == last else f"{first} to {last}"


def _word(ratio: float) -> str:
    if ratio < _MIXED:
        return "boundary lubrication"
    return "mixed lubrication" if ratio < _FULL else "full film"


def _inlet(scene: Scene, cases: Sequence[Case]) -> list[str]:
    """Return a line on a domain that cuts the inlet off, with the way out."""
    if scene.film.fidelity in UNSOLVED:
        return []
    worst = max(cases, key=lambda case: case.missing_film)
    if worst.missing_film <= _MISSING:
        return []
    before = inlets_before(0.5 * scene.film.domain, worst.hertz.a, worst.shape, worst.smooth_film)
    domain = _flooded(cases)
    nodes = (scene.film.points - 1) * domain / scene.film.domain
    points = next((each for each in POINTS if each > nodes), POINTS[-1])
    return [
        f"Inlet: film.domain ends {before:.2g} lengths of the inlet before the contact: its film comes out too thin, "
        f"by up to {100.0 * worst.missing_film / (1.0 + worst.missing_film):.2g} %; its error holds that. Take --set "
        f"film.domain='{1e3 * domain:.2g} mm' --grid {points}."
    ]


def _flooded(cases: Sequence[Case]) -> float:
    """Return the length [m] of a domain that cuts the inlet of no case off; 0 if nothing brings oil in."""
    halves = (
        case.hertz.a + inlets_for(_LEFT, case.shape) * inlet_length(case.hertz.a, case.shape, case.smooth_film)
        for case in cases
        if case.entrained
    )
    return 2.0 * max(halves, default=0.0)


def _below_the_grid(scene: Scene, cases: Sequence[Case]) -> list[str]:
    """Return a line on roughness below the grid that a scene does not give, with its effect, where it matters."""
    bare = [f"surface_{i}" for i, s in enumerate((scene.surface_1, scene.surface_2), 1) if _lacks_layer(s)]
    rough = math.hypot(*(side.surface.rms for side in cases[0].sides))
    thinnest = min(cases, key=lambda case: case.conventional_film)
    if not bare or scene.film.lumped or thinnest.conventional_film >= _DECIDES * rough:
        return []
    give = "give" if len(bare) > 1 else "gives"
    return [
        f"Roughness: {' and '.join(bare)} {give} none below the grid, on which solid contact depends at this lambda: "
        f"{assumed.of_microroughness(thinnest, bare)}Take finish = 'ground', 'polished', ... or microroughness."
    ]


def _lacks_layer(surface: Any) -> bool:
    return surface.microroughness is None and not surface.smooth


def _grid(scene: Scene, cases: Sequence[Case]) -> list[str]:
    """Return a line on a grid that is too coarse for the contact, with the way out."""
    least, most = (f(case.hertz.a for case in cases) for f in (min, max))
    nodes = 2.0 * least / scene.film.spacing
    if scene.film.fidelity in UNSOLVED or nodes >= _FEW:
        return []
    waves = _WAVES * max(side.surface.length for side in cases[0].sides)
    wide = max(_WIDE * most, waves, _flooded(cases))
    finer = (
        f"a smaller domain, such as --set film.domain='{1e3 * wide:.2g} mm'"
        if wide < 0.5 * scene.film.domain
        else f"--grid {2 ** math.ceil(math.log2(_FEW * scene.film.domain / least)) + 1}"
    )
    return [f"Grid: {nodes:.1f} nodes across the contact; below {_FEW:g} the film is one of the grid. Take {finer}."]


def legend(halves: str = "error (95 %), and in brackets the half width by what is assumed") -> list[str]:
    """Return what the columns of the table are; halves: the half width behind +-."""
    columns = "; ".join(f"{heading}: {meaning}" for heading, meaning in _LEGEND.items())
    return wrapped(f"Columns: {columns}; +-: {halves}.")


def after(scene: Scene, dataset: xr.Dataset, errors: Mapping[str, Error]) -> list[str]:
    """Return lines on the flags raised, with their quantities, and a verdict.

    `errors` are those of the last state by `contact_core.uncertainty`; empty if that is not known.
    """
    known = verdict.sentence(scene, dataset, errors)
    worth, film = assumed.sentence(scene, dataset), grown.by_oil(scene, dataset)
    return wrapped(
        *flags.sentences(scene, dataset),
        *([film] if film else []),
        known,
        *worth,
        *assumed.not_in_errors(dataset.attrs),
    )


def width() -> int:
    """Return the characters of a line: those of the terminal, within reason."""
    return min(max(shutil.get_terminal_size((_LONG, 24)).columns, _SHORT), _LONG)


def wrapped(*texts: str) -> list[str]:
    """Return paragraphs as lines of at most `width` characters, all but the first one of each indented."""
    how: dict[str, Any] = {"subsequent_indent": "  ", "break_long_words": False, "break_on_hyphens": False}
    return [line for text in texts for line in textwrap.wrap(text, width(), **how)]


def span(values: Iterable[float], unit: str = "") -> str:
    """Return a value, or the range of several, as text with a unit."""
    found = np.array(list(values), dtype=float)
    ends = list(dict.fromkeys(f"{end:.3g}" for end in (found.min(), found.max())))
    return " to ".join(ends) + (f" {unit}" if unit else "")
