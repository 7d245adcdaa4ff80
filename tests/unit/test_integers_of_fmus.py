"""Integers on their way from one FMU to another: whatever the target's C type cannot hold is refused, not wrapped."""

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from system_models.fmu.errors import CouplingError
from system_models.master.system import Connection, Port

BITS = {"Int8": 8, "Int16": 16, "Int32": 32, "Integer": 32, "Int64": 64}
TYPES = {name: (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for name, bits in BITS.items()}
TYPES |= {f"U{name}": (0, 2**bits - 1) for name, bits in BITS.items() if name != "Integer"}


def port(type_: str) -> Port:
    model: Any = SimpleNamespace(name="a")
    variable: Any = SimpleNamespace(name="i", type=type_, dimensions=[], variability="discrete")
    return Port(model, variable)


@given(type_=st.sampled_from(sorted(TYPES)), beyond=st.integers(1, 2**63), below=st.booleans())
def test_the_ends_of_a_type_pass_and_all_beyond_is_refused(type_: str, beyond: int, below: bool) -> None:
    wire = Connection(port("Int64"), port(type_), 1.0, 0.0)
    end = TYPES[type_][0 if below else 1]
    assert wire.result(end) == end
    value = end - beyond if below else end + beyond
    with pytest.raises(CouplingError, match=f"'a.i' = {value} is beyond what {type_}, its type, can hold"):
        wire.result(value)


def test_a_number_that_single_precision_makes_infinite_is_refused() -> None:
    wire = Connection(port("Int64"), port("Float32"), 1.0, 0.0)
    assert wire.result(2**60) == 2**60
    with pytest.raises(CouplingError, match="beyond what Float32"):
        wire.result(2**200)
