"""Rows of a simulation that goes on: those of its checkpoint, then the new ones."""

from types import SimpleNamespace

import numpy as np

from system_models.master.recorder import Recorder

PORTS = [
    SimpleNamespace(name="a.x", kind="real", variable=SimpleNamespace(type="Real", unit="m", description="place")),
    SimpleNamespace(name="a.on", kind="boolean", variable=SimpleNamespace(type="Boolean", unit=None, description="")),
    SimpleNamespace(name="a.n", kind="integer", variable=SimpleNamespace(type="UInt64", unit=None, description="")),
]
ROWS = [
    (0.0, [0.5, True, 0], (0.0, 0.0, 0.0, 0.0)),
    (0.1, [0.1 + 0.2, False, 1], (0.1, 3.0, 0.7, 0.2)),
    (0.3, [-1.0, True, 2**64 - 1], (0.2, 1.0, 0.0, 0.9)),
]


def recorder() -> Recorder:
    coupled = SimpleNamespace(wiring=SimpleNamespace(output_place={"a.x": 0}), system=SimpleNamespace(bonds=[]))
    return Recorder(coupled, PORTS)  # type: ignore[arg-type]


def test_restored_rows_stand_in_their_order_before_new_ones() -> None:
    whole, first, again = recorder(), recorder(), recorder()
    for row in ROWS:
        whole.add(row)
    for row in ROWS[:2]:
        first.add(row)
    again.restore(first.table(0))
    again.add(ROWS[2])
    assert again.count == 3
    found, expected = again.dataset({"title": "x"}), whole.dataset({"title": "x"})
    assert found.identical(expected)
    assert found["a.x"].values.tolist() == [0.5, 0.1 + 0.2, -1.0]
    assert found["a.on"].values.tolist() == [True, False, True]
    assert found["a.n"].values.tolist() == [0, 1, 2**64 - 1]
    assert found["master.iterations"].values.tolist() == [0.0, 3.0, 1.0]


def test_a_table_from_a_row_on_has_the_rows_since_then() -> None:
    some = recorder()
    for row in ROWS:
        some.add(row)
    np.testing.assert_array_equal(some.table(1), some.table(0)[1:])
    assert some.table(3).size == 0
