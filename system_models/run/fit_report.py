"""The report of a fit: tables, picture, CSV, JSON, and the named set for scenes."""

import csv
import json
from collections.abc import Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

import contact_core
from contact_core.quantities import TABLE
from contact_core.scene import OperatingPoint, units
from contact_core.scene.toml import unbuild
from contact_core.scene.tunables import with_values

from ..charts import files
from ..charts.chart import COLOURS, GREY, NOTHING, Chart, Line, Sheet
from .cosim_report import aligned
from .fit import Fit
from .fit_data import words
from .fit_estimate import COVERED, Limits
from .fit_model import Constant

_PERCENT = f"{100.0 * COVERED:.0f} %"


def table(fit: Fit) -> str:
    """Return a row for each constant: key, value, interval, unit."""
    rows = [["constant", "value", f"{_PERCENT} interval", "unit"]]
    for constant, limits in zip(fit.constants, fit.estimate.limits, strict=True):
        interval = interval_of(constant, limits)
        value = f"({fit.values[constant.key]:.4g})" if limits.open else f"{fit.values[constant.key]:.4g}"
        rows.append([constant.key, value, interval, constant.unit or "1"])
    return "\n".join(aligned(rows, 1))


def interval_of(constant: Constant, limits: Limits) -> str:
    """Return the interval of a constant in its unit, as text."""
    low, high = (None if end is None else f"{constant.at(end):.4g}" for end in (limits.low, limits.high))
    if limits.open:
        return f"not identifiable within {constant.low:.4g} to {constant.high:.4g}"
    if low is None:
        return f"at most {high}"
    return f"{low} to {high}" if high is not None else f"at least {low}"


def lines(fit: Fit) -> list[str]:
    """Return sentences on points, scatter, held-back points and what the level states of its errors."""
    measured, found = fit.measured, []
    used = ~fit.held & ~fit.silent
    for g, name in enumerate(measured.quantities):
        here = measured.quantity == name
        count = f"{int((here & used).sum())} points of {name} fitted, {int((here & used & fit.inside).sum())} inside"
        found.append(f"{count} their {_PERCENT} interval; {scatter_of(fit, g)}.")
    held = fit.held & ~fit.silent
    if held.any():
        inside = int((held & fit.inside).sum())
        found.append(f"Held back: {int(held.sum())} points, {inside} inside their {_PERCENT} interval.")
    if fit.silent.any():
        found.append(f"{int(fit.silent.sum())} points that no constant changes are left out, such as films at time 0.")
    if any(limits.open for limits in fit.estimate.limits):
        found.append(
            "Not identifiable: points fit about as well anywhere in the range; the value in brackets is an example."
        )
    errors = ", ".join(f"{name} {100.0 * error:.0f} %" for name, error in fit.stated.items() if error > 0.0)
    if errors:
        found.append(
            f"The level states errors of {errors}. They are common to the points of a test, so the constants take them "
            f"up: these are constants of level '{fit.level}'."
        )
    if fit.failures:
        found.append(
            f"The scene could not be computed with {fit.failures} of the sets of constants tried: passed over."
        )
    if not fit.agreed:
        found.append(
            f"NOT SETTLED: level '{fit.level}' is off the fitted curves by {fit.off:.2g} standard deviations. The "
            "constants are the best of those tried."
        )
    return found


def scatter_of(fit: Fit, group: int) -> str:
    """Return in words how measured numbers scatter about the curve of a quantity."""
    name = fit.measured.quantities[group]
    unit, factor = people_read(name)
    s, given = fit.estimate.scatter[group], bool((fit.measured.sd[fit.measured.quantity == name] > 0.0).any())
    size = f"{factor * s:.3g} {unit}".removesuffix(" 1")
    if fit.estimate.proportional[group]:
        size = f"{100.0 * s:.3g} % of the curve"
    if given and s == 0.0:
        return "the given standard deviations explain the residuals"
    return f"scatter beyond the given standard deviations {size}" if given else f"scatter {size}"


def people_read(quantity: str) -> tuple[str, float]:
    """Return the unit that people read of a quantity, and the factor from SI to it."""
    unit = TABLE[quantity].display or TABLE[quantity].unit
    return unit, 1.0 / units.unit(unit)[0]


