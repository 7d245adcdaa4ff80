"""Central films on domains that cut the inlet off, against longer ones with the same distance of the nodes.

    python -m benchmarks.film.inlet [--report]

Smooth bodies over Hamrock's and Dowson's U, G, W: circles, ellipses and lines, of steel and of rubber; smooth bodies of
shipped scenes; domains that an accuracy chooses. Writes docs/measured/film.md in some ten minutes; `--report`
from what results/film/inlet.json holds.
"""

import argparse
import json
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.claims import kept
from benchmarks.film.flux_films import Film, film
from benchmarks.film.inlet_contacts import Contact, contacts
from benchmarks.pages import Page
from benchmarks.timing import timed
from contact_core import ContactError, Scene
from contact_core.deterministic.instant import instant_of
from contact_core.scene import Case
from contact_core.scene.hertz_grid import HALF_WIDTHS, room_for_hertz, with_values

CHOSEN = 0.5 * HALF_WIDTHS  # half widths before the centre, by Hertz's contact alone
INLETS = (0.4, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0)  # before Hertz's contact
LONG = {False: 14.0, True: 60.0}  # inlets that stand for all, of points and of lines
COUNTED = 1e-3  # losses below it are left out of the verdicts: solutions stop early
IN_SCENES = 5e-3  # the same of scenes, whose longer domains are wider, too
SCENES = ("ball_209_inner", "dimple_rolling", "fzg_flank", "cam_tappet", "azam_case_a")
LONGER = (1, 2, 4)
BALL: dict[str, Any] = {  # of twenty lines, at the speeds below
    "name": "ball",
    "geometry": {"radius_x": "10 mm"},
    "solids": {"set": "steel"},
    "surface_1": {"rq": "0 nm"},
    "surface_2": {"rq": "0 nm"},
    "lubricant": {"viscosity": {"viscosity_40": "46 mm2/s", "viscosity_100": "6.8 mm2/s", "density": "870 kg/m3"}},
}
LINE = {"model": "line", "radius_x": "10 mm", "face_width": "8 mm"}
DUTIES = ((False, "50 N", 1), (False, "50 N", 10), (False, "5 N", 10), (True, "500 N", 2), (True, "500 N", 10))
ACCURACY = "10 %"


def measured(contact: Contact) -> dict[str, Any]:
    """Return the losses of a contact on domains of all lengths: a record."""
    a, b = contact.half_widths
    inlet, step = contact.inlet, contact.step
    beside, behind = max(CHOSEN * b, contact.beside), max(CHOSEN * a, 1.3 * a + inlet)
    whole = contact.film(a + LONG[contact.line] * inlet, behind, beside)

    def lost(before: float, behind: float, beside: float) -> float:
        return 1.0 - contact.film(before, behind, beside) / whole

    edges = [max(round((a + inlets * inlet) / step), round(a / step) + 1) * step for inlets in INLETS]
    return asdict(contact) | {
        "film": whole,
        "chosen": [lost(k * CHOSEN * a, CHOSEN * a, CHOSEN * b) for k in LONGER],
        "cut": [(before, lost(before, behind, beside)) for before in edges],
    }


def scene_film(scene: Scene) -> tuple[float, float]:
    """Return the central film [m] of the smooth bodies of a scene on its grid, nan without one, and CPU time [s]."""
    case = Case.bind(scene, scene.operation.point)
    grid = scene.grid(scene.rows)
    bare = instant_of(case, np.zeros(grid.shape), np.full(grid.shape, 1e11))

    def task() -> Film | None:
        with suppress(ContactError):
            return film(replace(bare, hardness=1e11, microroughness=None), grid, "fitted")
        return None

    found, seconds = timed(task)
    return found.central if found is not None and found.converged else float("nan"), seconds


