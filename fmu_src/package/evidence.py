"""Reference data in the FMU: a short run of its contact, so that an importer can check itself.

Layout: the FMI layered standard for references (fmi-ls-ref, 1.0.0-alpha.1), a manifest, stimuli, expected outputs.
"""

from collections.abc import Iterable, Iterator
from dataclasses import asdict, replace
from itertools import pairwise
from pathlib import Path
from string import Template
from xml.etree import ElementTree as ET

from contact_core import ContactError, OperatingPoint, Outputs, advance, initial_state
from contact_core.scene import Scene

from ..variables import first_point, variables

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
EXPERIMENT, STIMULI, EXPECTED = "steps.exp", "steps-in.csv", "steps-ref.csv"
TOLERANCE = 1e-4
TIMES = (0.0, 10.0, 14.0, 16.0, 17.0, 17.5)  # s: steps of different length, exact in binary
COMPARED = (
    "friction_force",
    "friction_coefficient",
    "power_loss",
    "dfriction_dload",
    "h_c",
    "contact_load_ratio",
    "contact_area_ratio",
    "approach",
    "tribofilm_1",
    "tribofilm_2",
    "wear_depth_1",
    "wear_depth_2",
    "valid",
)

_PURPOSE = "Replay of five steps: a change of load, of speed, a reversal and pure rolling"
_EXPLAINED = Template(Path(__file__).with_name("fmi-ls-ref.txt.in").read_text("ascii")).substitute(
    purpose=_PURPOSE, stimuli=f"{FOLDER}/{STIMULI}", expected=f"{FOLDER}/{EXPECTED}", tolerance=f"{TOLERANCE:g}"
)
_LAYERED_STANDARD = {
    "fmi-ls-name": "org.fmi-standard.fmi-ls-ref",
    "fmi-ls-version": "1.0.0-alpha.1",
    "fmi-ls-description": "Layered Standard providing information on related files included in an FMU.",
}
_NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"


def reference(scene: Scene) -> dict[str, bytes]:
    """Return name and content of every file of the reference data. Solves the contact at five operating points."""
    points, names = _points(scene), [v.name for v in variables(scene) if v.causality == "input"]
    inputs = [{name: getattr(point, name) for name in names} for point in points]
    outputs = [{name: found[name] + 0.0 for name in COMPARED} for found in _outputs(scene, points)]  # + 0.0: no -0
    return {
        f"{FOLDER}/fmi-ls-manifest.xml": _manifest(),
        f"{FOLDER}/{EXPERIMENT}": _experiment(),
        f"{FOLDER}/{STIMULI}": _table(TIMES[:-1], inputs, "r"),
        f"{FOLDER}/{EXPECTED}": _table(TIMES, outputs, ".9g"),
        "documentation/fmi-ls-ref.txt": _EXPLAINED.encode(),
    }


def _points(scene: Scene) -> list[OperatingPoint]:
    """Return the operating point of each step, beginning with the start values."""
    first = first_point(scene)
    lighter = replace(first, load=0.6 * first.load)
    slower = replace(lighter, speed_1=0.5 * first.speed_1, speed_2=0.5 * first.speed_2)
    back = replace(slower, speed_1=-slower.speed_1, speed_2=-slower.speed_2)
    rolling = replace(back, speed_1=back.entrainment_speed, speed_2=back.entrainment_speed)
    return [first, lighter, slower, back, rolling]


def _outputs(scene: Scene, points: list[OperatingPoint]) -> Iterator[dict[str, float]]:
    """Yield outputs after initialisation and after each step; like the FMU, unchanged where there is no solution."""
    state, found = initial_state(scene), Outputs()
    steps = [0.0, *(end - start for start, end in pairwise(TIMES))]
    for dt, point in zip(steps, [points[0], *points], strict=True):
        valid = True
        try:
            state, found = advance(scene, point, state, dt)
        except ContactError:
            valid = False
        yield asdict(found) | {"valid": valid}


def _table(times: Iterable[float], rows: list[dict[str, float]], digits: str) -> bytes:
    """Return a CSV table with a header of names."""
    lines = [",".join(["time", *rows[0]])]
    for time, row in zip(times, rows, strict=True):
        values = (repr(x) if digits == "r" else f"{x:{digits}}" for x in row.values())
        lines.append(",".join([repr(time), *values]))
    return ("\n".join(lines) + "\n").encode()


def _manifest() -> bytes:
    root = ET.Element("fmiReferences", {f"{{{_NAMESPACE}}}{name}": text for name, text in _LAYERED_STANDARD.items()})
    ET.SubElement(
        root,
        "Related",
        {
            "source": EXPERIMENT,
            "role": "experiment/smoke-test",
            "type": "application/x-ma-hs-experiments",
            "description": _PURPOSE,
        },
    )
    return _xml(root)


def _experiment() -> bytes:
    root = ET.Element(
        "Experiments", {"name": "Replay", "description": "Outputs of this FMU on the machine that built it"}
    )
    experiment = ET.SubElement(
        root,
        "Experiment",
        {
            "name": "steps",
            "description": f"{_PURPOSE}; the steps are those between the rows of {EXPECTED}",
            "startTime": repr(TIMES[0]),
            "stopTime": repr(TIMES[-1]),
            "tolerance": repr(TOLERANCE),
        },
    )
    ET.SubElement(experiment, "Stimuli", {"source": STIMULI, "type": "text/csv"})
    ET.SubElement(experiment, "References", {"source": EXPECTED, "type": "text/csv"})
    return _xml(root)


def _xml(root: ET.Element) -> bytes:
    ET.register_namespace("fmi-ls", _NAMESPACE)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
