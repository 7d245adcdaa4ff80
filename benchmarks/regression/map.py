"""Methods for the maps of `film.model = "map"`, on knots solved for them: held-back deviations, half widths, cost.

    tribofmu map mtm_zddp --out results/regression/map/mtm_zddp --accuracy '1 %' --time 10h
    tribofmu map mtm_zddp --out results/regression/map/coarse --accuracy '1 %' --time 15min \\
        --set film.points=33 surface_1.correlation_length='32 um' surface_2.correlation_length='32 um'
    python -m benchmarks.regression.map  # minutes: docs/measured/regression/map.md

The second one has blocks of half a second, which tell methods apart that few knots cannot. SMT (pip install smt) is
compared if it is installed.
"""

import math
import warnings
from collections.abc import Callable
from dataclasses import replace
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np

from benchmarks.folders import RESULTS
from benchmarks.pages import Page
from contact_core import Scene, deterministic, initial_state
from contact_core.correction import Knots, Place, conditioned
from contact_core.mapped import fitting
from contact_core.mapped.fitting import COVERED, FEWEST, Rule, Samples, fitted, predicted, spread_at, widths_at
from contact_core.mapped.knot import Knot, samples_of
from contact_core.mapped.map import COORDINATES, digest_of
from contact_core.scene import Case
from system_models.run.map_build import Judged, Order, fit_knots, held_knots, judged, read, scene_of_knots
from system_models.run.map_ranges import Ranges

STORE = RESULTS / "regression" / "map"
COARSE = {"film.points": "33", "surface_1.correlation_length": "32 um", "surface_2.correlation_length": "32 um"}
SETS: dict[str, tuple[str, dict[str, str], str]] = {  # scene, changes, words
    "mtm_zddp": ("mtm_zddp", {}, "mtm_zddp as shipped, 129 nodes"),
    "coarse": ("mtm_zddp", COARSE, "mtm_zddp on 33 nodes, correlation lengths of 32 um"),
}
NAMES = ("friction", "h_c", "W_c")
COUNTS = (30, 60, 120, 240, 480)
PARTS = 10  # of the knots, each left out in turn, for half widths
WIDE = 1.96  # standard deviations in a half width
REPEATED, TIMES = 10, 6  # knots that are solved again from other places of the patches, and how often
PLACE = tuple(range(len(Place._fields)))  # coordinates of `correction.Place`
ALL = tuple(range(len(COORDINATES)))

Array = np.ndarray
Predict = Callable[[Samples], tuple[Array, Array]]  # deviations, and widths up to a factor, [contacts, outputs]


class Data(NamedTuple):
    """Knots of a scene."""

    order: Order
    knots: tuple[Knot, ...]
    samples: Samples  # that methods are fitted to
    held: Samples  # that judge
    errors: Array  # half widths that the held-back blocks state


class Method(NamedTuple):
    """A method by name, and how it makes predictions of samples."""

    name: str
    of: Callable[[Samples], Predict]
    cost: Callable[[int], str]  # of a query, by the number of knots


def data(name: str) -> Data | None:
    """Return the knots that are kept under a name."""
    scene = Scene.from_toml(*SETS[name][:2])
    order, file = Order(scene, Ranges.of(scene, {}), 0.01, 0.0), STORE / name / "knots.jsonl"
    if not file.exists():
        return None
    found = read(order, file)
    knots = tuple(found[number] for number in sorted(found))
    held = held_knots(knots)
    if len(fit_knots(knots)) < FEWEST:
        return None
    exact = scene_of_knots(scene)
    return Data(
        order, knots, samples_of(exact, fit_knots(knots)), samples_of(exact, held), np.array([k.errors for k in held])
    )


def as_it_is(samples: Samples) -> Predict:
    """The regression level."""
    return lambda held: (np.zeros_like(held.off), np.ones_like(held.off))


