"""docs/extending.md, followed to the letter: each extension works, and touches the files that the page names alone."""

import csv
import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from comparison import HARD, approx
from page import ROOT, Tree, examples, section

LAW, SHAPE, OUTPUT = "A tribofilm law", "A shape", "An output"
SCHEME = "A coupling scheme"

LAW_FILES = {"contact_core/laws/tribofilm/quinn.py", "contact_core/laws/tribofilm/__init__.py"}
LAW_DATA = "contact_core/data/tribofilms.toml"
SHAPE_FILES = {"contact_core/shapes/barrel.py", "contact_core/shapes/__init__.py"}
OUTPUT_ROW = "contact_core/quantities.py"
OUTPUT_FILES = {"contact_core/deterministic/observed.py", "contact_core/regression/outputs.py"}
SCHEME_FILES = {
    "system_models/numerics/algorithms.py",
    "system_models/numerics/iteration.py",
}

_CHEAP = {
    "film.points": "33",
    "surface_1.correlation_length": "32 um",
    "surface_2.correlation_length": "32 um",
    "film.tolerance": "1e-2",
    "film.iterations": "60",
}
_START = f"""
import json
from contact_core import Scene, advance, initial_state, solve, track_of, uncertainty
CHEAP, HARD = {_CHEAP!r}, {HARD!r}
def scene_of(name="mtm_zddp", **changes):
    return Scene.from_toml(name, CHEAP | {{key.replace("__", "."): value for key, value in changes.items()}})
"""
_LOADED = """
from matplotlib.figure import Figure
from system_models.run import contact, report
from system_models.store import results
Figure.savefig = lambda figure, file, **options: open(file, "wb").close()
scene = scene_of()
advance(scene, scene.operation.point, initial_state(scene), 1.0)
"""
_FMU = """
import zipfile
from pathlib import Path
from fmu_src.package.build import build
def package_of(scene):
    with zipfile.ZipFile(build(scene, Path("contact.fmu"), "embedded")) as package:
        page = package.read("documentation/index.html").decode()
        return package.read("modelDescription.xml").decode(), page
"""


def extended(folder: Path, *titles: str, without: str = "") -> Tree:
    tree = Tree(folder)
    written = set[str]()
    for title in titles:
        written |= tree.follow(title, without)
    assert tree.changed() == written
    return tree


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tree]:
    """Return the packages with all extensions of the page, with kernels loaded, and pictures that are not rendered."""
    whole = extended(tmp_path_factory.mktemp("tree"), LAW, SHAPE, OUTPUT, SCHEME)
    try:
        yield whole.warmed(_START + _FMU + _LOADED)
    finally:
        whole.close()


@pytest.fixture
def extend(tmp_path: Path) -> Iterator[Callable[..., Tree]]:
    """Return what extends the packages by sections of the page, without one of their files."""
    trees: list[Tree] = []

    def make(*titles: str, without: str) -> Tree:
        trees.append(extended(tmp_path, *titles, without=without))
        return trees[-1]

    yield make
    for each in trees:
        each.close()


def found_by(tree: Tree, code: str) -> Any:
    return json.loads(tree.python(_START + code).splitlines()[-1])


def columns(tree: Tree, name: str) -> list[dict[str, str]]:
    """Return the rows of the result that a run has written."""
    with (tree.folder / "work" / "results" / name / "result.csv").open(encoding="utf-8") as file:
        heading, *rows = csv.reader(line for line in file if not line.startswith("#"))
    return [dict(zip((name.partition(" [")[0] for name in heading), row, strict=True)) for row in rows]


@pytest.mark.parametrize(
    ("title", "files"),
    [
        (LAW, LAW_FILES | {LAW_DATA}),
        (SHAPE, SHAPE_FILES),
        (OUTPUT, OUTPUT_FILES | {OUTPUT_ROW}),
        (SCHEME, SCHEME_FILES),
    ],
)
def test_an_extension_touches_so_many_files(title: str, files: set[str]) -> None:
    assert {block.file for block in section(title) if block.file} == files


