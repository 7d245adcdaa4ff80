"""The command `check` on FMUs of FMI 3.0: every rule asks them, and each defect is told by the rule concerned."""

import sys
import zipfile
from pathlib import Path

import pytest
from checking import LAX, ROUGH, XML, answers, deep_findings, edited, replaced, static_findings, verdicts
from mapped_scene import SMALL

from benchmarks import models
from contact_core import Scene
from fmu_src.flavours import Flavour
from fmu_src.package.build import build
from system_models.check.library import FMU2Checked, FMU3Checked
from system_models.check.verdict import Verdict


def built(name: str, tmp_path: Path, **variant: object) -> Path:
    return models.build(name, tmp_path, fmi=3, **variant)


def test_an_fmu_that_minds_its_calls_gets_no_note(tmp_path: Path) -> None:
    assert verdicts(answers(built("echo", tmp_path)), Verdict.PASS) >= LAX - ROUGH - {"stop time"}


@pytest.mark.long
def test_an_fmu_that_minds_its_host_gets_no_note(tmp_path: Path) -> None:
    assert verdicts(deep_findings(built("echo", tmp_path), *ROUGH), Verdict.PASS) == {"run", *ROUGH}


@pytest.mark.usefixtures("unoptimised")
@pytest.mark.parametrize("flavour", [pytest.param("native", marks=pytest.mark.long), "isolated"])
def test_our_own_fmu_fails_no_rule(tmp_path: Path, flavour: Flavour, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)
    fmu = build(
        Scene.from_toml("mtm_zddp", SMALL).at_level("regression"),
        tmp_path / "contact.fmu",
        flavour,
        fmi=3,
        reference=True,
    )
    assert verdicts(static_findings(fmu), Verdict.FAIL) == set()
    found = answers(fmu)
    assert verdicts(found, Verdict.FAIL) == set()
    assert verdicts(found, Verdict.NOTE) <= {"step splitting", "derivatives"}
    assert found["stop time"].verdict == Verdict.PASS


def test_a_good_fmu_fails_no_rule(tmp_path: Path) -> None:
    assert verdicts(static_findings(built("friction", tmp_path)), Verdict.FAIL) == set()
    found = answers(built("early", tmp_path))
    assert verdicts(found, Verdict.FAIL) == set()
    assert verdicts(found, Verdict.NOT_APPLICABLE) == {"derivatives", "reference results"}
    assert "another process give the same bits" in found["serialise"].evidence


@pytest.mark.parametrize(
    ("name", "start", "rule", "evidence"),
    [
        ("nan", {"t_nan": 0.015}, "finite", "y not finite after"),
        ("failing", {"t_fail": 0.015}, "run", "fmi3DoStep at 0.01 s, u = 0.01 was answered with error"),
        ("terminator", {"t_end": 0.015}, "run", "fmi3DoStep at 0.01 s, u = 0.01 was answered with discard"),
    ],
)
def test_a_misbehaving_fmu_fails_its_rule(
    tmp_path: Path, name: str, start: dict[str, float], rule: str, evidence: str
) -> None:
    found = answers(built(name, tmp_path, start=start), rule)
    assert verdicts(found, Verdict.FAIL) == {rule}
    assert evidence in found[rule].evidence


def test_a_state_that_is_promised_but_not_kept_fails_its_rules(tmp_path: Path) -> None:
    fmu = built("early", tmp_path, rollback=False)
    promised = replaced('canGetAndSetFMUState="false" canSerializeFMUState="false"', 'canGetAndSetFMUState="true"')
    found = answers(edited(fmu, tmp_path / "promises.fmu", promised), "rollback")
    assert "fmi3GetFMUState was answered with error" in found["rollback"].evidence


