"""Symbols of the equations: those that all laws share, and what each symbol of an equation stands for.

A law has its own in `Equations.symbols`. What stands alone left of a sign is defined by the equation itself.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import fields
from typing import Any, NamedTuple

from .equations import Equations


class Symbol(NamedTuple):
    """A symbol of an equation."""

    symbol: str
    unit: str  # empty: a number without a unit
    text: str
    field: str = ""  # of the law, whose value it is


# symbol: unit, text
COMMON: dict[str, tuple[str, str]] = {
    "x": ("m", "coordinate along entrainment, from the centre of the contact"),
    "y": ("m", "coordinate across entrainment"),
    "x′": ("m", "coordinate of the pressure that deforms"),
    "y′": ("m", "coordinate of the pressure that deforms"),
    "t": ("s", "time"),
    "p": ("Pa", "pressure, of oil and solids together"),
    "p_f": ("Pa", "pressure of the oil"),
    "p_s": ("Pa", "pressure of the solids"),
    "p_H": ("Pa", "largest pressure of Hertz's contact"),
    "a": ("m", "half width of Hertz's contact along x"),
    "b": ("m", "half width of Hertz's contact along y"),
    "h": ("m", "film thickness, the local gap"),
    "h_c": ("m", "central film thickness"),
    "h_s": ("m", "central film thickness of the smooth bodies, by formula"),
    "h_0": ("m", "rigid gap"),
    "h_{floor}": ("m", "gap at which solids touch, film.floor"),
    "g": ("m", "gap of the undeformed bodies"),
    "z_1": ("m", "heights of body 1"),
    "z_2": ("m", "heights of body 2"),
    "d": ("m", "elastic deformation"),
    "θ": ("", "share of the gap that oil fills"),
    "R_x": ("m", "combined radius of curvature along x"),
    "R_y": ("m", "combined radius of curvature along y"),
    "E′": ("Pa", "reduced modulus"),
    "W": ("N", "load"),
    "σ": ("m", "composite rms roughness"),
    "u_1": ("m/s", "surface speed of body 1"),
    "u_2": ("m/s", "surface speed of body 2"),
    "u_e": ("m/s", "entrainment speed"),
    "v": ("m/s", "sliding velocity of body 1 over body 2"),
    "v_x": ("m/s", "sliding velocity along x"),
    "ω": ("rad/s", "spin"),
    "η": ("Pa s", "viscosity"),
    "η_0": ("Pa s", "viscosity at p = 0"),
    "ρ": ("kg/m3", "density"),
    "ρ_0": ("kg/m3", "density at p = 0"),
    "τ": ("Pa", "shear stress"),
    "τ_N": ("Pa", "shear stress of a Newtonian oil, η |v|/h"),
    "τ_{oil}": ("Pa", "shear stress of the oil"),
    "τ_{solid}": ("Pa", "shear stress where solids touch"),
    "T": ("K", "temperature"),
    "T_{oil}": ("K", "temperature of the oil"),
    "T_{bulk}": ("K", "bulk temperature of the body"),
    "T_{bulk,i}": ("K", "bulk temperature of body i"),
    "μ": ("", "friction coefficient of solids"),
    "F": ("N", "friction force on body 1"),
    "F_r": ("N", "rolling resistance"),
    "P": ("W", "power loss"),
    "q": ("W/m2", "heat per area"),
    "W_c": ("", "share of the load that solids carry"),
    "A_c": ("", "real contact area over Hertz's area"),
    "h_t": ("m", "thickness of the tribofilm"),
    "w": ("m", "wear depth"),
    "k_B": ("J/K", "Boltzmann's constant, 1.380649e-23"),
    "h_P": ("J s", "Planck's constant, 6.62607015e-34"),
    "σ_h": ("Pa", "hydrostatic stress, tension positive"),
}

UNEXPLAINED = "not explained by the law"

_SYMBOL = re.compile(r"[^\W\d_]+[\u0300-\u036f′]*(?:_(?:\{[^{}]*\}|[\w∞]))?")
_UNITS = re.compile(r"\bin mm\^2/s|\bMPa\b|\bPa\b|oil's|solids'")
_WORD = re.compile(r"[a-z]{2,}′?(?:_t|_\{10\})?")  # functions, differentials and words
_NUMBERS = frozenset({"π", "Σ", "Σ_{k}"})
_DEFINED = re.compile(rf"({_SYMBOL.pattern})(?:\([^()]*\))? [=∝] ")
BESIDE = ",   "  # between the equations of one line


def in_lines(lines: Sequence[str]) -> Iterator[str]:
    """Yield the symbols of some lines of equations, each once, in their order."""
    found = dict.fromkeys(token for line in lines for token in _SYMBOL.findall(_UNITS.sub("", line)))
    yield from (token for token in found if not _WORD.fullmatch(token) and token not in _NUMBERS)


def defined(lines: Sequence[str]) -> set[str]:
    """Return the symbols that stand alone on the left of an equation."""
    phrases = (phrase for line in lines for phrase in line.split(BESIDE))
    return {match[1] for phrase in phrases if (match := _DEFINED.match(phrase.strip()))}


def explained(equations: Equations, law: Any) -> list[Symbol]:
    """Return what the symbols of a law's equations stand for; `law` is its class or record.

    Left out are those that only the equations define. What nothing explains has the text UNEXPLAINED.
    """
    known = {f.name: f.metadata for f in fields(law)} if hasattr(law, "__dataclass_fields__") else {}
    found = []
    for symbol in in_lines(equations.lines):
        said = equations.symbols.get(symbol)
        if said in known:
            found.append(Symbol(symbol, known[said]["unit"], known[said]["text"], said))
        elif said is not None:
            text, _, unit = said.rpartition(" [")
            found.append(Symbol(symbol, "" if unit == "1]" else unit.rstrip("]"), text))
        elif symbol in COMMON:
            found.append(Symbol(symbol, *COMMON[symbol]))
        elif symbol not in defined(equations.lines):
            found.append(Symbol(symbol, "", UNEXPLAINED))
    return found
