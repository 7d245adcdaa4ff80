"""Share of the load on the solids over lambda beside published fits, and what it depends on, one thing at a time.

    python -m benchmarks.surfaces.asperity_load_share

Writes docs/measured/surfaces.md and .png in about five minutes, one thread.
"""

import math
import time
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from benchmarks.pages import Page
from contact_core import Scene, initial_state
from contact_core.deterministic.transient import begin, follow
from contact_core.laws.asperity_layer import ELASTIC_HEIGHT, PLASTIC_HEIGHT
from contact_core.scene import Case
from system_models.validation.asperity_load import (
    CONTACTS,
    LAMBDAS,
    NODES,
    Contact,
    at_lambda,
    band,
    composite,
    fits,
    line_contact,
    scene_of,
    solved,
)

BASE = "mtm_zddp"
FEWEST, MOST = 3, 10  # realisations: more until the mean is known to ALLOWED
LONG = {"surface_1.correlation_length": "16 um", "surface_2.correlation_length": "16 um"}
STEPS = ((65, 1.0), (65, 0.5), (129, 1.0), (129, 0.5))  # nodes a side, nodes a step
NEGLIGIBLE = 0.01  # share that need not be known so well
FIRST = 10  # seed of the realisations beside the scene's own, less one
ALLOWED = 0.1  # standard error of a mean over the seeds, over the mean


def raw_trace(rq: float) -> dict[str, str]:
    """Return a roller on a raceway with the waves of a trace as it is stored, the instrument's among them.

    Of the rms height 0.53 in waves of 12.5 um and more, of even power per octave, and 0.85 in shorter ones.
    """
    each = rq / math.sqrt(2.0)
    return line_contact({
        "model": "self_affine", "rq": f"{0.53 * each:.4g} m", "hurst": "0.01", "roll_off": "180 um", "cut_off": "12.5 um",
        "microroughness.rms": f"{0.85 * each:.4g} m", "microroughness.longest": "12.5 um",
    })  # fmt: skip


TENTH, RIGID = "load a tenth: Hertz's pressure 0.46 of it", "all waves below the grid, where oil cannot deform them"
SHORT = "correlation length 4 um instead of 8 um (129 nodes)"
ALONG, ACROSS = "lay along the motion: 50 um by 8 um", "lay across the motion: 8 um by 50 um"
THIN = "flow of warm, thinning oil (lubricant.flow = local)"


def both(**changes: str) -> dict[str, str]:
    """Return changes of both surfaces; __ stands for a dot."""
    return {f"surface_{k}.{key.replace('__', '.')}": value for k in (1, 2) for key, value in changes.items()}


def below_the_grid() -> dict[str, str]:
    """Return BASE with the waves of its grid below it, where oil does not deform them: same rms height, same dry contact."""
    scene, changes = Scene.from_toml(BASE), {}
    for k, surface in enumerate((scene.surface_1, scene.surface_2), 1):
        fine = surface.microroughness
        rms = math.hypot(surface.rq, fine.rms)
        firmness = math.hypot(
            surface.slope / 2.3, fine.slope
        )  # q sigma: 2.3 of it is the slope of all waves of a layer
        changes |= {
            f"surface_{k}.rq": "1 nm",
            f"surface_{k}.microroughness.rms": f"{rms:.4g} m",
            f"surface_{k}.microroughness.longest": f"{2.0 * math.pi * rms / firmness:.4g} m",
        }
    return changes


FACTORS: dict[str, dict[str, str]] = {
    "as it ships": {},
    "grid: 129 nodes": {"film.points": "129"},
    "below the grid: nothing": both(microroughness__rms="0 m"),
    "below the grid: disc 32 nm instead of 16 nm": {"surface_2.microroughness.rms": "32 nm"},
    "below the grid: disc 60 nm": {"surface_2.microroughness.rms": "60 nm"},
    "below the grid: longest wave 2 um instead of 4 um": both(microroughness__longest="2 um"),
    "below the grid: longest wave 8 um": both(microroughness__longest="8 um"),
    SHORT: both(correlation_length="4 um") | {"film.points": "129"},
    "correlation length 16 um": LONG,
    "correlation length 25 um": both(correlation_length="25 um"),
    ALONG: both(correlation_length="50 um", correlation_length_across="8 um"),
    ACROSS: both(correlation_length="8 um", correlation_length_across="50 um"),
    RIGID: below_the_grid(),
    TENTH: {"operation.load": "5.37 N"},
    "sliding 0.1 % instead of 5 %": {"operation.speed_1": "0.10005 m/s", "operation.speed_2": "0.09995 m/s"},
    "sliding 100 %": {"operation.speed_1": "0.15 m/s", "operation.speed_2": "0.05 m/s"},
    THIN: {"lubricant.flow": "local"},
    "hardness 2 GPa instead of 6 GPa": {"plasticity.hardness": "2 GPa"},
    "hardness 20 GPa": {"plasticity.hardness": "20 GPa"},
}


