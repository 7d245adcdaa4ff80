"""contact.c, contact.h and slopes.c: one scene in C99, at a level that solves no contact, written from its Python.

`step`, `derivatives` and `first_state` are the program, Python that runs as it stands. Equations: `contact_core`.
"""

import copy
import dataclasses
import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from contact_core import initial_state
from contact_core.corrections.map import map_of
from contact_core.corrections.query import ByMap, slopes
from contact_core.errors import OperatingPointError, SceneError
from contact_core.quantities import OF_CALLER, OF_CORE
from contact_core.regression import evolution
from contact_core.regression.contact import MeanContact, evaluate
from contact_core.regression.surfaces import Tribofilms, tribofilms_of
from contact_core.scene import Case, OperatingPoint, Scene
from contact_core.state import Classes, ContactState, Mean, Outputs, changed
from contact_core.surfaces.track_means import means_of

from ..runtime.resources import homes_of, packed
from ..variables import variables
from . import keeping
from .calls import TRACKS, calling, header, initialise, source, stack_of
from .translate import Entry, Num, Stored, Translator, Untranslatable, array_kind, is_number, literal, parts

Found = tuple[ContactState, Outputs]


def bound(given: Case, state: ContactState) -> Case:
    """Return a case with the temperatures of a state. Raises OperatingPointError where it cannot be used."""
    scene, point = given.scene, given.op
    _check_radii(given)
    case = Case.at(scene, _with_own_radii(given), state.temperatures)
    law, bulk, inlet = scene.tribofilm, scene.heat.bulk, scene.lubricant.supply.inlet
    for temperature in point.bodies if bulk.from_inputs else (point.temperature,):
        if law.refusal(_COLD) and not law.covers(temperature):
            raise OperatingPointError(
                f"temperature = {temperature:g} K is outside the range where the tribofilm's constants hold. Use a set "
                "fitted at that temperature, or build the FMU anew with tribofilm.beyond_fit = 'extrapolate'."
            )
    if inlet is not None and point.load > 0.0:
        half_width = case.unit_hertz.a * case.growth[0]
        if inlet <= half_width:
            raise OperatingPointError(
                f"lubricant.supply.distance = {inlet:g} m must be more than the half width of Hertz's contact, "
                f"{half_width:.3g} m at {point.load:g} N: no oil would be before it. Lower the load."
            )
    _ = case.unit_hertz, case.growth, case.sides  # once, for all parts of a step
    return case


_MOST_STACK = 768 * 1024  # bytes of arrays; threads of Windows have 1 MB
_BODIES = (2,)  # shape of arrays with a number for each body
_COLD = 0.0  # K: no law covers it; as the temperature of a body: none yet
_SAME_RADIUS = 1e-9  # relative: a host may convert units


def _check_radii(case: Case) -> None:
    """Raise OperatingPointError if a point contact has other radii than the scene.

    The elliptic integrals of its shape are computed when the FMU is built.
    """
    for name, radius in own_radii(case.scene).items():
        given = getattr(case.op, name)
        if given is not None and abs(given - radius) > _SAME_RADIUS * radius:
            raise OperatingPointError(
                f"{name} = {given:g} m: this FMU holds Hertz's contact of {name} = {radius:g} m. Keep that, or build "
                f"the FMU anew with geometry.{name} set."
            )


def own_radii(scene: Scene) -> dict[str, float]:
    """Return the radii that the FMU of a scene holds: those of a point."""
    names = () if "radius_y" in scene.geometry.lacks else ("radius_x", "radius_y")
    return {name: getattr(scene.operation, name) or getattr(scene.geometry, name) for name in names}


def _with_own_radii(case: Case) -> OperatingPoint:
    """Return an operating point with those radii as constants; None where they are those of the geometry."""
    operation = case.scene.operation
    own = {name: getattr(operation, name) and radius for name, radius in own_radii(case.scene).items()}
    return dataclasses.replace(case.op, **own)


def step(case: Case, state: ContactState, dt: float) -> Found:
    """Return the state and the outputs after a step of `dt` [s]."""
    begun = _begun(case.op, state)
    after, outputs = evolution.advance(bound(case, begun), begun, dt, _LEVELS[case.scene.film.fidelity](case.scene))
    if case.scene.heat.bulk.stores_heat and dt == 0.0:  # bodies begin at the temperature of the oil of the first step
        after = changed(after, temperatures=state.temperatures)
    return after, outputs


def derivatives(case: Case, state: ContactState) -> tuple[float, float, float, float]:
    """Return the derivatives of friction_force by speed_1, speed_2, load and temperature, as a step of 0 has them."""
    begun = _begun(case.op, state)
    now = bound(case, begun).warmed(begun.temperatures)
    assert state.means is not None
    films = tribofilms_of(state.means)
    if _by_map(case.scene):
        return slopes(map_of(case.scene), now, films)
    return evaluate(now, films).derivatives


