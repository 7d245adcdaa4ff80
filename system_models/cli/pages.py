"""Pages of the documentation: their names, and the one that explains an error.

A page is named after its file, one of measurements by its path: `scenes`, `measured/film`.
"""

import re
from pathlib import Path

from contact_core.errors import (
    ContactError,
    ConvergenceError,
    FilmTooWideError,
    OperatingPointError,
    SceneError,
    StateError,
)

_PACKAGE = Path(__file__).parents[1]
_PLACES = (_PACKAGE / "docs", _PACKAGE.parent / "docs")  # installed, checkout
MEASURED = "measured/"

# words of a sentence, the first that are found count; page
_TOPICS = (
    (r"--fields", "fields"),
    (r"--ssp|\bmachine\b", "machines"),
    (r"film\.map|tribofmu map", "map"),
    (r"scuffing", "scuffing"),
    (r"\bstress\.|fatigue", "stress"),
    (r"correlation_length|microroughness|roll_off|heights|surface_[12]", "surfaces"),
)
_OF_COMMANDS = {
    "build": "fmu",
    "check": "check",
    "compare": "report",
    "cosim": "cosim",
    "explain": "explain",
    "fit": "fit",
    "log": "logs",
    "map": "map",
    "new": "scenes",
    "report": "report",
    "surface-file": "measured_surfaces",
    "surfaces": "surfaces",
    "sweep": "sweep",
    "validate": "validate",
}
_OF_ERRORS: dict[type[ContactError], str] = {  # the more special ones first
    FilmTooWideError: "numerics",
    ConvergenceError: "numerics",
    OperatingPointError: "model",
    SceneError: "scenes",
    StateError: "fmu",
}
_ELSE = "run"
NAMED = frozenset({page for _, page in _TOPICS} | {*_OF_COMMANDS.values(), *_OF_ERRORS.values(), _ELSE})


def files() -> dict[str, Path]:
    """Return the files of the pages by name, as docs/index.md orders them; none if they are not installed."""
    folder = next((place for place in _PLACES if (place / "index.md").is_file()), None)
    if folder is None:
        return {}
    index = (folder / "index.md").read_text("utf-8")
    paths = re.findall(r"^- \[.*\]\((.+\.md)\)", index, re.MULTILINE)
    return {name_of(path.removesuffix(".md")): folder / path for path in paths}


def name_of(path: str) -> str:
    """Return the name of a page by its path in the docs folder without suffix."""
    return path if path.startswith(MEASURED) else path.rpartition("/")[2]


def title(text: str) -> str:
    return text.partition("\n")[0].removeprefix("# ").replace("`", "")


def see(error: ContactError, command: str) -> str:
    """Return how to read the page that explains an error of a command; empty where the pages are what is asked for."""
    return "" if command == "docs" else f" See: tribofmu docs {page_of(error, command)}"


def page_of(error: ContactError, command: str) -> str:
    """Return the name of the page that explains an error of a command: by its words, its kind, or the command."""
    for words, page in _TOPICS:
        if re.search(words, str(error)):
            return page
    if command == "build" and re.search(r"flavour|--python", str(error)):  # no fault of the scene
        return _OF_COMMANDS[command]
    kind = next((page for each, page in _OF_ERRORS.items() if isinstance(error, each)), None)
    return kind or _OF_COMMANDS.get(command, _ELSE)
