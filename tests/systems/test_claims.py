"""What is claimed: sections of docs/measured are rendered from what is kept, and say when they are of older code."""

import subprocess
import sys
from datetime import date
from pathlib import Path

import pytest

from benchmarks import anew, claims, sections
from benchmarks.claims import CLAIMS, SOLVED, State
from benchmarks.folders import MEASURED, ROOT
from benchmarks.pages import Page

MOST = 40  # claims
DAYS = 4  # after which every sentinel has run in the tests
STATES = claims.states()
EVERY = sections.every()
IN_TURN = [name for k, name in enumerate(CLAIMS) if k % DAYS == date.today().toordinal() % DAYS]


def test_every_claim_has_a_section_a_command_and_numbers_of_its_sentinel() -> None:
    assert len(CLAIMS) <= MOST
    assert {*CLAIMS} == {section.name for section in EVERY} == {*STATES}
    for claim in CLAIMS.values():
        assert claim.sentinel.__doc__
        for command in claim.commands:
            assert (ROOT / "benchmarks" / f"{command.split()[0].replace('.', '/')}.py").exists(), command
    assert all(state.numbers for state in STATES.values())


@pytest.mark.parametrize("room", sections.ROOMS)
def test_the_page_of_a_room_is_the_one_that_is_rendered(room: str) -> None:
    assert (MEASURED / f"{room}.md").read_text("utf-8") == sections.page(room, claims.note)


def test_sections_of_older_code_say_so_at_their_head() -> None:
    older = {name for name, state in STATES.items() if not state.current}
    for section in EVERY:
        text = (MEASURED / f"{section.room}.md").read_text("utf-8")
        own = text.partition(f"\n## {section.title}\n\n")[2].partition("\n")[0]
        assert own.startswith("**The numbers of this section are of older code") == (section.name in older), (
            section.name
        )


@pytest.mark.parametrize("page", sections.citing(), ids=lambda page: page.stem)
def test_links_to_sections_of_older_code_say_so(page: Path) -> None:
    text = page.read_text("utf-8")
    assert sections.marked(text, claims.note) == text, "python -m benchmarks.claims --check surfaces/finishes writes it"


def test_a_link_is_marked_while_its_section_is_of_older_code() -> None:
    links = "[a](measured/film.md#moving-rough-contacts), [b](../measured/film.md#hard-cases), of older code"
    older = sections.marked(links, lambda section: "old" if section.name == "film/moving" else "")
    assert older == "[a](measured/film.md#moving-rough-contacts), of older code, [b](../measured/film.md#hard-cases)"
    assert sections.marked(older, lambda _: "").count("older") == 0


@pytest.mark.parametrize(
    ("state", "said"),
    [
        (None, "not measured since 2026-11-01"),
        (State({"h_c": 1.0}, "2026-11-28", False, {}), "not measured since 2026-11-01"),
        (State({"h_c": 1.0}, "2026-11-01", True, {}), ""),
        (State({"h_c": 1.0}, "2026-11-01", True, {"h_c": 1.5}), "its sentinel has moved, h_c was 1, is 1.5"),
    ],
)
def test_a_section_says_that_it_was_not_measured_or_what_has_moved(state: State | None, said: str) -> None:
    section = sections.Section("film/moving", "Moving", "2026-11-01", ())
    found = claims.said(section, state)
    assert said in found
    assert bool(found) == bool(said)


@pytest.mark.parametrize(
    ("now", "moved"),
    [
        ({"h_c": 1.0, "W_c": 0.5}, []),
        ({"h_c": 1.0 + 0.9 * SOLVED, "W_c": 0.5}, []),
        ({"h_c": 1.0 + 1.1 * SOLVED, "W_c": 0.5}, ["h_c"]),
        ({"h_c": 1.0}, ["W_c"]),
        ({"h_c": 1.0, "W_c": 0.5, "A_c": 0.1}, ["A_c"]),
    ],
)
def test_a_number_moves_beyond_the_tolerance_or_when_it_comes_or_goes(now: dict[str, float], moved: list[str]) -> None:
    assert claims.moved(CLAIMS["film/moving"], {"h_c": 1.0, "W_c": 0.5}, now) == moved


@pytest.mark.parametrize("name", IN_TURN)
def test_sentinels_of_today_stand_where_they_stood_or_their_section_says_so(name: str) -> None:
    """A quarter of them each day."""
    state = claims.checked(CLAIMS[name], STATES[name])
    if state.moved:
        said = f"{name}: {', '.join(state.moved)} moved, and its section does not say so"
        assert claims.note(sections.read(name)), f"{said}: python -m benchmarks.claims --check {name}"


def test_a_changed_law_moves_sentinels() -> None:
    """In a process of its own: tables of laws are kept from one call to the next."""
    names = ["film/flux", "regression/held_back"]
    run = f"""
from benchmarks.claims import CLAIMS, checked, states
from contact_core.laws.density import DowsonHigginson
DowsonHigginson.__call__ = lambda law, p: (5.9e8 + 1.44 * p) / (5.9e8 + p)
print(*(name for name in {names} if checked(CLAIMS[name], states()[name]).moved))
"""
    done = subprocess.run([sys.executable, "-c", run], cwd=ROOT, check=True, capture_output=True, text=True)
    assert done.stdout.split() == names


def test_a_check_that_finds_a_sentinel_moved_lets_the_page_say_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And a benchmark that is run anew takes the line away."""
    name = "surfaces/finishes"
    for module, place in ((claims, "PATH"), (sections, "MEASURED")):
        monkeypatch.setattr(module, place, tmp_path / "sentinels.json" if place == "PATH" else tmp_path)
    claims.store({name: STATES[name]._replace(numbers={key: 1.1 * x for key, x in STATES[name].numbers.items()})})
    monkeypatch.setattr(claims, "refresh", lambda: sections.render(claims.note, "surfaces"))
    assert claims.check([name])[name].moved
    assert "its sentinel has moved" in (tmp_path / "surfaces.md").read_text("utf-8")
    claims.keep([name])
    assert "its sentinel has moved" not in (tmp_path / "surfaces.md").read_text("utf-8")


def test_a_benchmark_that_backs_no_claim_is_refused_before_it_measures() -> None:
    with pytest.raises(LookupError, match="claim"):
        Page("film/nowhere", "Nowhere")


def test_measuring_anew_passes_over_what_is_current_and_begins_nothing_after_its_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = anew.asked(["fmu", "surfaces/finishes"])
    assert [claim.name for claim in asked] == ["surfaces/finishes", "fmu/overhead", "fmu/native"]
    monkeypatch.setattr(anew, "LOGS", tmp_path)
    monkeypatch.setattr(anew, "current", lambda claim: claim.name == "surfaces/finishes")
    monkeypatch.setattr(anew, "measured", lambda claim: claim.name == "fmu/native")
    ends = [line.split()[1:3] for line in anew.run(asked, 1.0, 1)]
    assert ends == [["of", "today's"], ["FAILED", "in"], ["measured", "in"]]
    assert {*anew.times()} == {"fmu/native"}
    assert [line.split()[1] for line in anew.run(asked[1:], -1.0, 1)] == ["left", "left"]


def test_a_room_that_is_not_there_is_refused() -> None:
    with pytest.raises(SystemExit, match="nowhere"):
        anew.asked(["nowhere"])
