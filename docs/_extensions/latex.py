"""Equations as LaTeX, from the notation of `contact_core.laws.equations`."""

import re
import unicodedata

from contact_core.laws.symbols import BESIDE

_TOKEN = re.compile(
    r"√(?P<root>[^\W\d_]+(?:_(?:\{[^{}]*\}|\w))?)|(?P<unit>mm\^2/s|MPa|Pa(?![\w_′]))|(?P<word>oil's|solids')"
    r"|(?P<name>[^\W\d_]+[\u0300-\u036f′]*)|(?P<script>[_^])(?:\{(?P<inside>[^{}]*)\}|(?P<one>[\w∞]))|(?P<sign>.)",
    re.DOTALL,
)
_FUNCTIONS = {name: f"\\{name}" for name in ("exp", "ln", "log", "max", "min", "tanh", "cosh")} | {
    name: f"\\operatorname{{{name}}}" for name in ("arsinh", "erf", "tr")
}
_SIGNS = {
    "−": "-",
    "·": r"\cdot ",
    "≤": r"\leq ",
    "≥": r"\geq ",
    "∝": r"\propto ",
    "∬": r"\iint ",
    "∫": r"\int ",
    "∂": r"\partial ",
    "∞": r"\infty ",
    "⟨": r"\langle ",
    "⟩": r"\rangle ",
    "→": r"\to ",
    "…": r"\dots ",
    "∗": r"\ast ",
    "{": r"\{",
    "}": r"\}",
}
_DIFFERENTIALS = frozenset({"dx", "dy", "dx′", "dy′"})
_BAR = "\u0304"


def latex(line: str) -> str:
    """Return one line of equations as LaTeX, without dollars."""
    return r",\qquad ".join(_converted(phrase) for phrase in line.split(BESIDE))


def _converted(text: str) -> str:
    found = "".join(_token(match, text) for match in _TOKEN.finditer(text))
    found = re.sub(r" \} *\\text\{ ", " ", found)  # words that stand together
    return re.sub(r" +(?=[ _^])", "", found).strip()


def _token(match: re.Match[str], text: str) -> str:
    if match["root"]:
        return rf"\sqrt{{{_converted(match['root'])}}}"
    if match["unit"]:
        return rf"\mathrm{{{match['unit'].replace('^2', '^{2}')}}}"
    if match["word"]:
        return rf"\text{{ {match['word']} }}"
    if match["script"]:
        return f"{match['script']}{{{_script(match['inside'] or match['one'])}}}"
    if match["name"]:
        return _name(match["name"], text[match.end() : match.end() + 1])
    return _SIGNS.get(match["sign"], match["sign"])


def _script(text: str) -> str:
    """Return an index or exponent: words upright, anything else as an equation."""
    return (
        re.sub(r"[A-Za-z]{2,}", lambda word: rf"\mathrm{{{word[0]}}}", text)
        if "," in text or (text.isalpha() and (text.isascii() and len(text) > 1))
        else _converted(text)
    )


def _name(text: str, after: str) -> str:
    if text in _FUNCTIONS:
        return f"{_FUNCTIONS[text]} "
    if text in _DIFFERENTIALS:
        return rf"\,d{text[1:].replace('′', chr(39))}"
    letters, primes = text.rstrip("′"), "'" * text.count("′")
    if letters.endswith(_BAR):
        return rf"\bar{{{letters[:-1]}}}"
    if letters == "Σ":
        return r"\Sigma" if after == ")" else r"\sum "
    if len(letters) > 1 and letters.isascii():
        return rf"\mathrm{{{letters}}}" if letters in ("Rq", "Pe") else rf"\text{{ {letters} }}"
    return " ".join(map(_letter, letters)) + primes


def _letter(letter: str) -> str:
    """Return a letter, a Greek one by its name."""
    name = unicodedata.name(letter, "")
    if not name.startswith("GREEK"):
        return letter
    greek = name.rpartition(" ")[2].lower().replace("lamda", "lambda")
    return f"\\{greek.capitalize() if 'CAPITAL' in name else greek} "
