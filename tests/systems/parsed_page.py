"""What pages of results have in them, a coarse grid for quick runs, and a short run of gears."""

import json
from html.parser import HTMLParser
from typing import Any

COARSE = [
    *("film.points=17", "operation.interval=30s"),
    *(f"surface_{body}.correlation_length=32um" for body in (1, 2)),
]
GEARS = ["run", "gear_fzg_c", "--unchecked", "--set", "mesh.stations=4", "--hours", "0.02"]


class Parsed(HTMLParser):
    """What a page loads, its sections, links, scripts of data, and text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.data: dict[str, Any] = {}
        self.open: list[str] = []
        self.text = self.own = ""
        self._script = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.loaded += [given[key] for key in ("src", "data", "poster", "srcset") if key in given]
        self.loaded += [given["href"]] if tag == "link" else []
        self.links += [given["href"]] if tag == "a" else []
        self.ids += [given["id"]] if "id" in given else []
        self._script = given.get("id", "") if given.get("type") == "application/json" else ""
        if tag not in ("meta", "link", "img", "br", "input"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()
        self._script = ""

    def handle_data(self, data: str) -> None:
        if self._script:
            self.data[self._script] = json.loads(data)
        elif self.open and self.open[-1] in ("script", "style"):
            self.own += data
        else:
            self.text += data


def self_contained(found: Parsed) -> bool:
    """Return True if a page loads only what is in it, and its links within it lead somewhere."""
    inside = all(each.startswith("data:") for each in found.loaded)
    foreign = [word for word in ("url(", "@import", "fetch(", "XMLHttpRequest", "import(") if word in found.own]
    dead = [link for link in found.links if link.startswith("#") and link[1:] not in found.ids]
    return inside and not foreign and not dead and not found.open and len({*found.ids}) == len(found.ids)
