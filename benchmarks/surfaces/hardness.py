"""Hardness of three layers: what each plasticity.indentation presses in, and what an elastic tribofilm changes.

    python -m benchmarks.surfaces.hardness

Writes docs/measured/surfaces/hardness.md. Half an hour of both rigs on 65 nodes, with each indentation: three minutes.
"""

import argparse
from dataclasses import dataclass, field, replace
from time import process_time

import numpy as np
from numpy.typing import NDArray

from benchmarks.pages import Page
from contact_core import ContactState, Scene, advance, initial_state, march, solve
from contact_core.deterministic.transient import rolled
from contact_core.surfaces.patches import facing_films

SCENES = ("azam_case_a", "mtm_zddp")
INDENTATIONS = ("none", "total", "iterated", "iterated_total")
MINUTES, POINTS, INSTANTS = 30, 65, 4  # of a run; nodes; instants looked at each minute
OFFSET = 0.7548776662466927, 0.5698402909980532  # of the additive sequence R2, in domains
FINE, FILMS, PLACES = 129, (2e-9, 10e-9, 50e-9, 150e-9), 12  # nodes, even films and instants of new bodies
THICK = 150e-9  # tribofilm on each body, under which its modulus is tried
MODULI = (None, 130e9, 30e9)
MARCH, SETTLED = 33, 17  # instants of a march, and those that are averaged
THESIS = 2.95  # p_max / p_H of the thesis


@dataclass
class Run:
    """One rig with one indentation."""

    scene: Scene
    cost: float = 0.0  # [s]
    layers: NDArray[np.int64] = field(default_factory=lambda: np.zeros(4, np.int64))
    touching: int = 0
    peak: float = 0.0  # mean over the instants of the largest pressure [Pa]
    wrong: float = 0.0  # largest p / H(U) - 1
    unconverged: int = 0
    outputs: dict[str, float] = field(default_factory=dict)
    plastic: tuple[float, ...] = ()  # volumes [m3] pressed into the patches


def layers(scene: Scene, state: ContactState, overlap: NDArray[np.float64]) -> list[NDArray[np.bool_]]:
    """Nodes that yield in the thicker film alone, in both, in the steel below, and in steel without any film."""
    (first, second), before = facing_films(scene, state)
    thick, depth, yields = first + second, before + overlap, overlap > 0.0
    bare = thick <= 0.0
    through = depth >= thick * (1.0 - 1e-9)
    alone = depth < np.abs(first - second)
    kinds = (alone & ~bare, ~alone & ~through, through & ~bare, bare)
    return [yields & kind for kind in kinds]


def look(run: Run, state: ContactState, share: float, n: int) -> None:
    """Add an instant of the rig as it is, whose solids carry their share of the load; nothing is pressed in by it."""
    scene = run.scene
    domain = scene.film.domain
    state = rolled(scene, state, [n * offset * domain for offset in OFFSET])
    fields = solve(scene, scene.operation.point, state, dry=True, solid_share=share)
    run.layers += [int(kind.sum()) for kind in layers(scene, state, fields.overlap)]
    run.touching += int((fields.solid_pressure > 0.0).sum())
    run.peak += float(fields.pressure.max()) / (MINUTES * INSTANTS)
    films, before = facing_films(scene, state)
    own = fields.overlap if scene.plasticity.iterated else 0.0
    limit = scene.plasticity.limit(*films, before + own, scene.tribofilm.full_thickness)
    run.wrong = max(run.wrong, float((fields.pressure / limit).max()) - 1.0)
    run.unconverged += not fields.converged


