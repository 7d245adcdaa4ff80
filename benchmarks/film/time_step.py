"""Moving rough contacts against the time step: what an instant of a longer or a shorter way of the oil changes.

    python -m benchmarks.film.time_step

Writes docs/measured/film.md in about ten minutes.
"""

import numpy as np

from benchmarks.film.moving import SCENES, first_block, values
from benchmarks.pages import Page
from contact_core import Scene, advance, initial_state
from contact_core.deterministic.accumulator import Accumulator
from contact_core.deterministic.sampling import sample_mixed
from contact_core.scene import Case

STEPS = (1.0, 0.25, 0.125)  # nodes that the oil moves by in an instant
SEEDS = (None, 11, 12)
TOLERANCES = ("3e-3", "1e-3")
NAMES = ("W_c", "A_c", "friction", "h_c [nm]")
BARS = (0.02, 0.02, 0.02, 0.03)
SPEEDS = (0.2875, 0.2125), (0.3375, 0.1625), (0.15, 0.35), (0.0, 0.5), (0.5, 0.0)
LAYERS = ("0 nm", "1 nm", "4 nm", "16 nm")  # rms of the asperities below the grid, on one body
INSTANTS = 256  # consecutive ones
APART = (1, 2, 4, 8, 16, 24)


def found_of(name: str, nodes: int, step: float, seed: int | None = None, **changes: str) -> np.ndarray:
    """Return the outputs of the first block at a way of the oil per instant."""
    return np.array(values(first_block(name, nodes, seed, **{"control.nodes_per_instant": f"{step:g}"} | changes)))


def steps(page: Page) -> None:
    """Add first blocks of both scenes at three steps, three realisations and two tolerances."""
    page.say("### Against the step\n\nFirst block of the shipped scenes. Step: way of the oil in an instant, in nodes.")
    page.header("scene", "nodes", "realisation", "film.tolerance", "step", *NAMES, "iterations")
    for name in SCENES:
        for nodes, seeds, tolerances in ((65, SEEDS, TOLERANCES), (129, SEEDS[:1], TOLERANCES[:1])):
            worst = np.zeros(len(NAMES))
            for k, seed in enumerate(seeds, 1):
                for tolerance in tolerances if seed is None else tolerances[:1]:
                    rows = [found_of(name, nodes, step, seed, **{"film.tolerance": tolerance}) for step in STEPS]
                    for step, row in zip(STEPS, rows, strict=True):
                        page.row(name, nodes, k, tolerance, step, *row[:4], row[5])
                    ratios = np.array(rows)[:, :4] / rows[-1][:4]
                    worst = np.maximum(worst, np.abs(ratios - 1.0).max(axis=0))
            said = ", ".join(f"{what} {100.0 * most:.1f} %" for what, most in zip(NAMES, worst, strict=True))
            page.verdict(
                f"{name}, {nodes} nodes: W_c, A_c and friction within 2 %, h_c within 3 % of the shortest step",
                said,
                bool((worst <= BARS).all()),
            )


