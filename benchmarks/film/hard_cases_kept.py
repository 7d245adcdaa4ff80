"""Kept rows of the hard cases: results/film/hard_cases, all with the same columns."""

import csv
from dataclasses import fields
from pathlib import Path
from typing import Any

from benchmarks.claims import kept
from benchmarks.film.independent import Judgement
from benchmarks.film.random_points import Point

NODES, TOLERANCE = 129, 3e-3
GRIDS = (65, 129, 257)
SAID = ("iterations", "pressure_change", "load_error", "h_c", "h_min", "contact_load_ratio", "contact_area_ratio")

COLUMNS = (
    *("case", "name", "nodes", *(entry.name for entry in fields(Point)), "moes_load", "formula_film", "ms"),
    *("converged", "shortfall", "algorithm", *SAID, *(entry.name for entry in fields(Judgement))),
)


def folder() -> Path:
    """Where solved points are kept."""
    return kept("film/hard_cases")


def read(path: Path) -> list[dict[str, str]]:
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def add(path: Path, row: dict[str, Any]) -> None:
    """Add a line to a file of comma-separated values; the columns are the same in all of them."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = not path.exists()
    with path.open("a", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="")
        if new:
            writer.writeheader()
        writer.writerow(row)
    print(*(f"{value:.3g}" if isinstance(value, float) else value for value in row.values()), flush=True)
