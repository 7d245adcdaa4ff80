"""The command `check --deep`: calls at the edge, and what an FMU does to hosts of other kinds."""

import ctypes
import math
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest
from checking import (
    answers,
    deep_findings,
    verdicts,
)

from benchmarks import models
from system_models.check import deep
from system_models.check.package import opened
from system_models.check.verdict import Verdict

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
@pytest.mark.long
def test_a_file_written_anywhere_but_in_the_temporary_folder_is_worth_a_note(slave: Callable[..., Path]) -> None:
    scribbling = f"{AT_WORK} and open('/proc/self/comm', 'w').write('slave')"
    found = deep_findings(slave("scribbles", start=scribbling), "home")["home"]
    assert found.verdict == Verdict.NOTE
    assert "where only /" in found.evidence
    assert "Permission denied" in found.evidence


@pytest.mark.long
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
    assert "of 200 children forked while other threads worked with it have survived" in found.evidence
    assert found.evidence.endswith("; it was in fmi2FreeInstance.")
