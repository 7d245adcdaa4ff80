"""Pages of docs/measured say what they were written from; those that others cite are of today's sources."""

import re
from pathlib import Path

import pytest

from benchmarks.dependencies import ITSELF, PAGES, SOURCES, UNMARKED, Tree, changed, stamp
from benchmarks.digests import meaning
from benchmarks.house.pages import lines, states
from benchmarks.pages import Page

ROOT = Path(__file__).parents[2]
MEASURED = ROOT / "docs" / "measured"
CITING = ("how_good.md", "validation.md", "how-to/run.md", "how-to/python.md", "how-to/scenes.md")
TEXTS = [(ROOT / "docs" / name).read_text("utf-8") for name in CITING]
CITED = {page for text in TEXTS for page in re.findall(r"measured/([\w/]+)\.md", text)}
# cited, but not written anew yet: a page leaves this list when its command has been run
OWED = {
    *("coupling/accuracy", "coupling/cost", "coupling/masters", "film/accuracy", "film/core_accuracy"),
    *("film/core_cost", "film/core_lambda", "film/core_smooth", "film/core_starts", "film/error_estimate"),
    *(
        "film/hard_cases",
        "film/inlet",
        "film/measured",
        "film/moving",
        "film/peers",
        "film/tolerance",
        "film/two_hours",
    ),
    *("fmu/endurance", "fmu/overhead", "friction/laws_cost", "friction/traction", "machines/tolerance"),
    *("friction/published_traction", "machines/rolling"),
    *("regression/cost", "regression/curves", "regression/held_back", "regression/shapes", "speed_error"),
    *("surfaces/asperity_load_share", "surfaces/evolution", "surfaces/stribeck", "surfaces/tribofilm"),
    "thesis/validation",
}


def test_no_cited_page_is_stale() -> None:
    found = states(MEASURED)
    listed = "\n".join(lines({page: why for page, why in found.items() if why}))
    print(listed)
    assert {page for page in CITED if found[page]} == OWED, f"cited pages are of older sources:\n{listed}"


def edited(path: str, old: str, new: str) -> Tree:
    """Today's sources with a change in one file."""
    text = SOURCES.files[path].decode()
    assert old in text
    return Tree({**SOURCES.files, path: text.replace(old, new).encode()})


DENSITY = "contact_core/laws/density.py"


@pytest.mark.parametrize(
    ("page", "path", "old", "new", "group"),
    [
        ("film/core_smooth", DENSITY, "1.34 * p", "1.35 * p", "film"),
        ("film/core_smooth", "contact_core/calls/point_contact.py", '"fitted"', '"upwind"', "calls"),
        ("film/core_smooth", "benchmarks/film/core_smooth.py", "129", "131", ITSELF),
        ("film/core_smooth", "benchmarks/film/cases.py", "0.5", "0.6", ITSELF),
        ("film/tolerance", "contact_core/scene/records.py", "default=120.0", "default=60.0", "control"),
        ("film/tolerance", "contact_core/data/scenes/mtm_zddp.toml", 'N"', 'kN"', "mtm_zddp"),
        ("film/measured", "system_models/validation/data/optical_films.csv", "1", "2", "measurements"),
        ("machines/gear_path", "system_models/machines/gear_pair/path.py", "0.5", "0.6", "machines"),
    ],
)
def test_a_page_is_stale_when_what_it_depends_on_changes(page: str, path: str, old: str, new: str, group: str) -> None:
    text = f"# Page\n\n{stamp(page)}\n"
    assert changed(page, text) == []
    assert changed(page, text, edited(path, old, new)) == [group]


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        (DENSITY, '"""rho', '"""In other words: rho'),
        (DENSITY, "\n\n\n", "\n\n\n# why\n"),
        (DENSITY, "pressure: NDArray[np.float64]", "pressure: object"),
        (DENSITY, "1.34 p", "1.34p"),
        ("contact_core/calls/point_contact.py", "numbers = ", "given = "),
        ("contact_core/film/scaled.py", "raise ConvergenceError(", 'raise ConvergenceError("Anew", '),
        ("contact_core/film/deterministic.py", "gap at which", "the gap at which"),
        ("contact_core/data/lubricants.toml", "\n\n", "\n# its source\n\n"),
        ("contact_core/regression/contact.py", "0.5", "0.6"),
    ],
)
def test_wording_and_other_sources_leave_a_page_fresh(path: str, old: str, new: str) -> None:
    assert changed("film/core_smooth", stamp("film/core_smooth"), edited(path, old, new)) == []


def test_a_new_file_of_a_group_makes_its_pages_stale() -> None:
    grown = Tree({**SOURCES.files, "contact_core/laws/another.py": b"VALUE = 1.0\n"})
    assert changed("film/core_smooth", stamp("film/core_smooth"), grown) == ["film"]
    assert changed("coupling/cost", stamp("coupling/cost"), grown) == []


@pytest.mark.parametrize("text", ["# Page\n", "<!-- depends on film 123 -->\n\nA line after it.\n"])
def test_a_page_that_does_not_end_with_its_digests_is_unmarked(text: str) -> None:
    assert changed("film/core_smooth", text) == [UNMARKED]


def test_python_is_read_by_what_it_does() -> None:
    same = (b"def f(x: int) -> int:\n    'Doc.'\n    return 2*x\n", b"def f(x):\n    # twice\n    return (2 * x)\n")
    assert meaning("a.py", same[0]) == meaning("a.py", same[1])
    assert meaning("a.py", same[0]) != meaning("a.py", b"def f(x):\n    return x * 2\n")


def test_every_group_of_a_page_has_files() -> None:
    assert [name for page in PAGES.values() for name in page.groups if not SOURCES.members(name)] == []


def test_a_page_that_is_not_declared_is_refused_before_it_is_measured() -> None:
    with pytest.raises(LookupError, match="dependencies"):
        Page("film/nowhere", "Nowhere")


def test_a_page_of_no_benchmark_is_refused(tmp_path: Path) -> None:
    (tmp_path / "nowhere.md").write_text("# Page\n", "utf-8")
    with pytest.raises(LookupError, match="nowhere"):
        states(tmp_path)
