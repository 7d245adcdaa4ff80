"""A page around its sections: head, style, navigation, script."""

import re
from collections.abc import Mapping
from importlib.resources import files
from string import Template

from .markup import text

_HEADING = re.compile(r'<section id="([\w-]+)"><h2>(.*?)</h2>')


def whole(title: str, kind: str, body: str, script: str = "", short: Mapping[str, str] | None = None) -> str:
    """Return a page of one file; `short`: words of the navigation in place of a section's heading, by its id."""
    here = files(__package__)
    named = _HEADING.findall(body)
    links = "".join(f'<a href="#{name}">{(short or {}).get(name, words)}</a>' for name, words in named)
    return Template(here.joinpath("page.html").read_text("utf-8")).substitute(
        title=text(title),
        kind=text(kind),
        links=links,
        body=body,
        style=here.joinpath("style.css").read_text("utf-8"),
        script=f"<script>\n{script}\n</script>" if script else "",
    )
