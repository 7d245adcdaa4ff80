"""Speed against error: what each level and each accuracy costs, and how far off it is.

    python -m benchmarks.film.grid_error         # the truths of single contacts: an hour
    python -m benchmarks.speed_error             # all: an hour, most of it for the truths of two hours
    python -m benchmarks.speed_error blocks      # single contacts only: the operating points of grid_error, 5 min
    python -m benchmarks.speed_error hours       # two hours of rubbing only
    python -m benchmarks.speed_error report      # the page, from what is known

Writes docs/measured/speed_error.md and its picture. What results/speed_error.json holds is kept: remove it after a change
of the core.
"""

import argparse
import json
import math
import time
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.claims import kept
from benchmarks.film import grid_error
from benchmarks.pages import Page
from benchmarks.timing import work_unit
from contact_core import OperatingPoint, Scene, SceneError, advance, initial_state, warm_up
from contact_core.quantities import ABSOLUTE, STATED

ACCURACIES = ("20 %", "10 %", "5 %", "2 %", "1 %", "0.5 %")
NODES = 257  # along x, of the truths
MOST = 193  # nodes along x that are run; finer ones would cost more than the truth
MINUTES, STEP = 120, 60.0
HOURS = ("azam_case_a", "mtm_zddp")
NAMES = {
    "friction_coefficient": "friction",
    "h_c": "h_c",
    "lambda_ratio": "lambda",
    "contact_load_ratio": "W_c",
    "wear_rate_1": "wear rate",
}
OF_HOURS = {
    "friction_coefficient": "friction",
    "h_c": "h_c",
    "contact_load_ratio": "W_c",
    "tribofilm_1": "tribofilm 1",
    "tribofilm_2": "tribofilm 2",
    "wear_depth_1": "wear 1",
    "wear_depth_2": "wear 2",
}
STATED_OF = STATED | {"wear_rate_1": "error_wear"}
TRUTH = f"{NODES} nodes"


class Setting(NamedTuple):
    """A scene at a level and an accuracy."""

    name: str
    scene: Scene


def settings(name: str) -> Iterator[Setting]:
    """Yield the settings of a scene, cheapest first; an accuracy that no grid gives is left out."""
    deterministic = {"film.model": "deterministic"}
    yield Setting("regression", Scene.from_toml(name).at_level("regression"))
    for accuracy in ACCURACIES:
        try:
            scene = Scene.from_toml(name, deterministic | {"control.accuracy": accuracy})
        except SceneError:
            break
        if scene.film.points <= MOST:
            yield Setting(accuracy, scene)
    yield Setting(TRUTH, Scene.from_toml(name, deterministic | {"film.points": str(NODES)}))


def block(setting: Setting, op: OperatingPoint) -> list[dict[str, Any]]:
    """Return the outputs of one contact on fresh surfaces."""
    warm_up(setting.scene)
    start = time.process_time()
    _, out = advance(setting.scene, op, initial_state(setting.scene), 0.0)
    return [asdict(out) | {"seconds": time.process_time() - start}]


def hours(setting: Setting, op: OperatingPoint) -> list[dict[str, Any]]:
    """Return the outputs of every minute of two hours."""
    warm_up(setting.scene)
    start, rows, state = time.process_time(), [], initial_state(setting.scene)
    state, out = advance(setting.scene, op, state, 0.0)
    for minute in range(MINUTES + 1):
        if minute:
            state, out = advance(setting.scene, op, state, STEP)
        rows.append(asdict(out) | {"seconds": time.process_time() - start})
    return rows


def solve(part: str) -> None:
    """Solve what is not known yet."""
    kept = read()

    def keep(key: str, task: Any, setting: Setting, op: OperatingPoint) -> None:
        if key not in kept:
            film = setting.scene.film
            kept[key] = {"rows": task(setting, op), "nodes": film.points if film.on_grid else 0}
            _file().write_text(json.dumps(kept))
            print(key, f"{kept[key]['rows'][-1]['seconds']:.3g} s", flush=True)

    if part in ("all", "blocks"):
        finest = grid_error.read()
        for case, level, scene, op in grid_error.cases():
            truth = finest.get(f"{case}, {scene.film.points} nodes")
            if level < grid_error.GRIDS - 1 or truth is None:
                continue
            kept[f"{case}|{TRUTH}"] = {"rows": [truth | {"seconds": math.nan}], "nodes": scene.film.points}
            for setting in settings(scene.name):
                if setting.name != TRUTH:
                    own = replace(setting.scene, surface_1=scene.surface_1, surface_2=scene.surface_2)
                    keep(f"{case}|{setting.name}", block, Setting(setting.name, own), op)
    if part in ("all", "hours"):
        for setting_of in zip(*map(settings, HOURS), strict=False):
            for name, setting in zip(HOURS, setting_of, strict=True):
                keep(f"{name}, two hours|{setting.name}", hours, setting, setting.scene.operation.point)


def read() -> dict[str, Any]:
    """Return what is known: rows of outputs and nodes, by "case|setting"."""
    found: dict[str, Any] = json.loads(_file().read_text()) if _file().exists() else {}
    return found


