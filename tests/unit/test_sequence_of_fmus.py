"""In which order FMUs of a loop step: a change of the schedule arrives within the step."""

from itertools import permutations
from types import SimpleNamespace

import pytest

from system_models.master.sequence import blocks
from system_models.master.settings import Settings

RING = [("a", "b"), ("b", "c"), ("c", "a")]


def port(name: str, variable: str) -> SimpleNamespace:
    return SimpleNamespace(name=f"{name}.{variable}", model=SimpleNamespace(name=name))


@pytest.mark.parametrize(("first", "expected"), [("a", "abc"), ("b", "bca"), ("c", "cab")])
@pytest.mark.parametrize("listed", [*permutations("abc")][::2])
def test_a_loop_begins_where_the_schedule_acts_and_goes_on_with_what_it_reaches(
    first: str, expected: str, listed: tuple[str, ...]
) -> None:
    """Whatever their names: outputs that follow their inputs a step later leave the order open otherwise."""
    connections = [SimpleNamespace(source=port(one, "y"), target=port(other, "u")) for one, other in RING]
    system = SimpleNamespace(connections=connections, schedule={f"{first}.load": [(0.0, 1.0)]})
    instances = {name: SimpleNamespace(feedthrough=False, inputs=SimpleNamespace(names=["u"])) for name in listed}
    inputs = [f"{name}.u" for name in listed]
    (block,) = blocks(system, instances, inputs, Settings(1.0, 0.1, "gauss_seidel"))  # type: ignore[arg-type]
    assert "".join(block.names) == expected
    fresh = {name: len(which) for name, which in block.sequence}
    assert fresh == {name: int(name != first) for name in "abc"}