def polynomial(rule: Rule, chosen: tuple[int, ...] = ALL) -> Callable[[Samples], Predict]:
    """Polynomials of a rule in some coordinates."""

    def of(samples: Samples) -> Predict:
        chart = fitting.polynomials(_only(samples, chosen), "", "", (), rule)

        def at(held: Samples) -> tuple[Array, Array]:
            few = _only(held, chosen)
            return predicted(chart, few), np.repeat(spread_at(chart, few.places)[:, None], 3, axis=1)

        return at

    return of


def _only(samples: Samples, chosen: tuple[int, ...]) -> Samples:
    """Return samples whose other coordinates do not change: a map leaves them out."""
    places = np.zeros_like(samples.places)
    places[:, chosen] = samples.places[:, chosen]
    return samples._replace(places=places)


def kriging(samples: Samples) -> Predict:
    """That of the level auto, with its constants, in the coordinates of `Place`; deviations over their rms."""
    scale = np.sqrt((samples.off**2).mean(0))
    none = np.full(len(samples.shares), "", object)
    given = Knots(none, samples.places[:, PLACE], samples.off / scale, samples.scatter / scale)

    def at(held: Samples) -> tuple[Array, Array]:
        found = conditioned(given, np.full(len(held.shares), "", object), held.places[:, PLACE])
        return found.mean * scale, np.maximum(found.left, 1e-3) * scale

    return at


def toolbox(kind: str) -> Callable[[Samples], Predict]:
    """Kriging of the Surrogate Modeling Toolbox, with its correlation lengths and noise by likelihood."""

    def of(samples: Samples) -> Predict:
        import smt.surrogate_models as models

        low, high = samples.places.min(0), samples.places.max(0)
        used = high > low + 1e-9
        scaled = (samples.places[:, used] - low[used]) / (high - low)[used]
        made = []
        for k in range(3):
            model = getattr(models, kind)(
                print_global=False,
                eval_noise=True,
                hyper_opt="Cobyla",
                n_start=1,
                **({"n_comp": 4} if kind == "KPLS" else {}),
            )
            model.set_training_values(scaled, samples.off[:, k : k + 1])
            model.train()
            made.append(model)

        def at(held: Samples) -> tuple[Array, Array]:
            here = (held.places[:, used] - low[used]) / (high - low)[used]
            mean = np.hstack([model.predict_values(here) for model in made])
            return mean, np.sqrt(np.maximum(np.hstack([model.predict_variances(here) for model in made]), 1e-8))

        return at

    return of


def methods() -> list[Method]:
    """Return the methods that are compared."""
    size = len(COORDINATES)

    def whole(degree: int) -> Method:
        terms = math.comb(size + degree, degree)
        rule = Rule(degree=degree, sparse=False)
        return Method(
            f"all terms of degree {degree}", polynomial(rule), lambda n: f"{terms * (terms + 1) // 2 + 5 * terms}"
        )

    def sparse(degree: int, most: int, text: str = "", chosen: tuple[int, ...] = ALL) -> Method:
        return Method(
            f"at most {most} terms, degree {degree}{text}",
            polynomial(Rule(degree=degree, most=most), chosen),
            lambda n: f"{most * (most + 1) // 2 + 5 * most}",
        )

    found = [
        Method("regression level", as_it_is, lambda n: "0"),
        Method("kriging as in auto", kriging, lambda n: f"{3 * (6 * n + n * n):,}"),
        whole(1),
        whole(2),
        whole(3),
        sparse(2, 40),
        sparse(3, 20),
        sparse(3, 40),
        sparse(3, 40, ", place of auto alone", PLACE),
        sparse(3, 40, ", without tribofilms", tuple(k for k in ALL if not COORDINATES[k].startswith("raised"))),
        sparse(4, 40),
    ]
    if find_spec("smt") is None:
        return found
    per_query = lambda n: f"{3 * ((size + 1) * n + n * n):,}"  # noqa: E731
    return [*found, Method("SMT, KRG", toolbox("KRG"), per_query), Method("SMT, KPLS", toolbox("KPLS"), per_query)]