def run_of(name: str, indentation: str) -> Run:
    """Return a rig after its minutes."""
    run = Run(Scene.from_toml(name, {"film.points": str(POINTS), "plasticity.indentation": indentation}))
    scene = run.scene
    state = initial_state(scene)
    for minute in range(MINUTES):
        begin = process_time()
        state, out = advance(scene, scene.operation.point, state, 60.0)
        run.cost += process_time() - begin
        run.unconverged += out.unconverged > 0.1
        for k in range(INSTANTS):
            look(run, state, max(out.contact_load_ratio, 0.01), INSTANTS * minute + k)
    names = ("contact_load_ratio", "contact_area_ratio", "tribofilm_1", "tribofilm_2", "h_c", "roughness_2")
    run.outputs = {each: getattr(out, each) for each in names}
    run.plastic = tuple(float(body.plastic.sum()) * scene.film.spacing**2 for body in state.bodies)
    return run


def covered(scene: Scene, thickness: float) -> ContactState:
    """Return new bodies under an even tribofilm [m] on each."""
    state = initial_state(scene)
    first, second = (replace(body, growth=np.full_like(body.growth, thickness)) for body in state.bodies)
    return replace(state, bodies=(first, second))


def new_row(page: Page, name: str, thickness: float) -> NDArray[np.int64]:
    """Add what yields between new bodies under even films; return the nodes of each kind."""
    run = Run(Scene.from_toml(name, {"film.points": str(FINE), "plasticity.indentation": "iterated"}))
    state = covered(run.scene, thickness)
    for k in range(PLACES):
        look(run, state, 1.0, k)
    shares = [f"{100.0 * count / run.touching:.3f}" for count in run.layers]
    peak = run.peak * MINUTES * INSTANTS / PLACES / run.scene.hertz(run.scene.operation.load).pressure_max
    page.row(name, f"{1e9 * thickness:g}", *shares, f"{peak:.2f}")
    return run.layers


def modulus_row(name: str, modulus: float | None) -> dict[str, float]:
    """Return means over a march of new bodies under an even tribofilm, and the dry contact's."""
    given = {} if modulus is None else {"solids.film_modulus": f"{modulus} Pa"}
    scene = Scene.from_toml(name, {"film.points": str(POINTS), "plasticity.film_hardness": "6 GPa"} | given)
    op, state = scene.operation.point, covered(scene, THICK)
    dry = solve(scene, op, state, dry=True)
    hertz = scene.hertz(op.load)
    seen: dict[str, list[float]] = {"pressure_max": [], "contact_area_ratio": [], "h_c": [], "contact_load_ratio": []}
    dt, begin = scene.film.spacing / max(abs(op.speed_1), abs(op.speed_2)), process_time()
    lost = 0
    for k, moment in enumerate(march(scene, state, lambda _: op, [k * dt for k in range(MARCH)])):
        if k < MARCH - SETTLED:
            continue
        lost += not moment.fields.converged
        for key, values in seen.items():
            values.append(moment.outputs[key])
    means = {key: float(np.mean(values)) for key, values in seen.items()}
    area = float(dry.touching.sum()) * scene.film.spacing**2 / hertz.area
    gives = scene.solids.film_give * 2.0 * THICK * hertz.pressure_max
    dry_values = {"dry_pressure": float(dry.pressure.max()), "dry_area": area, "rigid": dry.film.rigid_gap}
    rest = {"gives": gives, "cost": process_time() - begin, "lost": lost, "hertz": hertz.pressure_max}
    return means | dry_values | rest


