"""The exit code of comparisons, of which one disagrees."""

from argparse import Namespace
from pathlib import Path

import pytest

from system_models.cli import validate
from system_models.validation import page, registry
from system_models.validation.model import Comparison, Kind, Outcome, Row, exactly


def compared(computed: float) -> Comparison:
    row = Row("a film", "nm", exactly(100.0), computed, 1.0, "measured")
    return Comparison("A film", Kind.MEASURED, "About it.", "Nobody 1900", lambda: Outcome((row,)))


@pytest.mark.parametrize(("films", "code"), [((100.5, 100.5), 0), ((100.5, 110.0), 1), ((110.0, 100.5), 1)])
def test_one_comparison_that_disagrees_is_enough_to_fail(
    films: tuple[float, ...], code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "COMPARISONS", {f"film_{k}": compared(film) for k, film in enumerate(films)})
    monkeypatch.setattr(page, "write", lambda *given: [])
    assert validate.run(Namespace(names=[], listed=False, out=str(tmp_path))) == code
