"""Maps of `film.model = "map"`: methods, held-back histories, and runs of hours beside the deterministic level.

    tribofmu map mtm_zddp --out results/regression/map/mtm_zddp --accuracy '1 %' --time 2h --processes 2
    tribofmu map mtm_zddp --out results/regression/map/coarse --accuracy '1 %' --time 15min \\
        --set film.points=33 surface_1.correlation_length='32 um' surface_2.correlation_length='32 um'
    python -m benchmarks.regression.map  # minutes: docs/measured/regression/map.md

The second one has histories of a few seconds, which tell methods apart that few cannot. SMT (pip install smt) is
compared if it is installed.
"""

import math
import warnings
from collections.abc import Callable
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np

from benchmarks.folders import RESULTS
from benchmarks.pages import Page
from benchmarks.regression.map_runs import NAMES, along_runs, near_rolling
from contact_core import Scene
from contact_core.corrections import fitting
from contact_core.corrections.fitting import (
    COVERED,
    Rule,
    Samples,
    TooFewError,
    fitted,
    predicted,
    spread_at,
    widths_at,
)
from contact_core.corrections.knot import History, samples_of
from contact_core.corrections.kriging import Knots, Place, conditioned
from contact_core.corrections.map import COORDINATES, Map, digest_of
from system_models.run.map_build import (
    Judged,
    Order,
    fit_histories,
    is_held,
    judged,
    read,
    scene_of_histories,
    tasks,
)
from system_models.run.map_ranges import Ranges

STORE = RESULTS / "regression" / "map"
COARSE = {"film.points": "33", "surface_1.correlation_length": "32 um", "surface_2.correlation_length": "32 um"}
SETS: dict[str, tuple[str, dict[str, str], str]] = {  # scene, changes, words
    "mtm_zddp": ("mtm_zddp", {}, "mtm_zddp as shipped, 129 nodes"),
    "coarse": ("mtm_zddp", COARSE, "mtm_zddp on 33 nodes, correlation lengths of 32 um"),
}
COUNTS = (10, 20, 40, 80)
PARTS = 10  # of the histories, each left out in turn, for half widths
PLACE = tuple(range(len(Place._fields)))  # coordinates of `correction.Place`
ALL = tuple(range(len(COORDINATES)))

Array = np.ndarray
Predict = Callable[[Samples], tuple[Array, Array]]  # deviations, and widths up to a factor, [contacts, outputs]


class Data(NamedTuple):
    """Histories of a scene."""

    order: Order
    histories: tuple[History, ...]
    samples: Samples  # that methods are fitted to
    held: Samples  # that judge


class Method(NamedTuple):
    """A method by name, and how it makes predictions of samples."""

    name: str
    of: Callable[[Samples], Predict]
    cost: Callable[[int], str]  # of a query, by the number of knots


def data(name: str) -> Data | None:
    """Return the histories that are kept under a name; None for too few."""
    scene = Scene.from_toml(*SETS[name][:2])
    order, file = Order(scene, Ranges.of(scene, {}), 0.01, 0.0), STORE / name / "histories.jsonl"
    if not file.exists():
        return None
    known = read(order, file)
    found = tuple(known[task] for task in tasks(order) if task in known) if known else ()
    held = [history for history in found if history.fine and is_held(order, history.number)]
    exact = scene_of_histories(scene)
    try:
        return Data(order, found, samples_of(exact, fit_histories(order, found)), samples_of(exact, held))
    except TooFewError:
        return None


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
            numbers = np.searchsorted(np.unique(found.samples.history), found.samples.history)
            for part in range(parts):
                out = numbers % parts == part
                off, wide = method.of(found.samples.some(~out))(found.samples.some(out))
                gone = found.samples.off[out] - off
                needed[out] = np.sqrt(np.maximum(gone**2 - found.samples.scatter[out] ** 2, 0.0)) / wide
            factor = np.quantile(needed, COVERED, axis=0)
            off, wide = method.of(found.samples)(found.held)
        gone, half = found.held.off - off, wide * factor
        stated = np.hypot(half, found.held.stated)
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
    """Add what a map of fewer histories is worth."""
    page.say("Maps of fewer histories, judged by the same held-back ones:")
    page.header(
        "histories",
        "knots",
        "terms",
        *(f"{name}: {text}" for name in NAMES for text in ("rms", "half width", "inside")),
    )
    numbers = np.unique(found.samples.history)
    for count in (*(n for n in COUNTS if n < len(numbers)), len(numbers)):
        few = found.samples.some(np.isin(found.samples.history, numbers[:count]))
        chart = fitted(few, "", "", (), Rule())
        off, half = found.held.off - predicted(chart, found.held), widths_at(chart, found.held.places)
        stated = np.hypot(half, found.held.stated)
        cells = [
            [
                f"{100.0 * np.sqrt(np.mean(off[:, k] ** 2)):.1f}",
                f"{100.0 * np.median(half[:, k]):.1f}",
                f"{100.0 * np.mean(np.abs(off[:, k]) <= stated[:, k]):.0f}",
            ]
            for k in range(3)
        ]
        page.row(count, len(few.shares), 1 + len(chart.term), *(text for row in cells for text in row))


