"""documentation/index.html of a scene's FMU: one page, readable without network and scripts."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from html import escape
from typing import Any

import numpy as np

import contact_core
from contact_core.film import Deterministic, Regression
from contact_core.laws.load_sharing import flattening_of, rms_slope
from contact_core.scene import Scene
from contact_core.shapes import LineGeometry, PointGeometry, RollerGeometry
from contact_core.state import RangeFlag

from . import drawings, equations, evidence, markup, measured, packages
from .flavours import Flavour
from .markup import bullets, equation, paragraph, plain, table
from .resources import MODEL
from .slave import ContactSlave
from .variables import FIDELITY, INITIAL_STATE, Variable, variables

_STYLE = """
body { max-width: 60em; margin: 2em auto; padding: 0 1em; font: 16px/1.5 system-ui, sans-serif; color: #222; }
h1, h2, h3 { line-height: 1.2; } h2 { margin-top: 2.2em; border-bottom: 1px solid #bbb; } h3 { margin: 1.4em 0 .3em; }
table { border-collapse: collapse; margin: .8em 0; font-size: .88em; }
th, td { border-bottom: 1px solid #ddd; padding: .25em .7em .25em 0; text-align: left; vertical-align: top; }
code { font-size: .95em; } .wide { overflow-x: auto; } .source { font-size: .85em; color: #555; margin: .2em 0; }
.equation { font-family: Cambria, "Times New Roman", serif; font-size: 1.12em; margin: .3em 0 .3em 1.5em;
  white-space: pre-wrap; }
svg { max-width: 34em; display: block; font-size: 14px; } svg text { fill: #222; }
.middle { text-anchor: middle; } .end { text-anchor: end; }
.line path, .input, .asked, .output { fill: none; stroke: #222; stroke-width: 1.6; } .line .grid { stroke: #ccc; }
.ball { fill: #c3cbd4; } .disc { fill: #9aa5b1; } .oil { fill: #f3b34a; } .line .force { stroke: #a33; }
svg text.force { fill: #a33; } .input { stroke: #1f5fa8; stroke-width: 2.4; } .output { stroke: #a33; }
.asked { stroke-dasharray: 4 4; stroke: #888; } nav a { margin-right: 1em; white-space: nowrap; }
@media print { body { max-width: none; } h2, h3 { break-after: avoid; } }
"""

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>{title}</title><style>{style}</style></head>
<body>
<h1>{title}</h1>
<p>{description}</p>
<nav>{contents}</nav>
{body}
</body>
</html>
"""

_CELSIUS = 273.15


def documentation(scene: Scene, flavour: Flavour, reference: bool) -> bytes:
    """The page, UTF-8, for a flavour of the FMU, with or without reference data in it."""
    sections = {
        "contact": ("The contact", _contact(scene)),
        "signs": ("Signs and directions", _signs(scene)),
        "equations": ("Equations", _equations(scene)),
        "validity": ("Where it holds", _validity(scene)),
        "errors": ("How sure the outputs are", _errors(scene)),
        "steps": ("Steps", _steps(scene)),
        "status": ("Status, <code>valid</code> and <code>range_flags</code>", _status(flavour)),
        "variables": ("Variables", _variables(scene)),
        "state": ("State", _state()),
        "log": ("Log", _log()),
        "needs": ("What it needs", _needs(flavour)),
        "check": ("Check it", _check(reference)),
        "licence": ("Licence", _licence(flavour)),
    }
    body = [part for name, (title, parts) in sections.items() for part in (f'<h2 id="{name}">{title}</h2>', *parts)]
    page = _PAGE.format(
        title=escape(f"{MODEL}: {scene.name}"),
        description=escape(scene.description),
        style=_STYLE,
        contents=" ".join(f'<a href="#{name}">{title}</a>' for name, (title, _) in sections.items()),
        body="\n".join(body),
    )
    return page.encode()


def _formula(lines: Iterable[str], sentence: str = "", source: str = "") -> Iterator[str]:
    yield from map(equation, lines)
    if sentence:
        yield paragraph(sentence)
    if source:
        yield markup.source(source)


def _number(value: float, unit: str = "") -> str:
    return f"{value:.4g} {unit}".strip()


def _numbers(factor: float, values: Iterable[float], unit: str) -> str:
    return ", ".join(_number(factor * value) for value in values) + f" {unit}"


# sections


def _contact(scene: Scene) -> Iterator[str]:
    bodies, point, hertz = scene.geometry, scene.operation.point, scene.hertz(scene.operation.load)
    yield paragraph(
        "Two rough bodies roll and slide on each other in oil under a normal load. The FMU computes film, pressure and "
        "real contact, friction, the growth of a tribofilm where they rub, wear, and the roughness that results. "
        f"It starts at the level film.model = '{scene.film.name}': "
        + (
            f"fields on {scene.film.points} nodes along x and {scene.rows} along y, "
            f"{_number(1e6 * scene.film.spacing, 'µm')} apart."
            if scene.film.name == "deterministic"
            else "means of both surfaces, with curves of load sharing fitted to the deterministic level."
        )
        + f" The parameter {FIDELITY} changes the level at any step; this page is about the one at the start."
    )
    rows = [
        *(
            (f"radius of combined curvature along {axis}", _number(1e3 * radius, "mm"))
            for axis, radius in zip("xy", scene.radii(point), strict=False)
        ),
        *_face(scene),
        ("reduced modulus E′ = 2/[(1 − ν₁²)/E₁ + (1 − ν₂²)/E₂]", _number(1e-9 * scene.solids.reduced_modulus, "GPa")),
        *(
            (
                f"body {i}: rms roughness, correlation length; way between two passes",
                f"{_number(1e9 * s.rq, 'nm')}, {_number(1e6 * s.correlation_length, 'µm')}; {_number(1e3 * way, 'mm')}",
            )
            for i, s, way in ((1, scene.surface_1, bodies.track_length_1), (2, scene.surface_2, bodies.track_length_2))
        ),
        ("point of reference: load", _number(point.load, "N")),
        ("speeds of body 1 and 2", _numbers(1.0, (point.speed_1, point.speed_2), "m/s")),
        ("oil temperature", _number(point.temperature - _CELSIUS, "°C")),
        ("Hertz: half width along x", _number(1e6 * hertz.a, "µm")),
        *([("Hertz: half width along y", _number(1e6 * hertz.b, "µm"))] if _is_point(scene) else []),
        ("Hertz: largest pressure", _number(1e-9 * hertz.pressure_max, "GPa")),
    ]  # fmt: skip
    yield table(("", "this scene"), rows)
    if scene.warnings():
        yield "<h3>Notes on this scene</h3>"
        yield from bullets(scene.warnings())


def _is_point(scene: Scene) -> bool:
    return isinstance(scene.geometry, PointGeometry)


def _face(scene: Scene) -> Iterator[tuple[str, str]]:
    """What the loads and outputs of a line contact are meant for."""
    if isinstance(scene.geometry, PointGeometry):
        return
    yield "face width, on all of which load and outputs lie", _number(1e3 * scene.geometry.face_width, "mm")
    if isinstance(scene.geometry, LineGeometry) and scene.film.name == "deterministic":
        period = _number(1e3 * scene.rows * scene.film.spacing, "mm")
        yield "part of it that is solved and repeats itself", period


def _signs(scene: Scene) -> Iterator[str]:
    yield drawings.SIGNS
    spins = "spin" not in scene.geometry.lacks
    yield from bullets(
        (
            "x is the direction of entrainment. Speeds are those of the surfaces along x, relative to the contact.",
            "friction_force acts on body 1 along +x, the opposite on body 2. friction_coefficient is its size over the "
            "load, 0 without load.",
            *(
                ["spin is that of body 1 relative to body 2 and turns x towards y; spin_torque acts on it that way."]
                if spins
                else []
            ),
            f"power_loss = −friction_force (speed_1 − speed_2){' − spin_torque spin' if spins else ''}. It is never "
            "negative, and the bodies take it up: heat_flow_1 + heat_flow_2.",
            "The derivatives of friction_force are total."
            if isinstance(scene.film, Regression)
            else "The derivatives of friction_force are those at a held film: pressures grow with the load, the gap "
            "stands still.",
            "Each surface feels −rolling_resistance along +x, beside friction_force; its power is not in power_loss.",
        )
    )


def _equations(scene: Scene) -> Iterator[str]:
    yield paragraph("The laws in use, each with its source. Symbols of a law are named with its parameters below.")
    level, film = scene.film.name, scene.film
    governing = equations.GOVERNING[level] + equations.OF_SHAPE[level, scene.geometry.name]
    for title, lines, sentence in governing:
        yield f"<h3>{title}</h3>"
        yield from _formula(lines, sentence)
    if isinstance(film, Deterministic):
        lines, sentence = equations.CAVITATION[scene.lubricant.cavitation]
        yield f"<h3>Oil under tension: lubricant.cavitation = {scene.lubricant.cavitation}</h3>"
        yield from _formula(lines, sentence)
        lines, sentence = equations.SHARING[film.criterion]
        yield f"<h3>Solids and oil share the load: film.criterion = {film.criterion}</h3>"
        yield from _formula(lines, sentence)
    yield from _formula((), source=film.source)
    yield "<h3>Friction</h3>"
    yield from _formula(*equations.FRICTION[level])
    yield from _laws(scene)
    if scene.heat.inlet_shear != "none":
        yield f"<h3>heat.inlet_shear: {scene.heat.inlet_shear}</h3>"
        yield from _formula(*equations.INLET_SHEAR[scene.heat.inlet_shear])
    if level == "regression" and scene.lubricant.flow == "local" and scene.lubricant.rheology.name == "carreau":
        yield "<h3>lubricant.flow: local</h3>"
        yield from _formula(*equations.SHEAR_THINNING)
    yield "<h3>Options, fixed when the FMU was built</h3>"
    yield table(("option", "choice", "meaning"), _options(scene))


def _laws(record: Any, path: str = "") -> Iterator[str]:
    """Every law of the scene: equations and source."""
    for f in fields(record):
        part: Any = getattr(record, f.name)
        if (f.name, getattr(part, "name", "")) in equations.LAWS:
            lines, sentence = equations.LAWS[f.name, part.name]
            dose = equations.DOSES[part.dose] if f.name == "tribofilm" and part.name != "none" else ""
            yield f"<h3>{path}{f.name}: {part.name}</h3>"
            yield from _formula(lines, f"{sentence} {dose}".strip(), part.source)
        if is_dataclass(part):
            yield from _laws(part, f"{path}{f.name}.")


def _options(record: Any, path: str = "") -> Iterator[tuple[str, str, str]]:
    for f in fields(record):
        part: Any = getattr(record, f.name)
        if is_dataclass(part):
            yield from _options(part, f"{path}{f.name}.")
        elif f.metadata.get("choices"):
            yield f"{path}{f.name}", part, f.metadata["text"]


def _validity(scene: Scene) -> Iterator[str]:
    yield paragraph(
        "Inputs and parameters outside their ranges in the tables below are refused: valid turns false. Inside them "
        "range_flags says what makes an answer less sure. This scene, at its point of reference:"
    )
    yield table(("", "here", "meaning"), _standing(scene))
    yield paragraph(f"Not in the model: {', '.join(_left_out(scene))}.")


def _left_out(scene: Scene) -> Iterator[str]:
    """What a user might look for in vain."""
    if scene.lubricant.supply.name == "flooded":
        yield "starvation (lubricant.supply = flooded: the inlet is full)"
    if isinstance(scene.geometry, LineGeometry):
        yield "the ends of the face, and misalignment"
    if isinstance(scene.geometry, RollerGeometry):
        yield "misalignment"
    yield "heat carried along by moving asperities (temperatures are steady)"
    yield "wander of the bodies across the track"


def _standing(scene: Scene) -> Iterator[tuple[str, str, str]]:
    """Where the scene stands in the ranges of the model: what, value, what it means."""
    hertz, spacing, load = scene.hertz(scene.operation.load), scene.film.spacing, scene.operation.load
    steeper = 1.0 / scene.shape().power  # half widths and pressure grow with the load to that power
    hardest = load * (scene.plasticity.hardness / hertz.pressure_max) ** steeper
    yield "load", f"below {_number(hardest, 'N')}", "there Hertz's pressure of smooth bodies reaches the hardness"
    yield from _smooth_film(scene)
    if isinstance(scene.film, Regression):
        yield from _fitted(scene, scene.film)
    else:
        wide = load * min(room / half for room, half in zip(scene.room, (hertz.a, hertz.b), strict=True)) ** steeper
        few = load * (4.0 * spacing / hertz.a) ** steeper
        yield "load on this grid", f"{_number(few)} to {_number(wide, 'N')}", "8 nodes across the contact to all of it"
    for i, surface in ((1, scene.surface_1), (2, scene.surface_2)):
        if surface.rq > 0.0:
            nodes = _number(surface.correlation_length / spacing)
            yield f"nodes per correlation length, body {i}", nodes, "2 or more resolve the roughness; W_c depends on it"
    yield "tribofilm", _warmth(scene), "temperatures at which its constants hold, of the oil or of given bodies"


def _smooth_film(scene: Scene) -> Iterator[tuple[str, str, str]]:
    point, modulus = scene.operation.point, scene.solids.reduced_modulus
    oil = scene.lubricant.viscosity, point.inlet_temperature
    smooth = scene.shape().smooth(scene.operation.load, point.entrainment_speed, *oil, modulus)
    if smooth.entrainment_speed == 0.0:
        yield "film of the smooth bodies", "none", "nothing entrains oil: the contact is dry"
        return
    hertz, supply = scene.hertz(scene.operation.load), scene.lubricant.supply
    film = supply.film(smooth.film, hertz.a, scene.geometry.radius_x, scene.shape().side_resistance)
    by = "Nijenbanning, Venner and Moes" if _is_point(scene) else "Moes for lines"
    yield "Moes' M and L", ", ".join(map(_number, smooth.moes_parameters)), "numbers of load and lubricant"
    yield "flooded film of the smooth bodies", _number(1e9 * smooth.film, "nm"), f"by the formula of {by}"
    if supply.name != "flooded":
        yield "film that the supply leaves", _number(1e9 * film, "nm"), supply.source
    sigma = math.hypot(scene.surface_1.rq, scene.surface_2.rq)
    if sigma > 0.0:
        yield "λ = that over composite roughness", _number(film / sigma), "the smaller, the more the solids carry"


def _fitted(scene: Scene, film: Regression) -> Iterator[tuple[str, str, str]]:
    """What the curves of load sharing were fitted for."""
    first, second = scene.surface_1, scene.surface_2
    slope = rms_slope(first.rq, first.correlation_length, second.rq, second.correlation_length)
    rougher = max(first, second, key=lambda surface: surface.rq)
    pressure = scene.hertz(scene.operation.load).pressure_mean
    here = {
        "clearance": "see above",
        "flattening": _number(flattening_of(pressure, scene.solids.reduced_modulus, slope)) if slope > 0.0 else "none",
        "resolution": _number(rougher.correlation_length / film.spacing),
    }
    symbols = {"clearance": "λ", "flattening": "s", "resolution": "r"}
    for name, (low, high) in film.sharing.FITTED.items():
        yield f"{symbols[name]} of the fit", here[name], f"fitted from {low:g} to {high:g}"


def _warmth(scene: Scene) -> str:
    """The range of bulk temperatures at which the tribofilm's constants hold, to a degree."""
    held = [t for t in np.arange(230.0, 500.0, 0.1) if scene.tribofilm.covers(float(t))]
    low, high = (round(t - _CELSIUS) for t in (held[0], held[-1]))
    everywhere = len(held) == len(np.arange(230.0, 500.0, 0.1))
    return "any" if everywhere else f"{low} to {high} °C"


def _errors(scene: Scene) -> Iterator[str]:
    yield paragraph(
        "error_friction, error_film, error_tribofilm and error_wear are half widths of 95 % intervals, relative. "
        + (
            "They come from the fit of the level; where range_flags says outside the fit, twice as wide, a guess."
            if isinstance(scene.film, Regression)
            else "They come from time steps and sampling. The grid's error is in none of them and is larger where "
            "solids carry load: compare two grids. Wear driven by 'auto' was found beyond them more often than within."
        )
    )
    yield paragraph("What has been measured, and the command of the repository that measures it:")
    for found in measured.ERRORS[scene.film.name]:
        yield _measured(found)


def _measured(found: measured.Table) -> str:
    title = f"<p>{plain(found.title)} (<code>{plain(found.command)}</code>):</p>"
    return title + table(found.head, found.rows)


def _steps(scene: Scene) -> Iterator[str]:
    control = scene.control
    yield drawings.STEPS
    yield paragraph(
        "A communication step from t to t + h holds the inputs as they were set before it, and the outputs are those "
        "at t + h. Between steps they depend on the state alone: what is set is seen after the next step. Coupled to "
        "another model, one of the two is a step late; choose h so short that the inputs change little in it. Steps "
        "may differ in length; any length is allowed, zero too."
    )
    if isinstance(scene.film, Regression):
        yield paragraph(
            "Every step evaluates the contact anew. Tribofilm and wear run on in closed form over the time in which "
            f"they change the surfaces by control.change = {_number(1e9 * control.change, 'nm')}, several times in a "
            "long step; suggested_step is that time."
        )
    else:
        yield paragraph(
            "The rough contact is solved once a block, and tribofilm and wear run on in closed form in between, so a "
            "step far below a block costs next to nothing, and the contact's outputs stand still in it. A block ends "
            f"when film or wear have changed the heights by control.change = {_number(1e9 * control.change, 'nm')} "
            f"(rms), after control.longest = {_number(control.longest, 's')} at most, or when an input has moved by "
            f"control.input_change = {_number(100.0 * control.input_change, '%')} (a temperature by the viscosity it "
            "makes) or to or from zero. suggested_step is the time until the next solution is due without that. Inputs "
            "that wander beyond control.input_change in every step make every step cost a new solution."
        )
    yield _measured(measured.COSTS[scene.film.name])


def _status(flavour: Flavour) -> Iterator[str]:
    broken: dict[Flavour, tuple[tuple[str, str, str], ...]] = {
        "isolated": (
            ("an unexpected error in the model", "Error", "the log has its traceback; the host goes on"),
            (
                "the model's process ends, or gives no answer within TRIBOFMU_TIMEOUT",
                "Error",
                "the host goes on; restore a state, or reset, to go on in a new process",
            ),
        ),
        "embedded": (
            (
                "an unexpected error in the model",
                "OK",
                "valid is false; state and outputs stand; the log has its traceback",
            ),
        ),
    }
    yield table(
        ("what happened", "status", "answer"),
        (
            ("a step or value that can be used", "OK", "valid is true"),
            (
                "an input or step size that cannot be used, a contact that cannot be solved",
                "OK",
                "valid is false; time goes on, state and outputs stand, the log says why. The next step that can be "
                "computed makes valid true again",
            ),
            (
                f"a parameter or {INITIAL_STATE} that cannot be used",
                "OK",
                "the same at every step until a reset; it never runs with other values than those asked for",
            ),
            *broken[flavour],
        ),
    )
    yield paragraph("valid is to be looked at after every step. range_flags is the sum of:")
    yield table(("value", "name", "meaning"), ((flag.value, flag.name, flag.text) for flag in RangeFlag))


_KINDS = (("Inputs", "input"), ("Outputs", "output"), ("Parameters", "parameter"), ("Time", "independent"))


def _variables(scene: Scene) -> Iterator[str]:
    yield paragraph("All values are SI. Bounds are those of modelDescription.xml.")
    listed = variables(scene)
    for title, causality in _KINDS:
        yield f"<h3>{title}</h3>"
        if causality == "parameter":
            yield paragraph(
                f"Set them before initialisation ends; afterwards all but {FIDELITY} are fixed until a reset."
            )
        rows = (_row(v) for v in listed if v.causality == causality)
        yield table(("name", "unit", "least", "most", "start", "meaning"), rows)


def _row(v: Variable) -> tuple[str, ...]:
    low, high = (f"{bound:.10g}" if math.isfinite(bound) else "" for bound in (v.minimum, v.maximum))
    start = f"{v.start:.10g}" if isinstance(v.start, float) else str(v.start)
    return v.name, v.unit, low, high, start if v.has_start else "", v.text


def _state() -> Iterator[str]:
    yield from bullets(
        (
            "FMU states can be got, set, serialised and deserialised as often as needed: a replay agrees bit for bit, "
            "also in another instance and in another process. Parameters and inputs travel with the state.",
            "A damaged state, or one of another FMU, is refused when it is set: valid is false, everything stands.",
            f"{INITIAL_STATE} names a file with the bytes of contact_core's ContactState.to_bytes(), to start from "
            "surfaces that have run in; empty means fresh ones.",
            "fmi2Reset brings back the start values; the next run is the first one again.",
        )
    )


def _log() -> Iterator[str]:
    yield paragraph("Messages arrive where the host has switched logging on. Categories:")
    yield table(("category", "messages"), ContactSlave.log_categories.items())


def _needs(flavour: Flavour) -> Iterator[str]:
    where = {
        "isolated": "The FMU starts a Python of its own process for the model; the host needs none.",
        "embedded": "The model runs in the Python of the host.",
    }
    exact = " and ".join(f"{name} {version}" for name, version in packages.exact().items())
    yield paragraph(
        f"{where[flavour]} It takes Python {packages.python()} with {exact}, no other versions, and what pip installs "
        f"with them: {', '.join(packages.dependencies())}. The same is in externalDependencies.txt."
    )
    yield table(("environment variable", "meaning"), packages.VARIABLES[flavour].items())


def _check(reference: bool) -> Iterator[str]:
    if not reference:
        yield paragraph("This FMU was built without reference data.")
        return
    names = {evidence.STIMULI: "stimuli", evidence.EXPECTED: "expected outputs", evidence.EXPERIMENT: "experiment"}
    links = [f'<a href="../{evidence.FOLDER}/{name}">{text}</a>' for name, text in names.items()]
    yield (
        f"<p>The FMU carries a short run of its own, {', '.join(links)}, in the layout of the FMI layered standard for "
        f'references. <a href="fmi-ls-ref.txt">How to replay it</a>; tolerance {evidence.TOLERANCE:g}.</p>'
    )
    yield paragraph("tribofmu check FILE.fmu --deep replays it, beside other checks.")


def _licence(flavour: Flavour) -> Iterator[str]:
    names = packages.licences(flavour)
    links = ", ".join(f'<a href="licenses/{name}">{name}</a>' for name in names)
    yield (
        f"<p>{packages.PACKAGE} {contact_core.__version__} is under the BSD 3-clause licence. Texts of the licences of "
        f"what lies in this FMU: {links}. Please cite the sources of the laws, too.</p>"
    )
