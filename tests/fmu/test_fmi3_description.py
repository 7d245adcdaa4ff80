"""FMUs of FMI 3.0: their description says what that of FMI 2.0 says; terminals, sources and flavours."""

import zipfile
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree as ET

import fmpy
import pytest
from fmpy.validation import validate_fmu
from lxml import etree
from test_parts_fmu import EXAMPLES

from contact_core import Scene, SceneError
from fmu_src.flavours import VERSIONS, WITH_PYTHON
from fmu_src.native import build as native_build
from fmu_src.native import files as native_files
from fmu_src.package import compiled, fmi2, fmi3, terminals
from fmu_src.package.build import build
from fmu_src.package.command import main
from fmu_src.package.describe import Model
from fmu_src.package.document.page import documentation
from fmu_src.variables import variables
from system_models.parts.build import build as build_part
from system_models.parts.variables import variables as variables_of

pytestmark = pytest.mark.fmu

SCHEMAS = Path(fmpy.__file__).parent / "schema" / "fmi3"
TYPES = {"Real": "Float64", "Integer": "Int32", "Boolean": "Boolean", "String": "String"}
SOURCES = {"contact.c": b"int contact;\n", "contact.h": b"extern int contact;\n", "fmi.c": b"int fmi;\n"}


@pytest.fixture(scope="module")
def fmu(scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(scene, tmp_path_factory.mktemp("fmi3") / "small.fmu", fmi=3)


@pytest.fixture
def generator(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stand-in for the generator of C and its compilers."""
    folder = {2: "linux64", 3: "x86_64-linux"}

    def binaries(sources: Mapping[str, bytes], fmi: int, model: str, here: bool) -> dict[str, bytes]:
        return {f"binaries/{folder[fmi]}/{model}.so": b"library"}

    monkeypatch.setattr(native_files, "sources", lambda scene, fmi: SOURCES)
    monkeypatch.setattr(native_files, "binaries", binaries)


def content(fmu: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(fmu) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def faults(data: bytes, schema: str) -> list[str]:
    """What a schema of FMI 3.0 finds wrong."""
    checked = etree.XMLSchema(etree.parse(str(SCHEMAS / f"fmi3{schema}.xsd")))
    checked.validate(etree.fromstring(data))
    return [str(error) for error in checked.error_log]


def test_fmpy_finds_no_problem(fmu: Path, line_scene: Scene, tmp_path: Path) -> None:
    assert validate_fmu(str(fmu)) == []
    assert validate_fmu(str(build(line_scene, tmp_path / "line.fmu", fmi=3))) == []


def test_the_variables_are_those_of_fmi_2(fmu: Path, fmu_file: Path) -> None:
    three, two = (fmpy.read_model_description(str(file)) for file in (fmu, fmu_file))
    same = (
        "name valueReference description causality variability initial start unit displayUnit relativeQuantity min max"
    )
    for name in (*same.split(), "nominal"):
        assert [getattr(v, name) for v in three.modelVariables] == [getattr(v, name) for v in two.modelVariables]
    assert [v.type for v in three.modelVariables] == [TYPES[v.type] for v in two.modelVariables]
    assert {v.type for v in three.modelVariables} == set(TYPES.values())
    for v3, v2 in zip(three.modelVariables, two.modelVariables, strict=True):
        assert (v3.declaredType and v3.declaredType.name) == (v2.declaredType and v2.declaredType.name)


def test_units_types_and_the_rest_are_those_of_fmi_2(fmu: Path, fmu_file: Path) -> None:
    three, two = (ET.fromstring(content(file)["modelDescription.xml"]) for file in (fmu, fmu_file))
    for part in ("UnitDefinitions", "LogCategories", "DefaultExperiment"):
        assert ET.tostring(three.find(part)) == ET.tostring(two.find(part))
    typed = {t.get("name"): t.find("Real").attrib for t in two.find("TypeDefinitions")}
    assert {
        t.get("name"): {k: v for k, v in t.attrib.items() if k != "name"} for t in three.iter("Float64Type")
    } == typed


@pytest.mark.parametrize("kind", EXAMPLES)
def test_dependencies_name_the_same_variables_as_in_fmi_2(kind: str) -> None:
    """Those of a component, whose outputs depend on some inputs: FMI 2 counts from 1, FMI 3 has value references."""
    table = variables_of(EXAMPLES[kind][0])
    model = Model(kind, "token", "", {})
    two = ET.fromstring(fmi2.description(model, table, "isolated"))
    three = fmi3.description(model, table, "isolated")
    assert faults(three, "ModelDescription") == []
    names = [v.get("name") for v in two.iter("ScalarVariable")]

    def listed(unknown: ET.Element, own: str, first: int) -> tuple[str, list[str] | None]:
        known = unknown.get("dependencies")
        return names[int(unknown.get(own)) - first], known and [names[int(n) - first] for n in known.split()]

    for old, new in (("Outputs", "Output"), ("InitialUnknowns", "InitialUnknown")):
        expected = [listed(u, "index", 1) for u in two.find(f"ModelStructure/{old}")]
        assert [listed(u, "valueReference", 0) for u in ET.fromstring(three).iter(new)] == expected


def test_an_fmu_of_fmi_3_has_its_own_token_folders_and_no_files_of_fmi_2(
    fmu: Path, scene: Scene, tmp_path: Path
) -> None:
    two = content(build(scene, tmp_path / "two.fmu"))
    three = content(fmu)
    libraries = {name for name in three if name.startswith("binaries/")}
    assert libraries == {"binaries/x86_64-linux/MixedContact.so", "binaries/x86_64-windows/MixedContact.dll"}
    assert {"model.png"} <= set(two) - set(three)
    assert three["terminalsAndIcons/icon.png"] == two["model.png"]
    assert three["resources/guid.txt"] != two["resources/guid.txt"]
    described = ET.fromstring(three["modelDescription.xml"])
    assert described.get("instantiationToken") == three["resources/guid.txt"].decode()


@pytest.mark.parametrize("shape", ["scene", "line_scene"])
def test_terminals_name_variables_of_the_fmu(shape: str, request: pytest.FixtureRequest) -> None:
    table = variables(request.getfixturevalue(shape))
    data = terminals.terminals(table)
    assert faults(data, "TerminalsAndIcons") == []
    members = {
        terminal.get("name"): {m.get("memberName"): m.get("variableName") for m in terminal}
        for terminal in ET.fromstring(data).iter("Terminal")
    }
    assert {name for found in members.values() for name in found.values()} <= {v.name for v in table}
    assert members["body_1"] == members["body_1"] | {"speed": "speed_1", "heat_flow": "heat_flow_1"}
    assert set(members["body_1"]) - set(members["body_2"]) == {"friction_force"}
    assert ("spin" in members) == (shape == "scene")


def test_the_embedded_flavour_is_for_fmi_2_only(scene: Scene, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    refusal = (
        "There is no FMU of FMI 3.0 with flavour = 'embedded'. Build it with fmi = 2, or with flavour = 'isolated'"
    )
    with pytest.raises(SceneError, match=refusal):
        build(scene, tmp_path / "x.fmu", "embedded", fmi=3)
    assert main(["mtm_zddp", "--flavour", "embedded", "--fmi", "3", "--out", str(tmp_path / "x.fmu")]) == 2
    assert refusal in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


# native


@pytest.mark.parametrize("version", VERSIONS["native"])
def test_a_native_fmu_has_sources_and_libraries_and_nothing_of_python(
    version: int, quick: Scene, tmp_path: Path, generator: None
) -> None:
    fmu = build(quick, tmp_path / "native.fmu", "native", fmi=version)
    files = content(fmu)
    assert validate_fmu(str(fmu)) == []
    assert {name: data for name, data in files.items() if name.startswith("sources/") and name[-2] == "."} == {
        f"sources/{name}": data for name, data in SOURCES.items()
    }
    assert [name for name in files if name.startswith("resources/")] == []
    assert {2: "binaries/linux64/MixedContact.so", 3: "binaries/x86_64-linux/MixedContact.so"}[version] in files
    assert b"nothing that is not part of it" in files["documentation/externalDependencies.txt"]
    described = fmpy.read_model_description(str(fmu))
    (configuration,) = described.buildConfigurations
    assert configuration.sourceFileSets[0].sourceFiles == ["contact.c", "fmi.c"]
    assert not described.coSimulation.needsExecutionTool
    assert ET.fromstring(files["modelDescription.xml"]).get("generationTool").startswith("tribofmu")
    assert b"pythonfmu" not in files["modelDescription.xml"]


def test_native_fmus_give_derivatives_and_those_of_fmi_3_may_return_early(
    quick: Scene, tmp_path: Path, generator: None
) -> None:
    two, three = (
        ET.fromstring(content(build(quick, tmp_path / f"{fmi}.fmu", "native", fmi=fmi))["modelDescription.xml"])
        for fmi in (2, 3)
    )
    assert two.find("CoSimulation").get("providesDirectionalDerivative") == "true"
    for name in ("DirectionalDerivatives", "AdjointDerivatives", "IntermediateUpdate"):
        assert three.find("CoSimulation").get(f"provides{name}") == "true"
    assert three.find("CoSimulation").get("canReturnEarlyAfterIntermediateUpdate") == "true"
    readable = {v.get("causality") for v in three.find("ModelVariables") if v.get("intermediateUpdate") == "true"}
    assert readable == {"output"}


def test_the_page_of_a_native_fmu_tells_how_to_change_a_parameter_and_how_to_compile(quick: Scene) -> None:
    for fmi, other in ((2, 3), (3, 2)):
        page = documentation(quick, "native", False, fmi).decode()
        assert "build the FMU anew" in page
        assert "fmpy compile" in page
        assert f"fmi{fmi}Warning" in page
        assert f"fmi{other}" not in page
        assert "Python process" not in page


@pytest.mark.parametrize(("compiler", "named"), [("gcc", "no library for darwin64, win64."), ("zig", None)])
def test_the_command_line_names_platforms_without_a_library(
    compiler: str, named: str | None, tmp_path: Path, generator: None, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    monkeypatch.setattr(native_build, "default_compiler", lambda: compiler)
    arguments = ["--flavour", "native", "--set", "film.model=regression", "--out", str(tmp_path / "x.fmu")]
    assert main(["mtm_zddp", *arguments]) == 0
    said = capsys.readouterr().err
    assert named in said if named else "no library" not in said


def test_the_build_description_lists_what_is_compiled() -> None:
    data = compiled.build_description(SOURCES, "MixedContact")
    assert faults(data, "BuildDescription") == []
    root = ET.fromstring(data)
    assert [file.get("name") for file in root.iter("SourceFile")] == ["contact.c", "fmi.c"]
    assert root.find("BuildConfiguration").get("modelIdentifier") == "MixedContact"
    assert root.find("BuildConfiguration/SourceFileSet").get("language") == "C99"


def test_python_is_chosen_for_isolated_fmus_only(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    for flavour in VERSIONS.keys() - {"isolated"}:
        assert main(["mtm_zddp", "--flavour", flavour, "--python", "--out", str(tmp_path / "x.fmu")]) == 2
        assert "--python is for isolated FMUs" in capsys.readouterr().err


def test_flavours_in_python_are_all_but_the_native_one() -> None:
    assert set(WITH_PYTHON) == VERSIONS.keys() - {"native"}


def test_a_component_in_c_has_sources_and_nothing_of_python(tmp_path: Path) -> None:
    part = next(iter(EXAMPLES.values()))[0]
    files = content(build_part(part, tmp_path / "part.fmu", "native", here=True))
    assert {"sources/contact.c", f"binaries/linux64/{part.name}.so"} <= files.keys()
    assert [name for name in files if name.startswith("resources/") or name.endswith(".py")] == []
