"""The command `tribofmu` of the tree, and what it writes."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import xarray as xr
from golden_record import Record

COMMAND = [sys.executable, str(Path(sys.executable).parent / "tribofmu.py")]
CLOCKS = ("wall_seconds",)  # attributes that differ in every run
ORIGIN = "tribofmu: "  # begins a sentence of ours on stderr


def command(*words: str, fine: tuple[int, ...] = (0,)) -> subprocess.CompletedProcess[str]:
    """Run `tribofmu` in the working folder. Raises RuntimeError if it ends otherwise than it may."""
    done = subprocess.run([*COMMAND, *words], capture_output=True, text=True)
    if done.returncode not in fine:
        raise RuntimeError(f"tribofmu {' '.join(words)} ended with {done.returncode}: {done.stderr[-2000:]}")
    return done


def settings(**tables: dict[str, str]) -> list[str]:
    """Return `--set` for tables of keys; the name of a table comes before its keys."""
    pairs = [f"{name}.{key}={value}" if name != "_" else f"{key}={value}" for name, table in tables.items()
             for key, value in table.items()]  # fmt: skip
    return ["--set", *pairs]


def put_results(record: Record, folder: Path, names: tuple[str, ...] = ("result",)) -> None:
    """Keep every variable, numbers among the attributes, and the table."""
    for name in names:
        with xr.open_dataset(folder / f"{name}.nc") as dataset:
            for variable, values in dataset.load().variables.items():
                record.put(f"{name}.nc, {variable}", values.values)
                _put_attributes(record, f"{name}.nc, {variable}: ", values.attrs)
            _put_attributes(record, f"{name}.nc: ", dataset.attrs)
        record.put(f"{name}.csv", (folder / f"{name}.csv").read_text(encoding="utf-8"))


def _put_attributes(record: Record, prefix: str, attributes: dict) -> None:
    for key, value in attributes.items():
        if key in CLOCKS:
            continue
        if key in ("units", "scene_json"):
            record.put(f"{prefix}{key}", value)
        elif key == "cost":  # of each FMU; seconds among them
            record.put(f"{prefix}steps of FMUs", {name: row["steps"] for name, row in json.loads(value).items()})
        elif isinstance(value, int | float | np.number):
            record.put(f"{prefix}{key}", value)
