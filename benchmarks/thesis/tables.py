"""Tables beside the claims: balances, scatter of the surfaces, with and without tribofilm, smooth limit."""

from collections.abc import Callable, Iterator

import numpy as np

from benchmarks.pages import cells
from benchmarks.thesis.cases import CASES, INTERVAL, NUMERICS, SEEDS, Book, Missing, Run
from benchmarks.thesis.rows import crossing_text, crossover, formula_contact, nm, peak, time_above, two_hours
from contact_core import Scene
from contact_core.reference import hamrock_dowson, nijenbanning_venner_moes

Lines = list[str]
BALANCES = (
    "run",
    "depth ball / disc",
    "load cycles ball, disc",
    "ratio of cycles",
    "ratio of track lengths",
    "V less ∫ dV/dt, relative",
    "V / Archard's K W u_s ∫ W_c dt / H",
    "film less (grown - removed), relative",
)
PAIRS = (("A", "A_bare"), ("B", "B_bare"))


def table(*names: str) -> Lines:
    """Begin a table."""
    return [cells(names), "|" + "---|" * len(names)]


def balances(book: Book) -> Lines:
    """Return the balances."""
    lines = table(*BALANCES)
    for name, numerics in ((name, kind) for pair in PAIRS for name in pair for kind in NUMERICS):
        try:
            run = book.get(name, numerics)
        except Missing as missing:
            lines.append(cells((f"{name}, {numerics}", str(missing), *[""] * 6)))
            continue
        scene = CASES[name].in_numerics(numerics, book.trial)
        cycles = [run.end(f"load_cycles_{i}") for i in (1, 2)]
        bare, by_sliding = "bare" in name, scene.wear.of_sliding
        found = (
            run.end("wear_depth_1") / run.end("wear_depth_2"),
            f"{cycles[0]:.0f}, {cycles[1]:.0f}",
            cycles[0] / cycles[1],
            scene.geometry.track_length_2 / scene.geometry.track_length_1,
            f"{max(_volume_error(run, i) for i in (1, 2)):.1e}",
            _archard(run, scene) if bare and by_sliding else "—",
            "—" if bare else f"{max(_film_error(run, i) for i in (1, 2)):.1e}",
        )
        lines.append(cells((f"{name}, {numerics}", *found)))
    return lines


def _volume_error(run: Run, i: int) -> float:
    total = float(run[f"wear_rate_{i}"][1:].sum()) * INTERVAL
    return abs(total / run.end(f"wear_volume_{i}") - 1.0)


def _film_error(run: Run, i: int) -> float:
    return abs(run.end(f"film_{i}") - run.end(f"grown_{i}") + run.end(f"removed_{i}")) / run.end(f"grown_{i}")


def _archard(run: Run, scene: Scene) -> float:
    """Volume of the ball against the law's, whose solid load comes from the filtered outputs."""
    slide = abs(scene.operation.point.sliding_speed)
    share = run["contact_load_ratio"]
    worked = float(((share[1:] + share[:-1]) / 2.0).sum()) * INTERVAL * scene.operation.load * slide
    return run.end("wear_volume_1") * scene.plasticity.hardness / (scene.wear.bare * worked)


# quantity, unit, its value in a run, the output whose own error estimate belongs to it
Main = tuple[str, float, Callable[[Run], float], str]


def _end(name: str) -> Callable[[Run], float]:
    return lambda run: run.end(name)


MAIN: tuple[Main, ...] = (
    ("h_c start [nm]", 1e9, lambda run: float(run["h_c"][0]), ""),
    ("h_c peak [min]", 1.0, lambda run: peak(run, "h_c")[0], ""),
    ("h_c peak [nm]", 1e9, lambda run: peak(run, "h_c")[1], ""),
    ("h_c end [nm]", 1e9, _end("h_c"), "h_c"),
    ("λ end", 1.0, _end("lambda_ratio"), "lambda_ratio"),
    ("W_c start", 1.0, lambda run: float(run["contact_load_ratio"][0]), ""),
    ("W_c max", 1.0, lambda run: peak(run, "contact_load_ratio")[1], ""),
    ("W_c end", 1.0, _end("contact_load_ratio"), "contact_load_ratio"),
    ("A_c end", 1.0, _end("contact_area_ratio"), "contact_area_ratio"),
    ("p_max end [GPa]", 1e-9, _end("pressure_max"), "pressure_max"),
    ("film ball end [nm]", 1e9, _end("tribofilm_1"), "tribofilm_1"),
    ("film disc end [nm]", 1e9, _end("tribofilm_2"), "tribofilm_2"),
    ("film ball, peak / end", 1.0, lambda run: peak(run, "tribofilm_1")[1] / max(run.end("tribofilm_1"), 1e-30), ""),
    ("Rq ball end [nm]", 1e9, _end("roughness_1"), "roughness_1"),
    ("Rq disc end [nm]", 1e9, _end("roughness_2"), "roughness_2"),
    ("wear ball [nm]", 1e9, _end("wear_depth_1"), "wear_depth_1"),
    ("wear disc [nm]", 1e9, _end("wear_depth_2"), "wear_depth_2"),
    ("friction coefficient end", 1.0, _end("friction_coefficient"), "friction_coefficient"),
)


