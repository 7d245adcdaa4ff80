"""The files of machines that come with the package. Light to import."""

import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any


def shipped() -> dict[str, str]:
    """Names and descriptions of the machines that come with the package."""
    found = {p.name.removesuffix(".toml"): p for p in folder().iterdir() if p.name.endswith(".toml")}
    return {name: str(tomllib.loads(found[name].read_text("utf-8"))["description"]) for name in sorted(found)}


def folder() -> Any:
    """Where they lie."""
    return files(__package__) / "systems"


def is_machine(source: str) -> bool:
    """Whether this is the name of a shipped machine, or a file that says its kind."""
    if not source.endswith(".toml"):
        return (folder() / f"{source}.toml").is_file()
    try:
        return "kind" in tomllib.loads(Path(source).read_text("utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError):
        return False  # whoever reads it as a scene will say so
