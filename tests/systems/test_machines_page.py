"""The page of the machines says what there is, and its examples run."""

import re
import tomllib
from pathlib import Path

import pytest

from system_models.machines import reading, timeline
from system_models.machines.files import shipped_files
from system_models.machines.registry import KINDS

PAGE = Path(__file__).parents[2].joinpath("docs", "how-to", "machines.md").read_text("utf-8")
ROWS = re.findall(r"^\| `(\w+)` \| (.+?) \| (.+?) \| (.+?) \|$", PAGE, re.MULTILINE)
TOML = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


def test_the_page_names_every_kind_of_machine():
    assert [kind for kind, *_ in ROWS] == list(KINDS)


@pytest.mark.parametrize(("kind", "others", "contacts", "signals"), ROWS)
def test_the_page_names_the_signals_of_a_kind(kind, others, contacts, signals):
    assert re.findall(r"`(\w+)`", signals) == list(KINDS[kind].signals)


@pytest.mark.parametrize(("kind", "others", "contacts", "signals"), ROWS)
def test_the_page_names_the_fmus_of_a_kind(kind, others, contacts, signals):
    shipped = {"ball_on_disc": "mtm_rig", "ball_bearing": "bearing_209", "gear_pair": "gear_fzg_c"}
    name = shipped.get(kind, kind)
    assembly = reading.assemble(reading.read(name))
    assert set(re.findall(r"`(\w+)`", others)) == set(assembly.parts)
    assert set(re.findall(r"`(\w+)`", contacts)) <= set(assembly.contacts)


@pytest.mark.parametrize("text", TOML)
def test_the_duties_on_the_page_can_be_read(text):
    duty = tomllib.loads(text)["duty"]
    found = timeline.read(duty, KINDS["ball_bearing"].signals, Path(str(shipped_files()["bearing_209"])).parent)
    assert found.end > 0.0


@pytest.mark.long
def test_the_lines_of_python_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    names = {}
    exec(code.replace('"10 min"', '"5 s", "bearing.levels": "1"'), names)
    assert names["dataset"]["bearing.friction_torque"].values[-1] > 0.0
