"""The command `check --deep`: start values of the runs, and how long is waited for them."""

import itertools
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from checking import deep_findings, edited, replaced, verdicts

from system_models.check import deep, report
from system_models.check.verdict import Verdict
from system_models.cli.main import main
from system_models.fmu.errors import FmuError


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
    with pytest.raises(FmuError, match=r"fidelity = 3 must be at least 1 and at most 2\. Correct it in --set\."):
        deep_findings(levelled, "reset", fidelity="3")
    found = deep_findings(levelled, "reset", fidelity="2")
    assert found["run"].verdict == Verdict.FAIL
    assert "with fidelity = 2 (--set)" in found["start values"].evidence


@pytest.mark.long
def test_no_limit_of_an_isolated_fmus_start_fails_a_rule(slave: Callable[..., Path]) -> None:
    asks = "'pytest' in sys.modules or float(os.environ['TRIBOFMU_START_TIMEOUT'])"  # it runs while it is built, too
    assert deep_findings(slave("asks", start=asks), "finite")["run"].verdict == Verdict.PASS


def test_reference_results_are_those_of_the_fmus_own_start_values(levelled: Path) -> None:
    assert deep_findings(levelled, "reference results")["reference results"].verdict == Verdict.PASS


@pytest.mark.long
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
