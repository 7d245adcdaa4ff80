"""An exported system is valid SSP 1.0, and importers of SSP simulate it as we do."""

import json
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy.ssp
import numpy as np
import pytest
from comparison import approx
from fmpy.ssp.ssd import get_connections, read_ssd
from lxml import etree

from benchmarks.hosts import ssp_runner
from benchmarks.models import build
from contact_core import Scene
from fmu_src.package.build import build as build_contact
from system_models.master import CouplingError, System, export_ssp, simulate
from system_models.parts.build import build as build_part
from system_models.parts.shaft import Shaft

STEP, COUNT = 0.01, 40
SCHEMAS = Path(fmpy.ssp.__file__).parent / "schema"
SPACES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
    "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
}
MOTION = ["chassis.x", "chassis.v", "wheel.x", "wheel.v"]
ROAD = [
    ("wheel.x", "chassis.x_other"),
    ("wheel.v", "chassis.v_other"),
    ("chassis.x", "wheel.x_other"),
    ("chassis.v", "wheel.v_other"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("ssp")


@pytest.fixture(scope="module")
def fmus(folder: Path) -> dict[str, Path]:
    """Quarter car: no output depends on an input directly, so importers need no order among the FMUs."""
    return {name: build(f"{name}_displacement", folder) for name in ("wheel", "chassis")}


@pytest.fixture(scope="module")
def instrumented(fmus: dict[str, Path], folder: Path) -> System:
    """A quarter car with other parameters, and a gauge that has its input in millimetres and upside down."""
    gauge = build("gain", folder, a=0.5, unit_u="mm", unit_y="N")
    parameters = {"wheel.road": 0.2, "wheel.m": 41.0, "chassis.kc": 14e3, "gauge.b": 0.25}
    return System(fmus | {"gauge": gauge}, [*ROAD, ("wheel.x", "gauge.u", -2.0)], parameters)


def structure(file: Path) -> etree._Element:
    with zipfile.ZipFile(file) as archive:
        return etree.fromstring(archive.read("SystemStructure.ssd"))


def imported(importer: str, file: Path, names: list[str], step: float = STEP, count: int = COUNT) -> np.ndarray:
    """Values after each step, a row for each."""
    script = ssp_runner.__file__
    run = subprocess.run(
        [sys.executable, script, importer, str(file), str(step), str(count), *names], capture_output=True, text=True
    )
    if run.returncode == ssp_runner.UNUSABLE:
        pytest.skip(f"{importer}: {run.stderr.strip()}")
    assert run.returncode == 0, run.stderr[-2000:]
    return np.array(json.loads(run.stdout.splitlines()[-1]))  # libcosim logs to stdout


def own(system: System, names: list[str]) -> np.ndarray:
    """Values from the start on, a row for each communication point."""
    dataset = simulate(system, COUNT * STEP, STEP, algorithm="jacobi", order=0, outputs=names)
    assert dataset["time"].values == approx(STEP * np.arange(COUNT + 1))
    return np.column_stack([dataset[name].values for name in names])


def test_the_structure_is_valid(instrumented: System, folder: Path) -> None:
    file = export_ssp(instrumented, folder / "valid.ssp", 2.0)
    ssd = read_ssd(str(file))  # validates it
    assert (ssd.version, ssd.name, ssd.system.name) == ("1.0", "valid", "valid")
    found = {(a.parent.name, a.name, b.parent.name, b.name) for a, b in get_connections(ssd.system)}
    assert found == {tuple(f"{source}.{target}".split(".")) for source, target in [*ROAD, ("wheel.x", "gauge.u")]}
    root = structure(file)
    schema = etree.XMLSchema(file=str(SCHEMAS / "SystemStructureParameterValues.xsd"))
    sets = root.findall(".//ssv:ParameterSet", SPACES)
    assert len(sets) == 3
    for table in sets:
        schema.assertValid(etree.fromstring(etree.tostring(table)))
    assert root.find("ssd:DefaultExperiment", SPACES).attrib == {"startTime": "0.0", "stopTime": "2.0"}
    assert root.find(".//ssd:Annotations", SPACES) is None


def test_a_step_size_is_proposed_to_omsimulator(fmus: dict[str, Path], folder: Path) -> None:
    file = export_ssp(System(fmus, ROAD), folder / "stepped.ssp", 2.0, 5e-5)
    read_ssd(str(file))  # validates it
    (annotation,) = structure(file).findall("ssd:System/ssd:Annotations/ssc:Annotation", SPACES)
    assert annotation.get("type") == "org.openmodelica"
    (master,) = annotation.findall("oms:Annotations/oms:SimulationInformation/oms:FixedStepMaster", SPACES)
    assert master.attrib == {"description": "oms-ma", "stepSize": "0.00005", "relativeTolerance": "0.0001"}


def test_connectors_have_kind_type_and_unit(fmus: dict[str, Path], folder: Path) -> None:
    system = System(
        {"echo": build("echo", folder), "early": build("early", folder)}, [("early.events", "echo.integer_in")]
    )
    root = structure(export_ssp(system, folder / "types.ssp"))
    connectors = {
        (component.get("name"), c.get("name")): (c.get("kind"), etree.QName(c[0]).localname, c[0].get("unit"))
        for component in root.findall(".//ssd:Component", SPACES)
        for c in component.findall("ssd:Connectors/ssd:Connector", SPACES)
    }
    assert connectors == {
        ("early", "y"): ("output", "Real", "m"),
        ("early", "events"): ("output", "Integer", None),
        ("echo", "integer_in"): ("input", "Integer", None),
        ("echo", "real_out"): ("output", "Real", None),
        ("echo", "integer_out"): ("output", "Integer", None),
        ("echo", "boolean_out"): ("output", "Boolean", None),
    }
    (unit,) = root.findall("ssd:Units/ssc:Unit", SPACES)
    assert unit.get("name") == "m"
    assert unit[0].attrib == {"m": "1"}


def test_importers_that_convert_no_units_are_told_the_whole_factor(instrumented: System, folder: Path) -> None:
    root = structure(export_ssp(instrumented, folder / "units.ssp"))
    transformed = root.findall(".//ssd:Connection[ssc:LinearTransformation]", SPACES)
    (gauge,) = transformed
    assert gauge.get("endElement") == "gauge"
    assert gauge.get("suppressUnitConversion") == "true"
    assert {name: float(value) for name, value in gauge[0].attrib.items()} == {"factor": -2000.0, "offset": 0.0}


@pytest.mark.importers
@pytest.mark.parametrize(("importer", "lag"), [("libcosimpy", 1), ("ecospy", 0)])
def test_importers_simulate_what_we_do(importer: str, lag: int, instrumented: System, folder: Path) -> None:
    """libcosim shows outputs that were read before the inputs of the same time were set."""
    file = export_ssp(instrumented, folder / "car.ssp")
    theirs, ours = imported(importer, file, [*MOTION, "gauge.y"]), own(instrumented, [*MOTION, "gauge.y"])
    assert np.ptp(ours[:, 0]) > 0.1
    np.testing.assert_allclose(theirs[:, :4], ours[1:, :4], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(theirs[:, 4], ours[1 - lag : COUNT + 1 - lag, 4], rtol=1e-9)
    assert np.ptp(ours[:, 4]) == approx(0.5 * 2000.0 * np.ptp(ours[:, 2]), rel=1e-9)


@pytest.mark.importers
@pytest.mark.parametrize("importer", ["libcosimpy", "ecospy"])
def test_importers_set_the_level_of_a_contact(importer: str, folder: Path) -> None:
    grid = {"film.points": "17"} | {f"surface_{i}.correlation_length": "32 um" for i in (1, 2)}
    scene = Scene.from_toml("mtm_zddp", grid).at_level("regression")
    contact = build_contact(scene, folder / "contact.fmu", python=sys.executable)
    systems = {level: System({"contact": contact}, [], {"contact.fidelity": level}) for level in (1, 2)}
    fast, full = (own(system, ["contact.h_c"])[1:] for system in systems.values())
    assert np.all(np.abs(fast - full) > 0.1 * full)
    file = export_ssp(systems[2], folder / "level.ssp")
    np.testing.assert_allclose(imported(importer, file, ["contact.h_c"]), full, rtol=1e-9)


@pytest.mark.importers
@pytest.mark.parametrize("importer", ["libcosimpy", "ecospy"])
def test_importers_run_three_instances_of_an_isolated_fmu(importer: str, folder: Path) -> None:
    """ecos loads and unloads the library at each instantiation, under the instances that there are."""
    shaft = build_part(Shaft(inertia=0.5, coupling=3.0), folder / "shaft.fmu", python=sys.executable)
    chain = [("first.speed", "second.speed_drive"), ("second.speed", "third.speed_drive")]
    told = {"first.initial_speed": 80.0, "second.inertia": 0.2, "third.inertia": 0.1}
    system = System(dict.fromkeys(("first", "second", "third"), shaft), chain, told)
    names = [f"{name}.speed" for name in system.models]
    theirs, ours = imported(importer, export_ssp(system, folder / "shafts.ssp"), names), own(system, names)
    assert np.all(np.ptp(ours, axis=0) > 10.0)
    np.testing.assert_allclose(theirs, ours[1:], rtol=1e-9)


def test_fmpy_simulates_what_we_do(fmus: dict[str, Path], folder: Path) -> None:
    """It applies neither parameters nor factors, and all inputs are zero in its first step."""
    system = System(fmus, ROAD)
    ours = own(system, MOTION)
    assert not ours[0].any()
    theirs = imported("fmpy", export_ssp(system, folder / "plain.ssp"), MOTION)
    np.testing.assert_allclose(theirs, ours[1:], rtol=1e-9, atol=1e-12)


def test_each_file_is_there_once_and_the_bytes_repeat(fmus: dict[str, Path], folder: Path) -> None:
    other = folder / "other place"
    other.mkdir()
    namesake = other / fmus["wheel"].name
    namesake.write_bytes(fmus["wheel"].read_bytes())
    spaced = other / "wheel of Ä.fmu"
    spaced.write_bytes(fmus["wheel"].read_bytes())
    system = System({"a": fmus["wheel"], "b": fmus["wheel"], "c": namesake, "d": spaced})
    file = export_ssp(system, folder / "many.ssp")
    stem = fmus["wheel"].stem
    sources = [f"resources/{stem}.fmu", f"resources/{stem}_2.fmu", "resources/wheel_of__.fmu"]
    with zipfile.ZipFile(file) as archive:
        assert archive.namelist() == ["SystemStructure.ssd", *sources]
        assert {archive.read(source) for source in sources} == {fmus["wheel"].read_bytes()}
    components = structure(file).findall(".//ssd:Component", SPACES)
    assert [(c.get("name"), c.get("source")) for c in components] == [
        ("a", sources[0]),
        ("b", sources[0]),
        ("c", sources[1]),
        ("d", sources[2]),
    ]
    before = file.read_bytes()
    assert export_ssp(system, file).read_bytes() == before


def test_a_schedule_is_refused_unless_it_is_a_start_value(fmus: dict[str, Path], folder: Path) -> None:
    changing = System(fmus, ROAD, schedule={"wheel.road": [(0.0, 0.1), (1.0, 0.2)]})
    with pytest.raises(CouplingError, match=r"'wheel.road' changes by a schedule, which SSP cannot say"):
        export_ssp(changing, folder / "changing.ssp")
    assert not (folder / "changing.ssp").exists()
    constant = System(fmus, ROAD, schedule={"wheel.road": [(0.0, 0.3)]})
    root = structure(export_ssp(constant, folder / "constant.ssp"))
    (value,) = root.findall(".//ssv:Parameter[@name='road']/ssv:Real", SPACES)
    assert value.get("value") == "0.3"


def test_what_cannot_be_written_is_refused(fmus: dict[str, Path], folder: Path) -> None:
    with pytest.raises(CouplingError, match="cannot be written: No such file or directory"):
        export_ssp(System(fmus), folder / "no folder" / "x.ssp")
    with pytest.raises(CouplingError, match=r"stop_time = -1.0 must be a time above 0 s"):
        export_ssp(System(fmus), folder / "x.ssp", -1.0)
    with pytest.raises(CouplingError, match=r"step_size = 0.0 must be a time above 0 s"):
        export_ssp(System(fmus), folder / "x.ssp", 1.0, 0.0)