def scatter(book: Book, numerics: str) -> Lines:
    """Main numbers over the seeds: mean ± standard deviation, and in brackets the program's own half width."""
    sets: dict[str, list[Run]] = {}
    for name in ("A", "B", "B_bare"):
        runs = []
        for seed in SEEDS:
            try:
                runs.append(two_hours(book.getter(numerics, seed)(name)))
            except Missing:
                continue
        if len(runs) > 1:
            sets[name] = runs
    if not sets:
        return ["Not run."]
    lines = table("quantity", *(f"{name}, {len(runs)} surfaces" for name, runs in sets.items()))
    for text, scale, measure, output in MAIN:
        bare_film = "film" in text
        found = [
            "—" if bare_film and "bare" in name else _scatter(runs, scale, measure, output)
            for name, runs in sets.items()
        ]
        lines.append(cells((text, *found)))
    if {"B", "B_bare"} <= sets.keys():
        crossings = [crossover(*pair, "pressure_max") for pair in zip(sets["B"], sets["B_bare"], strict=False)]
        said = "; ".join(crossing_text(minute) for minute in crossings)
        lines.append(cells(("p_max with film, B", said, *[""] * (len(sets) - 1))))
    return lines


def _scatter(runs: list[Run], scale: float, measure: Callable[[Run], float], output: str) -> str:
    found = scale * np.array([measure(run) for run in runs])
    own = ""
    if output:
        widths = [scale * np.hypot(run.end(f"{output}.by_steps"), run.end(f"{output}.by_sampling")) for run in runs]
        own = f" ({np.mean(widths):.2g})"
    return f"{found.mean():.3g} ± {found.std(ddof=1):.2g}{own}"


ORDERED = (
    ("h_c", "h_c [nm]", 1e9),
    ("lambda_ratio", "λ", 1.0),
    ("lambda_conventional", "λ conventional", 1.0),
    ("contact_area_ratio_disc", "A_c, r < 2a/3", 1.0),
    ("contact_area_ratio", "A_c, whole", 1.0),
    ("contact_load_ratio_disc", "W_c, r < 2a/3", 1.0),
    ("contact_load_ratio", "W_c, whole", 1.0),
    ("roughness_1", "Rq ball [nm]", 1e9),
    ("roughness_raw_1", "Rq ball with groove [nm]", 1e9),
    ("roughness_2", "Rq disc [nm]", 1e9),
    ("roughness_raw_2", "Rq disc with groove [nm]", 1e9),
    ("pressure_max", "p_max [GPa]", 1e-9),
    ("wear_depth_1", "wear ball [nm]", 1e9),
    ("wear_depth_2", "wear disc [nm]", 1e9),
    ("friction_coefficient", "friction coefficient", 1.0),
)


def orderings(book: Book, film: str, bare: str, numerics: str) -> Lines:
    """With against without tribofilm."""
    try:
        one, other = book.get(film, numerics), book.get(bare, numerics)
    except Missing as missing:
        return [f"{missing}."]
    lines = table(
        "quantity", "mean with", "mean without", "end with", "end without", "with above, share of time", "with film"
    )
    for name, text, scale in ORDERED:
        means = [scale * run.mean(name) for run in (one, other)]
        ends = [scale * run.end(name) for run in (one, other)]
        numbers = [f"{value:.3g}" for value in (*means, *ends)]
        share = f"{100 * time_above(one, other, name):.0f} %"
        lines.append(cells((text, *numbers, share, crossing_text(crossover(one, other, name)))))
    return lines


def smooth_limit(book: Book) -> Lines:
    """Return h_c beside that of the smooth contact on the same grid."""
    lines = table(
        "run", "sliding in Archard's law", "smooth contact, same grid", "h_c after 2 h", "ratio", "last 20 min"
    )
    for smooth, name, numerics in _limits():
        sliding = "own speed" if numerics == "joint" else "u1 - u2"
        try:
            floor, run = book.get(smooth, numerics).end("h_c"), two_hours(book.get(name, numerics))
        except Missing as missing:
            lines.append(cells((f"{name}, {numerics}", sliding, str(missing), "", "", "")))
            continue
        end = run.end("h_c")
        late = f"{1e9 * (end - run.at('h_c', 100.0)):+.2g} nm"
        lines.append(cells((f"{name}, {numerics}", sliding, nm(floor), nm(end), f"{end / floor:.2f}", late)))
    parts = []
    for name, label in (("azam_case_a", "A"), ("mtm_zddp", "B")):
        contact = formula_contact(name)
        films = nm(hamrock_dowson(contact)[0]), nm(nijenbanning_venner_moes(contact))
        parts.append(f"{label}: Hamrock and Dowson {films[0]}, Nijenbanning, Venner and Moes {films[1]}")
    return [*lines, "", f"By formula, central film: {'; '.join(parts)}."]


def _limits() -> Iterator[tuple[str, str, str]]:
    for numerics in NUMERICS:
        for film, bare in PAIRS:
            yield f"{film}_smooth", film, numerics
            yield f"{film}_smooth", bare, numerics


def runs(book: Book) -> Lines:
    """Return the runs with their time and stated errors."""
    lines = table(
        "case",
        "what",
        "numerics",
        "blocks: mixed + dry",
        "CPU [s]",
        "largest step of h_c in a minute, after 2 min",
        "error of h_c",
        "of film, ball",
        "disc",
        "of wear",
        "unconverged, largest",
    )
    for case in CASES.values():
        for numerics in case.numerics:
            try:
                run = book.get(case.name, numerics)
            except Missing:
                continue
            errors = [
                f"{100 * run.end(f'error_{name}'):.1f} %" for name in ("film", "tribofilm_1", "tribofilm_2", "wear")
            ]
            unconverged = f"{100 * run['unconverged'].max():.0f} %"
            blocks = f"{run.end('blocks_mixed'):.0f} + {run.end('blocks_dry'):.0f}"
            seconds, jump = f"{float(run['seconds']):.0f}", nm(float(np.abs(np.diff(run["h_c"][2:])).max(initial=0.0)))
            lines.append(cells((case.name, case.text, numerics, blocks, seconds, jump, *errors, unconverged)))
    return lines
