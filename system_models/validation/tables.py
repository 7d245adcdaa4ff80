"""The tables in `data/`: see its README for sources and licences."""

import csv
from importlib.resources import files


def read(name: str) -> list[dict[str, float]]:
    """Return the rows of a table, NaN where a cell is empty; lines that begin with # say where it comes from."""
    lines = (files(__package__) / "data" / name).read_text("utf-8").splitlines()
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return [{key: float(value or "nan") for key, value in row.items()} for row in rows]
