"""Measured errors and costs shown in the documentation, from measured.json.

`python -m benchmarks.house.fmu_figures` writes that file from the sections of `docs/measured`.
"""

import json
from pathlib import Path
from typing import NamedTuple


class Table(NamedTuple):
    """Measured figures."""

    title: str
    command: str  # that measures them
    measured: str  # date
    older: bool  # than the code
    head: list[str]
    rows: list[list[str]]


_FOUND = json.loads(Path(__file__).with_name("measured.json").read_text(encoding="utf-8"))
ERRORS = {level: tuple(Table(**each) for each in tables) for level, tables in _FOUND["errors"].items()}
COSTS = {level: Table(**each) for level, each in _FOUND["costs"].items()}
