"""Commands in README and docs are such that today's command line takes: names, options, keys of scenes and machines."""

import argparse
import re
import shlex
from pathlib import Path

import pytest

from contact_core import Scene, shipped_scenes
from system_models.cli.main import parser_of_all
from system_models.machines import reading
from system_models.machines.files import shipped

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
_FENCED = re.compile(r"^```\w*\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_LINE = re.compile(r"^(?:.* && )?(tribofmu .*)$", re.MULTILINE)
_INDENTED = re.compile(r"^ {4}(tribofmu .*)$", re.MULTILINE)
_WITHIN = re.compile(r"`(tribofmu [^`]*)`")
_OPEN = re.compile(r"\b(?:SYSTEM|FILE|SCENE|NAME|MACHINE|DIR|DATA)\b|\.\.\.|HOST:PORT|A B")  # stands for something
_OF_PAGE = re.compile(r"\.(?:toml|npy|csv|json)\b|^(?:quinn_80c|leader)$")  # files, sets and schemes that a page makes
PARSER = parser_of_all()
SHIPPED = {*shipped_scenes(), *shipped()}


def commands(page: Path) -> list[str]:
    """Return the commands of a page: in blocks, indented, or within a sentence if they name what is shipped."""
    text = page.read_text("utf-8")
    found = [line for block in _FENCED.findall(text) for line in _LINE.findall(block)] + _INDENTED.findall(text)
    within = [line.replace("\n", " ") for line in _WITHIN.findall(_FENCED.sub("", text))]
    found += [line for line in within if SHIPPED & set(line.split())]
    return [line for line in found if not _OPEN.search(line)]


CASES = [pytest.param(line, id=f"{page.stem}: {line[9:60]}") for page in PAGES for line in commands(page)]


@pytest.mark.parametrize("line", CASES)
def test_a_command_of_a_page_is_one_of_todays(line: str) -> None:
    arguments = PARSER.parse_args(shlex.split(line, comments=True)[1:], argparse.Namespace())
    name, changes = getattr(arguments, "scene", ""), dict(getattr(arguments, "settings", None) or [])
    if any(_OF_PAGE.search(value) for value in changes.values()):
        changes = {}  # keys may go together
    if name in SHIPPED - {*shipped()}:
        Scene.from_toml(name, changes)
    elif name in SHIPPED:
        reading.assemble(reading.read(name, changes))


def test_the_pages_have_commands() -> None:
    assert len(CASES) > 100
