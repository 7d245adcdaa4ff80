"""Maps of a run at its field times, as data of the page that a script draws; profiles across the track as charts."""

import base64
import zlib
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Array
from fmu_src.html.markup import paragraph, section, text

from ..charts.chart import Chart, Line, shades
from ..charts.svg import figures, safe_json
from ..charts.units import time_unit, unit_for
from ..run.maps import ALONG, TIME
from ..run.track_picture import KINDS, cross_section, profile
from .opened import Run

_MOST = 1_500_000  # nodes of all maps of a page together, beyond which only every second, third ... is shown
_TIMES = 16  # maps of so many times are shown, evenly spread
_CODES = 65534  # of a value between the least and the largest; the next one is "no value"
_FEWEST_ROWS = 4  # of a map; with less it is a profile along x
_LOGARITHMIC = ("gap",)
_STOPS = 17  # colours of a map, between which the script interpolates
_PROFILES = 5  # times in a chart of profiles
_MAPS = (  # name, title, map of colours, what it is
    ("pressure", "Pressure", "inferno", "Pressure of oil and solids together, on the nodes of the contact."),
    ("fluid_pressure", "Pressure of the oil", "inferno", "The share of the pressure that the oil bears."),
    ("solid_pressure", "Pressure of the solids", "inferno", "The share that touching solids bear, mean over a node."),
    ("gap", "Gap", "cividis", "Distance of the surfaces; where they touch it is the floor of the model. Logarithmic."),
    ("tribofilm_map_1", "Tribofilm, body 1", "viridis", "Thickness on the track of body 1, which moves with it."),
    ("tribofilm_map_2", "Tribofilm, body 2", "viridis", "Thickness on the track of body 2, which moves with it."),
    ("wear_map_1", "Wear, body 1", "magma", "Depth worn off body 1."),
    ("wear_map_2", "Wear, body 2", "magma", "Depth worn off body 2."),
    ("plastic_map_1", "Plastic depth, body 1", "magma", "Permanent depth pressed into body 1."),
    ("plastic_map_2", "Plastic depth, body 2", "magma", "Permanent depth pressed into body 2."),
    ("pits_map_1", "Pits, body 1", "magma", "Depth that fatigue has broken out of body 1."),
    ("pits_map_2", "Pits, body 2", "magma", "Depth that fatigue has broken out of body 2."),
    ("surface_1", "Surface as it is, body 1", "viridis", "Heights of body 1 with wear, pits and tribofilm."),
    ("surface_2", "Surface as it is, body 2", "viridis", "Heights of body 2 with wear, pits and tribofilm."),
)


class _Field(NamedTuple):
    """A map at all shown times, in SI."""

    key: str
    title: str
    colours: str
    caption: str
    values: Array  # [time, y, x]
    along: Array  # x of its columns [m]


def sections(run: Run) -> str:
    """Return the sections of maps and of profiles, or a word on why there are none."""
    if TIME not in run.dataset.dims:
        return _none(run)
    chosen = _spread(run.dataset.sizes[TIME])
    dataset = run.dataset.isel({TIME: chosen})
    if dataset.sizes["y"] < _FEWEST_ROWS:
        return section("maps", "Maps of the contact", *_lines(dataset))
    return _viewer(dataset, len(chosen) < run.dataset.sizes[TIME]) + _profiles(dataset)


def _none(run: Run) -> str:
    if not run.of_contact:
        return ""
    solved = "iterations" in run.dataset and bool(np.any(run.dataset.variables["iterations"].values))
    words = (
        "This run kept no maps. Run it again with --fields 6 to see pressure, gap, tribofilm and wear at six times."
        if solved
        else "This level of the model has no maps: its surfaces are means over the track. With "
        "--set film.model=deterministic --fields 6 a run solves the contact node by node and keeps maps."
    )
    return section("maps", "Maps of the contact", paragraph(words, "quiet"))


def _spread(count: int) -> list[int]:
    return sorted({round(k) for k in np.linspace(0, count - 1, min(count, _TIMES))})