def test_the_law_grows_its_closed_form_at_both_levels(tree: Tree) -> None:
    found = found_by(
        tree,
        """
from contact_core.laws.tribofilm import Quinn
law = Scene.from_toml("mtm_zddp", {"tribofilm.set": "quinn_80c"}).tribofilm
assert isinstance(law, Quinn)
found = {"rate": law.rate(353.15)}
for level in ("deterministic", "regression"):
    changes = HARD | {"tribofilm.set": "quinn_80c", "heat": "none", "wear": "none", "control.driver": "dry"}
    scene = scene_of(**changes).at_level(level)  # microroughness would touch on a part of a node
    state, point = initial_state(scene), scene.operation.point
    if level == "regression":
        _, out = advance(scene, point, state, 30.0)
        found["step"] = out.tribofilm_2
    for step in (1.0, 7.0, 22.0):
        state, out = advance(scene, point, state, step)
    found[level] = [out.tribofilm_2, out.coverage_2]
    if level == "deterministic":
        found["thickest"] = float(track_of(scene, state, 2).tribofilm.max())
print(json.dumps(found))
""",
    )
    closed = (2.0 * found["rate"] * 30.0) ** 0.5
    assert found["rate"] == approx(100e-9**2 / (2.0 * 7200.0), rel=0.01)  # 100 nm after 2 h, as the set says
    assert found["thickest"] == approx(closed, rel=1e-9)  # a node that has been rubbed in every pass
    mean, coverage = found["regression"]
    assert mean == approx(coverage * closed, rel=0.02)  # of the part of the track that is rubbed, which grows a little
    assert mean == approx(found["step"], rel=1e-3)
    assert 0.0 < found["deterministic"][0] < closed


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
@pytest.mark.long
def test_the_law_is_in_the_c_of_a_native_fmu(tree: Tree) -> None:
    found = found_by(
        tree,
        f"""
import sys
from pathlib import Path
sys.path.append({str(ROOT)!r})
from benchmarks.fmu.native_contact import NativeContact, differences
scene = scene_of(tribofilm__set="quinn_80c").at_level("regression")
contact = NativeContact(scene, Path.cwd(), "gcc", "-O0")
print(json.dumps(["quinn_evolve" in contact.sources["contact.c"], differences(scene, contact, 2, 5)]))
""",
    )
    written, differences = found
    assert written
    assert differences["tribofilm_2"] < 1e-9


def test_the_law_is_in_the_fmu_and_law_and_output_are_in_the_results(tree: Tree) -> None:
    description, page = json.loads(
        tree.python(_START + _FMU + 'print(json.dumps(package_of(scene_of(tribofilm__set="quinn_80c"))))')
    )
    assert 'name="tribofilm.diffusion"' in description
    assert "tribofilm: quinn" in page
    assert "Quinn 1983" in page
    (code,) = examples(LAW, "python")
    film, coverage = map(float, tree.python(code).split())
    closed = 100e-9 * 0.5**0.5  # of a point that is rubbed all the time: the covered part is for some of it
    assert 0.6 * coverage * closed < film < coverage * closed
    (line,) = examples(LAW, "sh")
    tree.command(line)
    last = columns(tree, "mtm_zddp")[-1]
    assert float(last["tribofilm_1"]) > 5e-9
    assert float(last["asperity_pressure"]) > 1e8  # the output of the page


def test_the_law_obeys_what_every_law_of_its_slot_must(tree: Tree) -> None:
    """All random examples of the battery are of the law of the page."""
    printed = tree.python(
        f"""
import os, sys
os.environ["TRIBOFMU_TEST_EXAMPLES"] = "5"
import pytest
from contact_core.laws import SLOTS
from contact_core.laws.tribofilm import Quinn
assert Quinn in SLOTS["tribofilm"]
SLOTS["tribofilm"] = (Quinn,)
battery = {str(ROOT / "tests" / "properties" / "test_law_battery.py")!r}
sys.exit(pytest.main([battery, "-vv", "-p", "no:cacheprovider", "-k", "tribofilm or exposes"]))
"""
    )
    assert "[tribofilm-quinn] PASSED" in printed
    assert "test_a_tribofilm_after_two_times_is_that_after_their_sum PASSED" in printed


