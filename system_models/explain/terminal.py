"""An explanation as text for a terminal."""

import re
import textwrap
from collections.abc import Iterator

from contact_core.laws.symbols import COMMON, Symbol
from contact_core.scene.origins import Kind, Origin

from .model import Absent, Explanation, Part, Section, Value

NARROWEST, WIDEST = 80, 110  # columns
_MANY = 12  # defaults of one law that are told in a few lines
_SUPERSCRIPTS = str.maketrans("0123456789-−+", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁻⁺")
_POWER = re.compile(r"\^(?:\{([−-]?\d+)\}|(\d))")
_BRACES = re.compile(r"([_^])\{([^{}\s]*)\}")


class Sources:
    """Sources, numbered in the order in which they are cited."""

    def __init__(self) -> None:
        self.numbers: dict[str, int] = {}

    def cited(self, text: str) -> str:
        """Return the number of a source in brackets."""
        return f"[{self.numbers.setdefault(text, len(self.numbers) + 1)}]"


def render(explanation: Explanation, columns: int) -> str:
    """Return the text of an explanation, at most `columns` wide where words allow it."""
    width = min(max(columns, NARROWEST), WIDEST)
    sources = Sources()
    lines = [f"{explanation.name}: {explanation.description}"]
    lines += _wrapped(explanation.about, width)
    lines += [
        "",
        *_wrapped(
            "[n]: source, listed at the end. assumed: the file says so, or names no source. default: of tribofmu. "
            "set: changed by --set. chosen: for control.accuracy.",
            width,
        ),
    ]
    for section in explanation.sections:
        lines += _section(section, width, sources)
    lines += ["", "LEFT OUT", *_left_out(explanation.left_out, width)]
    lines += ["", "HOW SURE", *_trust(explanation, width)]
    lines += ["", "SYMBOLS", *_common(explanation, width)]
    lines += ["", "SOURCES"]
    for text, number in sources.numbers.items():
        lines += _wrapped(text, width, f"  [{number}]".ljust(7), " " * 7)
    return "\n".join(line.rstrip() for line in lines)


def readable(line: str) -> str:
    """Return a line of an equation with powers as superscripts, and without braces that are not needed."""
    line = _POWER.sub(lambda m: (m[1] or m[2]).translate(_SUPERSCRIPTS), line)
    return _BRACES.sub(lambda m: f"{m[1]}{m[2]}" if re.fullmatch(r"[\w,∞]+", m[2]) else m[0], line)


def _wrapped(text: str, width: int, first: str = "", later: str = "") -> list[str]:
    return textwrap.wrap(
        text, width, initial_indent=first, subsequent_indent=later, break_long_words=False, break_on_hyphens=False
    )


def _section(section: Section, width: int, sources: Sources) -> Iterator[str]:
    yield ""
    yield section.title.upper()
    for part in section.parts:
        if part.equations or part.values:
            yield ""
            yield from _part(part, width, sources)


def _part(part: Part, width: int, sources: Sources) -> Iterator[str]:
    cited = f" {sources.cited(part.source)}" if part.source else ""
    chosen = f"  ({_where(part.origin, sources)})" if part.model and part.origin else ""
    yield f"  {part.path}{': ' + part.model if part.model else ''}{cited}{chosen}"
    for shown in part.equations:
        if shown.title and shown.title != part.path:
            yield f"    {shown.title}"
        for line in shown.lines:
            yield from _wrapped(readable(line), width, "      ", "          ")
        if shown.source and shown.source != part.source:
            yield f"      {sources.cited(shown.source)}"
    if part.note:
        yield from _wrapped(readable(part.note), width, "    ", "    ")
    own = [_symbol(s) for s in part.symbols if not s.field and s.symbol not in COMMON or _differs(s)]
    if own:
        yield from _wrapped(f"with {'; '.join(own)}", width, "    ", "      ")
    defaults = [v for v in part.values if v.origin.kind is Kind.DEFAULT]
    if len(defaults) > _MANY:
        yield from _values([v for v in part.values if v not in defaults], width, sources)
        told = ", ".join(f"{v.key.rpartition('.')[2]} {v.shown}" for v in defaults)
        yield from _wrapped(f"default: {told}", width, "    ", "      ")
    else:
        yield from _values(part.values, width, sources)


def _differs(symbol: Symbol) -> bool:
    return not symbol.field and symbol.symbol in COMMON and COMMON[symbol.symbol] != (symbol.unit, symbol.text)


def _symbol(symbol: Symbol) -> str:
    unit = f" [{symbol.unit}]" if symbol.unit else ""
    return f"{readable(symbol.symbol)} {symbol.text}{unit}"


def _values(values: "tuple[Value, ...] | list[Value]", width: int, sources: Sources) -> Iterator[str]:
    if not values:
        return
    names = max(len(v.key.rpartition(".")[2]) for v in values)
    shown = min(max(len(v.shown) for v in values), 22)
    for v in values:
        symbol = readable(v.symbol).ljust(7)
        head = f"    {symbol}{v.key.rpartition('.')[2]:{names}}  {v.shown:{shown}}  {_where(v.origin, sources):8} "
        remark = f" ({v.origin.remark})" if v.origin.remark else ""
        yield from _wrapped(f"{v.text}{remark}", width, head, " " * min(len(head), 4 + 7 + names + shown + 13))


def _where(origin: Origin, sources: Sources) -> str:
    """Return in a word where a value comes from."""
    if origin.kind is Kind.SET:
        return sources.cited(f"set {origin.set_name}: {origin.source or 'assumed'}")
    if origin.kind is Kind.FILE:
        own = origin.source or ("" if not origin.remark else origin.remark)
        return "assumed" if origin.assumed else sources.cited(f"the scene's file: {own}")
    return {Kind.SETTING: "set", Kind.ACCURACY: "chosen", Kind.DEFAULT: "default"}[origin.kind]


def _left_out(absent: tuple[Absent, ...], width: int) -> Iterator[str]:
    for each in absent:
        choice = each.value if each.value else "not given"
        said = f"{each.cost} ({each.key}: {choice})" if each.key else each.cost
        yield from _wrapped(said, width, "  - ", "    ")


def _trust(explanation: Explanation, width: int) -> Iterator[str]:
    for sentence in explanation.trust:
        yield from _wrapped(sentence, width, "  ", "  ")
    yield ""
    wide = max(len(quantity) for quantity, _, _ in explanation.validity)
    values = max(len(here) for _, here, _ in explanation.validity)
    for quantity, here, meaning in explanation.validity:
        head = f"  {quantity:{wide}}  {here:{values}}  "
        yield from _wrapped(meaning, width, head, " " * len(head))
    yield ""
    for command, text in explanation.commands:
        yield f"  {command}"
        yield f"      {text}"


def _common(explanation: Explanation, width: int) -> Iterator[str]:
    parts = [part for section in explanation.sections for part in section.parts]
    used = {
        s.symbol: s for part in parts for s in part.symbols if not s.field and not _differs(s) and s.symbol in COMMON
    }
    yield from _wrapped("; ".join(_symbol(used[symbol]) for symbol in COMMON if symbol in used), width, "  ", "  ")
