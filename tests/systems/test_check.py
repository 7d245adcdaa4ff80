"""The command `check`: each defect of an FMU is told by the rule concerned, and by no other."""

import ctypes
import itertools
import math
import os
import re
import sys
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import models
import pytest
from pythonfmu.builder import FmuBuilder

from contact_core import Scene
from fmu_src.build import build
from system_models.check import deep, report, stages
from system_models.check.instance import Instance
from system_models.check.package import opened
from system_models.check.verdict import Answer, Finding, Verdict
from system_models.cli import main

XML = "modelDescription.xml"
Edit = Callable[[str], str]


def edited(fmu: Path, out: Path, edit: Edit, drop: str = "$^") -> Path:
    """A copy with its description edited, and without the files that `drop` matches."""
    with zipfile.ZipFile(fmu) as old, zipfile.ZipFile(out, "w") as new:
        for name in old.namelist():
            if not re.match(drop, name):
                data = old.read(name)
                new.writestr(name, edit(data.decode()) if name == XML else data)
    return out


def replaced(pattern: str, by: str) -> Edit:
    def edit(text: str) -> str:
        changed, count = re.subn(pattern, by, text, count=1)
        assert count == 1
        return changed

    return edit


def unchanged(text: str) -> str:
    return text


def static_findings(fmu: Path) -> dict[str, Finding]:
    with opened(fmu) as package:
        return {finding.rule: finding for finding in report.findings(package, False, 1.0, 1.0)}


def verdicts(found: dict, verdict: Verdict) -> set[str]:
    return {rule for rule, finding in found.items() if finding.verdict == verdict}


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Our own FMU, at its fast level, for hosts with Python."""
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    return build(scene, tmp_path_factory.mktemp("fmu") / "contact.fmu", flavour="embedded")


# the file


def test_our_own_fmu_breaks_no_rule(fmu: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(fmu)]) == 0
    *lines, last = capsys.readouterr().out.splitlines()
    assert {line[:18].strip() for line in lines} == set(report.static.RULES)
    assert re.search(r"1\d pass, 0 fail, \d note, 0 n/a\.$", last)


@pytest.mark.parametrize(
    ("edit", "rules", "evidence"),
    [
        (replaced(' unit="1"', ""), {"units"}, "Without a unit"),
        (replaced(r'(<Unit name="N">\s*)<BaseUnit [^>]*>', r"\1"), {"units"}, "Without a BaseUnit: the unit N,"),
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
        (replaced(' nominal="[^"]*"', ""), {"nominals"}, "Without a nominal: load;"),
        (replaced('(name="load".*\\s*<Real [^>]*start=)"[^"]*"', r'\1"-5"'), {"starts"}, "load starts at -5"),
        (
            replaced('(<Unknown index="[0-9]+") dependencies="" dependenciesKind=""', r"\1"),
            {"dependencies"},
            "Without dependencies: fr",
        ),
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


# the FMU at work

SLAVE = """
import json, math, os, sys, threading, time
from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real, String

class {name}(Fmi2Slave):
    {body}

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.u, self.x, self.y, self.hidden = 1.5, 0.0, 0.0, 0.0
        kinds = dict(u=Fmi2Causality.input, x=Fmi2Causality.local, y=Fmi2Causality.output)
        for name, causality in kinds.items():
            self.register_variable(Real(name, causality=causality, variability=Fmi2Variability.continuous))
        {start}

    def do_step(self, now, step):
        self.x += step * self.u
        self.y = self.x
        {step}
        return True
