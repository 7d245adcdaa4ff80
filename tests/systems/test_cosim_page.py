"""What docs/how-to/cosim.md tells to do works as it stands."""

import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from system_models.charts import files
from system_models.cli.main import main
from system_models.master import reading

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "cosim.md").read_text("utf-8")


def blocks(language: str) -> list[str]:
    found = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    return [text for name, text in found if name == language]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example's files, and the FMUs that its commands have built."""
    folder = tmp_path_factory.mktemp("rig")
    script, python = blocks("python")
    (settings,) = blocks("toml")
    (folder / "block.py").write_text(script)
    (folder / "rig.toml").write_text(settings)
    (folder / "rig.py").write_text(python)
    return folder


def test_the_example_runs_as_it_is_shown(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)
    monkeypatch.setattr(files, "save", lambda sheet, path, dpi=150: path)
    (commands,) = blocks("sh")
    for command in commands.splitlines():
        program, *arguments = shlex.split(command)
        if program == "pythonfmu":
            subprocess.run([sys.executable, "-m", program, *arguments], check=True, capture_output=True)
        else:
            assert (program, main(arguments)) == ("tribofmu", 0)
    printed = capsys.readouterr().out.splitlines()
    (shown,) = blocks("")
    for line in shown.splitlines():
        cells = line.split()
        if cells and cells[0].startswith(("block.x", "contact.")):
            (found,) = [row.split() for row in printed if row.startswith(cells[0])]
            assert found[:2] == cells[:2]
            assert list(map(number, found[2:])) == approx(list(map(number, cells[2:])), rel=1e-2)
    assert "Steps: 2000 to 1 s" in "".join(printed)
    with xr.open_dataset("results/rig/result.nc") as dataset:
        friction = dataset["contact.friction_force"].values
        assert dataset["contact.valid"].values.all()
        assert friction[-1] == approx(0.6 * friction[999], rel=0.05)  # the load falls from 50 N to 30 N
        assert dataset["block.x"].values[-1] == approx(friction[-1] / 20e3, rel=1e-3)  # at rest again
        assert np.abs(dataset["bond.contact.friction_force*block.v"]).max() < 0.1
    names: dict[str, Any] = {}
    exec(Path("rig.py").read_text(), names)
    assert names["dataset"]["block.x"].values[-1] == approx(friction[-1] / 20e3, rel=1e-3)


def number(cell: str) -> float:
    return float({"True": 1, "False": 0}.get(cell, cell))


def test_the_tables_name_every_key() -> None:
    for name, keys in reading._KEYS.items():
        assert f"[{name}]" in PAGE
        for key in keys:
            assert re.search(rf"\b{key}\b", PAGE), key
