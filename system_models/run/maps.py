"""Maps of the contact and of both bodies at one time as bytes, and the Dataset made of those of several times.

Those of the contact lie on its grid, those of a body on its patch, which moves with it. Maps are in single precision.
"""

import io
import logging
from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from contact_core import ContactState, OperatingPoint, Scene, initial_state, track_of
from contact_core.deterministic.present import present_instant
from contact_core.errors import ContactError
from contact_core.scene import Case
from contact_core.surfaces.patches import bare_heights

log = logging.getLogger(__name__)

TIME, ALONG = "field_time", "x_track"
ROUTES = ("none", "mixed", "dry", "fallback", "open")  # of an instant; none: no solution
_CONTACT = {  # unit and text
    "pressure": ("Pa", "pressure of oil and solids together"),
    "fluid_pressure": ("Pa", "pressure of the oil"),
    "solid_pressure": ("Pa", "pressure of the solids, mean over the area of a node"),
    "gap": ("m", "gap between the bodies, film.floor where solids touch"),
}
_BODY = {
    "tribofilm": "tribofilm thickness on",
    "wear": "depth worn off",
    "plastic": "permanent depth pressed into",
    "pits": "depth that fatigue has broken out of",
}
_MAP = np.dtype(np.float32)
_DEFLATED: dict[str, Any] = {"zlib": True, "complevel": 4, "shuffle": True}
_BODIES = (1, 2)


def size_of(scene: Scene) -> int:
    """Return the bytes that the maps of one time take up uncompressed."""
    points = scene.film.points
    return scene.rows * (len(_CONTACT) * points + 2 * len(_kept(scene)) * (points - 1)) * _MAP.itemsize


def _kept(scene: Scene) -> list[str]:
    """Return the names of the maps of a body: pits where a law of fatigue makes some."""
    return [name for name in _BODY if name != "pits" or scene.fatigue.damages]


def taken(scene: Scene, op: OperatingPoint, state: ContactState | None, time: float) -> bytes:
    """Return maps and profiles of a state, None if the contact could not be set up, at `time` [s].

    Where no contact can be solved its maps are missing (NaN), with a warning.
    """
    shown = state or initial_state(scene)
    places, route, converged = shown, "none", False
    found: dict[str, Any] = dict.fromkeys(_CONTACT, np.full((shown.rows, scene.film.points), np.nan))
    try:
        if state is None:
            raise ContactError("It could not be set up.")
        places, fields = present_instant(Case.bind(scene, op, state.temperatures), state)
    except ContactError as error:
        log.warning("The contact has no fields at %g s. %s", time, error)
    else:
        found |= {name: getattr(fields, name) for name in _CONTACT}
        route, converged = fields.route, fields.converged
    for body in _BODIES:
        track = track_of(scene, shown, body)
        found |= {f"{name}_map_{body}": getattr(track, name) for name in _kept(scene)}
        found |= {f"{name}_profile_{body}": getattr(track, name).mean(axis=1) for name in ("heights", *_kept(scene))}
        found[f"offset_{body}"] = places.bodies[body - 1].offset
    maps = {name: np.asarray(field, _MAP) for name, field in found.items() if np.ndim(field) == 2}
    stream = io.BytesIO()
    how = {"instant_route": np.int8(ROUTES.index(route)), "instant_converged": np.bool_(converged)}
    np.savez_compressed(stream, **(found | maps | how))
    return stream.getvalue()


