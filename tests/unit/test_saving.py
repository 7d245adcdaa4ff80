import math

import numpy as np
import pytest

from system_models.master import saving

MASTER = {
    "time": 0.1 + 0.2,
    "steps": 2**63,
    "odd": [math.inf, -0.0, 5e-324, None, True, "ü €"],
    "array": "a text, not an array",
    "history": [{"values": np.array([[np.pi, np.nan], [-0.0, np.inf]]), "size": 1e-300}],
    "empty": np.empty((0, 3)),
    "counts": np.array([1, 2], dtype=np.int32),
    "past": ((0.5, 0.25), (np.array([1.0]), np.array([-1e-17])), ()),
    "nothing": {},
}
STATES = {"b": b"\x00\xff" * 5, "a": b""}


def same(found: object, wanted: object) -> bool:
    if isinstance(wanted, np.ndarray):
        assert isinstance(found, np.ndarray)
        return (found.dtype, found.shape, found.tobytes()) == (wanted.dtype, wanted.shape, wanted.tobytes())
    if isinstance(wanted, dict):
        return (
            isinstance(found, dict) and list(found) == list(wanted) and all(same(found[n], wanted[n]) for n in wanted)
        )
    if isinstance(wanted, (list, tuple)):
        return type(found) is type(wanted) and all(same(a, b) for a, b in zip(found, wanted, strict=True))
    return type(found) is type(wanted) and repr(found) == repr(wanted)


def test_states_come_back_bit_for_bit() -> None:
    states, master = saving.unpack(saving.pack(STATES, MASTER))
    assert same(states, STATES)
    assert same(master, MASTER)


def test_random_numbers_come_back_bit_for_bit() -> None:
    bits = np.random.default_rng(7).integers(0, 2**64, 2000, dtype=np.uint64)
    numbers = bits.view(float)
    numbers = numbers[np.isfinite(numbers)]
    _, master = saving.unpack(saving.pack({}, {"floats": numbers.tolist(), "array": numbers}))
    assert np.array(master["floats"]).tobytes() == master["array"].tobytes() == numbers.tobytes()


def test_arrays_come_back_writable() -> None:
    _, master = saving.unpack(saving.pack({}, {"values": np.zeros(2)}))
    master["values"][0] = 1.0
    assert master["values"].tolist() == [1.0, 0.0]


def test_numbers_of_numpy_are_stored_as_numbers() -> None:
    stored = {"size": np.float64(0.1), "count": np.int64(3), "flag": np.bool_(True)}
    _, master = saving.unpack(saving.pack({}, stored))
    assert same(master, {"size": 0.1, "count": 3, "flag": True})


@pytest.mark.parametrize("value", [{1: 2.0}, {1.0}, object()])
def test_what_would_come_back_as_something_else_is_not_stored(value: object) -> None:
    with pytest.raises(TypeError, match="cannot be stored"):
        saving.pack({}, {"value": value})