def longer(scene: Scene, factor: int) -> Scene:
    """Return a scene on a grid so many times as long along x, with the same distance of the nodes."""
    values = {"film.domain": factor * scene.film.domain, "film.points": factor * (scene.film.points - 1) + 1}
    return with_values(scene, values)


def shipped(name: str) -> dict[str, Any]:
    """Return the loss on the domain of a shipped scene: a record."""
    scene = Scene.from_toml(name)
    films = [scene_film(longer(scene, factor))[0] for factor in LONGER]
    stated = Case.bind(scene, scene.operation.point).missing_film
    return {"name": name, "lost": films[2] / films[0] - 1.0, "left": films[2] / films[1] - 1.0, "stated": stated}


def asked(line: bool, load: str, speed: int) -> dict[str, Any]:
    """Return what an accuracy chooses for a scene, and on Hertz's contact alone with the same distance: a record."""
    operation = {"load": load, "speed_1": f"{speed} m/s", "speed_2": f"{speed} m/s", "temperature": "40 degC"}
    table = BALL | {"operation": operation, "control": {"accuracy": ACCURACY}} | ({"geometry": LINE} if line else {})
    scene = Scene.from_dict(table)
    room = room_for_hertz(scene)
    short = with_values(scene, {"film.domain": room, "film.points": max(round(room / scene.film.spacing), 16) + 1})
    long = scene_film(longer(scene, 2))[0]
    found = [scene_film(each) for each in (short, scene)]
    case = Case.bind(scene, scene.operation.point)
    return {
        "name": f"{'line' if line else 'ball'}, {load}, {speed} m/s",
        "half_widths": [each.film.domain / case.hertz.a for each in (short, scene)],
        "points": [each.film.points for each in (short, scene)],
        "lost": [1.0 - each / long for each, _ in found],
        "seconds": [seconds for _, seconds in found],
    }