class Found(NamedTuple):
    """Of the solved blocks of all seeds: mean share of the load on the solids, its standard error, others."""

    share: float
    error: float
    film: float  # h_c [m]
    rough: float  # lambda of the deformed bodies
    stated: float  # the half width that a block states
    unconverged: float


def mean(name: str, ratio: float, changes: Mapping[str, str]) -> Found:
    outs = [solved(name, ratio, changes)]
    while len(outs) < MOST:
        outs.append(solved(name, ratio, changes, FIRST + len(outs)))
        shares = np.array([out.contact_load_ratio for out in outs])
        error = float(shares.std(ddof=1) / math.sqrt(shares.size))
        if len(outs) >= FEWEST and (error < ALLOWED * shares.mean() or shares.mean() < NEGLIGIBLE):
            break
    means = (
        float(np.mean([getattr(out, key) for out in outs]))
        for key in ("h_c", "lambda_ratio", "error_load_ratio", "unconverged")
    )
    return Found(float(shares.mean()), error, *means)


def statistics(page: Page) -> None:
    page.say(
        "## Our own roughness by their method\n\nEvery fit is 1 at lambda 0, whatever the load: it is the pressure of rigid or dry rough bodies at a mean gap, "
        "over that at no gap. The same of our law of dry roughness, exp(-lambda sigma / h_0), fitted to our own dry contacts and to no fit of these "
        f"(`contact_core/laws/asperity_layer.py`): h_0 = {ELASTIC_HEIGHT:g} sigma of elastic, {PLASTIC_HEIGHT:g} sigma of yielding asperities."
    )
    page.header("lambda", "band of the fits", "elastic", "yielding", "inside")
    inside = []
    for ratio in sorted(set(fits()["erfc"])):
        low, high = band(ratio)
        elastic, yielding = (math.exp(-ratio / height) for height in (ELASTIC_HEIGHT, PLASTIC_HEIGHT))
        inside.append(low <= elastic <= high or low <= yielding <= high)
        page.row(ratio, f"{low:.4f} to {high:.4f}", elastic, yielding, inside[-1])
    page.verdict(
        "our statistics by the method of the fits within their band",
        f"at {sum(inside)} of {len(inside)} lambdas",
        all(inside),
    )


def contacts(page: Page) -> dict[str, list[Found]]:
    page.say(
        f"## Solved contacts\n\nFresh surfaces, one block of {NODES} nodes a side of {FEWEST} to {MOST} realisations each; lambda: film of smooth bodies by formula over the composite rms "
        "height of all waves, set by the speed. p_0/p_m: pressure of the dry, rigid roughness without a gap (0.45 E'/2 times its rms slope; of a layer below the grid its own law) over Hertz's mean pressure. "
        "Stated: half width of one block."
    )
    page.header("contact", "p_0/p_m", "lambda", "band", "W_c", "standard error", "stated", "h_c [nm]", "unconverged")
    all_found: dict[str, list[Found]] = {}
    raw = {"raceway, Rq 0.16 um, waves of the raw trace": Contact("fzg_flank", raw_trace(0.16e-6))}
    for name, contact in (CONTACTS | raw).items():
        for ratio in LAMBDAS:
            found = mean(contact.scene, ratio, contact.changes)
            all_found.setdefault(name, []).append(found)
            low, high = band(ratio)
            page.row(
                name, round(firmness(scene_of(contact.scene, contact.changes), ratio), 2), ratio, f"{low:.3f} to {high:.3f}",
                found.share, found.error, found.stated, 1e9 * found.film, found.unconverged,
            )  # fmt: skip
    return all_found


