"""Moving rough contacts: share of the solids, friction and film against the grid, and what they depend on.

    python -m benchmarks.film.moving

Writes docs/measured/film.md in about half an hour.
"""

import numpy as np

from benchmarks.pages import Page
from contact_core import Outputs, Scene, advance, initial_state

SCENES = ("azam_case_a", "mtm_zddp")
GRIDS, FINEST = (65, 129), 257
SEEDS = (None, 11, 12)
RMS = (0.0, 5e-9, 10e-9, 20e-9, 40e-9, 60e-9)  # m, of the disc
OTHERS = (
    ("as it is", {}),
    ("flow of warm, sheared oil", {"lubricant.flow": "local"}),
    ("film.floor 0.5 nm", {"film.floor": "0.5 nm"}),
    ("film.floor 2 nm", {"film.floor": "2 nm"}),
    (
        "longest wavelength 2 um",
        {"surface_1.microroughness.longest": "2 um", "surface_2.microroughness.longest": "2 um"},
    ),
    (
        "longest wavelength 8 um",
        {"surface_1.microroughness.longest": "8 um", "surface_2.microroughness.longest": "8 um"},
    ),
)
NAMES = ("W_c", "A_c", "friction", "h_c [nm]", "wear rate 1 [um3/s]", "iterations", "unconverged")


def of_disc(rms: float) -> dict[str, str]:
    """Return the changes of a scene for a microroughness of the disc [m]; for 0 the ball has none either."""
    changes = {"surface_2.microroughness.rms": f"{rms!r} m"}
    return changes | ({"surface_1.microroughness.rms": "0 m"} if rms == 0.0 else {})


def first_block(name: str, nodes: int, seed: int | None = None, **changes: str) -> Outputs:
    """Return the outputs of the first block."""
    scene = Scene.from_toml(name, {"film.points": str(nodes)} | changes)
    if seed is not None:
        scene = scene.realisation(seed)
    return advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]


def values(out: Outputs) -> tuple[float, ...]:
    """Return what the tables show of a block."""
    film = (out.h_c * 1e9, out.wear_rate_1 * 1e18)
    return (
        out.contact_load_ratio,
        out.contact_area_ratio,
        out.friction_coefficient,
        *film,
        out.iterations,
        out.unconverged,
    )


def grids(page: Page) -> None:
    """Add both scenes on several grids."""
    page.say(
        "### Against the grid\n\nFirst block of the shipped scenes on fresh surfaces. Three realisations of the surfaces."
    )
    page.header("scene", "realisation", "nodes", *NAMES)
    for name in SCENES:
        found = {n: [values(first_block(name, n, seed)) for seed in SEEDS] for n in (*GRIDS, FINEST)}
        for k in range(len(SEEDS)):
            for n, rows in found.items():
                page.row(name, k + 1, n, *rows[k])
        for n, most in zip(GRIDS, (5.0, 2.0), strict=True):
            ratio = np.array(found[n])[:, :5] / np.array(found[FINEST])[:, :5]
            each, mean = 100.0 * np.abs(ratio - 1.0).max(axis=0), 100.0 * (ratio.mean(axis=0) - 1.0)
            said = ", ".join(
                f"{what} {worst:.1f} ({off:+.1f})" for what, worst, off in zip(NAMES, each, mean, strict=False)
            )
            page.verdict(
                f"{name}: {n} nodes within {most:g} % of {FINEST}, worst realisation (mean of three)",
                said,
                bool(each.max() <= most),
            )


def sensitivity(page: Page) -> None:
    """Add what the share of the solids depends on."""
    page.say(
        f"### What it depends on\n\n`mtm_zddp` on {GRIDS[0]} nodes. First the microroughness of the disc; that of the ball stays, "
        "but for 0, where both solids are smooth above a hard floor."
    )
    page.header("rms [nm]", *NAMES)
    for rms in RMS:
        page.row(rms * 1e9, *values(first_block("mtm_zddp", GRIDS[0], **of_disc(rms))))
    page.say("Then other choices, each alone:")
    page.header("changed", *NAMES)
    for text, changes in OTHERS:
        page.row(text, *values(first_block("mtm_zddp", GRIDS[0], **changes)))


def main() -> None:
    page = Page("film/moving", "Moving rough contacts")
    grids(page)
    sensitivity(page)
    page.write()


if __name__ == "__main__":
    main()