def errors(found: dict[str, Any], truth: dict[str, Any], name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return true and stated errors of an output at all rows, relative to the found values, of W_c absolute."""
    mine, true = (np.array([row[name] for row in rows["rows"]]) for rows in (found, truth))
    stated = np.array([row[STATED_OF[name]] for row in found["rows"]])
    unit = 1.0 if STATED_OF[name] in ABSOLUTE else np.maximum(np.abs(mine), 1e-300)
    return np.abs(mine - true) / unit, stated


def report(known: dict[str, Any]) -> None:
    """Write the page."""
    page = Page("speed_error", "Speed against error")
    page.say(
        f"Truth: {NODES} nodes along x, the shipped control of blocks. Regression: the fitted curves. Accuracies: "
        "`control.accuracy`, which chooses grid, tolerance, blocks and instants; those that no grid gives are left out, "
        f"and those of more than {MOST} nodes. CPU seconds of one thread beside other work; work units (WU): times that "
        "of one deformation convolution on the same grid. Errors in %, relative to the value found, of W_c in points."
    )
    units: dict[int, float] = {}
    points = []
    for part, names in (("Single contacts on fresh surfaces", NAMES), ("Two hours of rubbing", OF_HOURS)):
        rubbing = names is OF_HOURS
        if not any(("two hours" in key) == rubbing and key.endswith(TRUTH) for key in known):
            continue
        page.say(f"### {part}")
        if rubbing:
            page.say(
                "Medians over all minutes, and in brackets the share of minutes at which the stated error covers it."
            )
        else:
            page.say(
                "Operating points of film/grid_error.md: speeds over that of the scene, every other one under half the load, each with "
                "surfaces of its own. True errors, and in brackets the stated ones. At the other accuracies more nodes are needed than the truth has."
            )
        page.header("case", "setting", "nodes", "CPU [s]", "WU", *names.values())
        for key, found in known.items():
            case, setting = key.split("|")
            truth, nodes, seconds = known.get(f"{case}|{TRUTH}"), found["nodes"], found["rows"][-1]["seconds"]
            if ("two hours" in case) != rubbing or truth is None:
                continue
            if nodes and nodes not in units:
                units[nodes] = work_unit(nodes)
            cost = (nodes or "-"), seconds, f"{seconds / units[nodes]:.3g}" if nodes else "-"
            if setting == TRUTH:
                if rubbing:
                    page.row(case, setting, *cost, *["-" for _ in names])
                continue
            cells = []
            for name in names:
                true, stated = errors(found, truth, name)
                points.append((setting, seconds, true, stated, name, rubbing, case))
                second = f"{np.mean(true <= stated):.0%}" if rubbing else f"{100 * stated[0]:.3g}"
                cells.append(f"{100 * np.median(true):.3g} ({second})")
            page.row(case, setting, *cost, *cells)
    verdicts(page, points)
    page.picture(picture(points), "speed_error.png", "error of friction and film against CPU time")
    page.write()


def verdicts(page: Page, points: list[Any]) -> None:
    """Add what was asked for of stated errors: of two hours for each scene apart, of single contacts together."""
    for level in sorted({point[0] for point in points}, key=lambda name: name != "regression"):
        for name in ("friction_coefficient", "h_c", "contact_load_ratio"):
            own = [point for point in points if point[0] == level and point[4] == name]
            single = [true <= stated for _, _, true, stated, _, rubbing, _ in own if not rubbing]
            if single:
                share = float(np.concatenate(single).mean())
                asked = f"{level}: stated errors of {NAMES[name]} of single contacts cover at least 90 %"
                page.verdict(asked, f"{share:.0%} of {len(single)}", share >= 0.9)
            hours = [(float(np.mean(true <= stated)), case) for _, _, true, stated, _, rubbing, case in own if rubbing]
            if hours:
                share, case = min(hours)
                asked = f"{level}: stated errors of {NAMES[name]} over two hours cover at least 95 % in each scene"
                page.verdict(asked, f"{share:.0%} ({case.partition(',')[0]})", share >= 0.95)


def picture(points: list[Any]) -> Any:
    """Return error against CPU time, a colour for each setting."""
    from matplotlib import colormaps
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    labels = [name for name in ("regression", *ACCURACIES) if any(point[0] == name for point in points)]
    colours = dict(zip(labels, colormaps["viridis"](np.linspace(0.0, 0.9, max(len(labels), 2))), strict=False))
    shown = (("friction_coefficient", "friction"), ("h_c", "central film"))
    for axis, (name, title) in zip(figure.subplots(1, 2, sharey=True), shown, strict=True):
        for setting, seconds, true, _, output, rubbing, _ in points:
            if output == name:
                value = max(float(np.median(true)), 1e-4)
                axis.plot(seconds, value, "s" if rubbing else "o", color=colours[setting], markersize=5)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlabel("CPU time [s]")
        axis.set_title(title)
        axis.spines[["top", "right"]].set_visible(False)
    first = figure.axes[0]
    first.set_ylabel("relative error")
    for label in labels:
        first.plot([], [], "o", color=colours[label], label=label if label == "regression" else f"accuracy {label}")
    first.plot([], [], "s", color="0.5", label="two hours (squares)")
    first.legend(frameon=False, fontsize="small")
    return figure


def _file() -> Path:
    return kept("speed_error") / "found.json"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="?", default="all", choices=("all", "blocks", "hours", "report"))
    part = parser.parse_args().part
    if part != "report":
        solve(part)
    report(read())


if __name__ == "__main__":
    main()