def firmness(scene: Scene, ratio: float) -> float:
    """Return the pressure of the dry, rigid roughness without a gap over Hertz's mean pressure."""
    modulus = scene.solids.reduced_modulus
    bodies = scene.surface_1, scene.surface_2
    waves = 0.45 * 0.5 * modulus * math.hypot(*(body.slope for body in bodies))
    layer = bodies[0].microroughness.beside(bodies[1].microroughness).pressure_scale(modulus, scene.plasticity.hardness)
    case = Case.bind(scene, at_lambda(scene, ratio))
    return math.hypot(waves, layer) / (
        case.hertz.pressure_max * (math.pi / 4.0 if case.shape.along_face else 2.0 / 3.0)
    )


def factors(page: Page) -> dict[str, list[Found]]:
    page.say(
        f"## One thing at a time\n\nContact `{BASE}`, everything else as it ships. h_c / sigma: of the solved, rough bodies."
    )
    heads = [text for ratio in LAMBDAS for text in (f"W_c at lambda {ratio:g}", "standard error", "h_c / sigma")]
    page.header("changed", *heads)
    all_found = {}
    for text, changes in FACTORS.items():
        all_found[text] = [mean(BASE, ratio, changes) for ratio in LAMBDAS]
        rough = composite(scene_of(BASE, changes))
        page.row(text, *(cell for found in all_found[text] for cell in (found.share, found.error, found.film / rough)))
    page.row(
        "the band of the fits",
        *(cell for ratio in LAMBDAS for cell in ("{:.3f} to {:.3f}".format(*band(ratio)), "", "")),
    )
    return all_found