def compared(page: Page, found: Data) -> None:
    """Add the table of methods."""
    page.header(
        "method", "cost", *(f"{name}: {text}" for name in NAMES for text in ("rms", "half width", "inside", "largest"))
    )
    count = len(found.samples.shares)
    for method in methods():
        terms = math.comb(len(COORDINATES) + 3, 3)
        if method.name == "all terms of degree 3" and terms > 0.7 * count:
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            needed = np.empty_like(found.samples.off)
            parts = 3 if method.name.startswith("SMT") else PARTS
            for part in range(parts):
                out = np.arange(count) % parts == part
                off, wide = method.of(found.samples.some(~out))(found.samples.some(out))
                gone = found.samples.off[out] - off
                needed[out] = np.sqrt(np.maximum(gone**2 - found.samples.scatter[out] ** 2, 0.0)) / wide
            factor = np.quantile(needed, COVERED, axis=0)
            off, wide = method.of(found.samples)(found.held)
        gone, half = found.held.off - off, wide * factor
        stated = np.hypot(half, found.errors)
        cells = [
            [
                f"{100.0 * np.sqrt(np.mean(gone[:, k] ** 2)):.1f}",
                f"{100.0 * np.median(half[:, k]):.1f}",
                f"{100.0 * np.mean(np.abs(gone[:, k]) <= stated[:, k]):.0f}",
                f"{np.max(np.abs(gone[:, k]) / stated[:, k]):.2f}",
            ]
            for k in range(3)
        ]
        page.row(method.name, method.cost(count), *(text for row in cells for text in row))


def by_count(page: Page, found: Data) -> None:
    """Add what a map of fewer knots is worth."""
    page.say("Maps of fewer knots, judged by the same held-back ones:")
    page.header("knots", "terms", *(f"{name}: {text}" for name in NAMES for text in ("rms", "half width", "inside")))
    whole = len(found.samples.shares)
    for count in (*(n for n in COUNTS if n < whole), whole):
        few = found.samples.some(np.arange(whole) < count)
        chart = fitted(few, "", "", (), Rule())
        off, half = found.held.off - predicted(chart, found.held), widths_at(chart, found.held.places)
        stated = np.hypot(half, found.errors)
        cells = [
            [
                f"{100.0 * np.sqrt(np.mean(off[:, k] ** 2)):.1f}",
                f"{100.0 * np.median(half[:, k]):.1f}",
                f"{100.0 * np.mean(np.abs(off[:, k]) <= stated[:, k]):.0f}",
            ]
            for k in range(3)
        ]
        page.row(count, 1 + len(chart.term), *(text for row in cells for text in row))