def map_of(page: Page, name: str, found: Data) -> tuple[Map, Judged]:
    """Add the map that `tribofmu map` makes of the histories."""
    scene, order = found.order.scene, found.order
    chart = fitted(found.samples, scene.name, digest_of(scene), order.ranges.rows, Rule())
    judge = judged(order, chart, found.histories)
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
    places = found.samples.places[found.samples.fine > 0.0]
    medians = np.median(widths_at(chart, places), axis=0)
    for k, output in enumerate(NAMES):
        off, alone, both = np.abs(judge.off[:, k]), judge.of_map[:, k], judge.stated[:, k]
        page.row(
            output, f"{100.0 * np.sqrt(np.mean(judge.raw[:, k] ** 2)):.1f} %", f"{100.0 * np.sqrt(np.mean(off**2)):.1f} %",
            f"{100.0 * medians[k]:.1f} %", f"{np.mean(off <= alone):.0%}", f"{np.mean(off <= both):.0%}", f"{np.max(off / both):.2f}", f"{np.mean(off <= 0.1 * both):.0%}",
        )  # fmt: skip
    page.verdict(
        f"{name}: held-back knots within the stated error",
        f"{np.min(np.mean(np.abs(judge.off) <= judge.stated, axis=0)):.0%} of {len(judge.off)}, at least 95 %",
        bool(np.all(np.mean(np.abs(judge.off) <= judge.stated, axis=0) >= 0.95)),
    )
    page.verdict(
        f"{name}: none above three times of it",
        f"{np.max(np.abs(judge.off) / judge.stated):.2f}",
        bool(np.all(np.abs(judge.off) <= 3.0 * judge.stated)),
    )
    page.verdict(
        f"{name}: median half width of friction and h_c at most 5 %",
        f"{100 * medians[0]:.1f} %, {100 * medians[1]:.1f} %",
        bool(max(medians[:2]) <= 0.05),
    )
    page.verdict(
        f"{name}: a query costs at most 1500 multiplications and additions", f"{chart.cost}", chart.cost <= 1500
    )
    return chart, judge


def main() -> None:
    """Compare, and write the page."""
    page = Page("regression/map", "Maps of what the regression level deviates by")
    page.say(
        "A history rubs for two hours at one random operating point (load 0.5 to 1.5 times, entrainment 0.3 to 3 times, slide-roll ratio 0.2 to 5 times that of the scene, "
        "both directions, 15 K either way), at the deterministic level and beside it at the regression level, and looks at four others on its way. A knot is what the one finds "
        "while the other believes the surfaces to be so. Some histories are held back whole. All in per cent: friction and h_c relative, W_c absolute. Half width: 95 %, median, "
        "beyond the scatter that a block states, by histories left out. Inside: held-back knots within half width and the block's own error together; largest: deviation over that. "
        "Cost: multiplications and additions of a query."
    )
    for name, (_, _, words) in SETS.items():
        found = data(name)
        if found is None:
            print(f"Not enough histories in {STORE / name}: see the commands above.")
            continue
        knots = [knot for history in found.histories for knot in history.knots]
        fine = sum(history.fine for history in found.histories)
        page.say(
            f"**{words}**: {len(found.histories)} histories, {fine} of them on the scene's grid; {len(found.samples.shares)} knots fitted, {len(found.held.shares)} held back, "
            f"{sum(not knot.counts for knot in knots)} of {len(knots)} that did not converge left out. "
            f"The held-back blocks state errors of {', '.join(f'{100 * x:.0f} %' for x in np.median(found.held.stated, axis=0))} (median)."
        )
        if len(set(found.samples.fine)) == 1:  # methods know nothing of two grids
            compared(page, found)
        chart, _ = map_of(page, name, found)
        along_runs(page, name, found.order, found.histories, chart)
        if len(set(found.samples.fine)) == 1:
            by_count(page, found)
            near_rolling(page, found.order.scene)
    page.write()


if __name__ == "__main__":
    main()