"""


@pytest.fixture
def slave(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Path]:
    """A small FMU, an integrator of its input u from -2 to 10, with a defect."""
    monkeypatch.setattr(sys, "path", [*sys.path])

    def make(name: str, step: str = "pass", start: str = "pass", body: str = "pass") -> Path:
        script = tmp_path / f"{name}.py"
        script.write_text(SLAVE.format(name=name, step=step, start=start, body=body))
        states = {"canGetAndSetFMUstate": True, "canSerializeFMUstate": True}
        fmu = FmuBuilder.build_FMU(script, tmp_path / f"{name}_plain.fmu", **states)
        ranged = replaced('<Real start="1.5"', '<Real start="1.5" min="-2" max="10"')
        independent = replaced('(<Outputs>\\s*<Unknown index="3")', r'\1 dependencies=""')
        return edited(fmu, tmp_path / f"{name}.fmu", lambda text: independent(ranged(text)))

    return make


# what they do, they do to the process in which they are asked
ROUGH = {"resources", "text", "reloading", "home", "children", "fork"}


def answers(fmu: Path) -> dict[str, Answer]:
    """The rules that run an FMU, answered in this process where that does it no harm."""
    folder = fmu.with_suffix("")
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    found = {}
    for rule, names in deep.RULES.items():  # `run` first: others read what it leaves
        if rule not in ROUGH:
            given = (stages.answer(folder, name, fmu.parent, {}) for name in names)
            found[rule] = next(answer for answer in given if answer is not None)
    return found


def deep_findings(fmu: Path, *rules: str, **start: str) -> dict[str, Finding]:
    """The rules that run an FMU, or some of them, in processes of their own that have all the time in the world."""
    with pytest.MonkeyPatch.context() as patch, opened(fmu) as package:
        patch.setattr(deep, "RULES", {rule: deep.RULES[rule] for rule in ("run", *rules)} if rules else deep.RULES)
        return {finding.rule: finding for finding in deep.findings(package, math.inf, math.inf, start.items())}


# what pythonfmu's binary lets pass
LAX = {"guid", "interface", "resources", "stop time", "communication point", "order of calls"}


def test_a_good_fmu_fails_no_rule_in_processes_of_its_own(slave: Callable[..., Path]) -> None:
    found = deep_findings(slave("good"))
    assert verdicts(found, Verdict.FAIL) == set()
    assert verdicts(found, Verdict.NOT_APPLICABLE) == {"reference results", "text"}
    assert verdicts(found, Verdict.NOTE) - {"memory"} == LAX | {"unusable input"}
    assert "with another guid, too" in found["guid"].evidence
    assert "for model exchange, too" in found["interface"].evidence
    assert "SIGABRT during fmi2Instantiate with fmuResourceLocation = None" in found["resources"].evidence
    assert "beyond the stop time is taken, and nothing says so" in found["stop time"].evidence
    assert "from 0.02 s after one that has ended at 0.01 s is taken" in found["communication point"].evidence
    assert "a step before initialisation, fmi2EnterInit" in found["order of calls"].evidence
    assert "2 settings of inputs" in found["feedthrough"].evidence
    assert "u = nan (into y)" in found["unusable input"].evidence
    assert "3 steps with inputs at the ends" in found["input range"].evidence


def test_an_fmu_that_minds_its_calls_and_its_host_gets_no_note(tmp_path: Path) -> None:
    found = deep_findings(models.build("echo", tmp_path), *LAX, *ROUGH)
    assert verdicts(found, Verdict.PASS) == {"run", *LAX, *ROUGH}


FORGETFUL = """
    @staticmethod
    def _fmu_state_to_bytes(state):
        return json.dumps({**state, "x": 0.0}).encode()
