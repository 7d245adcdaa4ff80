"""Scenes as they are shipped, on their own grids, at both levels; then every law on a coarse grid, and the calls."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

from golden_calls import CALLS
from golden_laws import VARIANTS
from golden_record import Record

from contact_core import ContactError, OperatingPoint, Scene, advance, initial_state, shipped_scenes, uncertainty

LEVELS = ("regression", "deterministic")
LONG = {"regression": (0.0, 1e-3, 10.0, 600.0), "deterministic": (0.0, 1e-3, 1.0)}
COARSE = (0.0, 1e-3, 20.0)


def runs(before: Any) -> Iterator[tuple[str, Callable[[Record], None]]]:
    """Return the names and functions of all runs."""
    for name in shipped_scenes():
        for level in LEVELS:
            yield f"{name}, {level}, as shipped", partial(_shipped, name, level)
    for name, (scene, overrides, point) in VARIANTS.items():
        yield f"{scene}, {name}", partial(_variant, scene, overrides, point)
    yield from CALLS.items()


def _shipped(name: str, level: str, record: Record) -> None:
    scene = Scene.from_toml(name).at_level(level)
    record.put("digest", scene.digest())
    record.put("scene", repr(scene.to_dict()))
    _steps(record, scene, scene.operation.point, LONG[level])


def _variant(name: str, overrides: dict[str, str], point: dict[str, float], record: Record) -> None:
    """Both levels from the beginning; then the one goes on where the other has stopped."""
    try:
        scene = Scene.from_toml(name, overrides)
    except ContactError as error:
        record.put("refused", str(error))
        return
    record.put("warnings", scene.warnings())
    op = replace(scene.operation.point, **point)
    ended = {}
    for level in LEVELS:
        ended[level] = _steps(record, scene.at_level(level), op, COARSE, f"{level}, ")
    for level, other in zip(LEVELS, reversed(LEVELS), strict=True):
        if ended[level] is not None:
            _advanced(record, f"{other} after {level}", scene.at_level(other), op, ended[level], 5.0)


def _steps(record: Record, scene: Scene, op: OperatingPoint, times: tuple[float, ...], prefix: str = "") -> Any:
    """Steps at one operating point, and one at another; the last state, None if a step was refused."""
    state = initial_state(scene)
    for i, dt in enumerate(times):
        state = _advanced(record, f"{prefix}step {i}", scene, op, state, dt)
        if state is None:
            return None
    other = replace(op, load=0.8 * op.load, speed_1=1.1 * op.speed_1, temperature=op.temperature + 1.0)
    return _advanced(record, f"{prefix}another point", scene, other, state, 1e-3)


def _advanced(record: Record, name: str, scene: Scene, op: OperatingPoint, state: Any, dt: float) -> Any:
    """One step, what it gives and the bytes of its state."""
    try:
        state, outputs = advance(scene, op, state, dt)
    except ContactError as error:
        record.put(f"{name}: refused", f"{type(error).__name__}: {error}")
        return None
    record.put(name, outputs)
    record.put(f"{name}: state", state.to_bytes())
    record.put(f"{name}: uncertainty", uncertainty(scene, state))
    return state
