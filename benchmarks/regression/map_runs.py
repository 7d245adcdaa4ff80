"""Runs at the level of a map beside the deterministic level, and contacts near pure rolling, for `regression.map`."""

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.pages import Page
from contact_core import OperatingPoint, Outputs, Scene, advance, initial_state
from contact_core.corrections.knot import History
from contact_core.corrections.kriging import CORRECTED
from contact_core.corrections.map import Map
from system_models.run.map_build import SEED, Order, is_held, scene_of_histories

NAMES = ("friction", "h_c", "W_c")
MINUTES = 120  # of a run beside the deterministic level
SLIPS, INSTANTS = (0.0, 0.0005, 0.005, 0.05), 48  # of contacts near pure rolling, and instants of their blocks


class Beside(NamedTuple):
    """Outputs at times of a run at the deterministic level, [times, outputs], and at another one."""

    deep: np.ndarray
    other: np.ndarray
    half: np.ndarray  # that the other one states, in the unit of the output

    @property
    def inside(self) -> np.ndarray:
        """Share of the times at which the deterministic level is within the stated error."""
        return np.mean(np.abs(self.other - self.deep) <= self.half, axis=0)

    @property
    def rms(self) -> np.ndarray:
        """Deviation: relative, of W_c absolute."""
        return np.sqrt(np.mean(((self.other - self.deep) / np.where([True, True, False], self.deep, 1.0)) ** 2, axis=0))


def seen(out: Outputs) -> list[float]:
    """Return friction, h_c and W_c."""
    return [getattr(out, name) for name in CORRECTED]


def run(scene: Scene, point: OperatingPoint, times: tuple[float, ...]) -> list[Outputs]:
    """Return the outputs of a run from fresh surfaces, at times [s]."""
    state, before, outs = initial_state(scene), 0.0, []
    for time in times:
        state, out = advance(scene, point, state, time - before)
        before = time
        outs.append(out)
    return outs


def beside(deep: list[list[float]], outs: list[Outputs]) -> Beside:
    """Return a run beside that of the deterministic level."""
    other = np.array([seen(out) for out in outs])
    half = np.array([[getattr(out, name) for name in CORRECTED.values()] for out in outs])
    return Beside(np.array(deep), other, half * np.where([True, True, False], other, 1.0))


def with_map(scene: Scene, chart: Map, folder: Path) -> Scene:
    """Return a scene at the level of a map."""
    file = folder / "map.json"
    file.write_text(chart.to_text(), "utf-8")
    scene = scene.at_level("map")
    return replace(scene, film=replace(scene.film, file=str(file)))


def along_runs(page: Page, name: str, order: Order, histories: Sequence[History], chart: Map) -> None:
    """Add runs of hours at the level of the map beside the deterministic level: the scene's own, and held-back ones."""
    scene = order.scene
    exact = scene_of_histories(scene)
    minutes = tuple(60.0 * k for k in range(MINUTES + 1))
    own = [seen(out) for out in run(scene.at_level("deterministic"), scene.operation.point, minutes)]
    runs = [("the scene's own, each minute", scene.operation.point, minutes, own)]
    for history in histories:
        if history.fine and is_held(order, history.number):
            plan = order.ranges.draw(SEED, history.number)
            rubbing = [knot for knot in history.knots if knot.point == plan.rubbing]
            text = f"held back, number {history.number}: {plan.rubbing.load:.0f} N, {plan.rubbing.entrainment_speed:.2g} m/s"
            runs.append((text, plan.rubbing, plan.times[: len(rubbing)], [list(knot.found) for knot in rubbing]))
    page.say(
        "Runs from fresh surfaces on at the level of the map, and of the regression level, beside the deterministic one: share of the rows within the error that "
        "the level states, and rms deviation. The histories of the map have the scene's own operation, but none of those held back."
    )
    page.header("run", "rows", "level", *(f"{each}: {text}" for each in NAMES for text in ("inside", "rms")))
    with tempfile.TemporaryDirectory() as folder:
        levels = {"map": with_map(exact, chart, Path(folder)), "regression": exact.at_level("regression")}
        for text, point, times, deep in runs:
            for level, at in levels.items():
                one = beside(deep, run(at, point, times))
                page.row(
                    text, len(times), level,
                    *(cell for k in range(3) for cell in (f"{one.inside[k]:.0%}", f"{100.0 * one.rms[k]:.1f} %")),
                )  # fmt: skip
                if times is minutes and level == "map":
                    page.verdict(
                        f"{name}: rows of two hours within the stated error", f"{one.inside.min():.0%}, at least 90 %", bool(one.inside.min() >= 0.9)
                    )  # fmt: skip


def near_rolling(page: Page, scene: Scene) -> None:
    """Add deviations of contacts that slide less and less."""
    own, deep = (
        scene.operation.point,
        replace(scene.at_level("deterministic"), control=replace(scene.control, mixed_instants=INSTANTS)),
    )
    page.say(
        "Fresh surfaces that slide less and less: what the deterministic level deviates by from the regression level."
    )
    page.header("entrainment [m/s]", "slide-roll ratio", "h_c", "W_c", "friction")
    for speed in (own.entrainment_speed, 2.5 * own.entrainment_speed):
        for slip in SLIPS:
            point = replace(own, speed_1=speed * (1.0 + 0.5 * slip), speed_2=speed * (1.0 - 0.5 * slip))
            one, other = (run(at, point, (0.0,))[0] for at in (deep, scene.at_level("regression")))
            friction = 100.0 * (one.friction_coefficient / other.friction_coefficient - 1.0) if slip else 0.0
            page.row(
                speed, slip, f"{100.0 * (one.h_c / other.h_c - 1.0):.1f} %",
                f"{100.0 * (one.contact_load_ratio - other.contact_load_ratio):.1f} %", f"{friction:.1f} %",
            )  # fmt: skip
