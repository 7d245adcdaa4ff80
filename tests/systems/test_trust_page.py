"""Numbers of docs/trust.md are those of the sections that it names, and sections agree with themselves."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from benchmarks import sections
from benchmarks.film import peers
from benchmarks.house.tables import Pages, number, numbers
from benchmarks.house.trust import MARKED, PATH, written
from benchmarks.thesis.page import KINDS, NAMES, explained
from benchmarks.thesis.rows import VERDICTS, Judged

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
README = (ROOT / "README.md").read_text("utf-8")
PAGES = Pages()
TEXT = PATH.read_text("utf-8")
BY_HAND = [line for line in MARKED.sub("", TEXT).splitlines() if sections.LINK.search(line)]
UNITS = r"(?:%|[mu]s\b|s\b|MB\b|kB\b|WU\b|times\b|work units|seconds|minutes)"


@pytest.mark.parametrize(
    ("cause", "shown"),
    [
        ("agrees with *a finer grid*: 3 nm", True),
        ("closed form: 3 nm", True),
        ("disagrees with *a finer grid*, too: 4 nm", False),
        ("*a finer grid* was not run yet", False),
    ],
)
def test_a_cause_is_shown_by_an_experiment_that_turns_the_claim_or_by_a_closed_form(cause: str, shown: bool) -> None:
    assert Judged("disagree", "4 nm", (cause,)).explained == shown


def section(name: str) -> str:
    return sections.read(name).text


def test_the_tables_are_those_that_the_sections_give() -> None:
    assert written(TEXT, PAGES) == TEXT


@pytest.mark.parametrize("line", BY_HAND, ids=lambda line: line[2:30])
def test_a_number_written_by_hand_is_in_a_section_that_its_line_names(line: str) -> None:
    """As rounded there, or a share in per cent."""
    linked = {(room, anchor) for _, room, anchor, _ in sections.LINK.findall(line)}
    known = [one for part in sections.every() if (part.room, part.anchor) in linked for one in numbers(part.text)]
    prose = re.sub(r"`[^`]*`|\]\([^)]*\)", "", line)
    for word in re.findall(r"(?<![\w.])\d+(?:\.\d+)?(?!\w)", prose):
        digits = len(word.partition(".")[2])
        assert any(round(scale * one, digits) == float(word) for one in known for scale in (1, 100)), word


def test_figures_of_a_measurement_stand_on_that_page_and_not_in_readme() -> None:
    prose = re.sub(r"```.*?```", "", README, flags=re.DOTALL)
    assert re.findall(rf".*\d ?{UNITS}.*", prose) == []


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("regression/held_back", r"(fzg_flank \| 16 \| 0 \| )[\d.]+", r"\g<1>0.97", "97 %; "),
        ("regression/cost", r"\| all of them \| load, speeds, temperature \| ", "| all | hot | 9", " us (all)"),
        (
            "speed_error",
            r"(_zddp, two hours \| regression \| - \| [\d.]+ \| - \| )[\d.]+",
            r"\g<1>46.8",
            "| 46.8 (",
        ),
        ("surfaces/evolution", r"(\| mixed \| [^(]*)\(\d\.\d+\)", r"\g<1>(0.01)", "; mu 1 % |"),
        ("film/moving", r"(\| mtm_zddp \| 1 \| 257 \| )[\d.]+", r"\g<1>0.1", " % (W_c)"),
    ],
)
def test_a_worse_figure_of_a_section_becomes_the_worst(
    name: str, old: str, new: str, said: str, tmp_path: Path
) -> None:
    shutil.copytree(sections.KEPT, tmp_path / "kept")
    path = sections.path_of(name, tmp_path / "kept")
    text, count = re.subn(old, new, path.read_text("utf-8"), count=1)
    assert count == 1
    path.write_text(text, "utf-8")
    changed = set(written(TEXT, Pages(tmp_path / "kept")).splitlines()) - set(TEXT.splitlines())
    assert any(said in line for line in changed), changed


# sections


def test_verdicts_on_the_thesis_are_counted_as_they_stand() -> None:
    text = section("thesis/validation")
    claims = {
        number: [cell.strip(" *|").partition(":")[0].strip("*") for cell in line.split(" | ")[3:]]
        for number, line in re.findall(r"^\| (\d\.\d+) \| (.*)$", text, re.MULTILINE)
    }
    for place, kind in enumerate(KINDS):
        judged = {}
        for claim, verdicts in claims.items():
            why = re.search(rf"^- \*\*{re.escape(claim)}\*\*.*\n((?:  - .*\n)*)", text, re.MULTILINE)
            said = re.findall(rf"  - {NAMES[kind]}: (.*)\.\n", why[1]) if why else []
            judged[claim] = Judged(verdicts[place], "", tuple(part for line in said for part in line.split("; ")))
        (row,) = (row for row in PAGES.rows("thesis/validation", "not run") if row[""] == NAMES[kind])
        counts = [sum(entry.verdict == verdict for entry in judged.values()) for verdict in VERDICTS]
        assert [int(row[verdict]) for verdict in VERDICTS] == counts
        assert f"**{sum(counts)} claims" in text
        assert explained(NAMES[kind], judged) in text


def test_ratios_and_differences_are_those_of_their_rows() -> None:
    direct = {row["slave"]: row for row in PAGES.rows("fmu/overhead", "slave", **{"called by": "direct call"})}
    for row in PAGES.rows("fmu/overhead", "slave"):
        over = number(row["median [us]"]) - number(direct[row["slave"]]["median [us]"])
        assert number(row["over the direct call [us]"]) == approx(over, abs=0.11)
    rows = PAGES.rows("film/peers", "ratio")
    for row in rows:
        others = [
            number(other["ms"])
            for other in rows
            if other["nodes"] == row["nodes"]
            and not other["solver"].startswith("tribofmu")
            and (row["solver"].endswith("again") or not other["solver"].endswith("again"))
        ]
        assert number(row["ratio"]) == approx(number(row["ms"]) / min(others), rel=2e-3, abs=0.006)


def test_the_page_of_the_fmu_says_what_a_step_costs_over_the_models_own_time() -> None:
    rows = {
        (row["slave"], row["called by"]): row["over the direct call [us]"]
        for row in PAGES.rows("fmu/overhead", "slave")
    }
    text = (DOCS / "how-to" / "fmu.md").read_text("utf-8")
    for slave, start in (("empty", "| a step of an empty model"), ("mtm_zddp", "| a step of `mtm_zddp`")):
        (line,) = (line for line in text.splitlines() if line.startswith(start))
        ways = (
            *("isolated, host in C", "isolated, host in C, any CPU"),
            *("embedded, fmpy", "embedded, host in C"),
        )
        assert re.findall(r"(\d+) us", line) == [f"{number(rows[slave, way]):.0f}" for way in ways]


# peers


@pytest.mark.parametrize(("factor", "shift", "named"), [(1.0, 0, 0), (1.0 + 1e-5, 0, 1), (1.0, 1, 1)])
def test_a_peer_that_finds_another_contact_is_named(factor: float, shift: int, named: int) -> None:
    def peer(case: peers.Case) -> tuple[np.ndarray, int]:
        pressure, iterations = peers.plain(case)
        return factor * np.roll(pressure, shift, axis=0), iterations

    wrong: list[str] = []
    peers.rows_of(peers.Case(33, 33), {peers.OURS: peers.tribofmu, "peer": peer}, 1, wrong)
    assert len(wrong) == named
    assert all("peer" in line for line in wrong)
