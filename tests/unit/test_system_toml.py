"""A system read from TOML is the one that is made in Python, and what does not fit is refused with a sentence."""

import zipfile
from pathlib import Path
from typing import Any

import pytest

from system_models.fmu.errors import CouplingError
from system_models.fmu.model import Model
from system_models.master.reading import read
from system_models.master.system import System

HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{{0}}">
<CoSimulation modelIdentifier="{name}"/>
<UnitDefinitions>
<Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
<Unit name="kN"><BaseUnit kg="1" m="1" s="-2" factor="1000"/></Unit>
<Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
<Unit name="N.s/m"><BaseUnit kg="1" s="-1"/></Unit>
</UnitDefinitions>
<ModelVariables>{variables}</ModelVariables>
<ModelStructure><Outputs>{outputs}</Outputs></ModelStructure>
</fmiModelDescription>"""
BLOCK = [
    ("v", "output", 'Real unit="m/s"'),
    ("gap.open", "output", "Boolean"),
    ("F", "input", 'Real unit="N" start="0"'),
    ("m", "parameter", 'Real start="1"'),
    ("spring.k", "parameter", 'Real start="1"'),
    ("count", "parameter", 'Integer start="1"'),
    ("label", "parameter", 'String start=""'),
]
CONTACT = [
    ("force", "output", 'Real unit="kN"'),
    ("slope", "output", 'Real unit="N.s/m"'),
    ("speed", "input", 'Real unit="m/s" start="0"'),
    ("load", "input", 'Real unit="N" start="0"'),
]


def variability(causality: str, kind: str) -> str:
    return "fixed" if causality == "parameter" else "continuous" if kind.startswith("Real") else "discrete"


def describe(path: Path, variables: list[tuple[str, str, str]]) -> None:
    """An FMU of which only the description can be read."""
    entries = "".join(
        f'<ScalarVariable name="{name}" valueReference="{i}" causality="{causality}" '
        f'variability="{variability(causality, kind)}"><{kind}/></ScalarVariable>'
        for i, (name, causality, kind) in enumerate(variables)
    )
    outputs = "".join(f'<Unknown index="{i}"/>' for i, v in enumerate(variables, 1) if v[1] == "output")
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("modelDescription.xml", HEAD.format(name=path.stem, variables=entries, outputs=outputs))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("rig")
    (folder / "fmus").mkdir()
    describe(folder / "fmus" / "block.fmu", BLOCK)
    describe(folder / "fmus" / "contact.fmu", CONTACT)
    return folder


FMUS = '[fmus]\nblock = "fmus/block.fmu"\ncontact = "fmus/contact.fmu"\n'
COUPLING = """
[coupling]
connections = [["block.v", "contact.speed"], ["contact.force", "block.F", -1.0]]
events = ["block.gap.open"]
bonds = [["contact.force", "block.v"]]
derivatives = [{ of = "contact.force", by = "contact.speed", is = "contact.slope" }]
"""
PARAMETERS = "[parameters]\nblock.m = 2\nblock.spring.k = 5.5\n"
SCHEDULE = '[schedule]\ncontact.load = [[0, 10.0], ["250 ms", 20]]\n'
SIMULATE = """
[simulate]
stop_time = "1 min"
step_size = "10 ms"
min_step = 1e-6
algorithm = "gauss_seidel"
order = 1
iterate = "none"
tolerance = 1e-3
outputs = ["block.v"]
"""


def load(folder: Path, text: str, *changes: tuple[str, str]) -> tuple[System, dict[str, Any]]:
    path = folder / "rig.toml"
    path.write_text(text, "utf-8")
    return read(path, changes)


def facts(system: System) -> dict[str, Any]:
    return {
        "paths": {name: model.path for name, model in system.models.items()},
        "connections": [(c.source.name, c.target.name, c.factor, c.offset) for c in system.connections],
        "parameters": {name: (type(value), value) for name, value in system.parameters.items()},
        "schedule": system.schedule,
        "events": [port.name for port in system.events],
        "bonds": [(bond.name, bond.watt) for bond in system.bonds],
        "derivatives": {pair: port.name for pair, port in system.derivatives.items()},
    }


def in_python(folder: Path) -> System:
    return System(
        {name: folder / "fmus" / f"{name}.fmu" for name in ("block", "contact")},
        [("block.v", "contact.speed"), ("contact.force", "block.F", -1.0)],
        {"block.m": 2.0, "block.spring.k": 5.5},
        {"contact.load": [(0.0, 10.0), (0.25, 20.0)]},
        ["block.gap.open"],
        [("contact.force", "block.v")],
        {("contact.force", "contact.speed"): "contact.slope"},
    )


def test_a_file_gives_the_system_made_in_python(folder: Path) -> None:
    system, settings = load(folder, FMUS + COUPLING + PARAMETERS + SCHEDULE + SIMULATE)
    assert facts(system) == facts(in_python(folder))
    assert [c.factor for c in system.connections] == [-1000.0, 1.0]
    assert settings == {
        "stop_time": 60.0,
        "step_size": 0.01,
        "min_step": 1e-6,
        "algorithm": "gauss_seidel",
        "order": 1,
        "tolerance": 1e-3,
        "outputs": ["block.v"],
    }


def test_the_order_of_the_tables_does_not_matter(folder: Path) -> None:
    system, settings = load(folder, SIMULATE + SCHEDULE + PARAMETERS + COUPLING + FMUS)
    assert facts(system) == facts(in_python(folder))
    assert settings["stop_time"] == 60.0


@pytest.mark.parametrize(
    "table",
    [
        '[parameters]\n"block.m" = 2\n"block.spring.k" = 5.5\n',
        '[parameters.block]\nm = 2\n"spring.k" = 5.5\n',
        "[parameters]\nblock = { m = 2, spring.k = 5.5 }\n",
        '[parameters.block]\nm = 2\n[parameters."block.spring"]\nk = 5.5\n',
    ],
)
def test_parameters_can_be_written_as_toml_allows(folder: Path, table: str) -> None:
    system, _ = load(folder, FMUS + COUPLING + table + SCHEDULE)
    assert facts(system) == facts(in_python(folder))


def test_values_keep_their_types(folder: Path) -> None:
    system, _ = load(folder, FMUS + '[parameters.block]\nm = 3\ncount = 4\nlabel = "5"\nF = 1\n')
    assert facts(system)["parameters"] == {
        "block.F": (float, 1.0),
        "block.count": (int, 4),
        "block.label": (str, "5"),
        "block.m": (float, 3.0),
    }


def test_a_file_of_fmus_alone_is_a_system(folder: Path) -> None:
    system, settings = load(folder, FMUS)
    assert list(system.models) == ["block", "contact"]
    assert settings == {}


def test_changes_win_over_the_file(folder: Path) -> None:
    system, settings = load(
        folder,
        FMUS + PARAMETERS + SIMULATE,
        ("parameters.block.m", "7"),
        ("parameters.block.spring.k", "8.5"),
        ("parameters.block.label", "wet"),
        ("simulate.stop_time", "0.5"),
        ("simulate.step_size", "2 ms"),
        ("simulate.algorithm", "jacobi"),
        ("simulate.tolerance", "none"),
        ("simulate.outputs", '["contact.force"]'),
    )
    assert system.parameters == {"block.label": "wet", "block.m": 7.0, "block.spring.k": 8.5}
    assert settings["stop_time"] == 0.5
    assert settings["step_size"] == 0.002
    assert settings["algorithm"] == "jacobi"
    assert "tolerance" not in settings
    assert settings["outputs"] == ["contact.force"]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", r"\[fmus\] is missing"),
        ("[fmu]\n", r"A system has no 'fmu'. Did you mean 'fmus'\? Its tables are fmus, parameters"),
        ('connections = [["block.v", "contact.speed"]]\n' + FMUS, r"no 'connections'. It belongs to \[coupling\]"),
        ("fmus = 3\n", r"fmus = 3 must be a table. Write \[fmus\]"),
        ("[fmus]\nblock = 1\n", r"fmus.block = 1 must be the path"),
        ('[fmus]\nblock = "none.fmu"\n', r"The FMU '.*none.fmu' of 'block' does not exist"),
        (FMUS + "[coupling]\nconnection = []\n", r"\[coupling\] has no 'connection'. Did you mean 'connections'\?"),
        (FMUS + "[coupling]\nstop_time = 1\n", r"\[coupling\] has no 'stop_time'. It belongs to \[simulate\]"),
        (
            FMUS + '[coupling]\nconnections = "block.v"\n',
            r"coupling.connections = 'block.v' must be a list of outputs",
        ),
        (FMUS + '[coupling]\nconnections = ["block.v"]\n', r"coupling.connections\[0\] = 'block.v' must be a list"),
        (FMUS + '[coupling]\nconnections = [["block.v"]]\n', r"The connection \['block.v'\] is not"),
        (FMUS + '[coupling]\nconnections = [["block.w", "block.F"]]\n', r"no variable 'w'"),
        (FMUS + '[coupling]\nconnections = [["contact.slope", "block.F"]]\n', r"measures another quantity"),
        (FMUS + "[coupling]\nevents = [1]\n", r"coupling.events\[0\] = 1 must be text"),
        (FMUS + '[coupling]\nbonds = [["block.v"]]\n', r"coupling.bonds has \['block.v'\], but a bond is a pair"),
        (FMUS + '[coupling]\nderivatives = [["a", "b", "c"]]\n', r"coupling.derivatives has \['a', 'b', 'c'\], but"),
        (FMUS + '[coupling]\nderivatives = [{ of = "a", by = "b" }]\n', r"`is`, the output that is the derivative"),
        (FMUS + '[parameters]\nblock.m = 1\n"block.m" = 2\n', r"\[parameters\] has 'block.m' twice"),
        (FMUS + "[parameters]\nblok.m = 1\n", r"'blok.m' names no variable .* Did you mean 'block'\?"),
        (FMUS + '[parameters]\nblock.m = "1 kg"\n', r"'block.m' = '1 kg' is not a value of type Real"),
        (FMUS + "[parameters]\nblock.count = 1.5\n", r"'block.count' = 1.5 is not a value of type Integer"),
        (FMUS + "[parameters]\nblock.count = 2147483648\n", r"'block.count' = 2147483648 is beyond what Integer"),
        (FMUS + "[parameters]\nblock.m = inf\n", r"'block.m' = inf is not a value"),
        (FMUS + "[schedule]\ncontact.load = 10.0\n", r"schedule.contact.load = 10.0 must be a list of pairs"),
        (
            FMUS + "[schedule]\ncontact.load = [[1]]\n",
            r"schedule.contact.load has \[1\], but it must be a list",
        ),
        (FMUS + '[schedule]\ncontact.load = [["1 m", 2]]\n', r"schedule.contact.load = '1 m' has the wrong unit"),
        (
            FMUS + "[simulate]\nstop = 1\n",
            r"\[simulate\] has no 'stop'. Did you mean 'stop_time'\?",
        ),
        (FMUS + '[simulate]\nstop_time = "1"\n', r"simulate.stop_time = '1' has no unit. Write for example '1.0 s'"),
        (FMUS + "[simulate]\nstop_time = true\n", r"simulate.stop_time = True must be a number"),
        (FMUS + f"[simulate]\nstop_time = 1{'0' * 400}\n", r"simulate.stop_time = 1000.* is too large"),
        (FMUS + '[simulate]\norder = "1"\n', r"simulate.order = '1' must be one of 0, 1, 2"),
        (FMUS + "[simulate]\nalgorithm = 1\n", r"simulate.algorithm = 1 must be one of 'jacobi', 'gauss_seidel'"),
        (FMUS + '[simulate]\niterate = "newton"\n', r"'newton' must be one of 'fixed_point', 'aitken', 'quasi_newton'"),
        (FMUS + '[simulate]\noutputs = "block.v"\n', r"simulate.outputs = 'block.v' must be a list of variables"),
        (FMUS + "[simulate\n", r"This is not valid TOML"),
    ],
)
def test_what_does_not_fit_is_refused(folder: Path, text: str, says: str) -> None:
    with pytest.raises(CouplingError, match=rf"In '.*rig.toml': .*{says}"):
        load(folder, text)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (("coupling.events", "[]"), "'coupling.events' cannot be set from outside"),
        (("parameter.block.m", "1"), r"Did you mean 'parameters'\?"),
        (("simulate", "1"), "Name parameters.FMU.VARIABLE, or simulate.NAME"),
        (("simulate.stop", "1"), r"\[simulate\] has no 'stop'. Did you mean 'stop_time'\?"),
        (("simulate.order", "one"), "simulate.order = 'one' must be one of 0, 1, 2"),
        (("parameters.block.x", "1"), "no variable 'x'"),
        (("simulate.order", "1\nstop_time = 2"), "must be one of 0, 1, 2"),
    ],
)
def test_changes_that_do_not_fit_are_refused(folder: Path, change: tuple[str, str], says: str) -> None:
    with pytest.raises(CouplingError, match=says):
        load(folder, FMUS + PARAMETERS, change)


def test_a_missing_file_is_refused(folder: Path) -> None:
    with pytest.raises(CouplingError, match=r"In '.*no.toml': The file cannot be read: No such file"):
        read(folder / "no.toml")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("rig.ssp", r"This is an SSP, which is written here \(--ssp\) and not read"),
        ("rig.fmu", r'This is an FMU, not the TOML file of a system\. Write one: \[fmus\] block = "rig\.fmu"'),
        ("rig.toml", r"This is an archive, not the TOML file of a system"),
    ],
)
def test_an_archive_in_place_of_a_system_is_named(name: str, said: str, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / name, "w") as archive:
        archive.writestr("modelDescription.xml", "")
    with pytest.raises(CouplingError, match=said):
        read(tmp_path / name)


@pytest.mark.parametrize(
    ("found", "other", "says"),
    [
        ('fmiVersion="2.0"', 'fmiVersion="1.0"', r"is of FMI 1\.0, which is not supported; FMI 2\.0 and 3\.0 are"),
        (' fmiVersion="2.0"', "", r"is of FMI \(no version\), which is not supported"),
        ('Reference="3"', 'Reference="abc"', "variable 'm' has valueReference = 'abc', which is no whole number"),
        ('Real start="1"', 'Real start="53,7"', "variable 'm' has start = '53,7', which is no number"),
        ('Integer start="1"', 'Integer start="1.5"', "variable 'count' has start = '1.5', which is no whole number"),
        ('Real start="1"', 'Real nominal="" start="1"', "variable 'm' has nominal = '', which is no number"),
        ('name="spring.k"', 'name="m"', "it has 2 variables called 'm', which cannot be told apart"),
        ('<Unknown index="', '<Unknown index="99', r"modelDescription\.xml breaks the rules of FMI\. Export it anew"),
    ],
)
def test_what_an_fmu_describes_wrongly_is_told_by_its_name(found: str, other: str, says: str, tmp_path: Path) -> None:
    describe(tmp_path / "whole.fmu", BLOCK)
    with zipfile.ZipFile(tmp_path / "whole.fmu") as whole, zipfile.ZipFile(tmp_path / "wrong.fmu", "w") as wrong:
        text = whole.read("modelDescription.xml").decode()
        assert found in text
        wrong.writestr("modelDescription.xml", text.replace(found, other, 1))
    with pytest.raises(CouplingError, match=says):
        Model("block", tmp_path / "wrong.fmu")


def test_a_system_is_text_in_utf_8_with_a_mark_or_without(folder: Path, tmp_path: Path) -> None:
    file = folder / "coded.toml"
    file.write_text(FMUS, "utf-8-sig")
    read(file)
    file.write_text(FMUS, "utf-16")
    with pytest.raises(CouplingError, match=r"it is not in UTF-8\. Save it as UTF-8\.$"):
        read(file)


def test_outputs_that_are_no_numbers_are_named(tmp_path: Path) -> None:
    describe(tmp_path / "teller.fmu", [("v", "output", "Real"), ("label", "output", "String")])
    system = System({"teller": tmp_path / "teller.fmu"})
    assert [port.name for port in system.outputs(None)] == ["teller.v"]
    assert system.left_out() == ["teller.label"]
