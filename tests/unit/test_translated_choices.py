"""A choice between a whole and another number in C is the one that Python takes."""

import shutil
from pathlib import Path

import pytest
from translated import translated, unknown

pytestmark = [pytest.mark.unit, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]


def whole_first(x, y):
    count = 0
    while count < y:
        count += 1
    return (count if x > 0.0 else 0.5 * x), (1 if x > 1.0 else 0.75 * y)


def test_a_whole_number_does_not_cut_the_other_one(tmp_path: Path) -> None:
    in_c = translated(tmp_path, whole_first, unknown(2))
    for x, y in ((2.0, 3.0), (0.5, 3.0), (-0.5, 2.5)):
        assert tuple(in_c(x, y)) == whole_first(x, y)
