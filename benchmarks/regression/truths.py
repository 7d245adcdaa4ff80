"""Solutions of a few contacts at the deterministic level, for tests of the error outputs of the regression level.

    python -m benchmarks.regression.truths               # 20 min
    python -m benchmarks.regression.truths --tribofilms  # 10 min
    python -m benchmarks.regression.truths --anew "beyond line 3" "fresh line 0"

Random contacts that no curve was fitted to (the seed `check` of regression_shapes.py): within the fit, beyond it, and
rubbed for ten minutes. Writes tests/golden/regression_level.json; what stands there is kept. With --anew: solves contacts that
stand there, new ones by name, in place. With --tribofilms: solves the contacts named in
tests/golden/regression_level_tribofilms.json anew.
"""

import argparse
import json
from collections.abc import Iterator
from dataclasses import asdict, replace
from typing import Any

from benchmarks.folders import ROOT
from benchmarks.regression.shapes_points import CHECK, MINUTES, RUBBED, RUNS, ShapePoint, points
from contact_core import OperatingPoint, Scene, advance, initial_state
from contact_core.surfaces.track_means import means_of

GOLDEN = ROOT / "tests" / "golden" / "regression_level.json"
TRIBOFILMS = GOLDEN.with_name("regression_level_tribofilms.json")
COUNT = 8  # of each shape
HEAVIEST = {"line": 1500.0, "circle": 75.0}  # N: others take long
BEYOND = {f"surface_{i}.microroughness.rms": "0 m" for i in (1, 2)}  # solids that touch at the floor alone
TRUTHS = ("friction_coefficient", "h_c", "contact_load_ratio", "unconverged")


def cases() -> Iterator[tuple[str, ShapePoint, dict[str, str], float]]:
    """Name, contact, changes of its scene, and for how long it rubs [s]."""
    for shape, heaviest in HEAVIEST.items():
        for k, drawn in enumerate(points(shape, CHECK, COUNT)):
            point = replace(drawn, load=min(drawn.load, heaviest))
            yield f"fresh {shape} {k}", point, {}, 0.0
            yield f"beyond {shape} {k}", point, BEYOND, 0.0
    for k, drawn in enumerate(points("line", RUBBED, RUNS)):
        yield f"rubbed line {k}", drawn, {}, 60.0 * MINUTES


def solved(point: ShapePoint, changes: dict[str, str], rubbed: float) -> dict[str, Any]:
    """A contact, so that a test can build it, and what the deterministic level says of it."""
    scene, op = point.build(changes), point.operating_point
    state, out = advance(scene, op, initial_state(scene), rubbed)
    return {
        "scene": scene.name,
        "changes": changed(scene),
        "point": {name: value for name, value in asdict(op).items() if value is not None},
        "means": [asdict(mean) for mean in means_of(scene, state)] if rubbed else None,
        "truth": {name: getattr(out, name) for name in TRUTHS},
    }


def changed(scene: Scene) -> dict[str, Any]:
    """Differences from the shipped scene of this name, by dotted names."""
    shipped = flat(Scene.from_toml(scene.name).to_dict())
    ours = {name: value for name, value in flat(scene.to_dict()).items() if name != "intervals"}
    return {name: value for name, value in ours.items() if shipped.get(name) != value}


def flat(tree: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    found = {}
    for name, value in tree.items():
        found |= flat(value, f"{prefix}{name}.") if isinstance(value, dict) else {f"{prefix}{name}": value}
    return found


def tribofilms() -> None:
    """Solve anew the tribofilms of circles that have rubbed, in place."""
    rows = json.loads(TRIBOFILMS.read_text())
    for name, row in rows.items():
        scene = Scene.from_toml(row["scene"], {key: str(value) for key, value in row["changes"].items()})
        _, out = advance(scene, OperatingPoint(**row["point"]), initial_state(scene), row["seconds"])
        row["truth"] = {body: getattr(out, body) for body in row["truth"]}
        print(name, row["truth"], flush=True)
        TRIBOFILMS.write_text(json.dumps(rows, indent=1) + "\n")


def anew(names: list[str]) -> None:
    """Solve stored contacts on new surfaces anew, in place."""
    rows = json.loads(GOLDEN.read_text())
    for name in names:
        row = rows[name]
        scene = Scene.from_toml(row["scene"], {key: str(value) for key, value in row["changes"].items()})
        _, out = advance(scene, OperatingPoint(**row["point"]), initial_state(scene), 0.0)
        row["truth"] = {key: getattr(out, key) for key in TRUTHS}
        print(name, row["truth"], flush=True)
    GOLDEN.write_text(json.dumps(rows, indent=1) + "\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tribofilms", action="store_true")
    parser.add_argument("--anew", nargs="+", metavar="NAME")
    arguments = parser.parse_args()
    if arguments.tribofilms:
        tribofilms()
        return
    if arguments.anew:
        anew(arguments.anew)
        return
    rows = json.loads(GOLDEN.read_text()) if GOLDEN.exists() else {}
    for name, *case in cases():
        if name not in rows:
            rows[name] = solved(*case)
            print(name, rows[name]["truth"], flush=True)
            GOLDEN.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