def record(fit: Fit) -> dict[str, Any]:
    return {
        **_origin(fit),
        "constants": [
            {
                "key": c.key, "value": fit.values[c.key], "unit": c.unit, "range": [c.low, c.high], "start": c.value,
                "interval": [None if end is None else c.at(end) for end in (limits.low, limits.high)],
                "identifiable": not limits.open,
            }
            for c, limits in zip(fit.constants, fit.estimate.limits, strict=True)
        ],
        "scatter": [
            {"quantity": name, "value": s, "of_the_curve": relative}
            for name, s, relative in zip(
                fit.measured.quantities, fit.estimate.scatter, fit.estimate.proportional, strict=True
            )
        ],
        "covered": COVERED, "stated_errors": fit.stated, "simulated_tests": fit.runs, "failures": fit.failures,
        "level_off_by_standard_deviations": fit.off,
        "scene_values": fit.scene.to_dict(),
    }  # fmt: skip


def _origin(fit: Fit) -> dict[str, Any]:
    used, held = ~fit.held & ~fit.silent, fit.held & ~fit.silent
    return {
        "data": fit.measured.source, "digest": fit.measured.digest, "scene": fit.scene.name, "level": fit.level,
        "version": contact_core.__version__, "points": int(used.sum()), "held_back": int(held.sum()),
        "held_back_inside": int((held & fit.inside).sum()),
    }  # fmt: skip


def write(fit: Fit, name: str, folder: Path) -> list[Path]:
    """Write fit.json, fit.csv, fit.png and the set NAME.toml into a folder and return their paths."""
    paths = [folder / "fit.json", folder / "fit.csv", folder / "fit.png", folder / f"{name}.toml"]
    paths[0].write_text(json.dumps(record(fit), indent=1) + "\n", encoding="utf-8")
    with paths[1].open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows(_rows(fit))
    files.save(sheet(fit), paths[2])
    paths[3].write_text(set_of(fit, name), encoding="utf-8")
    return paths


def _rows(fit: Fit) -> Iterator[list[Any]]:
    """Yield the rows of fit.csv: every measured number beside the curve and its interval, in SI."""
    inputs = [f.name for f in fields(OperatingPoint)]
    measured, found = fit.measured, fit.estimate
    heads = [f"{name} [{TABLE[name].unit}]" for name in inputs]
    yield ["quantity", "unit", *heads, "time [s]", "measured", "sd", "curve", "low", "high", "held_back", "inside"]
    for i, name in enumerate(measured.quantity.tolist()):
        test = measured.tests[int(measured.test[i])]
        curve, half = float(found.curve[i]), float(found.half[i])
        numbers = (measured.time[i], measured.value[i], measured.sd[i], curve, curve - half, curve + half)
        at = ["" if getattr(test, f) is None else getattr(test, f) for f in inputs]
        yield [name, TABLE[name].unit, *at, *map(float, numbers), int(fit.held[i]), int(fit.inside[i])]


def set_of(fit: Fit, name: str) -> str:
    """Return the TOML of a named set: the tables of the scene that have a fitted constant, and where it is from."""
    scene = with_values(fit.scene, fit.values)
    origin = _origin(fit)
    source = (
        f"Fitted to {origin['points']} points of {origin['data']} (sha256 {origin['digest']}) in scene "
        f"{origin['scene']} at level {fit.level}"
    )
    described = {
        **origin,
        "intervals": {
            c.key: f"{interval_of(c, limits)} {c.unit}".rstrip()
            for c, limits in zip(fit.constants, fit.estimate.limits, strict=True)
        },
        "scatter": {n: scatter_of(fit, g) for g, n in enumerate(fit.measured.quantities)},
    }
    parts = dict.fromkeys(c.key.partition(".")[0] for c in fit.constants)
    text = [f'# A scene uses it by [{part}] set = "{name}.toml:{name}".' for part in parts]
    tables = {part: unbuild(getattr(scene, part)) for part in parts}
    values = {"source": source, **tables, "intervals": _intervals(fit), "fit": described}
    return "\n".join([*text, "", *_toml(values, name)]) + "\n"


def _intervals(fit: Fit) -> dict[str, Any]:
    """Return the intervals of a set's constants whose limits are known, as a scene has them.

    Fitted constants are off together: each interval moves a constant by what those before it leave open, and those
    after it along. They are the columns of Cholesky's root of the covariance, which add as if they were independent.
    """
    limits = fit.estimate.limits
    closed = [i for i, limit in enumerate(limits) if limit.low is not None and limit.high is not None]
    root = fit.estimate.quantile * np.linalg.cholesky(fit.estimate.covariance[np.ix_(closed, closed)])
    found = {}
    for j in range(len(closed)):
        moved = [(fit.constants[i], fit.estimate.shares[i], root[k, j]) for k, i in enumerate(closed) if k >= j]
        ends = [[_text(c, at + way * by) for c, at, by in moved] for way in (-1, 1)]
        found[", ".join(c.key for c, _, _ in moved)] = ends if len(moved) > 1 else [end[0] for end in ends]
    return found