def _of_curves(scene: Scene) -> evolution.ContactOf:
    def contact_of(case: Case, tribofilms: Tribofilms) -> MeanContact:
        return evaluate(case, tribofilms, derivatives=False)

    return contact_of


def _of_map(scene: Scene) -> evolution.ContactOf:
    return ByMap(map_of(scene)).contact


# of a scene at its level, the function that evaluates contacts, without derivatives
_LEVELS: dict[str, Callable[[Scene], evolution.ContactOf]] = {"regression": _of_curves, "map": _of_map}


def _by_map(scene: Scene) -> bool:
    return scene.film.fidelity == "map"


def _begun(point: OperatingPoint, state: ContactState) -> ContactState:
    """Return a state whose bodies have temperatures: where none are stored yet, that of the oil."""
    if state.temperatures is None:
        return state
    one, two = (stored if stored > _COLD else point.temperature for stored in state.temperatures)
    return changed(state, temperatures=(one, two))


def first_state(scene: Scene) -> ContactState:
    """Return the state of fresh surfaces, with their track means."""
    state = initial_state(scene)
    return changed(state, means=state.means or means_of(scene, state), classes=evolution.classes_at(scene, state))


def inputs_of(scene: Scene) -> tuple[str, ...]:
    return tuple(v.name for v in variables(scene) if v.causality == "input")


def _point(scene: Scene) -> OperatingPoint:
    """Return the operating point at run time."""
    return OperatingPoint(**{name: Num(name) for name in _point_names(scene)})  # type: ignore[arg-type]


def _point_names(scene: Scene) -> list[str]:
    """Return the inputs that the equations look at."""
    unused = () if scene.heat.bulk.from_inputs else ("body_temperature_1", "body_temperature_2")
    return [name for name in inputs_of(scene) if name not in unused]


def _state(scene: Scene) -> ContactState:
    """Return the state at run time."""
    given = first_state(scene)
    names = [field.name for field in dataclasses.fields(Mean)]
    means = tuple(Mean(**{name: Num(f"{name}_{body}") for name in names}) for body in (1, 2))  # type: ignore[arg-type]
    before = changed(given.outputs, **{q.name: Num(f"last_{q.name}") for q in OF_CORE if q.kind == "Real"})
    warm = (Num("warm_1"), Num("warm_2")) if scene.heat.bulk.stores_heat else None
    classes = given.classes and Classes(**{name: _held(name, array) for name, array in vars(given.classes).items()})
    return changed(given, time=Num("time"), means=means, outputs=before, temperatures=warm, classes=classes)


def _held(name: str, array: np.ndarray) -> Any:
    """Return an array of the state at run time; a number for each body is a number."""
    if array.shape == _BODIES:
        return np.array([Num(f"{name}_1"), Num(f"{name}_2")], object)
    return Stored(array.shape, Num(name, array_kind("d", array.size)))