def scatter(page: Page, found: Data) -> Array:
    """Add what the same contacts give from other places of the patches; return the standard deviations."""
    scene = scene_of_knots(found.order.scene)
    deep, draw, all_of = scene.at_level("deterministic"), np.random.Generator(np.random.Philox(key=[3, 1])), []
    usable = fit_knots(found.knots)
    for knot in usable[:: max(len(usable) // REPEATED, 1)][:REPEATED]:
        values = []
        for _ in range(TIMES):
            state = replace(initial_state(scene), means=knot.means)
            bodies = tuple(replace(body, offset=float(draw.random()) * deep.film.domain) for body in state.bodies)
            out = deterministic.advance(Case.bind(deep, knot.point), replace(state, bodies=bodies), 0.0)[1]
            values.append((math.log(out.friction_coefficient), math.log(out.h_c), out.contact_load_ratio))
        all_of.append(np.var(values, axis=0, ddof=1))
    noise = np.sqrt(np.mean(all_of, axis=0))
    page.say(
        f"Scatter of a block: {REPEATED} of these contacts, each solved {TIMES} times from other places of the patches, have "
        f"standard deviations of {100 * noise[0]:.1f} % in friction, {100 * noise[1]:.1f} % in h_c and {100 * noise[2]:.1f} % in W_c (rms). "
        "What is left of the held-back deviations beyond that is the map's."
    )
    return noise


def map_of(page: Page, name: str, found: Data) -> Judged:
    """Add the map that `tribofmu map` makes of the knots."""
    scene, order = found.order.scene, found.order
    chart = fitted(found.samples, scene.name, digest_of(scene), order.ranges.rows, Rule())
    judge = judged(order, chart, found.knots)
    assert judge is not None
    page.say(
        f"The map of `tribofmu map`: {1 + len(chart.term)} terms, {chart.cost} multiplications and additions a query, "
        f"{len(chart.to_text()) / 1024:.0f} kB. Half widths that differ from place to place:"
    )
    page.header(
        "output",
        "off before, rms",
        "off, rms",
        "half width of the map, median",
        "inside it",
        "inside it and the block's",
        "largest over both",
        "inside a tenth of both",
    )
    medians = np.median(widths_at(chart, found.samples.places), axis=0)
    for k, output in enumerate(NAMES):
        off, alone, both = np.abs(judge.off[:, k]), judge.of_map[:, k], judge.stated[:, k]
        page.row(
            output, f"{100.0 * np.sqrt(np.mean(judge.raw[:, k] ** 2)):.1f} %", f"{100.0 * np.sqrt(np.mean(off**2)):.1f} %",
            f"{100.0 * medians[k]:.1f} %", f"{np.mean(off <= alone):.0%}", f"{np.mean(off <= both):.0%}", f"{np.max(off / both):.2f}", f"{np.mean(off <= 0.1 * both):.0%}",
        )  # fmt: skip
    if name == "coarse":
        page.verdict(
            "held-back knots within the stated error",
            f"{np.min(np.mean(np.abs(judge.off) <= judge.stated, axis=0)):.0%}, at least 95 %",
            bool(np.all(np.mean(np.abs(judge.off) <= judge.stated, axis=0) >= 0.95)),
        )
        page.verdict(
            "none above three times of it",
            f"{np.max(np.abs(judge.off) / judge.stated):.2f}",
            bool(np.all(np.abs(judge.off) <= 3.0 * judge.stated)),
        )
        page.verdict(
            "median half width of friction and h_c at most 5 %",
            f"{100 * medians[0]:.1f} %, {100 * medians[1]:.1f} %",
            bool(max(medians[:2]) <= 0.05),
        )
        page.verdict("a query costs at most 1500 multiplications and additions", f"{chart.cost}", chart.cost <= 1500)
    return judge


def main() -> None:
    """Compare, and write the page."""
    page = Page("regression/map", "Maps of what the regression level deviates by")
    page.say(
        "Knots: deterministic blocks at random operating points (load 0.2 to 2 times, entrainment 0.1 to 3 times, slide-roll ratio 0.1 to 10 "
        "times that of the scene, both directions, 25 K either way) on surfaces that the regression level has rubbed for up to two hours at another one. "
        "Every fifth is held back. All in per cent: friction and h_c relative, W_c absolute. Half width: 95 %, median, beyond the scatter that a block states, by "
        "knots left out. Inside: held-back knots within half width and the block's own error together; largest: deviation over that. Cost: multiplications and additions of a query."
    )
    for name in SETS:
        found = data(name)
        if found is None:
            print(f"Not enough knots in {STORE / name}: see the commands above.")
            continue
        refused = sum(not knot.counts for knot in found.knots)
        page.say(
            f"**{SETS[name][2]}**: {len(found.samples.shares)} knots, {len(found.held.shares)} held back, {refused} that did not converge left out. "
            f"The blocks state errors of {', '.join(f'{100 * x:.0f} %' for x in np.median(found.errors, axis=0))} (median)."
        )
        compared(page, found)
        map_of(page, name, found)
        by_count(page, found)
        if name == "coarse":  # blocks of the other one take half a minute
            scatter(page, found)
    page.write()


if __name__ == "__main__":
    main()