def report(kept: dict[str, Any]) -> None:
    """Write the page."""
    page = Page("film/inlet", "Domains that cut the inlet off")
    names = Contact.__dataclass_fields__
    records = [(Contact(**{name: one[name] for name in names}), one) for one in kept["contacts"]]
    pairs = []
    for contact, one in records:
        for before, lost in one["cut"]:
            if np.isfinite(lost) and lost > COUNTED:
                pairs.append((lost / (1.0 - lost), contact.stated(before)))
    true, stated = np.array(pairs).T
    covered, tenth = float((true <= stated).mean()), float((true <= 0.1 * stated).mean())
    page.verdict("stated losses cover the true ones in 90 to 100 %", f"{covered:.1%} of {len(pairs)}", covered >= 0.9)
    page.verdict("a tenth of them would not: below 50 %", f"{tenth:.1%}", tenth < 0.5)
    ratio = float(np.median(stated / true))
    page.verdict("stated over true at most 3 in the median", f"{ratio:.2f}", ratio <= 3.0)
    counted = [one for one in kept["scenes"] if one["lost"] > IN_SCENES]
    covers = sum(one["lost"] <= one["stated"] for one in counted)
    page.verdict(
        f"losses of shipped scenes above {IN_SCENES:.1%} are covered",
        f"{covers} of {len(counted)}",
        covers == len(counted),
    )
    most = max(one["lost"][1] for one in kept["asked"])
    page.verdict(f"at most 2.5 % is missing on domains chosen for {ACCURACY}", f"{most:.2%}", most <= 0.025)
    page.say(
        "Smooth bodies, isothermal, R_x = 10 mm, u_e = 1 m/s; U, G, W on R_x and E' (230 GPa, or 10 MPa for G = 0.2). Loss: of "
        f"h_central against a domain with {LONG[False]:g} lengths d of the inlet before Hertz's contact ({LONG[True]:g} of lines), all with "
        "the same distance of the nodes; d is where Hertz's gap equals the film of the formula (contact_core/film/lengths.py)."
    )
    page.say(
        f"### On {HALF_WIDTHS:.3g} half widths, and on twice and four times as much upstream\n\nHalf of it lies before the centre, as much behind and "
        "to either side. Loss in %; a dash: no solution."
    )
    page.header("contact", "d / a", "edge before Hertz's contact, in d", *(f"x {k}" for k in LONGER))
    for contact, one in records:
        a, d = contact.half_widths[0], contact.inlet
        page.row(contact, d / a, (CHOSEN - 1.0) * a / d, *map(percent, one["chosen"]))
    page.say(
        "### By lengths of the inlet\n\nLoss in % with so many d before Hertz's contact, and room behind and beside. Below "
        "each group what `inlet_loss` states, over the flooded film; M < 30: points whose pressure goes on beyond the edge."
    )
    page.header("contact", *(f"{inlets:g} d" for inlets in INLETS))
    for contact, one in records:
        page.row(contact, *(percent(lost) for _, lost in one["cut"]))
    for contact in (
        records[1][0],
        next(c for c, _ in records if c.smooth.circular_load < 30.0 and not c.line),
        records[-4][0],
    ):
        kind = "a line" if contact.line else "a light point" if contact.smooth.circular_load < 30.0 else "a point"
        a, d = contact.half_widths[0], contact.inlet
        law = [contact.stated(a + inlets * d) for inlets in INLETS]
        page.row(f"*stated of {kind}*", *(percent(each / (1.0 + each)) for each in law))
    page.say(
        "### Beside starvation by Hamrock and Dowson\n\n1 - [(m - 1) / (m* - 1)]^0.29, m* = 1 + 3.06 [(R/a)^2 H]^0.58, with the edge "
        "as meniscus, over the measured loss; points of steel with M > 30."
    )
    page.header("contact", *(f"{inlets:g} d" for inlets in INLETS))
    for contact, one in records:
        if not contact.line and contact.material > 1.0 and contact.smooth.circular_load > 30.0:
            page.row(
                contact, *(f"{contact.starved(x) / lost:.2f}" if lost > COUNTED else "–" for x, lost in one["cut"])
            )
    page.say(
        "### Smooth bodies of shipped scenes\n\nTrue: against four times the domain along x, over the film that is found; "
        "twice: the same on twice the domain. In %."
    )
    page.header("scene", "true", "stated", "twice")
    for one in kept["scenes"]:
        page.row(one["name"], percent(one["lost"]), percent(one["stated"]), percent(one["left"]))
    page.say(
        f"### Domains chosen for {ACCURACY}\n\nSmooth bodies in an oil of ISO VG 46 at 40 °C, control.accuracy = {ACCURACY}, no grid given. "
        f"Before: {HALF_WIDTHS:.3g} half widths with the same distance of the nodes. CPU time is that of one cold film."
    )
    page.header("contact", "half widths", "before", "points", "before", "loss [%]", "before", "CPU [s]", "before")
    for one in kept["asked"]:
        both = (one["half_widths"], one["points"], list(map(percent, one["lost"])), one["seconds"])
        page.row(one["name"], *(value for old, new in both for value in (new, old)))
    page.write()


def percent(loss: float) -> str:
    """Return a loss as text."""
    return f"{100.0 * loss:.2f}" if np.isfinite(loss) else "–"


def _file() -> Path:
    return kept("film/inlet") / "found.json"


def main() -> None:
    """Measure, unless told otherwise, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--report", action="store_true", help="write the page from what is kept")
    if not parser.parse_args().report:
        found: dict[str, Any] = {"contacts": []}
        for contact in contacts():
            found["contacts"].append(measured(contact))
            print(contact, [f"{lost:.4f}" for _, lost in found["contacts"][-1]["cut"]], flush=True)
        found |= {"scenes": [shipped(name) for name in SCENES], "asked": [asked(*duty) for duty in DUTIES]}
        _file().write_text(json.dumps(found))
    report(json.loads(_file().read_text()))


if __name__ == "__main__":
    main()
