"""The report of Stribeck curves: a table of friction, the shift of the curves, and one picture."""

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Mask
from contact_core.quantities import CELSIUS
from contact_core.state import RangeFlag

from ..charts.chart import GREY, NOTHING, Chart, Line, Sheet, shades
from ..store.results import ERROR
from .cosim_report import aligned

_SOURCE = "Dawczyk et al. 2019, doi:10.1007/s11249-019-1148-9"
_ROUGH = ("tribofilm_roughness_1", "tribofilm_roughness_2", "composite_roughness")
_PANELS: tuple[tuple[str, str, str, tuple[float, ...]], ...] = (
    ("friction_coefficient", "Friction coefficient", "µ", ()),
    ("lambda_ratio", "Lambda ratio", "λ", ()),
    ("contact_load_ratio", "Share of the solids in the load", "W_c", (0.5,)),
    ("contact_area_ratio", "Real contact area over the Hertz area", "A_c", ()),
)


def minutes(dataset: xr.Dataset) -> list[str]:
    """Return the rubbing times [min] as text."""
    return [f"{time / 60.0:g}" for time in dataset["rubbing_time"].values]


def table(dataset: xr.Dataset) -> str:
    """Return friction coefficients, a row for each speed and a column for each rubbing time."""
    times, speeds = minutes(dataset), dataset["entrainment_speed"].values
    head = [["speed", *("friction" for _ in times)], ["m/s", *(f"{time} min" for time in times)]]
    friction = zip(speeds, dataset["friction_coefficient"].values.T, strict=True)
    return "\n".join(aligned([*head, *([f"{u:.4g}", *(f"{mu:.4f}" for mu in row)] for u, row in friction)], 0))


def shift_lines(dataset: xr.Dataset) -> list[str]:
    """Return the transition of each curve and the roughness then; the shift in all."""
    level = dataset.attrs["friction_midway"]
    lines = []
    for text, row in zip(minutes(dataset), _rows(dataset), strict=True):
        first, second, both = (1e9 * float(row[name]) for name in _ROUGH)
        lines.append(
            f"After {text} min: W_c = 0.5 at {_speed(row['transition_speed'])}, friction {level:.3f} at "
            f"{_speed(row['transition_speed_friction'])}; roughness of the tribofilm {first:.1f} nm (body 1), "
            f"{second:.1f} nm (body 2), of both surfaces together {both:.1f} nm."
        )
    return [*lines, *_verdict(dataset)]


def _rows(dataset: xr.Dataset) -> list[xr.Dataset]:
    return [dataset.isel(rubbing_time=i) for i in range(dataset.sizes["rubbing_time"])]


def _speed(value: xr.DataArray) -> str:
    return f"{float(value):.3g} m/s" if np.isfinite(value) else "no speed of the sweep"


def _verdict(dataset: xr.Dataset) -> list[str]:
    """Return the shift of the transition from that of the first curve, beside the effect of roughness."""
    speeds, rough = (dataset[name].values for name in ("transition_speed", "composite_roughness"))
    moved = [
        f"{text} min by {speed / speeds[0]:.2f}, roughness by {both / rough[0]:.2f}"
        for text, speed, both in zip(minutes(dataset)[1:], speeds[1:], rough[1:], strict=True)
        if np.isfinite(speed / speeds[0])
    ]
    if not moved:
        return []
    fastest, roughest = (minutes(dataset)[int(np.nanargmax(values))] for values in (speeds, rough))
    return [
        f"Shift of W_c = 0.5 from the first curve, as a factor: after {'; '.join(moved)}. The transition is at the "
        f"highest speed after {fastest} min, the surfaces are roughest after {roughest} min. "
        f"Measured curves shift to higher speed as the tribofilm roughens ({_SOURCE})."
    ]


def closing_lines(dataset: xr.Dataset) -> list[str]:
    """Return validity and range, in sentences."""
    invalid, total = invalid_points(dataset), dataset["valid"].size
    lines = [f"All {total} points were computed.{_known(dataset)}"]
    if invalid:
        lines = [f"Validity: {invalid} of {total} points are INVALID.", *dataset.attrs["failures"].splitlines()]
    flags = dataset["range_flags"].values
    counts = {flag: int(((flags & flag) > 0).sum()) for flag in RangeFlag}
    return lines + [f"Range, at {n} of {total} points: {flag.text}." for flag, n in counts.items() if n]


def _known(dataset: xr.Dataset) -> str:
    """Return how well friction is known, from the surest of the points to the least sure one."""
    friction, half = dataset["friction_coefficient"], dataset.coords.get(f"friction_coefficient{ERROR}")
    if half is None or not (friction > 0.0).any():
        return ""
    relative = 100.0 * (half / friction).where(friction > 0.0)
    return f" Friction is known to {float(relative.min()):.2g} % at best, to {float(relative.max()):.2g} % at worst."


def invalid_points(dataset: xr.Dataset) -> int:
    """Return the number of points without an answer."""
    return int((~dataset["valid"].values).sum())


def sheet(dataset: xr.Dataset) -> Sheet:
    """Return friction, lambda ratio, load and area of the solids against speed, a line for each rubbing time.

    A hollow point stands for film solutions that have not converged, or a dry one in their place.
    """
    unsure = (dataset["range_flags"].values & (RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK)) > 0
    return Sheet([_curves(dataset, panel, unsure) for panel in _PANELS], _title(dataset), height=3.3)


def _curves(dataset: xr.Dataset, panel: tuple[str, str, str, tuple[float, ...]], unsure: Mask) -> Chart:
    name, title, symbol, levels = panel
    first = panel is _PANELS[0]  # that has the key
    values, half = dataset[name].values, dataset.coords.get(f"{name}{ERROR}")
    if name == "lambda_ratio":
        values = np.where(values < 1e3, values, np.nan)  # at its cap it says nothing
    speeds, lines = dataset["entrainment_speed"].values, []
    for k, (time, colour) in enumerate(zip(minutes(dataset), shades(len(values)), strict=True)):
        band, doubtful = None if half is None else half.values[k], unsure[k]
        lines.append(Line(time if first else "", speeds, values[k], band, colour=colour, style="o-"))
        lines.append(Line("", speeds[doubtful], values[k][doubtful], colour=colour, style="oh"))
    if first and unsure.any():
        lines.append(Line("not converged", NOTHING, NOTHING, colour=GREY, style="oh"))
    key, most = "rubbed [min]" if first else "", 1.0 if levels else None
    x_label, y_label = "entrainment speed [m/s]", f"{symbol} [–]"
    return Chart(title, x_label, y_label, lines, logarithmic_x=True, levels=levels, key=key, most=most)


def _title(dataset: xr.Dataset) -> str:
    return (
        f"{dataset.attrs['scene']}: {float(dataset['load']):.4g} N, {float(dataset['temperature']) - CELSIUS:.4g} °C, "
        f"slide-to-roll ratio {100.0 * float(dataset['slide_roll_ratio']):.3g} %, "
        f"level {dataset.attrs['film']}"
    )