def test_a_law_without_its_entry_is_refused_by_name(extend: Callable[..., Tree]) -> None:
    tree = extend(LAW, without="contact_core/laws/tribofilm/__init__.py")
    said = tree.python(_START + 'scene_of(tribofilm__set="quinn_80c")', fails=True)
    assert "[tribofilm] has no model 'quinn'." in said
    assert "Known are none, ghanbarzadeh" in said


def test_the_shape_obeys_hertz_and_ends_where_its_face_does(tree: Tree) -> None:
    (code,) = examples(SHAPE, "python")
    pressure, hertz = map(float, tree.python(code).split())
    assert pressure == approx(hertz, rel=2e-3)
    found = found_by(
        tree,
        code.replace('"0.4 mm"', '"0.2 mm"')
        + """
found = solve(scene, scene.operation.point, initial_state(scene), dry=True)
print(json.dumps([found.pressure.max(), float(abs(found.y[found.pressure.any(axis=1)]).max())]))
""",
    )
    assert found[1] <= 0.1e-3  # of the face
    assert found[0] > 1.2 * hertz  # its ends carry more


def test_the_shape_runs_at_both_levels_and_in_the_fmu(tree: Tree) -> None:
    found = found_by(
        tree,
        _FMU
        + """
point = scene_of(operation__load="20 N", control__driver="mixed", geometry__radius_y="30 mm")
table = point.to_dict()
barrel = Scene.from_dict(table | {"geometry": table["geometry"] | {"model": "barrel", "length": "0.4 mm"}})
found = [
    [advance(s, s.operation.point, initial_state(s), 1.0)[1].h_c
     for s in (point.at_level(level), barrel.at_level(level))]
    for level in ("deterministic", "regression")
]
print(json.dumps([*found, *package_of(barrel)]))
""",
    )
    (point, barrel), by_formula, description, page = found
    assert barrel == approx(point, rel=0.05)  # the ellipse ends within the face
    assert by_formula[0] == by_formula[1] > 0.0
    assert 'name="radius_y"' in description
    assert "A roller of the length l with a crown" in page


@pytest.mark.long
def test_a_shape_without_its_entry_is_refused_by_name(extend: Callable[..., Tree]) -> None:
    tree = extend(SHAPE, without="contact_core/shapes/__init__.py")
    said = tree.python(_START + 'scene_of(geometry__model="barrel")', fails=True)
    assert "[geometry] has no model 'barrel'." in said


def test_the_output_has_its_value_at_both_levels(tree: Tree) -> None:
    found = found_by(
        tree,
        """
found = {}
for level in ("deterministic", "regression"):
    scene = scene_of(control__driver="mixed").at_level(level)
    state, out = advance(scene, scene.operation.point, initial_state(scene), 1.0)
    load, hertz = scene.operation.load, scene.hertz(scene.operation.load)
    area = out.contact_area_ratio * 3.141592653589793 * hertz.a * hertz.b
    found[level] = [out.asperity_pressure, out.contact_load_ratio * load / area, scene.plasticity.hardness]
    unloaded = advance(scene, type(scene.operation.point)(0.0, 0.1, 0.1, 353.15), state, 1.0)[1]
    found[level] += [unloaded.asperity_pressure]
    if level == "deterministic":
        found["error"] = uncertainty(scene, state)["asperity_pressure"]
print(json.dumps(found))
""",
    )
    for level, close in (("deterministic", 0.05), ("regression", 1e-9)):
        pressure, expected, hardness, unloaded = found[level]
        assert pressure == approx(expected, rel=close)
        assert 0.0 < pressure < hardness
        assert unloaded == 0.0
    assert sum(found["error"]) > 0.0