def main() -> None:
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    page = Page("surfaces/hardness", "Hardness of three layers, and elastic tribofilms")
    runs = {name: {each: run_of(name, each) for each in INDENTATIONS} for name in SCENES}
    page.say(
        f"`plasticity.indentation` over {MINUTES} minutes on {POINTS} nodes. {INSTANTS} instants a minute are looked at in dry contact of the measured share of "
        "the load. *Film*: yielding nodes of Figure 5-4, case 1; *both films*: case 2; *steel*: case 3, through films that are there. *Bare*: without any film. Shares are of the touching nodes, "
        'in %. The depth before counts where the indentation says so. *Cost*: CPU time over that of "none".'
    )
    page.header(
        "rig", "indentation", "film", "both films", "steel", "bare", "p_max / p_H", "W_c", "A_c", "film 1, nm", "film 2, nm", "h_c, nm", "Rq_2, nm", "pressed in 1, um3", "2, um3", "cost",
    )  # fmt: skip
    for name, found in runs.items():
        for each, run in found.items():
            out, scene = run.outputs, run.scene
            shares = [f"{100.0 * count / run.touching:.3f}" for count in run.layers]
            sizes = [f"{out['contact_load_ratio']:.3f}", f"{out['contact_area_ratio']:.3f}"]
            nm = [f"{1e9 * out[key]:.1f}" for key in ("tribofilm_1", "tribofilm_2", "h_c", "roughness_2")]
            volumes = [f"{1e18 * volume:.0f}" for volume in run.plastic]
            peak = run.peak / scene.hertz(scene.operation.load).pressure_max
            page.row(name, each, *shares, f"{peak:.2f}", *sizes, *nm, *volumes, f"{run.cost / found['none'].cost:.2f}")
    page.say(
        f'The thesis has p_max / p_H = {THESIS} in case A. "total" is "iterated_total" with one update of the hardness an instant, from the depth of the instants before.'
    )
    iterated = [run for found in runs.values() for each, run in found.items() if each.startswith("iterated")]
    counts = sum((run.layers for run in iterated), np.zeros(4, np.int64))
    page.say(
        f'New bodies under even films on {FINE} nodes, "iterated", {PLACES} dry instants: peaks reach the steel through films of some nm (of even films, none is the thicker: no case 1); in a run the first passes press those peaks flat.'
    )
    page.header("rig", "film on each, nm", "film", "both films", "steel", "bare", "p_max / p_H")
    for name in SCENES:
        for thickness in FILMS:
            counts += new_row(page, name, thickness)
    page.verdict(
        "cases 1, 2 and 3 of Figure 5-4 occur within a solution",
        f"{counts[0]}, {counts[1]} and {counts[2]} nodes in {len(iterated) * MINUTES * INSTANTS + len(SCENES) * len(FILMS) * PLACES} instants",
        bool(counts[:3].min() > 0),
    )
    page.verdict(
        "p <= H(U) at every node, U as pressed in",
        f"excess {max(run.wrong for run in iterated):.1e}",
        all(run.wrong < 1e-12 for run in iterated),
    )
    page.verdict(
        "every solution converges",
        f"{sum(run.unconverged for run in iterated)} do not",
        not any(run.unconverged for run in iterated),
    )
    page.say(
        f"`solids.film_modulus` on new bodies, {1e9 * THICK:g} nm of tribofilm on each, as hard as the steel, Poisson's ratio 0.3: means over {SETTLED} instants of a march, and a dry instant. *Gives*: both films at "
        "Hertz's pressure, more than as much steel. *Closer*: approach of the dry bodies beyond that of rigid films."
    )
    page.header(
        "rig",
        "E_f, GPa",
        "gives, nm",
        "closer, nm",
        "dry p_max / p_H",
        "dry A_c",
        "p_max / p_H",
        "W_c",
        "A_c",
        "h_c, nm",
        "cost",
    )
    for name in SCENES:
        rows = {modulus: modulus_row(name, modulus) for modulus in MODULI}
        rigid = rows[None]
        for modulus, row in rows.items():
            page.row(
                name, "rigid" if modulus is None else f"{1e-9 * modulus:g}", f"{1e9 * row['gives']:.2f}", f"{1e9 * (rigid['rigid'] - row['rigid']):.2f}",
                f"{row['dry_pressure'] / row['hertz']:.3f}", f"{row['dry_area']:.4f}", f"{row['pressure_max'] / row['hertz']:.3f}", f"{row['contact_load_ratio']:.3f}",
                f"{row['contact_area_ratio']:.4f}", f"{1e9 * row['h_c']:.2f}", f"{row['cost'] / rigid['cost']:.2f}",
            )  # fmt: skip
        page.verdict(
            f"{name}: marches under elastic films converge",
            f"{sum(row['lost'] for row in rows.values()):.0f} instants do not",
            not any(row["lost"] for row in rows.values()),
        )
    page.write()


if __name__ == "__main__":
    main()
