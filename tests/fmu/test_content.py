"""Contents of the FMU beside the model: documentation, icon, licences, reference data."""

import csv
import io
import posixpath
import zipfile
from dataclasses import fields
from html.parser import HTMLParser
from itertools import pairwise, product
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree as ET

import pytest
from comparison import HARD, approx
from fmu_host import SHAPES, SMALL, hosted, unpacked

from benchmarks.house import fmu_figures
from benchmarks.house.tables import Pages
from contact_core import ConvergenceError, RangeFlag, Scene
from contact_core.film import FILMS
from contact_core.laws import SLOTS
from contact_core.laws.rheology import Carreau
from contact_core.scene import Lubricant
from contact_core.shapes import GEOMETRIES
from fmu_src.html.markup import equation
from fmu_src.package import evidence, licences
from fmu_src.package.build import build
from fmu_src.package.document.contact import COSTS, ERRORS
from fmu_src.package.document.page import documentation
from fmu_src.runtime.slave import ContactSlave
from fmu_src.variables import variables

ROOT = Path(__file__).parents[2]
REQUIRED = {"deterministic": {"points": 65, "domain": 1e-3, "floor": 1e-9}, "regression": {}, "auto": {}, "map": {}}
OTHERS = {  # laws that the shipped scenes do not use
    "lubricant.set": "m100",
    "lubricant.rheology": "carreau",
    "lubricant.rheology.critical_stress": "5 MPa",
    "lubricant.rheology.exponent": "0.5",
    "lubricant.density": "none",
    "lubricant.flow": "local",
    "heat.model": "field",
    "heat.inlet_shear": "gupta",
    "heat.bulk": "inputs",
    "tribofilm.set": "combined_80c",
    "film.criterion": "lumped",
    **HARD,
}


@pytest.fixture(scope="module", params=["deterministic", "regression"])
def contact(request) -> Scene:
    return Scene.from_toml("mtm_zddp", SMALL).at_level(request.param)


@pytest.fixture(scope="module")
def whole(contact, tmp_path_factory) -> Path:
    """The FMU with reference data."""
    return build(contact, tmp_path_factory.mktemp("whole") / "whole.fmu", "embedded", reference=True)


@pytest.fixture(scope="module")
def files(whole) -> dict[str, bytes]:
    with zipfile.ZipFile(whole) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.fixture
def table(files):
    """Rows of one of the tables of the reference data, as numbers by name."""

    def read(name: str) -> list[dict[str, float]]:
        text = files[f"{evidence.FOLDER}/{name}"].decode()
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(io.StringIO(text))]

    return read


# documentation


class Page(HTMLParser):
    """Nesting, links, ids and the text of each element of a page."""

    def __init__(self, page: bytes):
        super().__init__()
        self.open: list[str] = []
        self.links: list[str] = []
        self.ids: list[str] = []
        self.tags: set[str] = set()
        self.cells: list[str] = []
        self.text = ""
        self.feed(page.decode())
        self.close()

    def handle_starttag(self, tag, attributes):
        self.handle_startendtag(tag, attributes)
        if tag != "meta":
            self.open.append(tag)
        if tag == "td":
            self.cells.append("")

    def handle_startendtag(self, tag, attributes):
        self.tags.add(tag)
        self.links += [value for name, value in attributes if name in ("href", "src")]
        self.ids += [value for name, value in attributes if name == "id"]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "td" in self.open:
            self.cells[-1] += data
        self.text += data


@pytest.fixture(scope="module")
def page(files) -> Page:
    return Page(files["documentation/index.html"])


def laws(record) -> list[object]:
    """Every law in a scene, and its film."""
    parts = [part for part in vars(record).values() if hasattr(part, "__dataclass_fields__")]
    return [part for part in parts if hasattr(part, "source")] + [law for part in parts for law in laws(part)]


@pytest.mark.parametrize("flavour", ["embedded", "isolated", "native"])
@pytest.mark.parametrize("changes", [{}, OTHERS], ids=["as shipped", "other laws"])
@pytest.mark.parametrize("level", ["deterministic", "regression", "map"])
def test_the_page_is_well_nested_and_stands_alone(level, changes, flavour):
    scene = Scene.from_toml("mtm_zddp", SMALL | changes).at_level(level)
    page = Page(documentation(scene, flavour, reference=True))
    assert page.open == []
    assert len(set(page.ids)) == len(page.ids) > 10
    assert not page.tags & {"script", "link", "img", "iframe"}
    outside = [link for link in page.links if ":" in link]
    assert outside
    assert all(link.startswith("https://doi.org/10.") for link in outside)