"""
DIRECT = "y = property(lambda self: self.x + self.u, lambda self, value: None)"
SHARED = 'x = property(lambda self: sys.shared_x, lambda self, value: setattr(sys, "shared_x", value))'


@pytest.mark.parametrize(
    ("name", "defect", "rules", "evidence"),
    [
        ("spoils", {"step": "if 0.04 < self.x < 0.05: self.y = math.nan"}, {"finite"}, "y not finite after 3 step"),
        ("hides", {"step": "self.hidden += 1.0; self.y += self.hidden"}, {"rollback", "serialise"}, "instead of"),
        ("forgets", {"body": FORGETFUL}, {"serialise"}, "bytes do not hold"),
        ("shares", {"body": SHARED}, {"two instances"}, "y is 0.0"),
        (
            "feeds",
            {"body": DIRECT},
            {"feedthrough"},
            "u = 0 moves y without a step; its dependencies do not list it.",
        ),
        ("dislikes", {"step": "if step < 0.01: self.y = math.inf"}, {"step splitting"}, "two steps of 0.005 s"),
        ("overflows", {"step": "if self.u == 10.0: self.y = math.inf"}, {"input range"}, "with u = 10"),
    ],
)
def test_a_misbehaving_fmu_fails_its_rule_only(
    slave: Callable[..., Path], name: str, defect: dict[str, str], rules: set[str], evidence: str
) -> None:
    found = answers(slave(name, **defect))
    assert verdicts(found, Verdict.FAIL) == rules
    assert all(evidence in found[rule].evidence for rule in rules)


def test_what_is_worth_knowing_is_a_note(slave: Callable[..., Path]) -> None:
    found = answers(slave("leaps", step="self.y += step * 100.0"))
    assert verdicts(found, Verdict.FAIL) == set()
    assert verdicts(found, Verdict.NOTE) - {"memory"} == (LAX - ROUGH) | {"unusable input", "step splitting"}
    assert "move y by" in found["step splitting"].evidence


def test_memory_that_instances_leave_behind_is_worth_a_note(slave: Callable[..., Path]) -> None:
    found = deep_findings(slave("hoards", start="sys.hoard = [*getattr(sys, 'hoard', []), b'x' * (1 << 20)]"), "memory")
    grown = re.search(r"grows by (\d+) kB", found["memory"].evidence)
    assert grown is not None
    assert found["memory"].verdict == Verdict.NOTE
    assert 500 < int(grown[1]) < 2000  # of 1024 that each hoards: what else was freed meanwhile counts, too


@pytest.mark.parametrize(
    ("name", "defect", "verdict", "evidence"),
    [
        ("refuses", {"step": "if not math.isfinite(self.u): return False"}, Verdict.PASS, "2 refused by status"),
        (
            "freezes",
            {"step": "if not math.isfinite(self.u): self.x = self.y = 0.0"},
            Verdict.NOTE,
            "The outputs stand still, and nothing says so, after u = nan, u = inf",
        ),
        (
            "owns_up",
            {
                "step": "self.ok = math.isfinite(self.u); self.x = self.y = self.x if self.ok else 0.0",
                "start": "self.ok = True; self.register_variable(Boolean('ok', causality=Fmi2Causality.output))",
            },
            Verdict.PASS,
            "2 leave the outputs as they stand, with ok = false.",
        ),
    ],
)
def test_outputs_that_stand_still_must_be_told(
    slave: Callable[..., Path], name: str, defect: dict[str, str], verdict: Verdict, evidence: str
) -> None:
    found = answers(slave(name, **defect))["unusable input"]
    assert found.verdict == verdict
    assert evidence in found.evidence


def test_a_dependency_that_is_declared_is_no_fault(slave: Callable[..., Path], tmp_path: Path) -> None:
    listed = replaced('dependencies=""', 'dependencies="1"')
    found = answers(edited(slave("declares", body=DIRECT), tmp_path / "declared.fmu", listed))
    assert found["feedthrough"].verdict == Verdict.PASS
    unsaid = replaced('dependencies=""', "")
    found = answers(edited(slave("omits", body=DIRECT), tmp_path / "unsaid.fmu", unsaid))
    assert found["feedthrough"].verdict == Verdict.NOT_APPLICABLE


def test_feedthrough_is_seen_where_no_state_can_be_kept(slave: Callable[..., Path], tmp_path: Path) -> None:
    stateless = replaced('canGetAndSetFMUstate="true"', 'canGetAndSetFMUstate="false"')
    found = answers(edited(slave("feeds_on", body=DIRECT), tmp_path / "stateless.fmu", stateless))
    assert "u = 0 moves y" in found["feedthrough"].evidence


def test_a_reset_that_does_nothing_fails(slave: Callable[..., Path], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Instance, "reset", lambda self: None)
    assert verdicts(answers(slave("stays")), Verdict.FAIL) == {"reset"}


def test_capabilities_that_are_not_declared_are_not_asked_for(slave: Callable[..., Path], tmp_path: Path) -> None:
    def humble(text: str) -> str:
        return re.sub(r'(can(Get|Serial|Handle)\w+)="true"', r'\1="false"', text)

    found = answers(edited(slave("humble"), tmp_path / "humbler.fmu", humble))
    assert verdicts(found, Verdict.NOT_APPLICABLE) == {"rollback", "serialise", "step splitting", "reference results"}
    assert verdicts(found, Verdict.FAIL) == set()


def test_reference_results_are_replayed(slave: Callable[..., Path]) -> None:
    fmu = slave("referred")
    folder = "extra/org.fmi-standard.fmi-ls-ref"
    with zipfile.ZipFile(fmu, "a") as archive:
        archive.writestr(f"{folder}/in.csv", "time,u\n0.0,1.0\n1.0,3.0\n")
        archive.writestr(f"{folder}/ref.csv", "time,y\n0.0,0.0\n0.5,0.5\n1.0,1.0\n3.0,7.001\n")
    assert answers(fmu)["reference results"] == (
        Verdict.PASS,
        "4 values of ref.csv come out again within their tolerance.",
    )
    with zipfile.ZipFile(fmu, "a") as archive:
        archive.writestr(f"{folder}/ref.opt", "StartTime, 0.0\nRelTol, 1e-4\n")
    found = answers(fmu)
    assert verdicts(found, Verdict.FAIL) == {"reference results"}
    assert "y is 7.0 at 3 s; ref.csv has 7.001 +- 0.0007" in found["reference results"].evidence


@pytest.mark.parametrize(
    ("name", "step", "evidence"),
    [
        ("leaves", "os._exit(7)", "exit code 7 during fmi2DoStep at 0 s, u = 1.5"),
        ("aborts", "os.abort()", "SIGABRT during fmi2DoStep" if os.name == "posix" else "during fmi2DoStep"),
        ("raises", "raise ValueError('too far')", "too far"),
    ],
)
def test_a_crash_is_a_verdict(slave: Callable[..., Path], name: str, step: str, evidence: str) -> None:
    found = deep_findings(slave(name, step))
    assert verdicts(found, Verdict.FAIL) == {"run"}
    assert evidence in found["run"].evidence
    assert verdicts(found, Verdict.NOT_APPLICABLE) == set(deep.RULES) - {"run"}


@pytest.fixture
def stuck(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A statement that never ends; the checker's clock stands until it is reached, and then leaps."""
    reached, leaps = tmp_path / "reached", itertools.count(1e6, 1e6)
    monkeypatch.setattr(deep, "monotonic", lambda: next(leaps) if reached.exists() else 0.0)
    return f"(open({str(reached)!r}, 'w').close(), time.sleep(1e6))"