def dataset_of(scene: Scene, times: Sequence[float], records: Sequence[bytes]) -> xr.Dataset:
    """Return what `taken` gave at `times` [s] as variables along `field_time`, compressed when written.

    Patches that have got more rows in the run show new surfaces there before, and the contact has no values there.
    """
    every = [_unpacked(record) for record in records]
    rows = max(record["gap"].shape[0] for record in every)
    new = bare_heights(scene, rows)
    before: dict[str, Any] = dict.fromkeys(_CONTACT, np.nan)
    before |= {f"heights_profile_{body}": bare.mean(axis=1) for body, bare in zip(_BODIES, new, strict=True)}
    hertz, grid = scene.hertz(scene.operation.load), scene.grid(rows)
    along = np.arange(scene.film.points - 1) * scene.film.spacing
    text = "along the track of a body, on its patch, which repeats along the track"
    found = xr.Dataset(
        coords={
            TIME: (TIME, np.array(times), _about("s", "test time of the maps and profiles")),
            "y": ("y", grid.y, _about("m", "across entrainment, from the centre of the contact", axis="Y")),
            "x": ("x", grid.x, _about("m", "along entrainment, from the centre of the contact", axis="X")),
            ALONG: (ALONG, along, _about("m", text)),
        }
    )
    for name in every[0]:
        values = np.stack([_wide(record[name], rows, before.get(name, 0.0)) for record in every])
        found[name] = _variable(name, values)
    for body, bare in zip(_BODIES, new, strict=True):
        name, text = f"new_heights_{body}", f"heights of body {body} as new, positive toward the other body"
        found[name] = _deflated(("y", ALONG), bare.astype(_MAP), _about("m", text))
    across = "the same along y; the track of a body is |y| < half_width_y"
    found["half_width_x"] = ((), hertz.a, _about("m", "Hertz's half width along x at the load of [operation]"))
    found["half_width_y"] = ((), hertz.b, _about("m", across))
    return found


def _unpacked(record: bytes) -> dict[str, NDArray[Any]]:
    with np.load(io.BytesIO(record), allow_pickle=False) as arrays:
        return {name: arrays[name] for name in arrays.files}


def _wide(values: NDArray[Any], rows: int, before: Any) -> NDArray[Any]:
    """Return a map or profile with so many rows; new rows are filled with `before`."""
    if not values.ndim or values.shape[0] == rows:
        return values
    more = (rows - values.shape[0]) // 2
    wide = np.full((rows, *values.shape[1:]), 0.0, values.dtype)
    wide[:] = before
    wide[more : more + values.shape[0]] = values
    return wide


def _variable(name: str, values: NDArray[Any]) -> xr.Variable:
    """Return a variable along the times by the name that it has in a record."""
    if name in _CONTACT:
        return _deflated((TIME, "y", "x"), values, _about(*_CONTACT[name]))
    if name == "instant_route":
        meanings: dict[str, Any] = {
            "flag_values": np.arange(len(ROUTES), dtype=np.int8),
            "flag_meanings": " ".join(ROUTES),
        }
        return xr.Variable(TIME, values, _about("1", "how the instant of the maps was solved", **meanings))
    if name == "instant_converged":
        return xr.Variable(TIME, values, _about("1", "true: the instant of the maps converged"))
    kind, _, rest = name.partition("_")
    body = f"body {name[-1]}"
    if kind == "offset":
        text = f"how far the patch of {body} lies along +x: its first node is at the first x of the grid plus this"
        return xr.Variable(TIME, values, _about("m", f"{text}, modulo its length"))
    what = f"{_BODY[kind]} {body}" if kind in _BODY else f"heights of {body} as they are, toward the other body"
    if rest.startswith("profile"):
        return _deflated((TIME, "y"), values, _about("m", f"{what}, mean along the track"))
    return _deflated((TIME, "y", ALONG), values, _about("m", what))


def _deflated(dims: tuple[Hashable, ...], values: NDArray[Any], about: dict[str, Any]) -> xr.Variable:
    """Return a variable that is written compressed, the map of each time for itself."""
    chunks = tuple(1 if dim == TIME else size for dim, size in zip(dims, values.shape, strict=True))
    return xr.Variable(dims, values, about, _DEFLATED | {"chunksizes": chunks})


def _about(unit: str, text: str, **more: Any) -> dict[str, Any]:
    return {"units": unit, "long_name": text, **more}