def other_contacts(page: Page) -> None:
    """Add a nearly smooth film, thin layers of asperities below the grid, other cavities and exchanged bodies."""
    page.say("### Smooth films, hard floors, cavities\n\n`azam_case_a` on 65 nodes.")
    page.header("changed", "step", *NAMES)

    def compared(text: str, steps: tuple[float, ...], **changes: str) -> list[np.ndarray]:
        rows = [found_of("azam_case_a", 65, step, **changes) for step in steps]
        for step, row in zip(steps, rows, strict=True):
            page.row(text, step, *row[:4])
        return rows

    both = "surface_1.microroughness.rms", "surface_2.microroughness.rms"
    smooth = {"surface_1.rq": "4 nm", "surface_2.rq": "0 nm"} | dict.fromkeys(both, "0 nm")
    rows = compared("rq 4 nm, nothing below the grid", STEPS, **smooth)
    off = max(abs(row[3] / rows[-1][3] - 1.0) for row in rows)
    page.verdict("a nearly smooth film: h_c within 1 % at any step", f"{100.0 * off:.1f} %", bool(off <= 0.01))
    for rms in LAYERS:
        rows = compared(f"asperities below the grid of {rms}", STEPS, **dict(zip(both, (rms, "0 nm"), strict=True)))
        off = max(abs(row[0] / rows[-1][0] - 1.0) for row in rows)
        page.verdict(f"asperities below the grid of {rms}: W_c within 3 %", f"{100.0 * off:.0f} %", bool(off <= 0.03))
    one = compared("cavities that conserve mass", (1.0,), **{"lubricant.cavitation": "mass_conserving"})[0]
    other = compared("as it is", (1.0,))[0]
    page.verdict("both kinds of cavities the same", f"{abs(one[0] / other[0] - 1.0):.1g}", bool((one == other).all()))
    scene = Scene.from_toml("azam_case_a")
    speeds = {
        "operation.speed_1": f"{scene.operation.speed_2!r} m/s",
        "operation.speed_2": f"{scene.operation.speed_1!r} m/s",
    }
    off = compared("speeds of the bodies exchanged", (1.0,), **speeds)[0][0] / other[0] - 1.0
    page.verdict("speeds exchanged: W_c within 1 %", f"{100.0 * off:+.1f} %", bool(abs(off) <= 0.01))


def sliding(page: Page) -> None:
    """Add first blocks of bodies that slide past each other, and how much of the difference is stated."""
    page.say(
        "### Sliding\n\n`azam_case_a` on 65 nodes, its entrainment speed and other speeds of the bodies. Stated: half width of W_c at "
        "one node a step."
    )
    page.header("speed_1 [m/s]", "speed_2 [m/s]", "step", *NAMES, "W_c stated")
    worst, covered = 0.0, 0
    for pair in SPEEDS:
        given = {f"operation.speed_{body}": f"{speed:g} m/s" for body, speed in enumerate(pair, 1)}
        rows = []
        for step in STEPS:
            changes = {"film.points": "65", "control.nodes_per_instant": f"{step:g}"} | given
            scene = Scene.from_toml("azam_case_a", changes)
            out = advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]
            found = out.contact_load_ratio, out.contact_area_ratio, out.friction_coefficient, 1e9 * out.h_c
            rows.append((found[0], out.error_load_ratio))
            page.row(*pair, step, *found, out.error_load_ratio)
        worst = max(worst, abs(rows[0][0] / rows[-1][0] - 1.0))
        covered += abs(rows[0][0] - rows[-1][0]) <= rows[0][1]
    page.verdict("sliding: W_c within 2 % of the shortest step", f"{100.0 * worst:.0f} %", worst <= 0.02)
    page.verdict(
        "sliding: the difference within the stated error", f"{covered} of {len(SPEEDS)}", covered == len(SPEEDS)
    )


def alike(page: Page) -> None:
    """Add how much alike instants are over the way of the oil between them."""
    page.say(
        f"### How much alike instants are\n\nCorrelation of W_c of {INSTANTS} consecutive instants on 65 nodes by the nodes "
        "between two of them, and the standard deviation of single ones."
    )
    page.header("scene", "scatter of W_c [%]", *(f"{apart} nodes" for apart in APART))
    for name in SCENES:
        scene = Scene.from_toml(name, {"film.points": "65", "control.mixed_instants": str(INSTANTS)})
        state = initial_state(scene)
        sums = Accumulator.before(state)
        sample_mixed(Case.bind(scene, scene.operation.point), state, sums, False)
        shares = np.array([seen["contact_load_ratio"] for seen in sums.outputs])
        off = shares - shares.mean()
        page.row(
            name,
            100.0 * off.std() / shares.mean(),
            *(float((off[:-apart] * off[apart:]).mean() / off.var()) for apart in APART),
        )


def main() -> None:
    page = Page("film/time_step", "Moving rough contacts against the time step")
    steps(page)
    other_contacts(page)
    sliding(page)
    alike(page)
    page.write()


if __name__ == "__main__":
    main()