def test_the_output_is_in_the_fmu(tree: Tree) -> None:
    (code,) = examples(OUTPUT, "python")
    assert float(tree.python(code)) > 1e8
    description, page = json.loads(tree.python(_START + _FMU + "print(json.dumps(package_of(scene_of())))"))
    (variable,) = [part for part in description.split("<ScalarVariable ") if 'name="asperity_pressure"' in part]
    for said in ('causality="output"', 'unit="Pa"', 'displayUnit="GPa"', 'nominal="1000000000.0"'):
        assert said in variable
    assert "mean pressure of the solids where they touch" in page


@pytest.mark.parametrize("without", [OUTPUT_ROW, "contact_core/deterministic/observed.py"])
def test_an_output_is_a_row_and_what_computes_it(extend: Callable[..., Tree], without: str) -> None:
    tree = extend(OUTPUT, without=without)
    code = 'scene = scene_of(control__driver="dry")\nadvance(scene, scene.operation.point, initial_state(scene), 1.0)'
    said = tree.python(_START + code, fails=True)
    assert "asperity_pressure: an output of a block has a trend in the quantity table, and is computed." in said


def test_the_scheme_and_the_iteration_converge_at_their_orders(tree: Tree) -> None:
    found = found_by(
        tree,
        """
from pathlib import Path
import numpy as np
from benchmarks.models import systems
from system_models.master import simulate
case = systems.two_mass_force(Path("."))
past = case.history() | {"two.F": systems.spring_force}
exact = case.solution(2.0)[0]
def error(step, **options):
    run = simulate(case.system, 2.0, step, history=past, outputs=case.states, **options)
    assert run.attrs["unconverged"] == 0
    return float(np.abs(np.array([run[name].values[-1] for name in case.states]) - exact).max())
def orders(**options):
    return [error(step, algorithm="leader", **options) for step in (0.02, 0.01)]
found = {
    "scheme": [orders(order=order) for order in (0, 1, 2)],
    "iteration": orders(order=1, iterate="relaxed", iteration_tolerance=1e-9),
    "gauss_seidel": [error(step, order=1, algorithm="gauss_seidel") for step in (0.02, 0.01)],
}
print(json.dumps(found))
""",
    )
    for order, (coarse, fine) in enumerate(found["scheme"]):
        assert coarse / fine == approx(2.0 ** (order + 1), rel=0.25)
    coarse, fine = found["iteration"]
    assert coarse / fine == approx(4.0, rel=0.1)
    assert found["scheme"][1] == found["gauss_seidel"]  # of two FMUs


def test_followers_do_not_see_one_another(tree: Tree) -> None:
    found = found_by(
        tree,
        """
import numpy as np
from system_models.numerics.algorithms import ALGORITHMS
from system_models.numerics.iteration import METHODS
seen = list(ALGORITHMS["leader"](["one", "two", "three"]))
residuals = {}
for name in ("fixed_point", "relaxed"):
    method, v = METHODS[name](), np.array([1.0])
    method.start(np.array([1e-6]))
    for _ in range(40):
        v = method.next(v, -2.0 * v)  # G(v) = -2 v
    residuals[name] = abs(float(v[0]))
print(json.dumps([seen, residuals]))
""",
    )
    seen, residuals = found
    assert seen == ["one"]
    assert residuals["relaxed"] == approx(0.5**40, rel=1e-12)
    assert residuals["fixed_point"] > 1.0


def test_a_machine_is_coupled_by_the_scheme(tree: Tree) -> None:
    (line,) = examples(SCHEME, "sh")
    printed = tree.command(line)
    assert "to 0.5 s, of" in printed
    assert "Iterations:" in printed


def test_a_scheme_without_its_entry_is_refused_by_name(extend: Callable[..., Tree]) -> None:
    tree = extend(SCHEME, without="system_models/numerics/iteration.py")
    (line,) = examples(SCHEME, "sh")
    said = tree.command(line, fails=True)
    assert "'relaxed'" in said
    assert "'fixed_point'" in said
