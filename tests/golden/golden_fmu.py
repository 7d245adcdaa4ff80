"""FMUs of three scenes in both flavours, each driven by a host in a process of its own."""

import json
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from golden_command import command
from golden_laws import ELLIPSE, LINE, SMALL
from golden_record import Record

SCENES = {
    "mtm_zddp": ("mtm_zddp", SMALL),
    "regression level": ("mtm_zddp", SMALL | {"film.model": "regression"}),
    "line": ("fzg_flank", LINE),
    "ellipse with field of heat": ("mtm_zddp", ELLIPSE | {"heat.model": "field", "heat.bulk.model": "inputs"}),
}
FLAVOURS = ("embedded", "isolated")
TOLD = ("name", "valueReference", "causality", "variability", "initial")
KINDS = ("Real", "Integer", "Boolean", "String", "Enumeration")


def runs(before: Any) -> Iterator[tuple[str, Callable[[Record], None]]]:
    """Return the names and functions of all runs."""
    for name in SCENES:
        for flavour in FLAVOURS[:1] if "ellipse" in name else FLAVOURS:
            yield f"{name}, {flavour}", partial(_run, name, flavour)


def _run(name: str, flavour: str, record: Record) -> None:
    scene, overrides = SCENES[name]
    file = Path(f"{name.replace(' ', '_')}_{flavour}.fmu")
    changes = [f"{key}={value}" for key, value in overrides.items()]
    python = ["--python"] if flavour == "isolated" else []
    command("build", scene, "--out", str(file), "--flavour", flavour, *python, "--set", *changes)
    folder = Path(file.stem)
    with zipfile.ZipFile(file) as archive:
        archive.extractall(folder)
        for part in sorted(archive.namelist()):
            if part.endswith(".csv"):  # of reference
                record.put(f"file {part}", archive.read(part).decode())
    _describe(record, folder)
    host = [sys.executable, str(Path(__file__).with_name("golden_host.py")), str(folder.absolute()), "seen.json"]
    done = subprocess.run(host, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"The host has ended with {done.returncode}: {done.stderr[-2000:]}")
    record.values |= json.loads(Path("seen.json").read_text())


def _describe(record: Record, folder: Path) -> None:
    """What modelDescription.xml says of the model's abilities and of each variable."""
    root = ElementTree.parse(folder / "modelDescription.xml").getroot()
    slave = root.find("CoSimulation")
    record.put("abilities", {key: value for key, value in sorted(slave.attrib.items())})
    for variable in root.find("ModelVariables"):
        kind = next(part for part in variable if part.tag in KINDS)
        said = {key: variable.get(key) for key in TOLD} | {"kind": kind.tag}
        record.put(f"variable {variable.get('name')}", said | {key: kind.get(key) for key in sorted(kind.attrib)})
    for unit in root.iter("Unit"):
        record.put(f"unit {unit.get('name')}", [dict(sorted(part.attrib.items())) for part in unit])
    structure = root.find("ModelStructure")
    told = [f"{part.tag} {sorted(unknown.attrib.items())}" for part in structure for unknown in part]
    record.put("structure", "\n".join(told))
