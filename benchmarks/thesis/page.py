"""The page docs/measured/thesis.md: summary, claims by chapter with their causes, tables."""

import re
from collections import Counter
from collections.abc import Sequence

from benchmarks.pages import cells
from benchmarks.thesis.cases import CASES, NUMERICS, Book
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
KINDS = tuple(NUMERICS)  # in the order of the columns
NAMES = {"thesis": "thesis numerics", "ours": "ours", "joint": "joint reading"}
HOW = """\
Written by `python -m benchmarks.thesis.validation`, which runs the cases missing in results/thesis/validation; `--report` writes this page from the existing ones, `--list` lists them. Each verdict follows from its numbers by the
criterion beside it. The thesis: A. Azam, PhD thesis, University of Leeds, 2018. It prints most results as plots only, so shapes and
orders are compared, and numbers where its text gives them.

Each case is two hours of rubbing, one row per minute, in three columns. **Ours**: the scenes `azam_case_a` and `mtm_zddp` as shipped.
**Thesis numerics**: the same on the thesis's grid of 129x129 nodes on 0.5 mm, with upwind flow and one pressure for fluid and solid (`film.criterion =
lumped`), floor 0.47 nm, nothing rough below the grid, all blocks driven by mixed lubrication, 20 iterations an instant (one pressure never converges; 300 give
the first instant to 1 %);
growth by the clock, wear by u_1 - u_2.
**Joint reading**: the shipped scenes `azam_case_a_thesis` and `mtm_zddp_thesis`, in which all conventions are together under which the thesis's
figures come out: roughness white on the grid (65x65 nodes), growth while a node touches (`tribofilm.dose = contact_length`), wear by each body's own
speed, hardness by all plastic depth so far, upwind flow. Time steps and sampling of the moving surfaces are equal in all.

A disagreement has its cause shown if an experiment turns it: a run that differs in what its text says, another measure of the same run, or, for the first two
columns, the joint reading or an experiment on it; or if a closed form shows that the thesis's printed inputs cannot give its figure. Two differences are needed where
the thesis's contact stays in boundary lubrication for two hours though wear by own speed would flatten it: dry contacts drive the blocks, and u_1 - u_2 wears.

Set A: `azam_case_a` (u_e 0.25 m/s, 90 °C, SRR -2 % unless stated). Set B: `mtm_zddp` (0.1 m/s, 80 °C, SRR +5 %). Body 1 is the
ball, body 2 the disc; SRR = 2 (u_ball - u_disc) / (u_ball + u_disc). h_c: mean gap over r < 2a/3. λ = h_c / composite rms
roughness; conventional λ: with Hamrock and Dowson's film. A_c: real contact area / Hertz area; W_c: load on solids / load.
Mean films and depths: over the track |y| < a; covered: nodes with more than 1 nm. Roughness: over |y| < 2a/3, free of the groove's shape unless stated. Start: the fresh surfaces; end: after 2 h.
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
    counts = (*VERDICTS, "disagree, cause shown", "agree or cause shown")
    lines = [f"**{len(everything)} claims of {len(figures)} figures:**", "", *table("", *counts)]
    for kind in KINDS:
        found = [verdicts[kind] for verdicts in everything]
        count = Counter(entry.verdict for entry in found)
        shown = sum(entry.verdict == "disagree" and entry.explained for entry in found)
        lines.append(cells((NAMES[kind], *(count[verdict] for verdict in VERDICTS), shown, count["agree"] + shown)))
    lines.append("")
    for kind in KINDS:
        named = {
            f"{chapter}.{k}": verdicts[kind]
            for chapter, (_, _, found) in enumerate(judged, 5)
            for k, (_, verdicts) in enumerate(found, 1)
        }
        lines.append(explained(NAMES[kind], named))
    return lines


def explained(kind: str, judged: dict[str, Judged]) -> str:
    """Return which claims that do not come out have no cause shown, and which lack experiments."""
    wrong = {name: entry for name, entry in judged.items() if entry.verdict == "disagree"}
    bare = [name for name, entry in wrong.items() if not entry.explained]
    short = [name for name, entry in wrong.items() if any("not run yet" in cause for cause in entry.causes)]
    return (
        f"- {kind}: of {len(wrong)} that disagree, {len(wrong) - len(bare)} have a cause shown, {len(bare)} have not"
        f"{_listed(bare)}; {len(short)} lack experiments{_listed(short)}."
    )


def _listed(names: Sequence[str]) -> str:
    return f" ({', '.join(names)})" if names else ""


def _claims(chapter: int, found: Found) -> Lines:
    columns = [NAMES[kind] for kind in KINDS]
    seeded = [kind for kind in KINDS if any(verdicts[kind].seeds for _, verdicts in found)]
    lines = table(
        "", "figure", "the thesis shows", "agrees if", *columns, *(f"{NAMES[kind]}, seeds" for kind in seeded)
    )
    for k, (claim, verdicts) in enumerate(found, 1):
        texts = [_cell(verdicts[kind]) for kind in KINDS]
        seeds = [verdicts[kind].seeds.replace("/", " of ") for kind in seeded]
        lines.append(cells((f"{chapter}.{k}", claim.figure, claim.shows, claim.asked, *texts, *seeds)))
    return lines


def _cell(judged: Judged) -> str:
    """Verdict and numbers."""
    verdict = f"**{judged.verdict}**" if judged.verdict == "disagree" else judged.verdict
    return f"{verdict}: {judged.text}" if judged.text not in ("", "—") else verdict


def _causes(chapter: int, found: Found) -> Lines:
    lines = []
    for k, (claim, verdicts) in enumerate(found, 1):
        said = [
            f"  - {NAMES[kind]}: {'; '.join(verdicts[kind].causes).rstrip('.')}."
            for kind in KINDS
            if verdicts[kind].causes
        ]
        agrees = all(verdicts[kind].verdict == "agree" for kind in KINDS)
        if said or (claim.remark and not agrees):
            lines += [f"- **{chapter}.{k}** {claim.shows}. {claim.remark}".rstrip(), *said]
    if not lines:
        return []
    note = "Experiments: the same measure on runs that differ in what is said, or another measure on the same runs."
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
    made = [(case.name, kind) for case in CASES.values() for kind in case.numerics]
    missing = [f"{name} ({kind})" for name, kind in made if not book.has(name, kind)]
    lines += ["## Runs", "", f"Not run: {', '.join(missing) or 'none'}.", ""]
    earlier = [f"{name} ({kind})" for name, kind in made if book.is_earlier(name, kind)]
    if earlier:
        lines += [f"By earlier sources, of the same scenes: {', '.join(earlier)}.", ""]
    lines += runs(book)
    return lines