def test_every_link_of_the_page_leads_somewhere(files, page):
    inside = [link for link in page.links if ":" not in link]
    for link in inside:
        if link.startswith("#"):
            assert link[1:] in page.ids
        else:
            assert posixpath.normpath(f"documentation/{link}") in files
    assert f"../{evidence.FOLDER}/steps-ref.csv" in inside
    assert "licenses/license.txt" in inside


def test_the_page_names_every_variable_flag_and_log_category(page, contact):
    for names in (
        [v.name for v in variables(contact)],
        [v.text for v in variables(contact)],
        [flag.name for flag in RangeFlag],
        [flag.text for flag in RangeFlag],
        list(ContactSlave.log_categories),
    ):
        assert set(names) <= {cell.partition("; by what the scene assumes")[0] for cell in page.cells}


@pytest.mark.parametrize(
    ("flavour", "warning", "error", "log"),
    [
        ("isolated", "fmi2Warning", "fmi2Error", "The FMU always reports errors."),
        ("embedded", "fmi2OK", "fmi2OK", "The FMU sends messages if the host has switched logging on"),
    ],
)
def test_the_page_gives_the_status_of_each_event_and_what_is_logged(contact, flavour, warning, error, log):
    page = Page(documentation(contact, flavour, reference=False))
    status = dict(pairwise(page.cells))
    assert status["a usable step or value"] == "fmi2OK"
    assert status["an unusable input or step size, a contact that cannot be solved"] == warning
    assert status["an unusable parameter or initial_state"] == warning
    assert status["a state that cannot be used"] == error
    assert status["unexpected error in the model"] == error
    assert log in page.text


@pytest.mark.parametrize("changes", [{}, OTHERS], ids=["as shipped", "other laws"])
def test_the_page_names_every_law_in_use_with_its_source(contact, changes):
    scene = Scene.from_toml("mtm_zddp", SMALL | changes).at_level(contact.film.name)
    page = Page(documentation(scene, "isolated", reference=False))
    for law in laws(scene):
        assert law.name in page.text
        assert law.source in page.text
    assert len(laws(scene)) >= 9


def test_every_law_and_shape_has_equations():
    for law in (law for known in SLOTS.values() for law in known):
        assert law.equations.lines
        for option, texts in law.equations.options.items():
            assert set(texts) >= (choices(law, option) or {getattr(law, option)}) - {"none"}
    for geometry in GEOMETRIES:
        for shown in (geometry.equations, geometry.deformation, geometry.load_balance, geometry.smooth_film):
            assert shown.lines
        assert geometry.rolling.lines


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("film", FILMS)
def test_every_level_has_titled_equations_for_every_option(film, geometry):
    for cavitation, flow, criterion in product(
        choices(Lubricant, "cavitation"), choices(Lubricant, "flow"), ("split", "lumped")
    ):
        oil = SimpleNamespace(cavitation=cavitation, flow=flow, rheology=Carreau)
        options = {"criterion": criterion} if choices(film, "criterion") else {}
        found = film(**REQUIRED[film.name], **options).governing(geometry, oil)
        assert found
        assert all(shown.title and shown.lines for shown in (*found, film.friction))


def choices(law: type, name: str) -> set[str]:
    """Choices of a law's option; empty if it has no such option."""
    return {choice for field in fields(law) if field.name == name for choice in field.metadata["choices"]}


@pytest.mark.parametrize("level", ["deterministic", "regression"])
@pytest.mark.parametrize("shape", SHAPES)
def test_the_page_of_every_shape_speaks_of_that_shape(shape, level):
    name, changes = SHAPES[shape]
    scene = Scene.from_toml(name, changes).at_level(level)
    page = Page(documentation(scene, "isolated", reference=False))
    assert page.open == []
    assert f"geometry: {scene.geometry.name}" in page.text
    assert set(page.cells) >= {v.name for v in variables(scene)}
    on_face = shape != "ellipse"
    assert ("radius of combined curvature along y" in page.cells) != on_face
    assert ("face width, which load and outputs refer to" in page.cells) == on_face
    assert ("spin is the angular speed of body 1" in page.text) == (shape != "line")
    formula = "Moes for lines" if on_face else "Nijenbanning, Venner and Moes"
    assert f"by the formula of {formula}" in page.cells


