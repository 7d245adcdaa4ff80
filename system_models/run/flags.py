"""Range flags in numbers: which quantity is beyond which limit, at the worst of the rows that raise the flag."""

import math
from collections.abc import Callable
from dataclasses import fields

import numpy as np
import xarray as xr

from contact_core.film.lengths import inlet_length
from contact_core.laws.load_sharing import sliding_ratio
from contact_core.quantities import CELSIUS
from contact_core.regression.load_sharing import Fit, parted, surfaces_of
from contact_core.regression.surfaces import Tribofilm, regression_film
from contact_core.scene import Case, OperatingPoint, Scene
from contact_core.state import RangeFlag

_TEMPERATURES = range(0, 401)  # degC, at which a tribofilm law is asked whether its constants hold
_IN_WORDS = {  # of the places of the fitted curves
    "clearance": "film of smooth bodies / roughness",
    "layers": "that film / height of what is below the grid",
    "flattening": "pressure / what presses the roughness flat",
    "below": "pressure / what presses flat what is below the grid",
    "slip": "slide-to-roll ratio",
    "pressed": "Hertz pressure / hardness",
}
_SMOOTH = {  # places without end: nothing resists the pressure
    "flattening": "the bodies have no roughness",
    "below": "no body has microroughness (surface_1.microroughness)",
}
_NO_MOST, _NO_LEAST = ("layers",), ("slip", "pressed")  # as in `FittedSharing.covers`
Told = Callable[[Scene, xr.Dataset], str]


def sentences(scene: Scene, dataset: xr.Dataset) -> list[str]:
    """Return a sentence for each flag that some row raises, with the quantity and by how much it is beyond."""
    flags, total = dataset["range_flags"].values, dataset.sizes["time"]
    found = []
    for flag in RangeFlag:
        raised = (flags & flag) > 0
        if raised.any():
            number = by_how_much(flag, scene, dataset.isel(time=raised))
            rows = "all rows" if raised.all() else f"{int(raised.sum())} of {total} rows"
            found.append(f"Range, {rows}: {flag.text}" + (f" ({number})." if number else "."))
    return found


def by_how_much(flag: RangeFlag, scene: Scene, rows: xr.Dataset) -> str:
    """Return which quantity is beyond which limit in rows that raise a flag; empty of a flag that says it itself."""
    told = _TOLD.get(flag)
    return told(scene, rows) if told else ""


def operating_point(row: xr.Dataset) -> OperatingPoint:
    """Return the operating point of a row; inputs that the result has not keep their defaults."""
    names = (f.name for f in fields(OperatingPoint))
    return OperatingPoint(**{name: float(row[name]) for name in names if name in row})


def temperatures_of(scene: Scene) -> tuple[float, float] | None:
    """Return the lowest and highest temperature [degC] at which a scene's tribofilm law holds; None if at any."""
    held = [each for each in _TEMPERATURES if scene.tribofilm.covers(each + CELSIUS)]
    return (held[0], held[-1]) if held and len(held) < len(_TEMPERATURES) else None


def _temperature(scene: Scene, rows: xr.Dataset) -> str:
    ends = temperatures_of(scene)
    bodies = np.concatenate([rows[f"temperature_{i}"].values for i in (1, 2)]) - CELSIUS
    if ends is None:
        return ""
    worst = float(bodies[np.argmax(np.maximum(ends[0] - bodies, bodies - ends[1]))])
    return f"{worst:.0f} degC: fitted from {ends[0]:g} to {ends[1]:g} degC"


def _inlet(scene: Scene, rows: xr.Dataset) -> str:
    nodes = [_inlet_nodes(Case.at(scene, operating_point(row))) for row in _some(rows)]
    return f"{min(nodes):.1f} nodes across the inlet" if nodes else ""


def _inlet_nodes(case: Case) -> float:
    return inlet_length(case.hertz.a, case.shape, case.smooth_film) / case.scene.film.spacing


def _few(scene: Scene, rows: xr.Dataset) -> str:
    least = min(_some(rows), key=_load, default=None)
    if least is None:
        return ""
    wide = 2.0 * Case.at(scene, operating_point(least)).hertz.a
    return f"{wide / scene.film.spacing:.1f} nodes at {float(least['load']):.3g} N"


