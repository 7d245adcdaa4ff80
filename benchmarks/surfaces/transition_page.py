"""Page and picture of the transition from mixed to full film."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks.pages import Page
from contact_core import RangeFlag
from system_models.run.stribeck import transition_speed

Found = dict[str, Any]
COLOURS = {"deterministic": "#D55E00", "regression": "#0072B2", "smooth": "#666666"}
NM = 1e9

ASSUMED = """The source gives the parameter (h_m + h_c f_q) / Spk and its transition at 1 (Hansen, Prajapati, Björling and Larsson,
[10.1007/s11249-025-02060-6](https://doi.org/10.1007/s11249-025-02060-6); the parameter is theirs of 2021, Tribology Letters 69). Only
its abstract was at hand. Taken from it: the form, Spk as roughness, f_q as a correction for asperities that oil flattens, which depends on
their lay, the transition at 1. Not in it, and assumed here:

- h_c and h_m are those of smooth bodies by Hamrock and Dowson; of lines by Dowson and Toyoda, and Dowson.
- Spk is of both surfaces together (every height of one body meets every height of the other), as the grid shows them, with the
  microroughness of both below it: independent and Gaussian, so its distribution is folded with that of the heights on the grid.
- f_q lies between two ends. *Rigid*: f_q = 0. *Flattened*: h_c f_q = Spk - Spk', where Spk' is of the surfaces under oil by amplitude
  reduction theory (Venner and Lubrecht), which the abstract names as an alternative; the parameter is 1 where h_m = Spk'. Microroughness is not flattened.
  *f_q needed* is the one that makes the parameter 1 at the speed found here.
- The full film begins where solids carry 1 % of the load. In the measurements it is where contact is first noticed; other shares stand beside."""


MEANT = """### What it means

- Speed is the stricter measure. Where most of the peaks are flattened, the parameter of flattened asperities is near 1 over a wide range of speeds.
- Waves of 8 um, short beside the contact, stay under oil: the solids of `azam_case_a` lift off between the two ends, close to that of rigid asperities.
  Waves of 25 um are flattened: `fzg_flank` lifts off where amplitude reduction theory says so, at far less film than rigid peaks would need.
- Longer waves and lower roughness move the transition away from rigid asperities, as f_q must, and in the end away from the flattened ones: amplitude reduction
  theory is for single waves in pure rolling and a full film, and here solids already touch.
- The formulas' films are part of the agreement: the solver's smooth ones are thinner at these speeds, and with them the parameter of rigid asperities is further from 1.
- Which share of the load counts as lifted off matters as much as f_q: see the first table.
- Without microroughness solids carry less at every speed. Where waves are short the last of them lift off at much the same speed; on `fzg_flank`, whose long waves
  are flattened, microroughness is what still touches, and 1 % is reached at about half the speed without it.
- The regression level leaves mixed lubrication at lower speeds than the deterministic one, the more so on lines: its curves fall faster at small shares.

### Left out

`ball_209_inner`: an instant of its wide grid costs ten times those of the others.

### Measured mixed friction

None is compared here. Of the candidate, [10.1007/s11249-015-0536-z](https://doi.org/10.1007/s11249-015-0536-z), only the introduction was at hand. The friction
log of a test rig in github.com/moritzploss/tribology (MIT) is of one speed, 0.2 m/s, without oil and roughness. The films measured in the same repository are on
[another page](../film/measured.md)."""


def excess(curves: Found, level: str) -> np.ndarray:
    """Return the friction above that of smooth bodies, as a share of it."""
    mine, theirs = (np.array(curves[key]["friction"]) for key in (level, "smooth"))
    return mine / theirs - 1.0


def parameter_at(row: Found, speed: float, which: str) -> float:
    """Return a film parameter at a speed between or near the rows of a scene, by its power of the speed there."""
    at = list(row["at"].values())
    u, values = (np.log([one[key] for one in at]) for key in ("speed", which))
    slope, offset = np.polyfit(u, values, 1)
    return float(math.exp(offset + slope * math.log(speed)))


def verdicts(page: Page, kept: Found, scenes: Sequence[str], lifted: float, within: float) -> None:
    """Add what was asked for, for both ends of f_q: the speed of the transition beside that at which the parameter is 1."""
    for name in scenes:
        for level, text in (("as shipped", "deterministic level"), ("regression", "regression level")):
            row = kept[f"{name}: {level}"]
            one = row["at"][f"{lifted:g}"]
            for end in ("rigid", "flattened"):
                speed = row[f"speed of 1, {end}"]
                ratio = one["speed"] / speed
                page.verdict(
                    f"{name}, {text}: solids carry {lifted:.0%} within {within:.0%} of the speed at which the parameter is 1, asperities {end}",
                    f"{one['speed']:.3g} m/s, {ratio:.2f} of {speed:.3g} m/s; parameter {one[end]:.2f}",
                    bool(abs(ratio - 1.0) <= within),
                )


def shares(page: Page, kept: Found, scenes: Sequence[str]) -> None:
    """Add film parameters by the share of the load that counts as lifted off."""
    page.header(
        "scene", "level", "solids carry", "at m/s", "h_m nm", "h_c nm", "Spk nm", "Spk' nm", "parameter, rigid", "flattened",
        "f_q needed", "lambda of the run", "friction", "flags",
    )  # fmt: skip
    for name in scenes:
        for level, text in (("as shipped", "deterministic"), ("regression", "regression")):
            for share, one in kept[f"{name}: {level}"]["at"].items():
                lengths = [one[key] * NM for key in ("h_m", "h_c", "spk", "spk_deformed")]
                ends = (one["rigid"], one["flattened"], one["f_q_needed"], one["lambda"], one["friction"])
                flags = ", ".join(flag.name or "" for flag in RangeFlag(one["flags"])) or "none"
                page.row(name, text, float(share), one["speed"], *lengths, *ends, flags)


def frictions(page: Page, kept: Found, scenes: Sequence[str], share: float) -> None:
    """Add the transition as friction shows it."""
    page.header("scene", "level", "friction as of smooth bodies from m/s", "parameter there, rigid", "flattened")
    for name in scenes:
        curves = kept[f"{name}: curves"]
        for level, row in (("deterministic", "as shipped"), ("regression", "regression")):
            speed = transition_speed(curves["speed"], excess(curves, level), share)
            if math.isnan(speed):
                page.row(name, level, "not crossed", "", "")
                continue
            ends = [parameter_at(kept[f"{name}: {row}"], speed, which) for which in ("rigid", "flattened")]
            page.row(name, level, speed, *ends)


def smooth_films(page: Page, kept: Found, scenes: Sequence[str], lifted: float) -> None:
    """Add the films of the formulas beside those that the solver finds between smooth bodies, and the parameter with these."""
    page.header(
        "scene",
        "at m/s",
        "h_c nm, formula",
        "solved",
        "h_m nm, formula",
        "solved",
        "parameter with solved h_m, rigid",
        "flattened",
    )
    for name in scenes:
        one, row = kept[f"{name}: smooth"], kept[f"{name}: as shipped"]["at"][f"{lifted:g}"]
        lengths = [one[key] * NM for key in ("h_c", "h_c solved", "h_m", "h_m solved")]
        rigid = one["h_m solved"] / row["spk"]
        page.row(name, one["speed"], *lengths, rigid, rigid + 1.0 - row["spk_deformed"] / row["spk"])


def experiments(page: Page, kept: Found, variants: dict[str, list[str]], lifted: float) -> None:
    """Add the transition of changed surfaces and grids."""
    page.header(
        "scene",
        "changed",
        "at m/s",
        "over the scene's",
        "Spk nm",
        "Spk' nm",
        "parameter, rigid",
        "flattened",
        "f_q needed",
    )
    for name, texts in variants.items():
        first = kept[f"{name}: as shipped"]["at"][f"{lifted:g}"]["speed"]
        for text in texts:
            one = kept[f"{name}: {text}"]["at"][f"{lifted:g}"]
            lengths = [one[key] * NM for key in ("spk", "spk_deformed")]
            page.row(
                name,
                text,
                one["speed"],
                one["speed"] / first,
                *lengths,
                one["rigid"],
                one["flattened"],
                one["f_q_needed"],
            )


def picture(kept: Found, scenes: Sequence[str], lifted: float) -> Figure:
    """Share of the solids and friction over speed; the band is where the parameter of the source is 1."""
    figure = Figure(figsize=(3.2 * len(scenes), 5.6), layout="constrained")
    axes = figure.subplots(2, len(scenes), sharex="col", squeeze=False)
    for (upper, under), name in zip(axes.T, scenes, strict=True):
        curves, row = kept[f"{name}: curves"], kept[f"{name}: as shipped"]
        for level, colour in COLOURS.items():
            under.plot(curves["speed"], curves[level]["friction"], "o-", color=colour, markersize=3, label=level)
            if level != "smooth":
                upper.plot(curves["speed"], np.maximum(curves[level]["W_c"], 1e-5), "o-", color=colour, markersize=3)
        for axis in (upper, under):
            axis.axvspan(
                *sorted((row["speed of 1, rigid"], row["speed of 1, flattened"])),
                color="#009E73",
                alpha=0.25,
                linewidth=0,
            )
            axis.set_xscale("log")
            axis.spines[["top", "right"]].set_visible(False)
        upper.axhline(lifted, color="black", linewidth=0.6, linestyle=":")
        upper.set_yscale("log")
        upper.set_ylim(1e-4, 1.0)
        upper.set_title(name, fontsize="medium")
        under.set_xlabel("entrainment speed [m/s]")
    axes[0, 0].set_ylabel("share of the load that solids carry")
    axes[1, 0].set_ylabel("friction coefficient")
    axes[1, 0].legend(frameon=False, fontsize="small")
    return figure
