"""An explanation as text for a terminal."""

import re
import textwrap
from collections.abc import Iterator, Sequence

from contact_core.laws.symbols import BESIDE, Symbol, common
from contact_core.scene.origins import Kind, Origin

from .model import Absent, Explanation, Part, Section, Value

NARROWEST, WIDEST = 80, 110  # columns
_LONG = 25  # letters of a value that a column has room for
_MANY = 12  # most defaults of one law that are printed in full
Told = dict[tuple[str, ...], str]  # parts whose equations have been told, by these

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
    lines = _wrapped(f"{explanation.name}: {explanation.description}", width)
    lines += _wrapped(explanation.about, width)
    lines += ["", *_wrapped(explanation.summary, width)]
    lines += [
        "",
        *_wrapped(
            "Where a number is from: [n] a source, listed at the end; assumed: the file says so, or names no source; "
            "chosen: no property of the contact; accuracy: chosen for control.accuracy; default: of tribofmu; set: "
            "by --set, or by a machine's file.",
            width,
        ),
    ]
    told: Told = {}
    for section in explanation.sections:
        lines += _section(section, width, sources, told)
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


def _section(section: Section, width: int, sources: Sources, told: Told) -> Iterator[str]:
    yield ""
    yield section.title.upper()
    for part in section.parts:
        if part.equations or part.values:
            yield ""
            yield from _part(part, width, sources, told)


def _part(part: Part, width: int, sources: Sources, told: Told) -> Iterator[str]:
    cited = f"   law {sources.cited(part.source)}" if part.source else ""
    chosen = f", choice: {_where(part.origin, sources)}" if part.model and part.origin else ""
    yield f"  {part.path}{': ' + part.model if part.model else ''}{cited}{chosen}"
    lines = tuple(line for shown in part.equations for line in shown.lines)
    if lines in told:
        yield f"      equations as of {told[lines]}"
    else:
        told |= {lines: part.path} if lines else {}
        yield from _equations(part, width, sources)
    defaults = [v for v in part.values if v.origin.kind is Kind.DEFAULT]
    if len(defaults) > _MANY:
        yield from _values([v for v in part.values if v not in defaults], width, sources)
        few = ", ".join(f"{readable(v.symbol)} {v.key.rpartition('.')[2]} {v.shown}".lstrip() for v in defaults)
        yield from _wrapped(f"default: {few}", width, "    ", "      ")
    else:
        yield from _values(part.values, width, sources)


def _equations(part: Part, width: int, sources: Sources) -> Iterator[str]:
    for shown in part.equations:
        if shown.title and shown.title != part.path:
            yield f"    {shown.title}"
        for line in shown.lines:
            phrases = [line] if len(line) + 6 <= width else line.split(BESIDE)
            for phrase in phrases:
                yield from _wrapped(readable(phrase), width, "      ", "          ")
        if shown.source and shown.source != part.source:
            yield f"      {sources.cited(shown.source)}"
    if part.note:
        yield from _wrapped(readable(part.note), width, "    ", "    ")
    own = [_symbol(s) for s in part.symbols if (not s.field and s.symbol not in common()) or _differs(s)]
    if own:
        yield from _wrapped(f"with {'; '.join(own)}", width, "    ", "      ")


def _differs(symbol: Symbol) -> bool:
    return not symbol.field and symbol.symbol in common() and common()[symbol.symbol] != (symbol.unit, symbol.text)


def _symbol(symbol: Symbol) -> str:
    unit = f" [{symbol.unit}]" if symbol.unit else ""
    return f"{readable(symbol.symbol)} {symbol.text}{unit}"


def _values(values: Sequence[Value], width: int, sources: Sources) -> Iterator[str]:
    symbols = [readable(v.symbol) for v in values]
    names = [v.key.rpartition(".")[2] for v in values]
    where = [_where(v.origin, sources) for v in values]
    rows = list(zip(symbols, names, (v.shown for v in values), where, strict=True))
    sizes = [min(max(map(len, column)), _LONG) for column in zip(*rows, strict=True)]
    later = " " * (4 + sum(size + 2 for size in sizes if size))
    for v, (symbol, name, shown, origin) in zip(values, rows, strict=True):
        long = len(shown) > _LONG  # it stands alone
        row = (symbol, name, "" if long else shown, origin)
        head = "    " + "  ".join(cell.ljust(size) for cell, size in zip(row, sizes, strict=True) if size) + "  "
        remark = v.origin.remark.removeprefix(v.origin.word).removeprefix(": ")
        yield from _wrapped(f"{v.text} ({remark})" if remark else v.text, width, head, later)
        if long:
            yield f"        {shown}"


def _where(origin: Origin, sources: Sources) -> str:
    """Return where a value comes from: one word, or the number of its source."""
    if origin.word:
        return origin.word
    of_file = f"set {origin.set_name}" if origin.set_name else "the scene's file"
    return sources.cited(f"{of_file}: {origin.source or origin.remark}")


def _left_out(absent: tuple[Absent, ...], width: int) -> Iterator[str]:
    for each in absent:
        choice = each.value if each.value else "not given"
        said = f"{each.cost} ({each.key}: {choice})" if each.key else each.cost
        yield from _wrapped(said, width, "  - ", "    ")


def _trust(explanation: Explanation, width: int) -> Iterator[str]:
    for sentence in explanation.trust:
        yield from _wrapped(sentence, width, "  ", "  ")
    yield from _assumed(explanation.assumed, width)
    yield ""
    wide = max(len(quantity) for quantity, _, _ in explanation.validity)
    values = max(len(here) for _, here, _ in explanation.validity)
    for quantity, here, meaning in explanation.validity:
        head = f"  {quantity:{wide}}  {here:{values}}  "
        yield from _wrapped(meaning, width, head, " " * min(len(head), width - 30))
    yield ""
    for command, text in explanation.commands:
        yield f"  {command}"
        yield f"      {text}"


def _assumed(rows: Sequence[tuple[str, ...]], width: int) -> Iterator[str]:
    """Yield the table of what is assumed; each key and interval on a line of their own where the window is narrow."""
    if not rows:
        return
    yield ""
    wides = [max(map(len, column)) for column in zip(*rows, strict=True)]
    split = sum(wides) + 2 * len(wides) > width
    for key, between, *worth in rows:
        cells = [cell.ljust(wide) for cell, wide in zip(worth, wides[2:], strict=True)]
        if split:
            yield from _wrapped(f"{key}{between and f': {between}'}", width, "  ", "    ")
            yield f"      {'  '.join(cells)}"
        else:
            yield "  " + "  ".join([key.ljust(wides[0]), between.ljust(wides[1]), *cells])


def _common(explanation: Explanation, width: int) -> Iterator[str]:
    parts = [part for section in explanation.sections for part in section.parts]
    used = {
        s.symbol: s for part in parts for s in part.symbols if not s.field and not _differs(s) and s.symbol in common()
    }
    yield from _wrapped("; ".join(_symbol(used[symbol]) for symbol in common() if symbol in used), width, "  ", "  ")