@pytest.mark.parametrize("shape", SHAPES)
def test_the_loads_that_the_page_names_bring_hertz_to_the_hardness_and_to_the_edge(shape):
    name, changes = SHAPES[shape]
    scene = Scene.from_toml(name, changes)
    page = Page(documentation(scene, "isolated", reference=False))
    rows = dict(reversed(list(pairwise(page.cells))))  # the first of each name
    hardest = float(rows["load"].removeprefix("below ").removesuffix(" N"))
    assert scene.hertz(hardest).pressure_max == approx(scene.plasticity.hardness, rel=1e-3)
    few, wide = (float(word) for word in rows["load on this grid"].removesuffix(" N").split(" to "))
    assert scene.hertz(few).a == approx(4.0 * scene.film.spacing, rel=1e-3)
    filled = [half / room for half, room in zip((scene.hertz(wide).a, scene.hertz(wide).b), scene.room, strict=True)]
    assert max(filled) == approx(1.0, rel=1e-3)


STARVED = {"lubricant.supply.model": "film", "lubricant.supply.thickness": "50 nm"}


@pytest.mark.parametrize(
    ("changes", "told", "left"),
    [
        ({}, "The gap counts as full there", True),
        ({"lubricant.cavitation": "mass_conserving"}, "θ is the share of the gap that oil fills", True),
        ({"lubricant.cavitation": "mass_conserving"} | STARVED, "lubricant.supply: film", False),
        ({"lubricant.supply.model": "meniscus", "lubricant.supply.distance": "0.2 mm"}, "supply: meniscus", False),
    ],
)
def test_the_page_says_what_becomes_of_cavities_and_how_much_oil_there_is(changes, told, left):
    scene = Scene.from_toml("mtm_zddp", SMALL | changes)
    page = Page(documentation(scene, "isolated", reference=False))
    assert told in page.text
    assert ("starvation (lubricant.supply = flooded: the inlet is full)" in page.text) == left
    assert ("film with this oil supply" in page.cells) != left


def test_an_equation_has_scripts_and_italic_letters():
    assert equation("h_c < W_{max}^2 exp(x)") == (
        '<p class="equation"><i>h</i><sub><i>c</i></sub> &lt; <i>W</i><sub>max</sub><sup>2</sup> exp(<i>x</i>)</p>'
    )


def test_a_contact_that_nothing_entrains_is_described(contact):
    still = Scene.from_toml("mtm_zddp", SMALL | {"operation.speed_1": "1 m/s", "operation.speed_2": "-1 m/s"})
    page = Page(documentation(still.at_level(contact.film.name), "isolated", reference=False))
    assert "nothing entrains oil" in page.text
    assert "built without reference data" in page.text


def test_measured_figures_are_those_of_the_sections_with_their_dates():
    assert fmu_figures.PATH.read_text("utf-8") == fmu_figures.written(Pages())
    found = documentation(Scene.from_toml("mtm_zddp").at_level("regression"), "isolated", reference=False)
    page = found.decode()
    for table in (*ERRORS["regression"], COSTS["regression"]):
        assert len({len(row) for row in (table.head, *table.rows)}) == 1
        assert f"measured on {table.measured}{', of older code' if table.older else ''}" in page


# icon, licences, dependencies


def test_the_icon_is_the_shipped_picture(files):
    assert files["model.png"] == (ROOT / "fmu_src/package/icon.png").read_bytes()


def test_the_licences_are_ours_and_that_of_the_library_in_the_fmu(files):
    assert files["documentation/licenses/license.txt"] == (ROOT / "LICENSE").read_bytes()
    assert b"MIT License" in files["documentation/licenses/pythonfmu.txt"]
    described = ET.fromstring(files["modelDescription.xml"])
    assert [described.get(name) for name in ("author", "license")] == ["The tribofmu developers", "BSD-3-Clause"]
    assert described.get("copyright", "none") in (ROOT / "LICENSE").read_text().splitlines()
    isolated = licences.licences("isolated")
    assert set(isolated) == {"license.txt", "fmi.txt"}
    assert b"Redistribution and use in source and binary forms" in isolated["fmi.txt"]


def test_what_the_fmu_needs_from_outside_is_listed(files):
    text = files["documentation/externalDependencies.txt"].decode()
    for needed in ("Python >=3.11", "tribofmu 0.1.0", "pythonfmu 0.7", "numba>=", "PYTHONPATH"):
        assert needed in text
    assert "pytest" not in text
    assert "TRIBOFMU_PYTHON" in licences.external_dependencies("isolated").decode()


