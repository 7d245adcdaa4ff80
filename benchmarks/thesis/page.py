"""The page docs/measured/thesis/validation.md: summary, claims by chapter with their causes, tables."""

import re
from collections import Counter
from collections.abc import Sequence

from benchmarks.pages import cells
from benchmarks.thesis.cases import CASES, Book
from benchmarks.thesis.rows import VERDICTS, Claim, Judged, judge
from benchmarks.thesis.rows_5 import CLAIMS as GROWTH
from benchmarks.thesis.rows_6 import CLAIMS as LUBRICATION
from benchmarks.thesis.rows_7 import CLAIMS as WEAR
from benchmarks.thesis.tables import PAIRS, Lines, balances, orderings, runs, scatter, smooth_limit, table

CHAPTERS = (
    ("Chapter 5: growth of the tribofilm", GROWTH, ("validation_films.png", "validation_pads.png")),
    ("Chapter 6: film, contact, roughness", LUBRICATION, ("validation_lubrication.png",)),
    ("Chapter 7: wear", WEAR, ("validation_wear.png", "validation_scars.png")),
)
KINDS = ("thesis", "ours")  # in the order of the columns
NAMES = {"thesis": "thesis numerics", "ours": "ours"}
HOW = """\
Written by `python -m benchmarks.thesis.validation`, which runs the cases missing in results/thesis/validation; `--report` writes this page from the existing ones, `--list` lists them. Each verdict follows from its numbers by the
criterion beside it. The thesis: A. Azam, PhD thesis, University of Leeds, 2018. It prints most results as plots only, so shapes and
orders are compared, and numbers where its text gives them.

Each case is two hours of rubbing, one row per minute, in two numerics. **Ours**: the scene as shipped (separate fluid and solid pressure,
floor 1 nm). **Thesis numerics**: 129x129 nodes on 0.5 mm, one pressure for fluid and solid (`film.criterion =
lumped`), floor 0.47 nm, all blocks driven by mixed lubrication. Time steps and sampling of the moving surfaces are equal in both.

Set A: `azam_case_a` (u_e 0.25 m/s, 90 °C, SRR -2 % unless stated). Set B: `mtm_zddp` (0.1 m/s, 80 °C, SRR +5 %). Body 1 is the
ball, body 2 the disc; SRR = 2 (u_ball - u_disc) / (u_ball + u_disc). h_c: mean gap over r < 2a/3. λ = h_c / composite rms
roughness; conventional λ: with Hamrock and Dowson's film. A_c: real contact area / Hertz area; W_c: load on solids / load.
Mean films and depths: over the track |y| < a; covered: nodes with more than 1 nm. Roughness: over |y| < 2a/3, free of the groove's shape unless stated. Start: the fresh surfaces; end: after 2 h.

With `control.driver = auto`, as shipped, a dry contact under oil drives the blocks while W_c is above `control.dry_above`; h_c, λ and p_max
are then those of that contact, and may jump by some per cent where the driver changes. A peak at such a time is not judged.
"""

BOOKS = """\
A point of the ball passes the contact more often than a point of the disc, by the ratio of cycles. A pass lasts longer on the slower body,
by the ratio of speeds. Under the same film both would wear in the ratio of their track lengths. The thesis: "almost 4". V: wear volume,
the worse of the two bodies. Archard's volume: that of the ball."""


def page(book: Book, pictures: Sequence[str]) -> str:
    """The whole page."""
    judged = [(title, shown, _judged(claims, book)) for title, claims, shown in CHAPTERS]
    lines = ["# Comparison with Azam's thesis", "", HOW, *_trial_note(book), *_summary(judged), ""]
    for k, (title, shown, found) in enumerate(judged, 5):
        lines += [f"## {title}", "", *_claims(k, found), "", *_causes(k, found), ""]
        lines += [line for name in shown if name in pictures for line in (f"![{title}]({name})", "")]
    return "\n".join([*lines, *_tables(book)]).rstrip() + "\n"


Found = list[tuple[Claim, dict[str, Judged]]]


def _judged(claims: Sequence[Claim], book: Book) -> Found:
    return [(claim, {kind: judge(claim, book, kind) for kind in KINDS}) for claim in claims]


def _trial_note(book: Book) -> Lines:
    if book.trial.real:
        return []
    return [f"**A trial ({book.trial.hours:g} h, {book.trial.points or 'shipped'} points): not a result.**", ""]