def _text(constant: Constant, share: float) -> str:
    return f"{constant.at(min(max(float(share), 0.0), 1.0))!r} {constant.unit}".rstrip()


def _toml(values: Mapping[str, Any], path: str) -> Iterator[str]:
    """Yield the lines of a table and of the tables in it."""
    yield f"[{path}]"
    for key, value in values.items():
        if not isinstance(value, Mapping):
            yield f"{_key(key)} = {json.dumps(value, ensure_ascii=False)}"
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield ""
            yield from _toml(value, f"{path}.{_key(key)}")


def _key(text: str) -> str:
    return text if text.replace("_", "").isalnum() else json.dumps(text)


def sheet(fit: Fit) -> Sheet:
    """Return the picture: points, curves and bands, a panel for each quantity."""
    course = len(fit.drawn.time) > 0
    charts = [(_course if course else _over_input)(fit, name) for name in fit.measured.quantities]
    of = f"{fit.measured.source} in {fit.scene.name}, level {fit.level}; bands: {_PERCENT} of measurements"
    return Sheet(charts, of, columns=1, width=8.0, height=3.4)


def _course(fit: Fit, name: str) -> Chart:
    """Return a quantity against time, a colour for each test."""
    unit, factor = people_read(name)
    points, curves, lines = fit.measured, fit.drawn, []
    for i, text in enumerate(words(points.tests)):
        line = (curves.test == i) & (curves.quantity == name)
        curve, half = factor * curves.curve[line], factor * curves.half[line]
        lines.append(Line(text, curves.time[line] / 60.0, curve, half, colour=_colour(i)))
        here = np.flatnonzero((points.test == i) & (points.quantity == name))
        lines += _points(fit, here, points.time[here] / 60.0, factor, _colour(i))
    values = points.value[points.quantity == name]
    zero = bool(0.0 <= values.min() < 0.5 * values.max())
    return Chart("", "time [min]", f"{name} [{unit}]", [*lines, *_meaning(fit)], from_zero=zero)


def _over_input(fit: Fit, name: str) -> Chart:
    """Return a quantity at time 0 against the input that differs most between tests."""
    unit, factor = people_read(name)
    points, swept = fit.measured, _swept(fit.measured.tests)
    here = np.flatnonzero(points.quantity == name)
    x = np.array([float(getattr(points.tests[points.test[i]], swept) or 0.0) for i in here])
    order = np.argsort(x, kind="stable")
    here, x = here[order], x[order]
    curve = Line("fit", x, factor * fit.estimate.curve[here], factor * fit.estimate.half[here])
    lines = [curve, *_points(fit, here, x, factor, curve.ink), *_meaning(fit)]
    wide = bool(x.min() > 0.0 and x.max() > 10.0 * x.min())
    positive = wide and bool((points.value[here] > 0.0).all())
    return Chart(
        "", f"{swept} [{TABLE[swept].unit}]", f"{name} [{unit}]", lines,
        logarithmic=positive, logarithmic_x=wide, from_zero=False,
    )  # fmt: skip


def _points(fit: Fit, here: np.ndarray, x: np.ndarray, factor: float, colour: str) -> Iterator[Line]:
    """Yield measured numbers at x, those that are held back as hollow squares."""
    value, sd = factor * fit.measured.value[here], factor * fit.measured.sd[here]
    for held in (False, True):
        part = fit.held[here] == held
        bars = sd[part] if (sd[part] > 0.0).any() else None
        yield Line("", x[part], value[part], bars, colour=colour, style="sh" if held else "o")


def _meaning(fit: Fit) -> list[Line]:
    """Return the entries of the key for points."""
    kinds = [("fitted", "o"), *([("held back", "sh")] if fit.held.any() else [])]
    return [Line(text, NOTHING, NOTHING, colour=GREY, style=style) for text, style in kinds]


def _colour(test: int) -> str:
    return COLOURS[test % len(COLOURS)]


def _swept(tests: tuple[OperatingPoint, ...]) -> str:
    """Return the input whose numbers differ most, over the largest of them."""

    def spread(name: str) -> float:
        values = np.array([float(getattr(test, name) or 0.0) for test in tests])
        return float(np.ptp(values) / max(np.abs(values).max(), 1e-300))

    return max((f.name for f in fields(OperatingPoint)), key=spread)
