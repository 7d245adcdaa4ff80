"""docs/equations.md is what the laws say, in mathematics that can be set."""

import re
from pathlib import Path

import pytest
from matplotlib.mathtext import MathTextParser

from contact_core.film import FILMS
from contact_core.laws import SLOTS
from contact_core.laws.symbols import common
from contact_core.shapes import GEOMETRIES
from docs._extensions.equations import page
from docs._extensions.latex import latex

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "equations.md").read_text("utf-8")


def test_the_page_is_what_the_laws_say_today():
    assert page() == PAGE, "python -m docs._extensions.equations > docs/equations.md"


def test_the_page_has_every_law_level_and_shape():
    headings = re.findall(r"^### `(\w+)`$", PAGE, re.MULTILINE)
    laws = [law.name for laws in SLOTS.values() for law in laws]
    known = [*laws, *(shape.name for shape in GEOMETRIES), *(film.name for film in FILMS)]
    assert sorted(headings) == sorted([*known, "gaussian", "self_affine", "exponential"])


def test_the_glossary_has_every_symbol_that_laws_share_with_its_unit():
    """A row may have several: `p_f, p_s`, with one unit or one each; symbols are in its first or second column."""
    rows = [line.strip("| ").split(" | ") for line in (DOCS / "glossary.md").read_text("utf-8").splitlines()]
    known = set()
    for first, second, third, *_ in (row for row in rows if len(row) > 3):
        for names, units in ((first, second), (second, third)):
            symbols, each = names.split(", "), units.split(", ")
            known |= set(zip(symbols, each if len(each) == len(symbols) else len(symbols) * each, strict=False))
    shared = {(symbol.translate(str.maketrans("′", "'", "{}")), unit or "1") for symbol, (unit, _) in common().items()}
    assert shared - known == set()


@pytest.mark.parametrize("every", [5, pytest.param(1, marks=pytest.mark.long)])
def test_all_mathematics_of_the_page_can_be_set(every):
    found = re.findall(r"^```math\n(.+)\n```$", PAGE, re.MULTILINE)
    assert len(found) > 100
    parser = MathTextParser("path")
    for each in found[::every]:
        parser.parse(f"${each}$")  # raises ValueError


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("h_c/σ = W_c g^{1/2},   p_0 = 196 MPa", r"h_{c}/\sigma = W_{c} g^{1/2},\qquad p_{0} = 196 \mathrm{MPa}"),
        ("T_{bulk,i} = T_{oil}", r"T_{\mathrm{bulk},i} = T_{\mathrm{oil}}"),
        ("√J_{2,a} exp{−x}", r"\sqrt{J_{2,a}} \exp \{-x\}"),
        ("W = ∬ p dx′ + Σ 1/N (1 + Σ)", r"W = \iint p \,dx' + \sum 1/N (1 + \Sigma)"),
        ("p_f = 0 for x < −d̄", r"p_{f} = 0 \text{ for } x < -\bar{d}"),
    ],
)
def test_a_line_is_converted(line, said):
    assert latex(line) == said