def _summary(judged: Sequence[tuple[str, Sequence[str], Found]]) -> Lines:
    everything = [verdicts for _, _, found in judged for _, verdicts in found]
    figures = {name for _, _, found in judged for claim, _ in found for name in re.findall(r"\d-\d+", claim.figure)}
    lines = [f"**{len(everything)} claims of {len(figures)} figures:**", "", *table("", *VERDICTS)]
    for kind in KINDS:
        count = Counter(verdicts[kind].verdict for verdicts in everything)
        lines.append(cells((NAMES[kind], *(count[verdict] for verdict in VERDICTS))))
    run = [verdicts for verdicts in everything if all(entry.verdict != "not run" for entry in verdicts.values())]
    differ = sum(len({entry.verdict for entry in verdicts.values()}) > 1 for verdicts in run)
    lines += ["", f"Of {len(run)} claims judged in both, the verdicts differ in {differ}."]
    for kind in KINDS:
        named = {
            f"{chapter}.{k}": verdicts[kind]
            for chapter, (_, _, found) in enumerate(judged, 5)
            for k, (_, verdicts) in enumerate(found, 1)
        }
        lines.append(explained(NAMES[kind], named))
    return lines


def explained(kind: str, judged: dict[str, Judged]) -> str:
    """Return how many of the claims that do not come out, by their numbers, experiments explain."""
    wrong = {name: entry.causes for name, entry in judged.items() if entry.verdict == "disagree"}
    mended = [name for name, causes in wrong.items() if any(cause.startswith("agrees with") for cause in causes)]
    none = [
        name for name, causes in wrong.items() if not any(cause.startswith(("agrees", "not by")) for cause in causes)
    ]
    short = [name for name, causes in wrong.items() if any("not run yet" in cause for cause in causes)]
    return (
        f"Of the {len(wrong)} that disagree in {kind}, an experiment makes {len(mended)} agree and none of those tried "
        f"{len(wrong) - len(mended) - len(none)}; {len(none)} have no experiment that was run"
        f"{_listed(none)}, {len(short)} lack some of theirs{_listed(short)}."
    )


def _listed(names: Sequence[str]) -> str:
    return f" ({', '.join(names)})" if names else ""


def _together(verdicts: dict[str, Judged]) -> str:
    """One verdict if both numerics have the same."""
    thesis, ours = (verdicts[kind].verdict for kind in KINDS)
    return ours if thesis == ours else f"{thesis} / {ours}"


def _claims(chapter: int, found: Found) -> Lines:
    names = (
        "",
        "figure",
        "the thesis shows",
        "agrees if",
        "thesis numerics",
        "ours",
        "verdict",
        "holds in seeds, thesis / ours",
    )
    lines = table(*names)
    for k, (claim, verdicts) in enumerate(found, 1):
        texts = [verdicts[kind].text for kind in KINDS]
        together = _together(verdicts)
        together = f"**{together}**" if "disagree" in together else together
        seeds = [verdicts[kind].seeds or "—" for kind in KINDS]
        seen = "" if seeds == ["—", "—"] else " / ".join(s if s == "—" else s.replace("/", " of ") for s in seeds)
        lines.append(cells((f"{chapter}.{k}", claim.figure, claim.shows, claim.asked, *texts, together, seen)))
    return lines


def _causes(chapter: int, found: Found) -> Lines:
    lines = []
    for k, (claim, verdicts) in enumerate(found, 1):
        said = [f"  - {NAMES[kind]}: {'; '.join(verdicts[kind].causes)}." for kind in KINDS if verdicts[kind].causes]
        agrees = all(verdicts[kind].verdict == "agree" for kind in KINDS)
        if said or (claim.remark and not agrees):
            lines += [f"- **{chapter}.{k}** {claim.shows}. {claim.remark}".rstrip(), *said]
    if not lines:
        return []
    note = "Experiments: the same measure on runs with one difference, or another measure on the same runs."
    return ["### Causes of disagreement", "", note, "", *lines]


def _tables(book: Book) -> Lines:
    lines = ["## Balances", "", *balances(book), "", BOOKS, ""]
    lines += ["## Decay of h_c towards the smooth contact", "", *smooth_limit(book), ""]
    for film, bare in PAIRS:
        for kind in KINDS:
            lines += [
                f"## With and without tribofilm, set {film}, {NAMES[kind]}",
                "",
                *orderings(book, film, bare, kind),
                "",
            ]
    for kind in KINDS:
        lines += [f"## Scatter over five pairs of surfaces, {NAMES[kind]}", ""]
        lines += [
            "Mean ± standard deviation; in brackets the mean of the stated half width (time steps and sampling).",
            "",
        ]
        lines += [*scatter(book, kind), ""]
    missing = [
        f"{case.name} ({kind})" for case in CASES.values() for kind in case.numerics if not book.has(case.name, kind)
    ]
    lines += ["## Runs", "", f"Not run: {', '.join(missing) or 'none'}.", "", *runs(book)]
    return lines
