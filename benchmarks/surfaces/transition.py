"""Speed at which the shipped scenes pass from mixed to full film, against the transition that Hansen et al. measured.

    python -m benchmarks.surfaces.transition            measures what is not yet in results/transition.json, then the page
    python -m benchmarks.surfaces.transition --again    all anew, after a change of the core

Writes docs/measured/surfaces/transition.md and docs/measured/surfaces/transition.png in about three quarters of an hour.
"""

import argparse
import json
import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from benchmarks.folders import RESULTS
from benchmarks.pages import Page
from benchmarks.surfaces import transition_page
from benchmarks.surfaces.film_parameter import Peaks, films, point_at, speed_of_one
from contact_core import Outputs, Scene, advance, initial_state

KEPT = RESULTS / "transition.json"
START = {"azam_case_a": 8.0, "mtm_zddp": 8.0, "fzg_flank": 3.0}  # m/s, first guesses of the transition
NODES = "65"  # along x
CIRCLES = ("azam_case_a", "mtm_zddp")  # whose smooth films are solved beside the formulas
LEVELS = (0.1, 0.03, 0.01, 0.003)  # shares of the load that solids carry
LIFTED = 0.01  # the share that is called a full film
WITHIN = 0.3
FRICTION = 0.1  # more friction than smooth bodies by this share
SPAN = np.geomspace(1 / 30, 4.0, 11)  # speeds of the curves, over that of the transition
TIMES = 1.6  # first step from a guess, as a factor of speed
CLOSE = 0.1  # of the two speeds about a transition, as a share
Found = dict[str, Any]


def no_microroughness() -> dict[str, str]:
    """Return the changes to surfaces above a hard floor."""
    return {f"surface_{body}.microroughness.rms": "0 nm" for body in (1, 2)}


def smooth() -> dict[str, str]:
    """Return the changes to smooth bodies."""
    return no_microroughness() | {f"surface_{body}.rq": "0 nm" for body in (1, 2)}


def rougher(name: str, factor: float) -> dict[str, str]:
    """Return the changes to all roughness, that below the grid too, times a factor."""
    scene = Scene.from_toml(name)
    changes = {}
    for body, surface in ((1, scene.surface_1), (2, scene.surface_2)):
        changes[f"surface_{body}.rq"] = f"{factor * surface.rq!r} m"
        changes[f"surface_{body}.microroughness.rms"] = f"{factor * surface.microroughness.rms!r} m"
    return changes


def longer(name: str, factor: float) -> dict[str, str]:
    """Return the changes to correlation lengths times a factor."""
    scene = Scene.from_toml(name)
    pairs = ((1, scene.surface_1), (2, scene.surface_2))
    return {f"surface_{body}.correlation_length": f"{factor * one.correlation_length!r} m" for body, one in pairs}


def variants(name: str) -> dict[str, tuple[dict[str, str], int | None]]:
    """Return what is changed in the experiments on a scene: settings, and a seed of other surfaces."""
    found: dict[str, tuple[dict[str, str], int | None]] = {
        "as shipped": ({}, None),
        "other surfaces 1": ({}, 11),
        "other surfaces 2": ({}, 12),
        "129 nodes": ({"film.points": "129"}, None),
        "no microroughness": (no_microroughness(), None),
        "roughness x 0.5": (rougher(name, 0.5), None),
        "roughness x 1.5": (rougher(name, 1.5), None),
        "correlation length x 2": (longer(name, 2.0), None),
        "correlation length x 4": (longer(name, 4.0), None),
    }
    return dict(list(found.items())[: 2 if name == "mtm_zddp" else None])  # which is much like azam_case_a


class Contact:
    """A scene on fresh surfaces at its own slide-to-roll ratio, load and temperature, over entrainment speed."""

    def __init__(self, name: str, changes: dict[str, str], seed: int | None = None) -> None:
        scene = Scene.from_toml(name, {"film.points": NODES} | changes)
        scene = scene if seed is None else scene.realisation(seed)
        # however near the speed of the scene, a speed is solved for itself
        self.scene = replace(scene, control=replace(scene.control, input_change=0.0))
        self.state = initial_state(self.scene)
        self.outputs = cache(self._outputs)

    def _outputs(self, speed: float) -> Outputs:
        return advance(self.scene, point_at(self.scene, speed), self.state, 0.0)[1]

    def solids(self, speed: float) -> float:
        """Return the share of the load that solids carry."""
        return float(self.outputs(speed).contact_load_ratio)

    def film_parameter(self, speed: float, peaks: Peaks) -> Found:
        """Return films, peaks and film parameters at a speed."""
        central, least = films(self.scene, speed)
        deformed = peaks.deformed(speed)
        out = self.outputs(speed)
        return {
            "speed": speed,
            "h_c": central,
            "h_m": least,
            "spk": peaks.rigid,
            "spk_deformed": deformed,
            "f_q": (peaks.rigid - deformed) / central,
            "f_q_needed": (peaks.rigid - least) / central,
            "rigid": least / peaks.rigid,
            "flattened": (least + peaks.rigid - deformed) / peaks.rigid,
            "W_c": float(out.contact_load_ratio),
            "friction": float(out.friction_coefficient),
            "lambda": float(out.lambda_ratio),
            "flags": int(out.range_flags),
        }


