"""The command `check --deep`: each defect of what an FMU answers is told by the rule concerned, and by no other."""

import os
import re
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from built import Built
from checking import LAX, ROUGH, answers, deep_findings, edited, replaced, verdicts

from benchmarks import models
from contact_core import Scene
from fmu_src.flavours import Flavour
from system_models.check import deep
from system_models.check.instance import Instance
from system_models.check.verdict import Verdict


def partly(fmu: Path) -> dict[str, Any]:
    """Ask in this process, and in others what might crash."""
    return answers(fmu) | deep_findings(fmu, "resources", "text")


@pytest.mark.parametrize("asked", [partly, pytest.param(deep_findings, marks=pytest.mark.long)])
def test_a_good_fmu_fails_no_rule(slave: Callable[..., Path], asked: Callable[[Path], dict[str, Any]]) -> None:
    found = asked(slave("good"))
    assert verdicts(found, Verdict.FAIL) == set()
    assert verdicts(found, Verdict.NOT_APPLICABLE) == {"derivatives", "reference results", "text"}
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
    fmu = models.build("echo", tmp_path)
    assert verdicts(answers(fmu), Verdict.PASS) >= LAX - ROUGH
    assert verdicts(deep_findings(fmu, "resources", "text"), Verdict.PASS) == {"run", "resources", "text"}


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
    hoards = slave("hoards", step="if now == 0.0: sys.hoard = [*getattr(sys, 'hoard', []), b'x' * (1 << 20)]")
    found = deep_findings(hoards, "memory")
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


@pytest.mark.parametrize(
    ("name", "step", "verdict"),
    [
        ("shrinks", "self.ok = self.u < 10.0; self.x = self.y = self.x if self.ok else 0.0", Verdict.NOTE),
        ("signals", "self.ok = self.u < 10.0", Verdict.PASS),
        ("rejects", "if self.u == 10.0: return False", Verdict.FAIL),
    ],
)
def test_a_range_is_what_the_fmu_can_use(slave: Callable[..., Path], name: str, step: str, verdict: Verdict) -> None:
    start = "self.ok = True; self.register_variable(Boolean('ok', causality=Fmi2Causality.output))"
    found = answers(slave(name, step=step, start=start), "input range")["input range"]
    assert found.verdict == verdict
    assert verdict == Verdict.PASS or "u = 10" in found.evidence
    assert verdict != Verdict.NOTE or "u = 10 (ok = false, and the outputs stand still)" in found.evidence


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
    assert verdicts(found, Verdict.NOT_APPLICABLE) == {
        "rollback",
        "serialise",
        "step splitting",
        "derivatives",
        "reference results",
    }
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


EXPERIMENTS = """<Experiments><Experiment tolerance="{}">
<Stimuli source="held.csv"/><References source="out.csv"/>
</Experiment></Experiments>"""


@pytest.mark.parametrize(
    ("tolerance", "alone", "verdict", "evidence"),
    [
        ("1e-2", "1.5", Verdict.PASS, "4 values of out.csv, alone.csv come out again within their tolerance."),
        ("1e-2", "1.6", Verdict.NOTE, "alone.csv has 1.6 +- 0.0016. Its manifest names no experiment, so that inputs"),
        ("1e-3", "1.5", Verdict.FAIL, "y is 1.0 at 1 s; out.csv has 1.005 +- 0.001."),
    ],
)
def test_reference_results_are_those_that_the_manifest_names(
    slave: Callable[..., Path], tolerance: str, alone: str, verdict: Verdict, evidence: str
) -> None:
    fmu = slave("named")
    related = '<r><Related source="../runs.xml" role="experiment"/><Related source="../alone.csv" role="result"/></r>'
    with zipfile.ZipFile(fmu, "a") as archive:
        archive.writestr("extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml", related)
        archive.writestr("extra/runs.xml", EXPERIMENTS.format(tolerance))
        archive.writestr("extra/held.csv", "time,u\n0.0,1.0\n")
        archive.writestr("extra/out.csv", "time,y\n0.0,0.0\n1.0,1.005\n")
        archive.writestr("extra/alone.csv", f"time,y\n0.0,0.0\n1.0,{alone}\n")
    found = answers(fmu, "reference results")["reference results"]
    assert found.verdict == verdict
    assert evidence in found.evidence


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


def test_rules_go_on_after_one_that_crashes(slave: Callable[..., Path]) -> None:
    found = deep_findings(slave("bursts", "if self.u == 10.0: os.abort()"), "input range", "reset")
    assert verdicts(found, Verdict.FAIL) == {"input range"}
    assert "u = 10" in found["input range"].evidence
    assert verdicts(found, Verdict.PASS) == {"run", "reset"}


def test_other_processes_are_asked(slave: Callable[..., Path]) -> None:
    found = deep_findings(slave("knows", "self.y += os.getpid()"), "rollback", "replay")
    assert verdicts(found, Verdict.FAIL) == {"replay"}


@pytest.mark.long
@pytest.mark.parametrize("flavour", ["embedded", "isolated"])
def test_our_own_fmu_is_restored_in_another_process(
    flavour: Flavour, scene: Scene, built: Built, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)
    rules = {"serialise", "guid"}
    found = deep_findings(built.fmu(scene.at_level("regression"), flavour), *rules)
    assert verdicts(found, Verdict.NOTE) == ({"guid"} if flavour == "embedded" else set())
    assert verdicts(found, Verdict.PASS) == {"run", *rules} - verdicts(found, Verdict.NOTE)
