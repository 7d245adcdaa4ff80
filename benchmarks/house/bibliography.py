"""Write docs/bibliography.md: every source with a DOI that code, data or a page cites, and where.

    python -m benchmarks.house.bibliography

A source is named as the longest of its citations names it: "Authors, Journal volume (year) page, doi:...". A citation without authors
and year, where no other one of the same source has them, is refused.
"""

import re
from collections import defaultdict
from collections.abc import Iterator

from benchmarks.folders import ROOT

PATH = ROOT / "docs" / "bibliography.md"
ROOMS = ("contact_core", "fmu_src", "system_models", "benchmarks", "docs")
KINDS = {".py", ".toml", ".md"}
INTRODUCTION = """# Bibliography

Every source with a DOI that the code, its data or a page cites, and where. `python -m benchmarks.house.bibliography` writes this page.
Books, standards and theses without one are named where they are used.
"""
DOI = re.compile(r"doi:\s?(10\.\d{4,}/[^\s,;`\"'\]]*[\w)])")
NAME = r"(?:(?:de|van|van der|van den|von) )?[A-Z][\w'’-]+"
AUTHORS = rf"{NAME}(?:(?:, | & | and ){NAME})*(?: et al\.)?"
JOURNAL = r"(?:(?:[A-Z][\w./'’-]*|\d+|&|of|in|im|and),? )*"
YEAR = r"(?:18|19|20)\d\d"
CITATION = re.compile(
    rf"((?:{AUTHORS})(?:,? |, {JOURNAL})(?:{YEAR}|\({YEAR}\)[ \w]*))(?:, (?:section|chapter)s? [^,]*)?, \[?$"
)
BEFORE = re.compile(r"^(?:Of|In|After) ")


def citations(text: str) -> Iterator[tuple[str, str]]:
    """Yield the DOIs of a text, each with what names its source, or nothing."""
    plain = re.sub(r'"?[ \t]*\\?\n\s*(?:# ?|f?")?', " ", text)
    plain = re.sub(r" +", " ", plain)
    for match in DOI.finditer(plain):
        doi = match[1]
        while doi.endswith(")") and doi.count(")") > doi.count("("):
            doi = doi[:-1]
        named = CITATION.search(plain[max(0, match.start() - 160) : match.start()])
        yield doi, BEFORE.sub("", named[1].strip()) if named else ""


def written() -> str:
    """Return the page."""
    names: dict[str, set[str]] = defaultdict(set)
    places: dict[str, set[str]] = defaultdict(set)
    shown: dict[str, str] = {}
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*")):
            if path.suffix in KINDS and path != PATH and "__pycache__" not in path.parts:
                for doi, name in citations(path.read_text("utf-8")):
                    key = doi.lower()
                    shown.setdefault(key, doi)
                    names[key].add(name)
                    places[key].add(str(path.relative_to(ROOT)))
    nameless = [shown[key] for key, found in names.items() if not max(found, key=len)]
    if nameless:
        raise ValueError(f"No citation has authors and year before the DOI: {', '.join(sorted(nameless))}")
    lines = [
        f"- {max(sorted(names[key]), key=len)}, [doi:{shown[key]}](https://doi.org/{shown[key]}): "
        + ", ".join(f"`{place}`" for place in sorted(places[key]))
        for key in names
    ]
    return "\n".join([INTRODUCTION, *sorted(lines, key=str.casefold), ""])


if __name__ == "__main__":
    PATH.write_text(written(), encoding="utf-8")
