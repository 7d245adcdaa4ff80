"""Pages of the documentation for what goes wrong: what an error is about, and the page that explains it."""

import re

from contact_core.errors import (
    ContactError,
    ConvergenceError,
    FilmTooWideError,
    OperatingPointError,
    SceneError,
    StateError,
)

# words of a sentence, the first that are found count; page
_TOPICS = (
    (r"--fields", "docs/how-to/fields.md"),
    (r"--ssp|\bmachine\b", "docs/how-to/machines.md"),
    (r"film\.map|tribofmu map", "docs/how-to/map.md"),
    (r"scuffing", "docs/how-to/scuffing.md"),
    (r"\bstress\.|fatigue", "docs/how-to/stress.md"),
    (r"correlation_length|microroughness|roll_off|heights|surface_[12]", "docs/how-to/surfaces.md"),
)
_OF_COMMANDS = {
    "build": "docs/how-to/fmu.md",
    "check": "docs/how-to/check.md",
    "cosim": "docs/how-to/cosim.md",
    "fit": "docs/how-to/fit.md",
    "map": "docs/how-to/map.md",
    "surfaces": "docs/how-to/surfaces.md",
}
_OF_ERRORS: dict[type[ContactError], str] = {  # the more special ones first
    FilmTooWideError: "docs/concepts/numerics.md",
    ConvergenceError: "docs/concepts/numerics.md",
    OperatingPointError: "docs/concepts/model.md",
    SceneError: "docs/how-to/scenes.md",
    StateError: "docs/how-to/fmu.md",
}
_ELSE = "docs/index.md"
PAGES = frozenset({page for _, page in _TOPICS} | {*_OF_COMMANDS.values(), *_OF_ERRORS.values(), _ELSE})


def page_of(error: ContactError, command: str) -> str:
    """Return the page that explains an error of a command: by its words, its kind, or the command."""
    for words, page in _TOPICS:
        if re.search(words, str(error)):
            return page
    kind = next((page for each, page in _OF_ERRORS.items() if isinstance(error, each)), None)
    return kind or _OF_COMMANDS.get(command, _ELSE)
