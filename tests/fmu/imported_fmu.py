"""What an importer must know of an FMU, read without any importer."""

from __future__ import annotations

import zipfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree


@dataclass(frozen=True)
class Fmu:
    """An FMU: the version of FMI, names of its Real outputs, and value references by name."""

    path: Path
    fmi: int
    identifier: str
    token: str
    outputs: tuple[str, ...]
    by_name: dict[str, int]

    @property
    def real(self) -> str:
        """FMI's name of the type of a Real."""
        return "Real" if self.fmi == 2 else "Float64"

    def references(self, names: Iterable[str]) -> list[int]:
        return [self.by_name[name] for name in names]

    @classmethod
    def read(cls, path: Path, outputs: Iterable[str] = ()) -> Fmu:
        """The FMU in a file; `outputs` in place of its own: in this order."""
        with zipfile.ZipFile(path) as archive:
            root = ElementTree.fromstring(archive.read("modelDescription.xml"))
        fmi = int(root.attrib["fmiVersion"][0])
        token = root.attrib["guid" if fmi == 2 else "instantiationToken"]
        variables = root.findall("ModelVariables/*")
        found = [
            v.attrib["name"]
            for v in variables
            if v.get("causality") == "output" and (v.tag == "Float64" or v.find("Real") is not None)
        ]
        return cls(
            path,
            fmi,
            root.find("CoSimulation").attrib["modelIdentifier"],
            token,
            tuple(outputs) or tuple(found),
            {v.attrib["name"]: int(v.attrib["valueReference"]) for v in variables},
        )