def _fields(dataset: xr.Dataset) -> Iterator[_Field]:
    """Yield the maps that are not zero throughout."""
    for key, title, colours, caption in _MAPS:
        values = _values(dataset, key)
        if values is not None and np.any(values[np.isfinite(values)]):
            along = dataset.variables[
                "x" if key in ("pressure", "fluid_pressure", "solid_pressure", "gap") else ALONG
            ].values
            yield _Field(key, title, colours, caption, values, along)


def _values(dataset: xr.Dataset, key: str) -> Array | None:
    name, _, body = key.partition("_")
    if name == "surface":
        heights = np.asarray(dataset.variables[f"new_heights_{body}"].values, dtype=float)
        film = np.asarray(dataset.variables[f"tribofilm_map_{body}"].values, dtype=float)
        return heights + film - _lost(dataset, body)
    return np.asarray(dataset.variables[key].values, dtype=float) if key in dataset else None


def _lost(dataset: xr.Dataset, body: str) -> Array:
    """Return the depth worn off, pressed in and broken out of a body [m]."""
    kept = [f"{kind}_map_{body}" for kind in ("wear", "plastic", "pits")]
    return np.asarray(sum(np.asarray(dataset.variables[name].values, dtype=float) for name in kept if name in dataset))


def _viewer(dataset: xr.Dataset, fewer: bool) -> str:
    """Return the section in which a script draws the maps."""
    fields = list(_fields(dataset))
    stride = _stride(fields)
    y, times = dataset.variables["y"].values, dataset.variables[TIME].values
    clock, length = time_unit(float(times[-1])), unit_for("m", [np.ptp(y), *(np.ptp(each.along) for each in fields)])
    about = {
        "times": [f"{float(clock.of(time)):.4g} {clock.name}" for time in times],
        "length": length.name,
        "half": [float(length.of(float(dataset.variables[f"half_width_{axis}"]))) for axis in "xy"],
        "stops": {name: _stops(name) for name in {each.colours for each in fields}},
        "maps": [_described(each, y, stride, length.factor) for each in fields],
    }
    count = dataset.sizes[TIME]
    thinned = f" Every {_ordinal(stride)} node is shown." if stride > 1 else ""
    thinned += " More times are in the result file." if fewer else ""
    options = "".join(f'<option value="{k}">{text(each.title)}</option>' for k, each in enumerate(fields))
    zero = _zero(dataset)
    return section(
        "maps",
        "Maps of the contact",
        paragraph(
            "Maps of the contact lie on its grid; maps of a body lie on its surface and move with it. The ellipse is "
            "the Hertz contact of smooth bodies, dashed lines are the edges of the track. Entrainment runs to the "
            f"right.{thinned}{zero}"
        ),
        '<noscript><p class="quiet">The maps need JavaScript, which is off.</p></noscript>',
        f'<div class="viewer" hidden><div class="controls"><label>Show <select class="what">{options}</select></label>'
        '<label class="wide-label">Time <input class="when" type="range" min="0" '
        f'max="{count - 1}" value="{count - 1}" step="1"><output class="now"></output></label>'
        '<button type="button" class="play" aria-label="play through the times">▶ play</button></div>'
        '<p class="what-it-is quiet"></p>'
        '<div class="pair"><figure><canvas class="flat" width="1040" height="880"></canvas>'
        "<figcaption>From above. Move the pointer over the map to read values.</figcaption></figure>"
        '<figure><canvas class="solid" width="1040" height="880" tabindex="0"></canvas>'
        "<figcaption>In 3-D, heights stretched. Drag, or use the arrow keys, to turn it.</figcaption></figure></div>"
        f'<script type="application/json" id="maps-data">{safe_json(about)}</script></div>',
    )


def _zero(dataset: xr.Dataset) -> str:
    """Return a sentence on maps that are zero throughout."""
    zero = [
        title for key, title, *_ in _MAPS if key in dataset and not np.any(np.nan_to_num(dataset.variables[key].values))
    ]
    return f" Zero everywhere and therefore not listed: {', '.join(zero).lower()}." if zero else ""


