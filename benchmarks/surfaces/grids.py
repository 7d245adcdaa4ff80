"""Surfaces of each kind on grids of 65 to 513 nodes: what each grid shows, and what refining changes.

    python -m benchmarks.surfaces.grids

Writes docs/measured/surfaces/grids.md and docs/measured/surfaces/grids.png.
"""

import argparse
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from benchmarks.folders import MEASURED
from benchmarks.pages import save
from contact_core import Scene
from contact_core.scene import SelfAffine, Surface
from contact_core.surfaces.laid import Shown, shown
from contact_core.surfaces.patches import bare_heights
from contact_core.surfaces.roughness import generate

DOCS = MEASURED / "surfaces"
SCENE = "azam_case_a"
GRIDS = (65, 129, 257, 513)
SMOOTH = Surface(0.0, 40e-6, 1)
BAND = SelfAffine(rq=100e-9, hurst=0.8, roll_off=60e-6, cut_off=4e-6, seed=1)


def dimple() -> np.ndarray:
    """Dimple of Mourier et al., Tribol. Int. 39 (2006) 1745, on 1 um: 175 nm deep, level beyond 18.6 um."""
    at = np.arange(40) - 19.5
    r = np.hypot(at[:, None], at[None, :]) / (1.2 * 15.5)
    return np.where(r < 1.0, -175.0 * np.cos(0.5 * np.pi * r) * np.exp(-2.0 * r**2), 0.0)


def patch() -> np.ndarray:
    """Stand-in for a measured patch: 0.25 mm of a surface on 1 um that does not close on itself."""
    return 1e9 * generate(replace(BAND, seed=2), 513, 512e-6, 1)[:250, :250]


def scenes(points: int) -> dict[str, Scene]:
    """Return scenes with one rough body, by kind."""
    scene = replace(Scene.from_toml(SCENE, {"film.points": str(points)}), surface_1=SMOOTH, surface_2=SMOOTH)
    return {
        "Gaussian, 20 um": replace(scene, surface_2=Surface(100e-9, 20e-6, 1)),
        "Gaussian, 40 um along and 10 um across": replace(
            scene, surface_2=Surface(100e-9, 40e-6, 1, correlation_length_across=10e-6)
        ),
        "self-affine, 60 to 4 um": replace(scene, surface_2=BAND),
        "file, mirrored": scene.with_heights(2, patch(), 1e-6, "nm"),
        "file, flat beyond": scene.with_heights(2, dimple(), 1e-6, "nm", "flat"),
    }


def row(kind: str, points: int, found: Shown, change: float) -> str:
    grid = found.on_grid
    return (
        f"| {kind} | {points} | {1e9 * found.rms:.4g} | {1e9 * grid.rms:.4g} | {100.0 * found.cut / found.rms:.3g} % | "
        f"{found.slope:.3g} | {grid.slope:.3g} | {1e9 * grid.peak_to_valley:.4g} | {100.0 * change:.2g} % |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args()
    lines = [
        "# Surfaces on four grids",
        "",
        f"Written by `python -m benchmarks.surfaces.grids`. Patches of {SCENE}, {1e3 * Scene.from_toml(SCENE).film.domain:g} mm square. "
        "*Cut* is the rms height of what the grid does not show, over the rms height of all waves. *Change* is the rms "
        f"difference at shared nodes from {GRIDS[-1]} nodes, over the same.",
        "",
        "| surface | nodes | rms of all waves, nm | rms, nm | cut | rms slope of all waves | rms slope | peak to valley, nm | change |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    made = {points: scenes(points) for points in GRIDS}
    figure = Figure(figsize=(12, 5), layout="constrained")
    kinds = list(made[GRIDS[0]])
    axes = figure.subplots(2, len(kinds))
    for i, kind in enumerate(kinds):
        heights = {points: bare_heights(made[points][kind], points)[1] for points in GRIDS}
        for points in GRIDS:
            step = (GRIDS[-1] - 1) // (points - 1)
            found = shown(made[points][kind], 2)
            change = float(np.std(heights[GRIDS[-1]][::step, ::step] - heights[points])) / found.rms
            lines.append(row(kind, points, found, change))
        for ax, points in zip(axes[:, i], (GRIDS[0], GRIDS[-1]), strict=True):
            most = 1e9 * np.abs(heights[GRIDS[-1]]).max()
            ax.imshow(
                1e9 * heights[points], origin="lower", extent=(0, 0.5, 0, 0.5), vmin=-most, vmax=most, cmap="gray"
            )
            ax.set_title(f"{kind.replace(' and', chr(10) + 'and')}\n{points} nodes", fontsize="small")
            ax.set_xticks([]), ax.set_yticks([])
    save("surfaces/grids", "\n".join([*lines, "", "![The surfaces on the coarsest and finest grid](grids.png)"]))
    figure.savefig(DOCS / "grids.png", dpi=80)
    print("\n".join(lines))


if __name__ == "__main__":
    main()
