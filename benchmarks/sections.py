"""What each benchmark found, kept as data in benchmarks/measured, and the pages of docs/measured rendered from it.

A room of benchmarks has one page, docs/measured/<room>.md, with a section for each of its benchmarks.
"""

import json
import re
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.folders import MEASURED, ROOT

KEPT = ROOT / "benchmarks" / "measured"
OLDER = ", of older code"
LINK = re.compile(r"(\]\((?:[./]|docs/)*measured/(\w+)\.md#([\w-]+)\))(, of older code)?")
# rooms in the order in which docs/index.md lists them, with the titles of their pages
ROOMS = {
    "film": "One contact at one instant",
    "surfaces": "Surfaces over hours",
    "speed_error": "Speed and error together",
    "regression": "The regression level",
    "friction": "Friction",
    "stress": "Stress and micropitting",
    "machines": "Machines",
    "coupling": "Co-simulation",
    "fmu": "FMUs",
    "thesis": "The thesis",
    "house": "Tests and code",
}


@dataclass(frozen=True)
class Section:
    """What a benchmark found: its page in Markdown without the title, and when."""

    name: str  # room/name of the benchmark, or its name alone
    title: str
    measured: str  # date
    lines: tuple[str, ...]

    @property
    def room(self) -> str:
        """The room, whose page has this section."""
        return self.name.partition("/")[0]

    @property
    def anchor(self) -> str:
        """The heading, as links name it."""
        return re.sub(r"[^\w -]", "", self.title.lower()).strip().replace(" ", "-")

    @property
    def text(self) -> str:
        """The section in Markdown, without its title."""
        return "\n".join(self.lines) + "\n"


def path_of(name: str, folder: Path = KEPT) -> Path:
    """The file that keeps a section."""
    return folder / f"{name}.json"


def read(name: str, folder: Path = KEPT) -> Section:
    """Return the section of a benchmark."""
    kept = json.loads(path_of(name, folder).read_text(encoding="utf-8"))
    return Section(**{**kept, "lines": tuple(kept["lines"])})


def every(folder: Path = KEPT) -> list[Section]:
    """All sections, by room and name."""
    found = [read(path.relative_to(folder).with_suffix("").as_posix(), folder) for path in folder.rglob("*.json")]
    return sorted(found, key=lambda section: (list(ROOMS).index(section.room), section.name))


def keep(name: str, text: str, measured: str, folder: Path = KEPT) -> Section:
    """Keep what a benchmark wrote: a page in Markdown that begins with its title."""
    title, _, rest = text.strip().partition("\n")
    if not title.startswith("# "):
        raise ValueError(f"{name}: a section begins with its title, not {title!r}")
    section = Section(name, title.removeprefix("# "), measured, tuple(rest.strip().splitlines()))
    path = path_of(name, folder)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(asdict(section), ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    return section


def _body(section: Section) -> list[str]:
    """Lines of a section as part of its room's page: headings a level deeper, pictures in the folder of the room."""
    lines, code = [], False
    for line in section.lines:
        code ^= line.startswith("```")
        if line.startswith("#") and not code:
            line = f"#{line}"
        line = re.sub(r"(!\[[^\]]*\]\()(?=[\w.]+\))", rf"\g<1>{section.room}/", line)
        lines.append(re.sub(r"\]\((\w+)\.md\)", lambda found: f"](#{read(f'{section.room}/{found[1]}').anchor})", line))
    return lines


def page(room: str, note: Callable[[Section], str], folder: Path = KEPT) -> str:
    """Return the page of a room; `note` gives what stands at the head of a section, if anything."""
    sections = [section for section in every(folder) if section.room == room]
    notes = {section.name: note(section) for section in sections}
    listed = [
        f"- [{section.title}](#{section.anchor}): measured on {section.measured}"
        + (OLDER if notes[section.name] else "")
        for section in sections
    ]
    lines = [f"# {ROOMS[room]}", "", "`python -m benchmarks.claims` lists what is claimed from here.", "", *listed, ""]
    for section in sections:
        lines += [f"## {section.title}", ""]
        lines += [f"**{notes[section.name]}**", ""] if notes[section.name] else []
        lines += [*_body(section), ""]
    return "\n".join(lines).rstrip() + "\n"


def render(note: Callable[[Section], str], room: str = "") -> None:
    """Write the page of a room, or of all."""
    for one in (room,) if room else ROOMS:
        (MEASURED / f"{one}.md").write_text(page(one, note), encoding="utf-8")


def place(name: str, folder: Path = KEPT) -> str:
    """Return where a section stands below docs/measured."""
    section = read(name, folder)
    return f"{section.room}.md#{section.anchor}"


def marked(text: str, note: Callable[[Section], str], folder: Path = KEPT) -> str:
    """Return a page with ", of older code" behind each link to such a section, and behind no other."""
    older = {(section.room, section.anchor) for section in every(folder) if note(section)}
    return LINK.sub(lambda found: found[1] + (OLDER if (found[2], found[3]) in older else ""), text)


def citing() -> list[Path]:
    """The pages that link to sections and are written by hand."""
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    return [page for page in pages if MEASURED not in page.parents and LINK.search(page.read_text(encoding="utf-8"))]
