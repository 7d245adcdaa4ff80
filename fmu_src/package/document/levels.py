"""Sentences and rows of the page that differ between the fidelity levels, by name of the level."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from contact_core.laws.load_sharing import flattening_of, layer_height, rms_slope, sliding_ratio
from contact_core.scene import Case, Scene

from ...html.markup import number

Row = tuple[str, str, str]


@dataclass(frozen=True)
class LevelText:
    """Text of one fidelity level."""

    summary: Callable[[Scene], str]
    size: Callable[[Scene], Iterator[tuple[str, str]]]  # rows on the part of the contact that is solved
    limits: Callable[[Scene], Iterator[Row]]  # rows on the range of validity
    derivatives: str
    errors: str
    steps: Callable[[Scene], str]


def _fields(scene: Scene) -> str:
    return (
        f"fields on {scene.film.points} nodes along x and {scene.rows} along y, "
        f"{number(1e6 * scene.film.spacing, 'µm')} apart."
    )


def _period(scene: Scene) -> Iterator[tuple[str, str]]:
    if scene.shape().periodic:
        yield "solved part of the face, repeated along y", number(1e3 * scene.rows * scene.film.spacing, "mm")


def _loads_on_grid(scene: Scene) -> Iterator[Row]:
    hertz, load = scene.hertz(scene.operation.load), scene.operation.load
    power = 1.0 / scene.shape().power  # half widths grow with the load to the power of its inverse
    wide = load * min(room / half for room, half in zip(scene.room, (hertz.a, hertz.b), strict=True)) ** power
    few = load * (4.0 * scene.film.spacing / hertz.a) ** power
    yield (
        "load on this grid",
        f"{number(few)} to {number(wide, 'N')}",
        "from 8 nodes across the contact to the whole grid",
    )


def _steps_of_blocks(scene: Scene) -> str:
    control = scene.control
    return (
        "The rough contact is solved once per block; tribofilm and wear grow in closed form in between. A step far "
        "shorter than a block therefore costs next to nothing, and the outputs of the contact are constant in it. A "
        f"block ends when film or wear have changed the heights by control.change = "
        f"{number(1e9 * control.change, 'nm')} (rms), after control.longest = {number(control.longest, 's')} at most, "
        f"or when an input has changed by control.input_change = {number(100.0 * control.input_change, '%')} (a "
        "temperature: by the viscosity) or to or from zero. suggested_step is the time to the next solution if no "
        "input changes. Inputs that change by more than control.input_change in every step cost a new solution in "
        "every step."
    )


def _fitted_ranges(scene: Scene) -> Iterator[Row]:
    """Yield the arguments of the fitted curves of load sharing and their fitted ranges."""
    film: Any = scene.film
    first, second = scene.surface_1, scene.surface_2
    point, pressure = scene.operation.point, scene.hertz(scene.operation.load).pressure_mean
    below = Case.bind(scene, point).microroughness
    slope = rms_slope(first.rms, first.length, second.rms, second.length)
    here = {
        "clearance": "see above",
        "flattening": number(flattening_of(pressure, scene.solids.reduced_modulus, slope)) if slope > 0.0 else "none",
        "below": number(flattening_of(pressure, scene.solids.reduced_modulus, below.slope)) if below else "none",
        "layers": f"film / {number(1e9 * layer_height(film.floor, below.rms if below else 0.0), 'nm')}",
        "slip": number(sliding_ratio(point.sliding_speed, point.entrainment_speed)),
        "pressed": number(scene.hertz(scene.operation.load).pressure_max / scene.plasticity.hardness),
    }
    symbols = {"clearance": "Z", "layers": "f", "flattening": "s", "below": "s_m", "slip": "Σ", "pressed": "Π"}
    for name, (low, high) in film.sharing.FITTED.items():
        yield f"{symbols[name]} of the fit", here[name], f"fitted from {low:g} to {high:g}"


def _steps_in_closed_form(scene: Scene) -> str:
    change = number(1e9 * scene.control.change, "nm")
    return (
        "Every step evaluates the contact anew. Tribofilm and wear grow in closed form over the time in which they "
        f"change the surfaces by control.change = {change}, several times in a long step. suggested_step is that time."
    )


LEVELS = {
    "deterministic": LevelText(
        _fields,
        _period,
        _loads_on_grid,
        "The derivatives of friction_force hold the film: pressures grow with the load, the gap does not change.",
        "They include the distance of the nodes, time steps, sampling, iterations that stop early, and film that is "
        "missing where the domain cuts the inlet off. That of the nodes follows a rule fitted to differences between "
        "grids of the shipped scenes; another kind of surface may lie outside it: compare two grids.",
        _steps_of_blocks,
    ),
    "regression": LevelText(
        lambda scene: "means of both surfaces, with curves of load sharing fitted to the deterministic level.",
        lambda scene: iter(()),
        _fitted_ranges,
        "The derivatives of friction_force are total.",
        "They come from the fit of this level. Where range_flags reports a point outside the fit they are twice as "
        "wide, which is assumed.",
        _steps_in_closed_form,
    ),
    "map": LevelText(
        lambda scene: (
            "means of both surfaces as at the regression level, corrected by a map of this scene: polynomials fitted "
            "to deterministic blocks."
        ),
        lambda scene: iter(()),
        _fitted_ranges,
        "The derivatives of friction_force are total.",
        "They come from the blocks of the map, and beyond its ranges, where range_flags reports it, from the fit of "
        "the regression level.",
        _steps_in_closed_form,
    ),
    "auto": LevelText(
        lambda scene: (
            "means of both surfaces as at the regression level, corrected by deterministic blocks that are "
            "solved where friction or film would be less sure than control.accuracy, 10 % without it."
        ),
        lambda scene: iter(()),
        _fitted_ranges,
        "The derivatives of friction_force are total.",
        "They come from the fit of the regression level, and are narrower near the blocks that are solved.",
        _steps_in_closed_form,
    ),
}