def _ordinal(count: int) -> str:
    return {2: "second", 3: "third"}.get(count, f"{count}th")


def _stride(fields: list[_Field]) -> int:
    stride = 1
    while sum(each.values[:, ::stride, ::stride].size for each in fields) > _MOST:
        stride += 1
    return stride


def _described(each: _Field, y: Array, stride: int, length: float) -> dict[str, object]:
    """Return a map as the script needs it: values in a unit, coded by 16 bits and compressed."""
    unit = unit_for("Pa" if "pressure" in each.key else "m", each.values)
    shown = unit.of(each.values[:, ::stride, ::stride])
    low, high, codes = encoded(shown)
    return {
        "title": each.title,
        "caption": each.caption,
        "unit": unit.name,
        "colours": each.colours,
        "log": each.key in _LOGARITHMIC,
        "body": each.key[-2:] in ("_1", "_2"),
        "low": low,
        "high": high,
        "top": _top(shown, each.key),
        "shape": list(shown.shape[1:]),
        "x": [length * float(each.along[0]), length * float(each.along[::stride][-1])],
        "y": [length * float(y[0]), length * float(y[::stride][-1])],
        "data": codes,
    }


def encoded(values: Array) -> tuple[float, float, str]:
    """Return least and largest of the values and their codes from one to the other: 16 bits, deflated, base64."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    scaled = (np.nan_to_num(values, nan=low) - low) / ((high - low) or 1.0)
    codes = np.where(np.isfinite(values), np.rint(_CODES * scaled), _CODES + 1).astype("<u2")
    return low, high, base64.b64encode(zlib.compress(codes.tobytes(), 9)).decode()


def _top(shown: Array, key: str) -> float:
    """Return the value at which the colours end: single peaks, and the gap far from the contact, may be beyond it."""
    finite = shown[np.isfinite(shown)]
    if not finite.size:
        return 1.0
    if key in _LOGARITHMIC:
        return max(float(np.percentile(finite, 80.0)), 10.0 * float(finite.min()))
    return float(np.percentile(finite, 99.8)) or float(finite.max())


def _stops(name: str) -> list[list[int]]:
    """Return the red, green and blue of colours of a map of matplotlib, of equal distance."""
    return [[int(each[k : k + 2], 16) for k in (1, 3, 5)] for each in shades(_STOPS, name, 0.0, 1.0)]


def _profiles(dataset: xr.Dataset) -> str:
    """Return the section of profiles across the track, mean along it, and of cross-sections of the surfaces."""
    last = dataset.sizes[TIME] - 1
    some = dataset.isel({TIME: sorted({round(k) for k in np.linspace(min(1, last), last, _PROFILES)})})
    every = [(kind, body) for kind in KINDS for body in (1, 2) if dataset[f"{kind}_profile_{body}"].values.any()]
    charts = [*(profile(some, kind, body) for kind, body in every), *(cross_section(dataset, body) for body in (1, 2))]
    return section(
        "profiles",
        "Profiles across the track",
        paragraph(
            "Means along the track at some times of the run; the track is the grey stretch. Cross-sections are a "
            "single line across the middle of the map, so they show single asperities."
        ),
        figures(charts, "profile"),
    )


def _lines(dataset: xr.Dataset) -> Iterator[str]:
    """Yield the maps of a contact with a row or a few as charts along x, at the last time."""
    yield paragraph("The contact is a line: it is the same along y, so maps are curves along x, at the end of the run.")
    charts = []
    for each in _fields(dataset):
        unit = unit_for("Pa" if "pressure" in each.key else "m", each.values)
        length, log = unit_for("m", [np.ptp(each.along)]), each.key in _LOGARITHMIC
        line = Line(each.title, length.of(each.along), unit.of(each.values[-1].mean(axis=0)))
        charts.append(Chart(each.title, f"x {length.label}", unit.label, [line], each.caption, logarithmic=log))
    yield figures(charts, "line")