def test_a_call_beyond_its_limit_leaves_open_whether_the_fmu_runs(
    slave: Callable[..., Path], stuck: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(report.static, "RULES", {})  # of which this FMU breaks one
    assert main(["check", str(slave("hangs", stuck)), "--deep", "--limit", "4", "--budget", "2"]) == 3
    printed = capsys.readouterr().out
    assert "note  Not finished: fmi2DoStep at 0 s, u = 1.5 had not returned after 4 s (--limit).\n" in printed
    assert printed.count("The FMU has not been seen to run.") == len(deep.RULES) - 1
    assert printed.endswith("; 1 not finished in time.\n")


def test_a_rule_beyond_its_budget_says_how_far_it_came(
    slave: Callable[..., Path], stuck: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(deep, "RULES", {rule: deep.RULES[rule] for rule in ("run", "input range")})
    lingers = slave("lingers", f"if self.u == 10.0: {stuck}")
    assert main(["check", str(lingers), "--deep", "--limit", "1e9", "--budget", "30"]) == 1
    out = capsys.readouterr().out
    assert (
        "note  Not finished in 30 s (--budget): 2 of 3 settings have been stepped with, and are right; it was in "
        "fmi2DoStep at 0 s, u = 10.\n"
    ) in out
    assert out.endswith("; 1 not finished in time.\n")


def test_rules_go_on_after_one_that_crashes(slave: Callable[..., Path]) -> None:
    found = deep_findings(slave("bursts", "if self.u == 10.0: os.abort()"), "input range", "reset")
    assert verdicts(found, Verdict.FAIL) == {"input range"}
    assert "u = 10" in found["input range"].evidence
    assert verdicts(found, Verdict.PASS) == {"run", "reset"}


# start values


@pytest.fixture
def levelled(slave: Callable[..., Path], tmp_path: Path) -> Path:
    """An FMU of two levels that starts at the higher one, where its steps fail; it carries results of its first."""
    parameter = "causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable"
    start = f"self.fidelity = 2; self.register_variable(Integer('fidelity', {parameter}))"
    fmu = slave("levelled", "if self.fidelity > 1: return False", start)
    out = edited(fmu, tmp_path / "levels.fmu", replaced('<Integer start="2"', '<Integer start="2" min="1" max="2"'))
    with zipfile.ZipFile(out, "a") as archive:
        archive.writestr("extra/ref.csv", "time,fidelity\n0.0,2\n")
    return out


def test_an_fmu_of_several_levels_runs_at_its_cheapest_unless_asked(levelled: Path) -> None:
    found = deep_findings(levelled, "reset")
    assert verdicts(found, Verdict.PASS) >= {"run", "reset"}
    assert "with fidelity = 1, the cheapest, where it starts with 2 (--set fidelity=2" in found["start values"].evidence
    found = deep_findings(levelled, "reset", fidelity="2")
    assert found["run"].verdict == Verdict.FAIL
    assert "with fidelity = 2 (--set)" in found["start values"].evidence


def test_reference_results_are_those_of_the_fmus_own_start_values(levelled: Path) -> None:
    assert deep_findings(levelled, "reference results")["reference results"].verdict == Verdict.PASS


def test_inputs_move_about_the_start_values_that_are_asked_for(slave: Callable[..., Path]) -> None:
    found = deep_findings(slave("fast", "if self.u < 4.0: return False"), "finite", u="4")
    assert found["run"].verdict == Verdict.PASS
    assert "with u = 4.0 (--set)" in found["start values"].evidence


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("v=1", "'v' is no input or parameter"),
        ("y=1", "'y' is no input or parameter"),
        ("u=one", "u = 'one' is no Real. Correct it in --set."),
    ],
)
def test_start_values_that_cannot_be_set_are_told(
    slave: Callable[..., Path], capsys: pytest.CaptureFixture[str], setting: str, said: str
) -> None:
    assert main(["check", str(slave("steady")), "--deep", "--set", setting]) == 2
    assert said in capsys.readouterr().err


