"""The command `check`: each defect of a file is told by the rule concerned, and by no other."""

import math
import re
import zipfile
from pathlib import Path

import pytest
from checking import XML, Edit, deep_findings, edited, replaced, static_findings, unchanged, verdicts

from contact_core import Scene
from fmu_src.package.build import build
from system_models.check import deep, report
from system_models.check.package import opened
from system_models.check.verdict import Finding, Verdict
from system_models.cli.main import main


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Our own FMU, at its regression level, for hosts with Python."""
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    return build(scene, tmp_path_factory.mktemp("fmu") / "contact.fmu", flavour="embedded")


def test_our_own_fmu_breaks_no_rule(fmu: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(fmu)]) == 0
    *lines, last = capsys.readouterr().out.splitlines()
    assert {line[:18].strip() for line in lines} == set(report.static.RULES)
    assert re.search(r"1\d pass, 0 fail, \d note, 0 n/a\.$", last)


@pytest.mark.parametrize(
    ("edit", "rules", "evidence"),
    [
        (
            replaced('(name="load".*\\s*<Real [^>]*)unit="N"', r'\1unit="newton"'),
            {"units", "fmpy"},
            "Not in UnitDefinitions: the unit 'newton' of load.",
        ),
        (
            replaced(r'(<Unit name="N">\s*)<BaseUnit [^>]*>', r'\1<BaseUnit kg="1" m="1" s="-1"/>'),
            {"unit audit"},
            "'N' is declared as kg=1 m=1 s=-1; by its name it is kg=1 m=1 s=-2",
        ),
        (
            replaced('offset="-273.15"', 'offset="273.15"'),
            {"unit audit"},
            "'degC' of 'K' has factor=1 offset=273.15; by its name it has factor=1 offset=-273.15",
        ),
        (
            replaced('(<Unit name="Pa">\\s*<BaseUnit [^>]*>)', r'\1<DisplayUnit name="GPa" factor="1e9"/>'),
            {"unit audit"},
            "'GPa' of 'Pa' has factor=1e+09 offset=0; by its name it has factor=1e-09 offset=0",
        ),
        (
            replaced('(name="um" factor=)"[^"]*"', r'\1"1000"'),
            {"unit audit"},
            "by its name it has factor=1e+06 offset=0",
        ),
        (
            replaced('(<Unit name="N">\\s*<BaseUnit [^>]*>)', r'\1<DisplayUnit name="mm" factor="1000"/>'),
            {"unit audit"},
            "'mm' of 'N' is by its name m=1 factor=0.001, and cannot show kg=1 m=1 s=-2",
        ),
        (replaced('nominal="50.0"', 'nominal="0"'), {"nominals"}, "load = 0 must be finite and above zero"),
        (replaced('nominal="50.0"', 'nominal="-50"'), {"nominals"}, "load = -50 must be finite and above zero"),
        (
            replaced('(name="speed_1" valueReference=)"1"', r'\1"0"'),
            {"aliases"},
            "With one valueReference, 0, but not one unit: load in N, speed_1 in m/s.",
        ),
        (
            replaced('(name="speed_2" valueReference=)"2"', r'\1"1"'),
            {"aliases"},
            "With one valueReference, 1, but each to be set: speed_1, speed_2.",
        ),
        (replaced('startTime="0.0"', 'startTime="7200"'), {"experiment"}, "stopTime = 7200.0 must be above startTime"),
        (replaced('stepSize="[^"]*"', 'stepSize="0"'), {"experiment"}, "stepSize = 0 must be finite and above zero"),
        (replaced('(name="load".*\\s*<Real [^>]*start=)"[^"]*"', r'\1"-5"'), {"starts"}, "load starts at -5"),
        (
            replaced('(<Outputs>\\s*)<Unknown index="[0-9]+" [^>]*>', r"\1"),
            {"outputs", "fmpy"},
            "Not in ModelStructure/Outputs: friction_force.",
        ),
        (
            replaced('(<InitialUnknowns>\\s*)<Unknown index="[0-9]+" [^>]*>', r"\1"),
            {"initial unknowns", "fmpy"},
            "not in ModelStructure/InitialUnknowns: friction_force.",
        ),
        (replaced("<fmiModelDescription ", '<fmiModelDescription colour="red" '), {"schema", "fmpy"}, "'colour'"),
        (replaced('needsExecutionTool="true"', 'needsExecutionTool="false"'), {"host needs"}, "must declare"),
    ],
)
def test_a_defect_of_the_description_fails_its_rule_only(
    fmu: Path, tmp_path: Path, edit: Edit, rules: set[str], evidence: str
) -> None:
    found = static_findings(edited(fmu, tmp_path / "edited.fmu", edit))
    assert verdicts(found, Verdict.FAIL) == rules
    assert any(evidence in found[rule].evidence for rule in rules)


@pytest.mark.parametrize(
    ("edit", "rule", "evidence"),
    [
        (replaced(' unit="1"', ""), "units", "Without a unit"),
        (replaced(r'(<Unit name="N">\s*)<BaseUnit [^>]*>', r"\1"), "units", "Without a BaseUnit: the unit N,"),
        (replaced(' nominal="[^"]*"', ""), "nominals", "Without a nominal: load;"),
        (
            replaced('(<Unknown index="[0-9]+") dependencies="" \\w+=""', r"\1"),
            "dependencies",
            "Without dependencies: fr",
        ),
    ],
)
def test_what_fmi_leaves_open_is_worth_a_note(fmu: Path, tmp_path: Path, edit: Edit, rule: str, evidence: str) -> None:
    found = static_findings(edited(fmu, tmp_path / "edited.fmu", edit))
    assert verdicts(found, Verdict.FAIL) == set()
    assert found[rule].verdict == Verdict.NOTE
    assert evidence in found[rule].evidence


def test_a_description_that_cannot_be_interpreted_is_not_judged_further(fmu: Path, tmp_path: Path) -> None:
    odd = edited(fmu, tmp_path / "edited.fmu", replaced('causality="input"', 'causality="inward"'))
    found = static_findings(odd)
    assert verdicts(found, Verdict.FAIL) == {"schema", "fmpy"}
    assert verdicts(found, Verdict.NOT_APPLICABLE) >= {"units", "outputs", "starts"}


def test_a_missing_platform_is_worth_a_note_and_no_platform_a_failure(fmu: Path, tmp_path: Path) -> None:
    with opened(fmu) as package:
        here = package.platform
    found = static_findings(edited(fmu, tmp_path / "one.fmu", unchanged, f"binaries/{here}/"))
    assert verdicts(found, Verdict.FAIL) == set()
    assert f"None for this machine, {here}" in found["platforms"].evidence
    found = static_findings(edited(fmu, tmp_path / "none.fmu", unchanged, "binaries/"))
    assert verdicts(found, Verdict.FAIL) == {"platforms"}


def test_a_binary_of_another_name_is_not_found(fmu: Path, tmp_path: Path) -> None:
    renamed = edited(fmu, tmp_path / "x.fmu", replaced('modelIdentifier="MixedContact"', 'modelIdentifier="Mixed"'))
    found = static_findings(renamed)
    assert verdicts(found, Verdict.FAIL) == {"platforms"}
    assert "no library called Mixed" in found["platforms"].evidence


def test_a_path_out_of_the_folder_and_a_damaged_file_fail_the_archive(fmu: Path, tmp_path: Path) -> None:
    out = edited(fmu, tmp_path / "out.fmu", unchanged)
    with zipfile.ZipFile(out, "a") as archive:
        archive.writestr("../outside.txt", "")
    assert verdicts(static_findings(out), Verdict.FAIL) == {"archive"}
    with zipfile.ZipFile(fmu) as archive:
        entry = archive.getinfo("documentation/index.html")
    data = bytearray(fmu.read_bytes())
    data[entry.header_offset + entry.compress_size // 2] ^= 0xFF
    (tmp_path / "damaged.fmu").write_bytes(data)
    assert verdicts(static_findings(tmp_path / "damaged.fmu"), Verdict.FAIL) == {"archive"}


def test_a_file_that_is_no_fmu_is_refused_with_a_sentence(
    fmu: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cut = tmp_path / "cut.fmu"
    cut.write_bytes(fmu.read_bytes()[:5000])
    empty = edited(fmu, tmp_path / "empty.fmu", unchanged, XML)
    for file, said in (
        (cut, "is cut short"),
        (empty, "holds no modelDescription.xml"),
        (edited(fmu, tmp_path / "xml.fmu", lambda text: text[:-30]), "cannot be read"),
        (tmp_path / "nowhere.fmu", "No such file"),
    ):
        assert main(["check", str(file)]) == 2
        printed = capsys.readouterr()
        assert said in printed.err
        assert printed.out == ""


def test_a_unit_of_angles_without_rad_is_worth_a_note(fmu: Path, tmp_path: Path) -> None:
    assert static_findings(fmu)["unit audit"].verdict == Verdict.PASS
    without = replaced(r'(<Unit name="rad/s">\s*<BaseUnit .*)rad="1"', r"\1")
    old = static_findings(edited(fmu, tmp_path / "old.fmu", without))
    assert old["unit audit"].verdict == Verdict.NOTE
    assert "The BaseUnit of 'rad/s' lacks rad." in old["unit audit"].evidence


def test_a_display_unit_of_turns_is_converted_to_radians(fmu: Path, tmp_path: Path) -> None:
    def shown(factor: float) -> Finding:
        by = rf'\1<DisplayUnit name="rpm" factor="{factor!r}"/></Unit>'
        turning = edited(
            fmu, tmp_path / f"{factor}.fmu", replaced(r'(<Unit name="rad/s">\s*<BaseUnit [^>]*>)\s*</Unit>', by)
        )
        return static_findings(turning)["unit audit"]

    assert shown(30.0 / math.pi).verdict == Verdict.PASS
    assert shown(60.0).verdict == Verdict.FAIL


def test_a_failed_rule_is_told_by_the_exit_code(fmu: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(edited(fmu, tmp_path / "bare.fmu", unchanged, "binaries/"))]) == 1
    assert "1 fail" in capsys.readouterr().out


# the binaries


def with_binary(fmu: Path, out: Path, name: str, data: bytes) -> Path:
    """A copy with another library in it."""
    copy = edited(fmu, out, unchanged, re.escape(name))
    with zipfile.ZipFile(copy, "a") as archive:
        archive.writestr(name, data)
    return copy


LIBRARIES = {"linux64": "binaries/linux64/MixedContact.so", "win64": "binaries/win64/MixedContact.dll"}


@pytest.mark.parametrize(
    ("folder", "of", "evidence"),
    [("linux64", "win64", "a library for x86_64-windows"), ("win64", "linux64", "a library for x86_64-linux")],
)
def test_a_library_in_the_folder_of_another_platform_fails(
    fmu: Path, tmp_path: Path, folder: str, of: str, evidence: str
) -> None:
    with zipfile.ZipFile(fmu) as archive:
        data = archive.read(LIBRARIES[of])
    found = static_findings(with_binary(fmu, tmp_path / "other.fmu", LIBRARIES[folder], data))
    assert verdicts(found, Verdict.FAIL) == {"platforms"}
    assert f"{LIBRARIES[folder]} is {evidence}, not for {folder}." in found["platforms"].evidence


def test_a_file_that_is_no_library_fails_where_the_platform_is_known(fmu: Path, tmp_path: Path) -> None:
    found = static_findings(with_binary(fmu, tmp_path / "script.fmu", LIBRARIES["linux64"], b"#!/bin/sh\n"))
    assert verdicts(found, Verdict.FAIL) == {"platforms"}
    assert "for no platform known here, not for linux64" in found["platforms"].evidence


@pytest.mark.parametrize("folder", LIBRARIES)
@pytest.mark.parametrize("part", [0.0005, 0.3, 0.999])
def test_a_library_that_is_cut_short_fails(fmu: Path, tmp_path: Path, folder: str, part: float) -> None:
    with zipfile.ZipFile(fmu) as archive:
        data = archive.read(LIBRARIES[folder])
    cut = data[: int(part * len(data))]
    found = static_findings(with_binary(fmu, tmp_path / "cut.fmu", LIBRARIES[folder], cut))
    assert verdicts(found, Verdict.FAIL) == {"platforms"}
    assert f"{LIBRARIES[folder]} cannot be loaded: it is damaged" in found["platforms"].evidence


@pytest.mark.parametrize(
    "data", [b"", b"#!/bin/sh\n", b"\x7fELF\x01\x01\x01" + bytes(90), b"\xcf\xfa\xed\xfe" + bytes(90)]
)
def test_a_binary_of_another_kind_is_not_examined(fmu: Path, tmp_path: Path, data: bytes) -> None:
    other = edited(fmu, tmp_path / "other.fmu", unchanged, "binaries/")
    with zipfile.ZipFile(other, "a") as archive:
        archive.writestr("binaries/linux32/MixedContact.so", data)
    found = static_findings(other)
    for rule in ("functions", "host needs"):
        assert found[rule].verdict == Verdict.NOT_APPLICABLE
        assert "linux32 was not examined: it is neither a 64-bit ELF nor a PE file." in found[rule].evidence


def test_what_cannot_be_run_here_is_not_judged(fmu: Path, tmp_path: Path) -> None:
    none = edited(fmu, tmp_path / "none.fmu", unchanged, "binaries/")
    exchange = edited(fmu, tmp_path / "exchange.fmu", replaced("<CoSimulation ", "<ModelExchange "))
    for file in (none, exchange):
        assert verdicts(deep_findings(file), Verdict.NOT_APPLICABLE) == set(deep.RULES)


MANIFEST = "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml"


@pytest.mark.parametrize(
    ("manifest", "verdict", "evidence"),
    [
        (
            '<r><Related source="../../documentation/index.html" role="result"/></r>',
            "pass",
            "documentation/index.html;",
        ),
        (
            '<r><Related source="no%20where.exp" role="experiment/smoke-test"/></r>',
            "note",
            "no where.exp, which the FMU",
        ),
        ('<r><Related source="../../../../etc/hostname" role="result"/></r>', "note", "There are no reference results"),
        ('<r><Related source="file:///etc/hostname" role="result"/></r>', "note", "There are no reference results"),
        ('<!DOCTYPE r><r><Related source="x" role="result"/></r>', "fail", "it has a DOCTYPE"),
    ],
)
def test_the_manifest_says_which_results_there_are(
    fmu: Path, tmp_path: Path, manifest: str, verdict: str, evidence: str
) -> None:
    copy = edited(fmu, tmp_path / "named.fmu", unchanged)
    with zipfile.ZipFile(copy, "a") as archive:
        archive.writestr(MANIFEST, manifest)
    with opened(copy) as package:
        found = report.static.reference_data(package)
    assert found.verdict == verdict
    assert evidence in found.evidence


FMI_3 = """<fmiModelDescription fmiVersion="3.0" modelName="three" instantiationToken="3">
  <CoSimulation modelIdentifier="three"/>
  <UnitDefinitions><Unit name="m"><BaseUnit m="1"/></Unit></UnitDefinitions>
  <ModelVariables>
    <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
    <Float64 name="x" valueReference="1" causality="output" unit="m" nominal="1e-6" {initial}/>
  </ModelVariables>
  <ModelStructure><Output valueReference="1" dependencies=""/><InitialUnknown valueReference="1"/></ModelStructure>
</fmiModelDescription>
"""


@pytest.mark.parametrize(("initial", "failing"), [("", set()), ('initial="exact"', {"starts", "fmpy"})])
def test_the_file_of_an_fmi_3_fmu_is_judged(tmp_path: Path, initial: str, failing: set[str]) -> None:
    with zipfile.ZipFile(tmp_path / "three.fmu", "w") as archive:
        archive.writestr(XML, FMI_3.format(initial=initial))
        archive.writestr("sources/three.c", "")
    found = static_findings(tmp_path / "three.fmu")
    assert verdicts(found, Verdict.FAIL) == failing
    assert verdicts(found, Verdict.NOT_APPLICABLE) == {"functions", "host needs"}
