"""Sections on the contact: data of the scene, signs, range of validity, errors and steps."""

import json
import math
from collections.abc import Iterable, Iterator
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contact_core.assumed import HEADS, assumed, told
from contact_core.errors import ContactError
from contact_core.quantities import CELSIUS
from contact_core.scene import Scene, SelfAffine, Surface

from ...flavours import Flavour
from ...html.markup import bullets, heading, number, paragraph, table, text
from ...variables import FIDELITY
from .levels import LEVELS


class Measured(NamedTuple):
    """Measured errors or costs; `python -m benchmarks.house.fmu_figures` writes measured.json from docs/measured."""

    title: str
    command: str  # that measures them
    measured: str  # date
    older: bool  # than the code
    head: list[str]
    rows: list[list[str]]


_FOUND = json.loads(Path(__file__).with_name("measured.json").read_text(encoding="utf-8"))
ERRORS = {level: tuple(Measured(**each) for each in tables) for level, tables in _FOUND["errors"].items()}
COSTS = {level: Measured(**each) for level, each in _FOUND["costs"].items()}


# levels whose measured errors and costs are those of another: of steps without a block, and outside a map
_MEASURED = {"auto": "regression", "map": "regression"}


def _numbers(factor: float, values: Iterable[float], unit: str) -> str:
    return ", ".join(number(factor * value) for value in values) + f" {unit}"


def data(scene: Scene, flavour: Flavour) -> Iterator[str]:
    """Yield the section on the data of the scene."""
    bodies, point, hertz = scene.geometry, scene.operation.point, scene.hertz(scene.operation.load)
    yield paragraph(
        "Two rough bodies roll and slide on each other in oil under a normal load. The FMU computes film thickness, "
        "pressure, real contact area, friction, growth of the tribofilm, wear and the resulting roughness. It "
        f"{_at_level(scene, flavour)}"
    )
    rows = [
        *(
            (f"radius of combined curvature along {axis}", number(1e3 * radius, "mm"))
            for axis, radius in zip("xy", scene.radii(point), strict=False)
        ),
        *_face(scene),
        ("reduced modulus E′ = 2/[(1 − ν₁²)/E₁ + (1 − ν₂²)/E₂]", number(1e-9 * scene.solids.reduced_modulus, "GPa")),
        *(
            (
                f"body {i}: rms roughness{_given(s)}, correlation length; track length between two passes",
                f"{number(1e9 * s.rms, 'nm')}, {number(1e6 * s.length, 'µm')}; {number(1e3 * track, 'mm')}",
            )
            for i, s, track in (
                (1, scene.surface_1, bodies.track_length_1),
                (2, scene.surface_2, bodies.track_length_2),
            )
        ),
        ("reference operating point: load", number(point.load, "N")),
        ("speeds of body 1 and 2", _numbers(1.0, (point.speed_1, point.speed_2), "m/s")),
        ("oil temperature", number(point.temperature - CELSIUS, "°C")),
        ("Hertz contact: half width along x", number(1e6 * hertz.a, "µm")),
        *([("Hertz contact: half width along y", number(1e6 * hertz.b, "µm"))] if bodies.face_width is None else []),
        ("Hertz contact: maximum pressure", number(1e-9 * hertz.pressure_max, "GPa")),
    ]
    yield table(("", "this scene"), rows)
    if scene.warnings():
        yield heading("Notes on this scene")
        yield bullets(scene.warnings())


def _at_level(scene: Scene, flavour: Flavour) -> str:
    """Return the end of a sentence on the level of the FMU, and whether it can be changed."""
    level = f"the {scene.film.fidelity} level: {LEVELS[scene.film.fidelity].summary(scene)}"
    if flavour == "native":
        return f"has {level}"
    return (
        f"starts at {level} The parameter {FIDELITY} changes the level at any step; this page describes the one at the "
        "start."
    )


def _given(surface: Surface | SelfAffine) -> str:
    """Return that the roughness contains heights that were given, or an empty text."""
    return f" with the heights of resources/{surface.heights.packed.file}" if surface.heights else ""


def _face(scene: Scene) -> Iterator[tuple[str, str]]:
    if scene.geometry.face_width is not None:
        yield "face width, which load and outputs refer to", number(1e3 * scene.geometry.face_width, "mm")
        yield from LEVELS[scene.film.fidelity].size(scene)


def _drawing(name: str) -> str:
    return files(__package__).joinpath(f"{name}.svg").read_text("utf-8")


def signs(scene: Scene) -> Iterator[str]:
    """Yield the section on signs and directions."""
    yield _drawing("signs")
    spins = "spin" not in scene.geometry.lacks
    yield bullets(
        (
            "x is the direction of entrainment. Speeds are surface speeds along x, relative to the contact.",
            "friction_force acts on body 1 along +x, the opposite force on body 2. friction_coefficient is its "
            "magnitude over the load, 0 without load.",
            *(
                ["spin is the angular speed of body 1 relative to body 2, positive from x to y; spin_torque acts on "
                 "body 1 and has the same direction."]
                if spins
                else []
            ),
            f"power_loss = −friction_force (speed_1 − speed_2){' − spin_torque spin' if spins else ''}. It is never "
            "negative and flows into the bodies: heat_flow_1 + heat_flow_2.",
            LEVELS[scene.film.fidelity].derivatives,
            "A force −rolling_resistance acts on each surface along +x in addition to friction_force; power_loss does "
            "not include its power.",
        )
    )  # fmt: skip