def paths(value: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield the numbers of state and outputs with the way to them."""
    if isinstance(value, np.ndarray) and value.shape == _BODIES:
        yield from paths(tuple(value), path)
    elif is_number(value) or isinstance(value, np.ndarray):
        yield path, value
    elif isinstance(value, Stored):
        yield path, value.data
    else:
        for name, item in parts(value) or ():
            yield from paths(item, (*path, name))


def written(scene: Scene) -> dict[str, str]:
    """Return the C sources of a scene by the names of their files.

    Contacts that differ in track lengths only, such as the stations of a gear mesh, have all files but tracks.c alike.
    Raises SceneError for a scene that the native FMU cannot have.
    """
    check(scene)
    geometry, key = scene.geometry, _key(scene)
    if key not in _written:
        _written[key] = _equations_kept(scene)
    return {**_written[key], "tracks.c": _tracks(geometry.track_length_1, geometry.track_length_2)}


_written: dict[str, dict[str, str]] = {}  # by scene, without what is known at run time only


def _key(scene: Scene) -> str:
    """Return all of a scene that its equations in C depend on."""
    table = scene.to_dict()
    for name in TRACKS if _may_vary(scene) else ():
        table["geometry"].pop(name)
    for name in _point_names(scene):
        if name not in own_radii(scene):
            table["operation"].pop(name, None)
    return json.dumps(table, sort_keys=True)


def _may_vary(scene: Scene) -> bool:
    """Return True if track lengths can be numbers at run time: a map is read for the scene as it is."""
    return not _by_map(scene)


def _tracks(*lengths: float) -> str:
    values = (
        f"const double {name} = {literal(value).text};" for name, value in zip(TRACKS.values(), lengths, strict=True)
    )
    return "\n".join(['#include "contact.h"', "", *values, ""])


def _at_run_time(scene: Scene) -> Scene:
    """Return a scene whose track lengths are numbers at run time."""
    geometry, loose = copy.copy(scene.geometry), object.__new__(type(scene))
    geometry.__dict__.update({name: Num(number) for name, number in TRACKS.items()})
    fields = {field.name: getattr(scene, field.name) for field in dataclasses.fields(scene)}  # no cached properties
    loose.__dict__.update(fields | {"geometry": geometry})
    return loose


def _equations_kept(scene: Scene) -> dict[str, str]:
    """Return the equations, written by an earlier run or now."""
    key = ("equations", keeping.code_of("contact_core", "fmu_src", *homes_of(scene)), _key(packed(scene)))
    return keeping.kept_texts(key, lambda: _equations(scene))


def _equations(scene: Scene) -> dict[str, str]:
    given = _at_run_time(scene) if _may_vary(scene) else scene
    case, state = Case(given, _point(scene)), _state(scene)
    try:
        stepped, step_texts = translated(step, [case, state, Num("dt")])
        slopes, slope_texts = translated(derivatives, [case, state])
    except Untranslatable as error:
        raise SceneError(
            f"The equations of '{scene.name}' cannot be written as C: {error}\n`tribofmu docs native_fmu` says "
            "what can. Write that line so, or build with --flavour isolated."
        ) from error
    if (bytes_ := stack_of(step_texts)) > _MOST_STACK:
        raise SceneError(
            f"stress.layers = {scene.depths.size} needs {bytes_ / 1024:.0f} kB of stack in C, more than the "
            f"{_MOST_STACK / 1024:.0f} kB that every host has. Lower stress.layers, or build with --flavour isolated."
        )
    outputs = [v.name for v in variables(scene) if v.causality == "output" and v.name not in OF_CALLER]
    new_state, new_outputs = stepped.result
    after, first = dict(paths(new_state)), dict(paths(first_state(scene)))
    needed = {number.text for number in (*stepped.takes, *slopes.takes)}
    held = [(path, number) for path, number in paths(state) if isinstance(number, Num) and number.text in needed]
    inputs = inputs_of(scene)
    stepping = [
        *initialise([(number.text, first.get(path, _COLD)) for path, number in held]),
        "",
        *calling(
            "contact_step(const contact_inputs *in, double dt, contact_state *state, contact_outputs *out,",
            stepped,
            inputs,
            [
                *((f"state->{number.text}", after[path]) for path, number in held),
                *((f"out->{name}", getattr(new_outputs, name)) for name in outputs if name not in SLOPES),
            ],
        ),
    ]
    sloping = calling(
        "contact_derivatives(const contact_inputs *in, const contact_state *state, contact_outputs *out,",
        slopes,
        inputs,
        [(f"out->{name}", each) for name, each in zip(SLOPES, slopes.result, strict=True)],
    )
    return {
        "contact.h": header(
            f"One contact, '{scene.name}', at the level '{scene.film.fidelity}'; written from contact_core.",
            variables(scene),
            [f"{number.text}{number.kind[1:]}" for _, number in held],
            outputs,
            _OF_TRACKS,
        ),
        "contact.c": source([*step_texts, "\n".join(stepping)]),
        "slopes.c": source([*slope_texts, "\n".join(sloping)]),
    }


def check(scene: Scene) -> None:
    """Raise SceneError for a scene that no native FMU can have."""
    if scene.film.fidelity not in _LEVELS:
        raise SceneError(
            f"The level '{scene.film.fidelity}' solves contacts, and a native FMU has no solver. Set film.model = "
            "'regression' without film.correction = 'blocks', or build with --flavour isolated."
        )


_OF_TRACKS = (
    "/* Travel of a point of a body between two passes [m]. */",
    f"extern const double {', '.join(TRACKS.values())};",
    "",
)


def translated(function: Any, operands: list[Any], instead: Mapping[Any, Any] | None = None) -> tuple[Entry, list[str]]:
    """Return a function to be called from C, and it and all that it needs as C."""
    reads: dict[Any, set[str]] = {}
    needed: dict[Any, set[str]] = {}  # members that were left out, but are read
    while True:  # members of results that nothing reads are left out, and then what was computed for them
        translator = Translator(reads, instead)
        entry = translator.program(function, operands)
        texts = translator.texts([entry])
        for key, member in translator.members.missed(texts):
            needed.setdefault(key, set()).add(member)
        found = dict(reads)
        for key, members in translator.members.wanted(texts, [entry.name]).items():
            found[key] = members & reads.get(key, members) | needed.get(key, set())
        if found == reads:
            return entry, texts
        reads = found


SLOPES = ("dfriction_dspeed_1", "dfriction_dspeed_2", "dfriction_dload", "dfriction_dtemperature")
