"""docs/bibliography.md has every source that is cited, by authors and year."""

import pytest

from benchmarks.house.bibliography import PATH, citations, written


def test_the_page_is_the_one_that_code_and_pages_give() -> None:
    assert PATH.read_text("utf-8").splitlines() == written().splitlines()


DOI = "10.1115/1.3453074"


@pytest.mark.parametrize(
    ("before", "name"),
    [
        ("Source: Hertz, J. Tribol. 99 (1977) 264,\n    ", "Hertz, J. Tribol. 99 (1977) 264"),
        ("as in (Chevalier et al. 1998, ", "Chevalier et al. 1998"),
        ("Faces and gradients are those of Love 1929, ", "Love 1929"),
        ("ISO VG 100. Arana & Ulacia, Proc. J 233 (2019) 3, \"\n    \"", "Arana & Ulacia, Proc. J 233 (2019) 3"),
        ("by its slopes (", ""),
    ],
)  # fmt: skip
def test_a_source_is_named_by_authors_and_year(before: str, name: str) -> None:
    assert list(citations(f"{before}doi:{DOI}.")) == [(DOI, name)]
