"""Blocks of a page, run in their order in the working folder, as a reader would."""

import re
import shlex
import tomllib
from pathlib import Path
from typing import Any

import xarray as xr

from contact_core.laws import offered
from system_models.cli.main import main
from system_models.machines import registry

DOCS = Path(__file__).parents[1] / "docs"
_BLOCK = re.compile(r"(?:^`([^`\n]+)`, new:\n\n)?^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def followed(page: str, section: str = "") -> dict[str, Any]:
    """Run the blocks of a page, or of a section of it; return the names that its Python has made."""
    text = (DOCS / f"{page}.md").read_text("utf-8")
    if section:
        (text,) = re.findall(rf"^## {section}\n(.*?)(?=^## |\Z)", text, re.DOTALL | re.MULTILINE)
    names: dict[str, Any] = {}
    for file, language, block in _BLOCK.findall(text):
        if file:
            Path(file).write_text(block, "utf-8")
        elif language == "python":
            exec(compile(block, page, "exec"), names)
        elif language == "sh":
            for line in block.splitlines():
                program, *arguments = shlex.split(line)
                if line == "pip install -e .":
                    install()
                    continue
                assert program == "tribofmu"
                assert main(arguments) == 0, line
    for value in names.values():
        if isinstance(value, xr.Dataset):
            value.close()
    return names


def install() -> None:
    """Leave in the working folder, which is on the path, what pip does beside an editable package; no network."""
    project = tomllib.loads(Path("pyproject.toml").read_text("utf-8"))["project"]
    info = Path(f"{project['name'].replace('-', '_')}-{project['version']}.dist-info")
    info.mkdir()
    heading = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    (info / "METADATA").write_text(heading, "utf-8")
    groups = project["entry-points"].items()
    text = "".join(f"[{group}]\n" + "".join(f"{n} = {v}\n" for n, v in entries.items()) for group, entries in groups)
    (info / "entry_points.txt").write_text(text, "utf-8")
    forget()


def forget() -> None:
    """Let laws and machines of other packages be looked for anew."""
    offered.of_others.cache_clear()
    registry.kinds.cache_clear()