def definitions(page: Page) -> None:
    page.say(
        "## Definition of lambda\n\nThe same contact; smooth: without any roughness, solved on the same grid. By that film lambda is a fifth smaller, "
        "where the fits are higher: the distance from the band would grow. Without what is below the grid it is 1 % larger."
    )
    page.header(
        "by formula, Rq of all waves",
        "by formula, Rq on the grid",
        "by the smooth, solved film",
        "by the rough, solved film",
    )
    scene = Scene.from_toml(BASE)
    rough = composite(scene)
    on_grid = math.hypot(scene.surface_1.rms, scene.surface_2.rms)
    for ratio in LAMBDAS:
        op = at_lambda(scene_of(BASE, {}), ratio)
        speeds = {f"operation.speed_{k}": f"{speed!r} m/s" for k, speed in ((1, op.speed_1), (2, op.speed_2))}
        smooth = scene_of(BASE, both(rq="0 m", microroughness__rms="0 m") | speeds)
        _, fields = begin(Case.bind(smooth, smooth.operation.point), initial_state(smooth))
        middle = float(fields.gap[fields.gap.shape[0] // 2, np.abs(fields.x).argmin()])
        page.row(ratio, ratio * rough / on_grid, middle / rough, mean(BASE, ratio, {}).film / rough)


def marched(nodes: int, way: float, changes: Mapping[str, str]) -> float:
    """Return W_c of a march in steps of so many nodes, over the second half of a pass at the first of LAMBDAS."""
    scene = scene_of(BASE, dict(changes) | {"film.points": str(nodes)})
    case = Case.bind(scene, at_lambda(scene, LAMBDAS[0]))
    dt = way * scene.film.spacing / case.fastest
    state, _ = begin(case, initial_state(scene))
    shares = []
    for _ in range(round((nodes - 1) / way)):
        state, fields = follow(case, state, dt, [speed * dt for speed in case.speeds])
        shares.append(float(fields.solid_pressure.sum()) * scene.film.spacing**2 / case.op.load)
    return float(np.mean(shares[len(shares) // 2 :]))


def steps(page: Page) -> None:
    page.say(
        f"## Time step\n\nA march of `{BASE}` at lambda {LAMBDAS[0]:g}, one pass, the second half of it averaged; one realisation. Steps of half a node lower W_c: the step is not why it lies below the fits. "
        "The change is small only where a correlation length has four nodes, so part of it is likely the film's mass, which half steps interpolate between nodes. "
        "Which of both is nearer to the truth is open. Blocks, in steps of one node, differ little between 65 and 129 nodes (above), where step and spacing are halved together."
    )
    page.header(
        "nodes a side",
        "nodes a step",
        "W_c at 8 um",
        "nodes a correlation length",
        "W_c at 16 um",
        "nodes a correlation length",
    )
    for nodes, way in STEPS:
        per = 8e-6 * (nodes - 1) / 0.5e-3
        page.row(nodes, way, marched(nodes, way, {}), per, marched(nodes, way, LONG), 2.0 * per)


def answer(page: Page, changed: dict[str, list[Found]]) -> None:
    """Add why solved shares differ from the fits, in numbers of this page."""
    ships = changed["as it ships"]

    def times(text: str) -> str:
        return " and ".join(f"{one.share / base.share:.2g}" for one, base in zip(changed[text], ships, strict=True))

    page.say(
        f"## Why\n\nW_c over that of `{BASE}` as it ships, at lambda {LAMBDAS[0]:g} and {LAMBDAS[1]:g}.\n\n"
        "**The fits are another quantity.** Each is 1 at lambda 0 whatever the load; read so, our own dry roughness lies within "
        "them at every lambda. A solved contact has the load in it: at a tenth of the load, or 0.46 of the pressure, W_c is "
        f"{times(TENTH)} times as large.\n\n"
        "**Below the band, where it is: oil presses waves on the grid flat.** The same waves put below the grid, where oil cannot deform "
        f"them, give {times(RIGID)} times W_c. The longer the waves against the contact, the flatter: {times('correlation length 16 um')} "
        f"times at 16 um, {times('correlation length 25 um')} at 25 um, as gear flanks have here; {times(SHORT)} at 4 um. Sliding adds to it: "
        f"{times('sliding 100 %')} times at 100 %.\n\n"
        "**What is below the grid decides.** It stays rigid and steep, so that it carries load over what is left of the long waves: "
        f"without it {times('below the grid: nothing')} times, with 32 nm on the disc instead of 16 nm "
        f"{times('below the grid: disc 32 nm instead of 16 nm')}. Bearing surfaces, a fifth of Rq below 4 um and correlation lengths of "
        "6 and 18 um by their traces, reach the band or pass it. The raw trace, whose short waves are partly the instrument's, lies far above.\n\n"
        f"**Of less weight:** lay along the motion {times(ALONG)} times, across it {times(ACROSS)}; oil that thins and warms between "
        f"asperities {times(THIN)} times; hardness of 2 GPa {times('hardness 2 GPa instead of 6 GPa')}, 20 GPa "
        f"{times('hardness 20 GPa')}; 129 nodes {times('grid: 129 nodes')}."
    )


def draw(page: Page, scenes: dict[str, list[Found]], changed: dict[str, list[Found]]) -> None:
    figure = Figure(figsize=(7.2, 5.0), layout="constrained")
    axes = figure.add_subplot()
    for number, over in enumerate(fits().values()):
        axes.plot(list(over), list(over.values()), color="0.7", lw=1.0, label="published fits" if number == 0 else None)
    at = np.linspace(0.0, 2.5, 60)
    axes.plot(at, np.exp(-at / ELASTIC_HEIGHT), "k--", lw=1.2, label="our dry roughness by their method")
    for marker, (name, found) in zip("os^vDPX*", scenes.items(), strict=False):
        axes.plot(LAMBDAS, [one.share for one in found], f"{marker}-", ms=5, lw=1.0, label=name)
    rigid = changed[RIGID]
    axes.plot(LAMBDAS, [one.share for one in rigid], "k+", ms=9, label=f"{BASE}, all waves below the grid")
    axes.set(
        yscale="log",
        ylim=(1e-4, 1.0),
        xlim=(0.4, 2.1),
        xlabel="lambda, smooth film by formula over Rq",
        ylabel="share of the load on the solids",
    )
    axes.legend(frameon=False, fontsize=7.5, ncols=2)
    page.picture(figure, "asperity_load_share.png", "share of the load on the solids over lambda")


def main() -> None:
    start = time.process_time()
    page = Page("surfaces/asperity_load_share", "Share of the load on the solids over lambda, beside published fits")
    page.say(ABOUT)
    statistics(page)
    scenes = contacts(page)
    changed = factors(page)
    answer(page, changed)
    definitions(page)
    steps(page)
    draw(page, scenes, changed)
    known = [one for rows in (*scenes.values(), *changed.values()) for one in rows if one.share > NEGLIGIBLE]
    worst = max(one.error / one.share for one in known)
    page.verdict(
        f"W_c known to {100 * ALLOWED:g} % (standard error of {FEWEST} to {MOST} realisations) where it is above {NEGLIGIBLE:g}",
        f"at worst {100 * worst:.0f} %",
        worst <= ALLOWED,
    )
    page.say(f"{time.process_time() - start:.0f} CPU s.")
    page.write()


ABOUT = """Fits: `system_models/validation/data/asperity_load_share.csv`, with their sources; all computed by their authors from profiles or
statistics, none measured. One row of that table is left out: Masjedi & Khonsari's, written down from memory."""


if __name__ == "__main__":
    main()
