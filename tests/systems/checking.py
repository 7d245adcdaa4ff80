"""Files with one defect, and what the rules of `check` say to them."""

import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from system_models.check import deep, report, stages
from system_models.check.package import opened
from system_models.check.verdict import Answer, Finding, Verdict

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


# what pythonfmu's binary lets pass
LAX = {"guid", "interface", "resources", "stop time", "communication point", "order of calls"}
# what they do, they do to the process in which they are asked
ROUGH = {"resources", "text", "reloading", "home", "children", "fork"}


def answers(fmu: Path, *rules: str) -> dict[str, Answer]:
    """The rules that run an FMU, or some of them, answered in this process where that does it no harm."""
    folder = fmu.with_suffix("")
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    found = {}
    for rule, names in deep.RULES.items():  # `run` first: others read what it leaves
        if rule not in ROUGH and (not rules or rule in ("run", *rules)):
            given = (stages.answer(folder, name, fmu.parent, {}) for name in names)
            found[rule] = next(answer for answer in given if answer is not None)
    return found


def deep_findings(fmu: Path, *rules: str, **start: str) -> dict[str, Finding]:
    """The rules that run an FMU, or some of them, in processes of their own that have all the time in the world."""
    with pytest.MonkeyPatch.context() as patch, opened(fmu) as package:
        patch.setattr(deep, "RULES", {rule: deep.RULES[rule] for rule in ("run", *rules)} if rules else deep.RULES)
        return {finding.rule: finding for finding in deep.findings(package, math.inf, math.inf, start.items())}