def test_a_step_that_nobody_gives_has_a_thousand_of_the_fmus_own_at_most(tmp_path: Path) -> None:
    small = replaced("<CoSimulation ", '<CoSimulation fixedInternalStepSize="1e-6" ')
    found = answers(edited(built("gain", tmp_path), tmp_path / "small.fmu", small), "finite")
    assert "3 steps of 0.001 s" in found["run"].evidence


def test_a_dependency_that_is_not_declared_fails_its_rule(tmp_path: Path) -> None:
    independent = replaced('(<Output valueReference="4") dependencies="3"', r'\1 dependencies=""')
    found = answers(edited(built("gain", tmp_path), tmp_path / "silent.fmu", independent))
    assert verdicts(found, Verdict.FAIL) == {"feedthrough"}
    assert "moves y without a step" in found["feedthrough"].evidence
    assert found["derivatives"].evidence == "1 derivatives agree with differences, while it is initialised."


@pytest.mark.parametrize(("fmi", "library"), [(2, FMU2Checked), (3, FMU3Checked)])
def test_a_wrong_derivative_fails_its_rule(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fmi: int, library: type
) -> None:
    fmu = models.build("gain", tmp_path, fmi=fmi, start={"a": 3.0})
    assert answers(fmu)["derivatives"].evidence == "1 derivatives agree with differences."
    right = library.getDirectionalDerivative
    monkeypatch.setattr(library, "getDirectionalDerivative", lambda *a: [1.1 * x for x in right(*a)])
    found = answers(fmu)
    assert verdicts(found, Verdict.FAIL) == {"derivatives"}
    assert "The derivative of y by u is given as 3.3; differences give 3." in found["derivatives"].evidence


def test_derivatives_that_are_refused_and_kinks_are_told(tmp_path: Path) -> None:
    found = answers(built("contact_point", tmp_path), "derivatives")["derivatives"]
    assert found.verdict == Verdict.NOTE
    assert "Not smooth enough to compare: F by x. Refused: dF_dx by x," in found.evidence


def test_a_library_of_another_version_lacks_functions(tmp_path: Path) -> None:
    fmu, other = built("gain", tmp_path), models.build("gain", tmp_path, fmi=2)
    with zipfile.ZipFile(fmu) as good, zipfile.ZipFile(other) as old, zipfile.ZipFile(tmp_path / "m.fmu", "w") as new:
        new.writestr(XML, good.read(XML))
        new.writestr("binaries/x86_64-linux/gain.so", old.read("binaries/linux64/gain.so"))
    found = static_findings(tmp_path / "m.fmu")["functions"]
    assert found.verdict == Verdict.FAIL
    assert "does not export fmi3ActivateModelPartition, fmi3CompletedIntegratorStep" in found.evidence


def test_arrays_are_left_out_and_told(tmp_path: Path) -> None:
    many = (
        '<Float64 name="many" valueReference="99" causality="output"><Dimension start="3"/></Float64></ModelVariables>'
    )
    fmu = edited(built("gain", tmp_path), tmp_path / "arrays.fmu", replaced("</ModelVariables>", many))
    found = answers(fmu)
    assert verdicts(found, Verdict.FAIL) == set()
    assert "Arrays, clocks and binary data are neither set nor read here: many." in found["run"].evidence


@pytest.mark.parametrize(
    ("name", "evidence"),
    [
        ("terminalsAndIcons/terminalsAndIcons.xml", "terminalsAndIcons.xml: Element 'wrong'"),
        ("sources/buildDescription.xml", "buildDescription.xml: Element 'wrong'"),
    ],
)
def test_further_documents_are_held_against_their_schemata(tmp_path: Path, name: str, evidence: str) -> None:
    fmu = edited(built("gain", tmp_path), tmp_path / "documents.fmu", lambda text: text)
    with zipfile.ZipFile(fmu, "a") as archive:
        archive.writestr(name, "<wrong/>")
    found = static_findings(fmu)
    assert found["schema"].verdict == Verdict.FAIL
    assert evidence in found["schema"].evidence