def validity(scene: Scene) -> Iterator[str]:
    """Yield the section on the range of validity."""
    yield paragraph(
        "Inputs and parameters outside the ranges in the tables below are refused: valid becomes false. Inside them, "
        "range_flags reports what makes a result less certain. This scene, at its reference operating point:"
    )
    yield table(("", "here", "meaning"), limits(scene))
    yield paragraph(f"Not modelled: {', '.join(_not_modelled(scene))}.")


def _not_modelled(scene: Scene) -> Iterator[str]:
    if not scene.lubricant.supply.starves:
        yield "starvation (lubricant.supply = flooded: the inlet is full)"
    yield from not_modelled(scene)


def not_modelled(scene: Scene) -> Iterator[str]:
    """Yield what no law of a scene like this knows."""
    yield from scene.geometry.not_modelled
    yield "heat carried along by moving asperities (temperatures are steady)"
    yield "motion of the bodies across the track"


def limits(scene: Scene) -> Iterator[tuple[str, str, str]]:
    """Yield quantity, value and meaning of the limits of the model at this scene."""
    hertz, load = scene.hertz(scene.operation.load), scene.operation.load
    power = 1.0 / scene.shape().power  # maximum pressure grows with the load to the power of its inverse
    hardest = load * (scene.plasticity.hardness / hertz.pressure_max) ** power
    yield "load", f"below {number(hardest, 'N')}", "there the Hertz pressure of the smooth bodies reaches the hardness"
    yield from _smooth_film(scene)
    yield from LEVELS[scene.film.fidelity].limits(scene)
    for i, surface in ((1, scene.surface_1), (2, scene.surface_2)):
        if not surface.smooth:
            nodes = number(surface.length / scene.film.spacing)
            yield f"nodes per correlation length, body {i}", nodes, "2 or more resolve the roughness; W_c depends on it"
    yield "tribofilm", _temperatures(scene), "bulk temperatures (oil or given bodies) for which its constants hold"


def _smooth_film(scene: Scene) -> Iterator[tuple[str, str, str]]:
    point, modulus = scene.operation.point, scene.solids.reduced_modulus
    oil = scene.lubricant.viscosity, point.inlet_temperature
    smooth = scene.shape().smooth(scene.operation.load, point.entrainment_speed, *oil, modulus)
    if smooth.entrainment_speed == 0.0:
        yield "film of the smooth bodies", "none", "nothing entrains oil: the contact is dry"
        return
    hertz, supply = scene.hertz(scene.operation.load), scene.lubricant.supply
    film = supply.film(smooth.film, hertz.a, scene.geometry.radius_x, scene.shape().side_resistance)
    yield "Moes' M and L", ", ".join(map(number, smooth.moes_parameters)), "load and lubricant parameters"
    formula = f"by the formula of {scene.geometry.film_formula}"
    yield "flooded film of the smooth bodies", number(1e9 * smooth.film, "nm"), formula
    if supply.starves:
        yield "film with this oil supply", number(1e9 * film, "nm"), supply.source
    sigma = math.hypot(scene.surface_1.rms, scene.surface_2.rms)
    if sigma > 0.0:
        yield "Z: that film over composite roughness", number(film / sigma), "the smaller Z, the more load on solids"


def _temperatures(scene: Scene) -> str:
    """Return the range of bulk temperatures for which the constants of the tribofilm hold, to a degree."""
    tried = np.arange(230.0, 500.0, 0.1)
    held = [t for t in tried if scene.tribofilm.covers(float(t))]
    low, high = (round(t - CELSIUS) for t in (held[0], held[-1]))
    return "any" if len(held) == len(tried) else f"{low} to {high} °C"


def errors(scene: Scene) -> Iterator[str]:
    """Yield the section on the errors of the outputs."""
    yield paragraph(
        "error_friction, error_rolling, error_film, error_tribofilm_1 and _2 and error_wear are half widths of 95 % "
        "intervals, relative; "
        "error_load_ratio is that of contact_load_ratio, absolute. " + LEVELS[scene.film.fidelity].errors
    )
    yield paragraph("Measured errors, and the command of the repository that measures them:")
    for found in ERRORS[_MEASURED.get(scene.film.fidelity, scene.film.fidelity)]:
        yield _measured(found)


def assumptions(scene: Scene) -> Iterator[str]:
    """Yield the section on what the scene assumes."""
    yield paragraph(
        "Values that the scene assumes, the interval of each, and the half widths that these make of friction, film, "
        "load on the solids, wear rate and growth of tribofilm at the reference operating point, on new surfaces, by "
        "the regression level. "
        "They come beside the errors above."
    )
    try:
        rows = told(scene.intervals, assumed(scene, scene.operation.point))
    except ContactError as error:
        yield paragraph(str(error))
        return
    if rows:
        yield table(HEADS, rows)
    else:
        yield paragraph("The scene has no intervals.")


def _measured(found: Measured) -> str:
    when = f"measured on {found.measured}{', of older code' if found.older else ''}"
    title = f"<p>{text(found.title)} (<code>{text(found.command)}</code>, {when}):</p>"
    return title + table(found.head, found.rows)


def steps(scene: Scene) -> Iterator[str]:
    """Yield the section on communication steps."""
    yield _drawing("steps")
    yield paragraph(
        "A communication step from t to t + h holds the inputs as set before it; the outputs are those at t + h. "
        "Between steps the outputs depend on the state alone: a new input takes effect in the next step. Coupled to "
        "another model, one of the two lags by a step; choose h so short that the inputs change little in it. Steps "
        "may differ in length; any length is allowed, zero too."
    )
    yield paragraph(LEVELS[scene.film.fidelity].steps(scene))
    yield _measured(COSTS[_MEASURED.get(scene.film.fidelity, scene.film.fidelity)])