def crossing(share: Callable[[float], float], level: float, guess: float) -> float:
    """Return the speed [m/s] at which a falling share is at a level, linear in logarithms between two close speeds."""

    def inside(margin: float) -> float:
        above, below = (math.log(max(share(end), 1e-3 * level) / level) for end in (low, high))
        part = min(max(above / (above - below), margin), 1.0 - margin)
        return float(low ** (1.0 - part) * high**part)

    low = high = guess
    while share(low) < level:
        low /= TIMES
    while share(high) >= level:
        high *= TIMES
    while high > (1.0 + CLOSE) * low:
        middle = inside(0.1)
        low, high = (middle, high) if share(middle) >= level else (low, middle)
    return inside(0.0)


def measured(name: str, changes: dict[str, str], seed: int | None, levels: tuple[float, ...]) -> Found:
    """Return film parameters at the speeds at which solids carry these shares of the load."""
    contact = Contact(name, changes, seed)
    peaks = Peaks(contact.scene)
    speed, found = START[name], {}
    for level in levels:
        speed = crossing(contact.solids, level, speed)
        found[f"{level:g}"] = contact.film_parameter(speed, peaks)
    reached = [speed_of_one(contact.scene, peaks, deformed=deformed) for deformed in (False, True)]
    return {"at": found, "speed of 1, rigid": reached[0], "speed of 1, flattened": reached[1]}


def curves(name: str, middle: float) -> Found:
    """Return friction and share of the solids over speed: both levels, and smooth bodies."""
    speeds = [float(middle * part) for part in SPAN]
    found: Found = {"speed": speeds}
    fast = {"film.model": "regression"}
    for text, changes in {"deterministic": {}, "regression": fast, "smooth": smooth()}.items():
        contact = Contact(name, changes)
        outs = [contact.outputs(speed) for speed in speeds]
        found[text] = {
            "W_c": [float(out.contact_load_ratio) for out in outs],
            "friction": [float(out.friction_coefficient) for out in outs],
            "flags": [int(out.range_flags) for out in outs],
        }
    return found


def smooth_film(name: str, speed: float) -> Found:
    """Return films of smooth bodies by formula and as solved."""
    contact = Contact(name, smooth() | {"film.points": "129"})
    central, least = films(contact.scene, speed)
    out = contact.outputs(speed)
    return {
        "speed": speed,
        "h_c": central,
        "h_m": least,
        "h_c solved": float(out.h_central),
        "h_m solved": float(out.h_min),
    }


def results(again: bool) -> Found:
    """Return all measurements, from results/transition.json as far as they are there."""
    kept: Found = json.loads(KEPT.read_text("utf-8")) if KEPT.exists() and not again else {}

    def keep(key: str, task: Callable[[], Found]) -> Found:
        if key not in kept:
            kept[key] = task()
            KEPT.parent.mkdir(exist_ok=True)
            KEPT.write_text(json.dumps(kept, indent=1), "utf-8")
            print(key, json.dumps(kept[key])[:400], flush=True)
        found: Found = kept[key]
        return found

    for name in START:
        for text, (changes, seed) in variants(name).items():
            levels = LEVELS if text in ("as shipped", "no microroughness") else (LIFTED,)
            row = keep(f"{name}: {text}", lambda c=changes, s=seed, n=name, le=levels: measured(n, c, s, le))
            if text == "as shipped":
                speed = row["at"][f"{LIFTED:g}"]["speed"]
                fast = {"film.model": "regression"}
                keep(f"{name}: regression", lambda n=name, f=fast, le=levels: measured(n, f, None, le))
                keep(f"{name}: curves", lambda n=name, u=speed: curves(n, u))
                if name in CIRCLES:
                    keep(f"{name}: smooth", lambda n=name, u=speed: smooth_film(n, u))
    return kept


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--again", action="store_true", help="measure anew")
    kept = results(parser.parse_args().again)
    page, scenes = Page("surfaces/transition", "From mixed to full film"), list(START)
    transition_page.verdicts(page, kept, scenes, LIFTED, WITHIN)
    page.say(transition_page.ASSUMED)
    page.picture(
        transition_page.picture(kept, scenes, LIFTED),
        "transition.png",
        "share of the solids and friction over speed; the band is where the parameter is 1, from flattened to rigid asperities",
    )
    page.say(f"### By the share that solids carry\n\nFresh surfaces, first block, {NODES} nodes along x.")
    transition_page.shares(page, kept, scenes)
    page.say(
        f"### By friction\n\nThe speed from which friction is less than {FRICTION:.0%} above that of the same bodies without roughness."
    )
    transition_page.frictions(page, kept, scenes, FRICTION)
    page.say(
        "### Films of smooth bodies\n\nThe formulas beside the solver, 129 nodes along x, at the deterministic transition."
    )
    transition_page.smooth_films(page, kept, CIRCLES, LIFTED)
    page.say(f"### What it depends on\n\nThe speed at which solids carry {LIFTED:.0%}, each change alone.")
    transition_page.experiments(page, kept, {name: list(variants(name)) for name in scenes}, LIFTED)
    page.say(transition_page.MEANT)
    page.write()


if __name__ == "__main__":
    main()
