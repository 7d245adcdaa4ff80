"""A long simulation needs memory for its rows, and for nothing else."""

import gc
import sys
from typing import Any

import pytest
from built import Built
from memory import allocated, new_objects_only

from benchmarks.models import systems
from system_models.master import simulate

ROW = 8 * (1 + 1 + 4)  # bytes: time, one output, how the step went
SLACK = 50_000  # bytes; one saved state a step would be more
BLOCKS = 500  # small objects of Python


@pytest.mark.parametrize(
    ("steps", "fmi", "options"),
    [
        (3_000, 2, {}),
        (2_000, 3, {"iterate": "aitken", "order": 1}),
        pytest.param(700, 2, {"tolerance": 1e-7, "order": 2}, marks=pytest.mark.long),
    ],
    ids=["saved in every step", "FMI 3, iterated", "with error control"],
)
def test_memory_stays_flat(built: Built, steps: int, fmi: int, options: dict[str, Any]) -> None:
    seen: list[int] = []
    blocks: list[int] = []
    calls = 0

    def watch(time: float) -> None:
        nonlocal calls
        calls += 1
        if calls % (steps // 20) == 0:
            gc.collect()
            seen.append(allocated())
            blocks.append(sys.getallocatedblocks())

    end = 2.0 if "tolerance" in options else steps * 1e-3
    case = systems.two_mass_force(built.models, fmi=fmi)
    with new_objects_only():
        result = simulate(case.system, end, 1e-3, outputs=["one.x"], progress=watch, **options)
    assert result.attrs["steps"] >= steps
    assert len(seen) >= 10
    # Rows are kept in arrays that grow by an eighth, and are copied then.
    assert seen[-1] - seen[len(seen) // 5] <= 2 * ROW * len(result.time) + SLACK
    assert blocks[-1] - blocks[len(blocks) // 5] < BLOCKS