# calls at the edge, and hosts of other kinds

SETUP = """
    stop = math.inf

    def setup_experiment(self, start, stop, tolerance):
        self.stop = math.inf if stop is None else stop
"""


@pytest.mark.parametrize(
    ("name", "step", "verdict", "evidence"),
    [
        ("stops", "if now + step > self.stop + 1e-9: return False", Verdict.PASS, "answered with discard"),
        (
            "haggles",
            "if now + step > self.stop: return False",
            Verdict.FAIL,
            "with 0.009999999999999998 s as stop time",
        ),
    ],
)
def test_a_stop_time_is_kept_but_for_rounding(
    slave: Callable[..., Path], name: str, step: str, verdict: Verdict, evidence: str
) -> None:
    found = answers(slave(name, step, body=SETUP))
    assert found["stop time"].verdict == verdict
    assert evidence in found["stop time"].evidence


WIPING = """
    def enter_initialization_mode(self):
        self.x = self.y = 0.0
"""


def test_a_second_initialisation_that_wipes_the_state_is_worth_a_note(slave: Callable[..., Path]) -> None:
    found = answers(slave("wipes", body=WIPING))
    assert verdicts(found, Verdict.FAIL) == set()
    assert "an initialisation mode that comes too late, y is 0.0 instead of" in found["order of calls"].evidence


TEXT = "self.register_variable(String('s', causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed))"


@pytest.mark.parametrize(
    ("name", "setter", "verdict", "evidence"),
    [
        ("chokes", "os.abort() if len(text) > 1000 else None", Verdict.FAIL, "of s = b'xxxxxxxx'..., 100000 bytes"),
        ("reads", "None", Verdict.NOTE, r"of s = b'\xff\xfe \xc3( \x80', 7 bytes"),  # pythonfmu's binary cannot
    ],
)
def test_texts_of_all_kinds_are_tried(
    slave: Callable[..., Path], name: str, setter: str, verdict: Verdict, evidence: str
) -> None:
    body = f"s = property(lambda self: 'read', lambda self, text: {setter})"
    found = deep_findings(slave(name, start=TEXT, body=body), "text")
    assert found["text"].verdict == verdict
    assert evidence in found["text"].evidence


