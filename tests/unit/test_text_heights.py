"""Heights in text: matrices with any mark between numbers, and points that leave some places out."""

import numpy as np
import pytest
from comparison import approx

from system_models.instruments.text_heights import read

Z = np.round(np.arange(60.0).reshape(6, 10) ** 1.3 / 7.0, 4)


def matrix(mark: str, comma: bool = False) -> bytes:
    rows = [mark.join(f"{value:.4f}" for value in row) for row in Z]
    text = "# heights\n" + "\n".join(rows) + "\n"
    return (text.replace(".", ",") if comma else text).encode()


@pytest.mark.parametrize(
    "content",
    [
        matrix("\t"), matrix(";"), matrix(","), matrix(", "), matrix(" "), matrix("  "), matrix("\t", True),
        matrix(";", True), matrix(" ", True), b"\xef\xbb\xbf" + matrix(";").replace(b"\n", b"\r\n"),
    ],
)  # fmt: skip
def test_a_matrix_is_read_whatever_stands_between_its_numbers(content: bytes) -> None:
    found = read(content)
    assert found is not None and found.spacing is None
    assert found.heights == approx(Z, rel=1e-9)


def test_cells_without_a_number_have_no_height() -> None:
    found = read(matrix(";").replace(b"0.1429", b"---"))
    assert found is not None
    assert np.argwhere(np.isnan(found.heights)).tolist() == [[0, 1]]


def points(order: np.ndarray, noise: float = 0.0) -> bytes:
    y, x = np.divmod(order, 10)
    shift = noise * np.sin(np.arange(len(order)))
    return "\n".join(
        f"{2.0 + 0.5 * (i + d):.5f} {-1.0 + 0.8 * j:.5f} {Z[j, i]:.4f}" for i, j, d in zip(x, y, shift, strict=True)
    ).encode()


def test_points_lie_on_their_lattice_in_any_order_with_gaps() -> None:
    order = np.random.default_rng(1).permutation(60)
    kept = order[order != 34]
    found = read(points(kept, noise=0.01))
    assert found is not None
    assert found.spacing == approx((0.8, 0.5), rel=1e-2)
    assert np.argwhere(np.isnan(found.heights)).tolist() == [[3, 4]]
    there = np.isfinite(found.heights)
    assert found.heights[there] == approx(Z[there], rel=1e-9)


def test_points_all_over_and_rows_of_different_lengths_are_no_heights() -> None:
    scattered = np.random.default_rng(2).uniform(size=(60, 3))
    assert read("\n".join(" ".join(map(str, row)) for row in scattered).encode()) is None
    assert read(b"1 2 3 4\n1 2 3\n") is None
    assert read(b"\x89PNG\r\n\x1a\n\x00\x00") is None
