"""The calls of contact_core beside `advance`, each once or a few times."""

from dataclasses import fields, replace
from itertools import islice
from typing import Any

import numpy as np
from golden_laws import LINE, SMALL, SMOOTH
from golden_record import Record

from contact_core import (
    Logarithmic,
    Rounded,
    Scene,
    Transient,
    advance,
    dry_contact,
    initial_state,
    line_contact,
    march,
    parted,
    point_contact,
    run_cycle,
    solve,
    track_of,
    warm_up,
)

STEEL = {"reduced_modulus": 230e9, "speed_1": 4.0, "speed_2": 2.6, "viscosity": 0.0143, "pressure_viscosity": 15e-9}
BALL = {"load": 77.85, "radius_x": 0.01, "speed_1": 0.25, "speed_2": 0.25, "viscosity": 0.004, "grid": 65}
INSIDE = ("film", "sheared")  # of the fields of an instant: the names in them are not promised


def _rough(rows: int, columns: int, rms: float, seed: int = 7) -> np.ndarray:
    """Heights that do not depend on the code."""
    made = np.random.default_rng(seed).standard_normal((rows, columns))
    for axis in (0, 1):
        made = made + np.roll(made, 1, axis) + np.roll(made, -1, axis)
    return rms * made / made.std()


def _fields(record: Record, name: str, found: Any) -> None:
    for f in fields(found):
        if f.name not in INSIDE:
            record.put(f"{name}.{f.name}", getattr(found, f.name))


def _point(record: Record) -> None:
    steel = STEEL | BALL
    record.put("ball", point_contact(**steel))
    record.put("ellipse", point_contact(**(STEEL | {"load": 300.0, "radius_x": 5.1e-3, "radius_y": 0.1, "grid": 65})))
    rough = {"heights_1": _rough(65, 65, 2e-8), "spacing": 8e-6, "hardness": 4e9}
    record.put("rough", point_contact(**({**steel, "grid": None} | rough)))
    record.put("slow", point_contact(**(steel | {"speed_1": 1e-3, "speed_2": 1e-3} | rough | {"grid": None})))
    record.put("starved", point_contact(**steel, cavitation="mass_conserving", supply=5e-8))
    record.put("meniscus", point_contact(**steel, meniscus=2e-4, fft="scipy"))
    record.put("barus", point_contact(**steel, viscosity_law="barus", density_law="none"))
    record.put("at rest", point_contact(**(steel | {"speed_1": 0.0, "speed_2": 0.0})))
    record.put("lumped", point_contact(**({**steel, "grid": None} | rough), criterion="lumped", floor=0.47e-9))


def _line(record: Record) -> None:
    flank = STEEL | {"load": 286e3, "radius": 8.73e-3}
    record.put("smooth", line_contact(**flank))
    record.put("starved", line_contact(**flank, cavitation="mass_conserving", supply=0.2e-6))
    record.put("rough", line_contact(**flank, heights_1=_rough(16, 129, 1e-7), spacing=7e-6, hardness=4e9))
    for profile in (Logarithmic(2e-6), Rounded(1.6e-3, 2e-2)):
        name = type(profile).__name__
        record.put(name, line_contact(**flank, length=2e-3, profile=profile, grid=65))


def _dry(record: Record) -> None:
    heights, steel = _rough(64, 65, 1e-7), {"spacing": 8e-6, "reduced_modulus": 230e9}
    record.put("elastic", dry_contact(heights, radius=0.01, load=50.0, **steel))
    record.put("plastic", dry_contact(heights, radius=0.01, load=50.0, hardness=3e9, **steel))
    record.put("flat", dry_contact(heights, radius=np.inf, load=50.0, **steel))
    record.put("ellipse", dry_contact(heights, radius=0.01, radius_y=0.03, load=50.0, fft="scipy", **steel))


def _scene(**more: str) -> tuple[Scene, Any, Any]:
    scene = Scene.from_toml("mtm_zddp", SMALL | {name.replace("__", "."): value for name, value in more.items()})
    return scene, initial_state(scene), scene.operation.point


def _solve(record: Record) -> None:
    scene, state, op = _scene()
    _fields(record, "steady", solve(scene, op, state))
    _fields(record, "dry", solve(scene, op, state, dry=True))
    state, _ = advance(scene, op, state, 5.0)
    dt = scene.film.spacing / op.entrainment_speed
    _fields(record, "next", solve(scene, op, state, Transient(dt, 1, 40)))
    other = Scene.from_toml("fzg_flank", LINE)
    _fields(record, "line", solve(other, other.operation.point, initial_state(other)))
    record.put("state of a realisation", initial_state(scene.realisation(3)).to_bytes())


def _march(record: Record) -> None:
    scene, state, op = _scene()
    for order in (1, 2):
        duty = lambda time: replace(op, load=op.load * (1.0 + 0.5 * np.sin(time * 1e3)))  # noqa: E731
        for i, moment in enumerate(march(scene, state, duty, np.linspace(0.0, 2e-3, 5).tolist(), order=order)):
            record.put(f"order {order}, moment {i}", moment.outputs)
            record.put(f"order {order}, moment {i}: time", moment.time)
            record.put(f"order {order}, moment {i}: gap", moment.fields.gap)
            record.put(f"order {order}, moment {i}: state", moment.state.to_bytes())
    loads = {0.0: op.load, 1e-5: 0.0, 2e-5: op.load}
    opened = march(scene, state, lambda time: replace(op, load=loads[time]), list(loads))
    for i, moment in enumerate(islice(opened, 3)):
        record.put(f"opened, moment {i}", moment.outputs)


def _cycle(record: Record) -> None:
    scene, state, op = _scene(tribofilm__beyond_fit="extrapolate")
    duty = lambda time: replace(op, load=op.load * (1.0 + 0.5 * np.sin(time * 1e4)))  # noqa: E731
    after, moments = run_cycle(scene, state, duty, np.linspace(0.0, 3e-4, 7).tolist(), 1e4)
    record.put("moments", [moment.outputs for moment in moments])
    record.put("outputs", after.outputs)
    record.put("state", after.to_bytes())


def _parted(record: Record) -> None:
    scene, state, op = _scene(**{f"surface_{i}__rq": SMOOTH[f"surface_{i}.rq"] for i in (1, 2)})
    op = replace(op, speed_1=0.0, speed_2=0.0)
    apart = parted(scene, op, state, 2e-6)
    record.put("apart", apart.to_bytes())
    for i, moment in enumerate(march(scene, apart, lambda time: op, np.linspace(0.0, 2e-4, 8).tolist())):
        record.put(f"moment {i}", moment.outputs)
        record.put(f"moment {i}: gap", moment.fields.gap)


def _tracks(record: Record) -> None:
    scene, state, op = _scene()
    warm_up(scene)
    for level in ("deterministic", "regression"):
        state, _ = advance(scene.at_level(level), op, state, 30.0)
        for body in (1, 2):
            record.put(f"{level}, body {body}", track_of(scene.at_level(level), state, body))
    record.put("long", track_of(scene, state, 2, 2e-3))


CALLS = {
    "point_contact": _point,
    "line_contact": _line,
    "dry_contact": _dry,
    "solve": _solve,
    "march": _march,
    "run_cycle": _cycle,
    "parted, march": _parted,
    "track_of, warm_up": _tracks,
}