def has_landlock() -> bool:
    """Whether Linux can keep a process from writing: its version of landlock_create_ruleset."""
    return sys.platform == "linux" and ctypes.CDLL(None).syscall(444, None, ctypes.c_size_t(0), 1) > 0


AT_WORK = "'pytest' not in sys.modules"  # not while the FMU is built


@pytest.mark.skipif(sys.platform != "linux", reason="asked on Linux only")
@pytest.mark.parametrize(
    ("rule", "defect", "evidence"),
    [
        ("home", {"start": "os.stat(os.environ['HOME'])"}, "It cannot be instantiated without a home folder"),
        (
            "children",
            {"start": f"{AT_WORK} and (os.fork() or os._exit(0))"},
            "the host has a child process that it did not start",
        ),
    ],
)
def test_a_demand_on_the_host_is_worth_a_note(
    slave: Callable[..., Path], rule: str, defect: dict[str, str], evidence: str
) -> None:
    found = deep_findings(slave(f"demands_{rule}", **defect), "home", "children")
    assert verdicts(found, Verdict.NOTE) == {rule}
    assert evidence in found[rule].evidence


@pytest.mark.skipif(not has_landlock(), reason="this system has no Landlock")
def test_a_file_written_anywhere_but_in_the_temporary_folder_is_worth_a_note(slave: Callable[..., Path]) -> None:
    scribbling = f"{AT_WORK} and open('/proc/self/comm', 'w').write('slave')"
    found = deep_findings(slave("scribbles", start=scribbling), "home")["home"]
    assert found.verdict == Verdict.NOTE
    assert "where only /" in found.evidence
    assert "Permission denied" in found.evidence


def test_a_library_that_forgets_its_instances_when_loaded_again_is_worth_a_note(tmp_path: Path) -> None:
    found = deep_findings(models.build("registrar", tmp_path), "two instances", "reloading")
    assert verdicts(found, Verdict.PASS) == {"run", "two instances"}
    assert "after the library was loaded again was answered with error (This library" in found["reloading"].evidence


@pytest.mark.skipif(sys.platform != "linux", reason="asked on Linux only")
def test_a_lock_that_a_forked_child_cannot_get_is_worth_a_note(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The checker's clock leaps when it has found the same call ten times in a row."""
    seen: list[bytes] = []

    def clock() -> float:
        seen.extend(path.read_bytes() for path in tmp_path.glob("tribofmu-check-*/notebook/call"))
        stands = len(set(seen[-10:])) == 1 and b"fmi2FreeInstance" in seen[-1] and b"forked" in seen[-1]
        return 1e6 if stands else 0.0

    monkeypatch.setattr(deep, "monotonic", clock)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(deep, "RULES", {"fork": ("fork",)})
    with opened(models.build("locker", tmp_path)) as package:
        (found,) = deep.findings(package, math.inf, 1.0)
    assert found.verdict == Verdict.NOTE
    assert "of 200 children forked while other threads worked with it have gone on" in found.evidence
    assert found.evidence.endswith("; it was in fmi2FreeInstance.")


def test_other_processes_are_asked(slave: Callable[..., Path]) -> None:
    found = deep_findings(slave("knows", "self.y += os.getpid()"), "rollback", "replay")
    assert verdicts(found, Verdict.FAIL) == {"replay"}


@pytest.mark.parametrize("flavour", ["embedded", "isolated"])
def test_our_own_fmu_is_rolled_back_and_restored_in_another_process(
    flavour: str, scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)
    rules = {"rollback", "serialise", "feedthrough", "guid"}
    found = deep_findings(build(scene.at_level("regression"), tmp_path / "contact.fmu", flavour), *rules)
    assert verdicts(found, Verdict.NOTE) == ({"guid"} if flavour == "embedded" else set())
    assert verdicts(found, Verdict.PASS) == {"run", *rules} - verdicts(found, Verdict.NOTE)


def test_what_cannot_be_run_here_is_not_judged(fmu: Path, tmp_path: Path) -> None:
    none = edited(fmu, tmp_path / "none.fmu", unchanged, "binaries/")
    exchange = edited(fmu, tmp_path / "exchange.fmu", replaced("<CoSimulation ", "<ModelExchange "))
    for file in (none, exchange):
        assert verdicts(deep_findings(file), Verdict.NOT_APPLICABLE) == set(deep.RULES)


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
