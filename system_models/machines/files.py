"""The files of machines that come with the package, in `<kind>/shipped/`. Light to import."""

import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any


def shipped() -> dict[str, str]:
    """Return names and descriptions of the machines that come with the package."""
    found = shipped_files()
    return {name: str(tomllib.loads(found[name].read_text("utf-8"))["description"]) for name in sorted(found)}


def shipped_files() -> dict[str, Any]:
    folders = [kind / "shipped" for kind in files(__package__).iterdir() if (kind / "shipped").is_dir()]
    found = [file for folder in folders for file in folder.iterdir() if file.name.endswith(".toml")]
    return {file.name.removesuffix(".toml"): file for file in found}


def is_machine(source: str) -> bool:
    """Return True for the name of a shipped machine, or for a file that says its kind."""
    if not source.endswith(".toml"):
        return source in shipped_files()
    try:
        return "kind" in tomllib.loads(Path(source).read_text("utf-8-sig"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError):
        return False  # reading it as a scene will give the error