def _unconverged(scene: Scene, rows: xr.Dataset) -> str:
    return f"up to {100.0 * float(rows['unconverged'].max()):.0f} % of a block" if "unconverged" in rows else ""


def _sliding(scene: Scene, rows: xr.Dataset) -> str:
    speeds = np.abs([rows[f"speed_{i}"].values for i in (1, 2)])
    slow, fast = speeds.min(axis=0), speeds.max(axis=0)
    at = int(np.argmin(slow / fast))
    return f"{slow[at]:.3g} m/s beside {fast[at]:.3g} m/s"


def _outside(scene: Scene, rows: xr.Dataset) -> str:
    """Return which numbers of the fitted curves are beyond their ranges, of surfaces as new."""
    scene = scene.at_level("regression")
    some = sorted(_some(rows), key=_load, reverse=True)
    if not some:
        return "at rest"
    for row in some:
        case = Case.at(scene, operating_point(row))
        if case.op.slides and 0.0 in case.speeds:
            return "a body stands still; they are of two that move"
        for name, here in _fit(case)._asdict().items():
            if name in _SMOOTH and math.isinf(here):
                return f"{_SMOOTH[name]}: fitted to bodies that have it"
            low, high = regression_film(scene).sharing.FITTED[name]
            if here > high and name not in _NO_MOST:
                return f"{_IN_WORDS[name]} {here:.3g}: fitted to {high:.3g} at most"
            if here < low and name not in _NO_LEAST:
                return f"{_IN_WORDS[name]} {here:.3g}: fitted from {low:.3g} on"
    return ""


def _fit(case: Case) -> Fit:
    first, second = (Tribofilm(0.0, 0.0, side.surface.rms, 0.0, side.surface.rms) for side in case.sides)
    fit = parted(case, surfaces_of(case, (first, second)), case.smooth_film, case.growth).fit
    return fit._replace(slip=sliding_ratio(case.op.sliding_speed, case.op.entrainment_speed))


def _unsure(scene: Scene, rows: xr.Dataset) -> str:
    names = {"friction": "error_friction", "h_c": "error_film"}
    return ", ".join(f"{name} up to {100.0 * float(rows[error].max()):.0f} %" for name, error in names.items())


def _scuffing(scene: Scene, rows: xr.Dataset) -> str:
    hottest = float(rows["contact_temperature_max"].max()) - CELSIUS
    return f"scuffing ratio up to {float(rows['scuffing_ratio'].max()):.2f}, {hottest:.0f} degC"


def _pitted(scene: Scene, rows: xr.Dataset) -> str:
    areas = [100.0 * float(rows[f"micropitted_area_{i}"].max()) for i in (1, 2) if f"micropitted_area_{i}" in rows]
    return f"up to {max(areas):.2g} % of a track" if areas else ""


def _some(rows: xr.Dataset) -> list[xr.Dataset]:
    """Return rows under load and in motion that stand for all: of least and most load, slowest and fastest, last."""
    loads, speed = rows["load"].values, np.abs(rows["speed_1"].values + rows["speed_2"].values)
    loaded = np.flatnonzero((loads > 0.0) & (speed > 0.0))
    if not loaded.size:
        return []
    chosen = {int(loaded[f(values[loaded])]) for f in (np.argmin, np.argmax) for values in (loads, speed)}
    return [rows.isel(time=k) for k in sorted({*chosen, int(loaded[-1])})]


def _load(row: xr.Dataset) -> float:
    return float(row["load"])


_TOLD: dict[RangeFlag, Told] = {
    RangeFlag.TRIBOFILM_TEMPERATURE: _temperature,
    RangeFlag.INLET_UNRESOLVED: _inlet,
    RangeFlag.NOT_CONVERGED: _unconverged,
    RangeFlag.FEW_NODES: _few,
    RangeFlag.SLOW_BODY: _sliding,
    RangeFlag.OUTSIDE_FIT: _outside,
    RangeFlag.UNSURE: _unsure,
    RangeFlag.SCUFFING: _scuffing,
    RangeFlag.PITTED: _pitted,
}
