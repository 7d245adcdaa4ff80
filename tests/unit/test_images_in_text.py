"""Heights in text become an image in metres, without the library that reads instruments' files."""

from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from contact_core.errors import ContactError
from system_models.instruments.surface_file import _of_text
from system_models.instruments.text_heights import TextHeights

HEIGHTS = np.arange(16.0 * 32.0).reshape(16, 32)  # rows along y


def test_a_matrix_is_as_long_as_it_is_told_along_each_axis() -> None:
    """0.8 mm along y over 16 rows, 6.4 mm along x over 32 columns; heights in um."""
    image = _of_text(Path("a.txt"), "", TextHeights(HEIGHTS, None), "um", (6.4e-3, 0.8e-3))
    assert image.spacing == approx((0.05e-3, 0.2e-3))
    assert image.heights[1, 0] == approx(32e-6)


def test_points_say_their_spacing_in_the_unit_of_their_heights() -> None:
    image = _of_text(Path("a.txt"), "", TextHeights(HEIGHTS, (2.0, 5.0)), "um", None)
    assert image.spacing == approx((2e-6, 5e-6))


@pytest.mark.parametrize(
    ("spacing", "unit", "size", "said"),
    [
        (None, None, (1e-3, 1e-3), "in which unit"),
        (None, "um", None, "how large it is. Give --size"),
        ((1.0, 1.0), "um", (1e-3, 1e-3), "Leave --size out"),
        (None, "s", (1e-3, 1e-3), "no length"),
    ],
)
def test_what_text_does_not_say_is_asked_back(
    spacing: tuple[float, float] | None, unit: str | None, size: tuple[float, float] | None, said: str
) -> None:
    with pytest.raises(ContactError, match=said):
        _of_text(Path("a.txt"), "", TextHeights(HEIGHTS, spacing), unit, size)
