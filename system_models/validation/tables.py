"""The measurements in `data/`: see its README for sources and licences."""

import csv
from importlib.resources import files


def read(name: str) -> list[dict[str, float]]:
    """Return the rows of a table of measurements."""
    text = (files(__package__) / "data" / name).read_text("utf-8")
    return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(text.splitlines())]