def test_a_package_without_its_licence_is_named(monkeypatch):
    monkeypatch.setattr(licences, "PACKAGE", "tribofmu-elsewhere")
    with pytest.raises(FileNotFoundError, match="tribofmu-elsewhere is not installed with its LICENSE"):
        licences.licences("isolated")


# reference data


def replayed(folder: Path, stimuli, expected) -> list[tuple[float, str]]:
    """Time and name of every expected value that the FMU misses."""
    scale = {name: max(abs(row[name]) for row in expected) for name in expected[0]}
    missed, inputs = [], {row.pop("time"): row for row in (dict(row) for row in stimuli)}
    with hosted(folder) as host:
        host.initialise(**inputs[0.0])
        found = host.outputs()
        for i, row in enumerate(expected):
            if i:
                start = expected[i - 1]["time"]
                found = host.step(row["time"] - start, **inputs.get(start, {}))
            missed += [
                (row["time"], name)
                for name in row.keys() - {"time"}
                if abs(found[name] - row[name]) > evidence.TOLERANCE * scale[name]
            ]
    return missed


def test_the_fmu_replays_its_reference_data(whole, table, tmp_path):
    stimuli, expected = table(evidence.STIMULI), table(evidence.EXPECTED)
    folder = unpacked(whole, tmp_path)
    assert replayed(folder, stimuli, expected) == []
    assert all(row["valid"] for row in expected)
    expected[3]["friction_force"] *= 1.01
    expected[5]["tribofilm_1"] *= 1.01
    assert replayed(folder, stimuli, expected) == [(16.0, "friction_force"), (17.5, "tribofilm_1")]


def test_the_stimuli_of_a_line_are_its_inputs(line_scene):
    text = evidence.reference(line_scene.at_level("regression"))[f"{evidence.FOLDER}/{evidence.STIMULI}"].decode()
    rows = list(csv.DictReader(io.StringIO(text)))
    assert set(rows[0]) == {"time"} | {v.name for v in variables(line_scene) if v.causality == "input"}
    assert all(float(value) == float(value) for row in rows for value in row.values())


def test_the_stimuli_change_load_and_speed_turn_back_and_roll(table):
    first, lighter, slower, back, rolling = table(evidence.STIMULI)
    assert lighter["load"] < first["load"]
    assert abs(slower["speed_1"]) < abs(lighter["speed_1"])
    assert (back["speed_1"], back["speed_2"]) == (-slower["speed_1"], -slower["speed_2"])
    assert rolling["speed_1"] == rolling["speed_2"] != 0.0
    times = [row["time"] for row in table(evidence.EXPECTED)]
    assert len({late - early for early, late in pairwise(times)}) == len(times) - 1


def test_the_manifest_leads_to_the_tables_and_the_tolerance(files):
    manifest = ET.fromstring(files[f"{evidence.FOLDER}/fmi-ls-manifest.xml"])
    name = "{http://fmi-standard.org/fmi-ls-manifest}fmi-ls-name"
    assert (manifest.tag, manifest.get(name)) == ("fmiReferences", "org.fmi-standard.fmi-ls-ref")
    experiments = ET.fromstring(files[f"{evidence.FOLDER}/{manifest.find('Related').get('source')}"])
    experiment = experiments.find("Experiment")
    assert float(experiment.get("tolerance")) == evidence.TOLERANCE
    for kind in ("Stimuli", "References"):
        assert f"{evidence.FOLDER}/{experiment.find(kind).get('source')}" in files


def test_expected_values_stand_where_the_contact_has_no_solution(contact, monkeypatch):
    solved, calls = evidence.advance, []

    def sometimes(scene, point, state, dt):
        calls.append(dt)
        if len(calls) == 3:
            raise ConvergenceError("no solution")
        return solved(scene, point, state, dt)

    monkeypatch.setattr(evidence, "advance", sometimes)
    text = evidence.reference(contact)[f"{evidence.FOLDER}/{evidence.EXPECTED}"].decode()
    rows = [line.split(",")[1:] for line in text.splitlines()[1:]]
    assert calls == [0.0, 10.0, 4.0, 2.0, 1.0, 0.5]
    assert [row[-1] for row in rows] == ["1", "1", "0", "1", "1", "1"]
    assert rows[2][:-1] == rows[1][:-1] != rows[3][:-1]


def test_the_same_scene_gives_the_same_bytes(whole, contact, tmp_path):
    assert build(contact, tmp_path / "again.fmu", "embedded", reference=True).read_bytes() == whole.read_bytes()
