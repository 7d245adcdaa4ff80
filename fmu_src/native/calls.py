"""contact.h, and its functions, which call what was written from Python."""

import re
from collections.abc import Sequence
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from ..variables import Variable
from .names import c_name
from .translate import Entry, Num, c_type, declared, literal, wrapped

TRACKS = {"track_length_1": "TRACK_LENGTH_1", "track_length_2": "TRACK_LENGTH_2"}  # numbers in tracks.c


def initialise(values: Sequence[tuple[str, Any]]) -> list[str]:
    """Return contact_initialise, with the members of the state of fresh surfaces."""
    return [
        "int contact_initialise(const contact_inputs *in, contact_state *state, contact_outputs *out,",
        "    contact_message *why)",
        "{",
        *(_begun(name, value) for name, value in values),
        "    return contact_step(in, 0.0, state, out, why);",
        "}",
    ]


def _begun(name: str, value: Any) -> str:
    """Return the statement that sets a member of the state of fresh surfaces; arrays begin at zero."""
    if not isinstance(value, np.ndarray):
        return f"    state->{name} = {literal(value).text};"
    assert not value.any()
    return f"    memset(state->{name}, 0, sizeof state->{name});"


def calling(head: str, entry: Entry, inputs: Sequence[str], sets: Sequence[tuple[str, Any]]) -> list[str]:
    """Return a function that calls an entry and sets members to numbers of what that returns."""

    def text(value: Any) -> str:
        if not isinstance(value, Num):
            return literal(value).text
        if not entry.name:
            return entry.place(value, inputs, TRACKS.values()) if value.text.isidentifier() else value.text
        return f"found.{value.text}" if entry.returns > 1 else "found"

    called = entry.called(inputs, TRACKS.values()) if entry.name else ""
    found = f"const {f'struct {entry.name}' if entry.returns > 1 else 'double'} found = {called};"
    calls = wrapped(found if entry.returns else f"{called};", 1) if entry.returns or entry.may_fail else []
    refuses = ["    if (why->text[0] != '\\0') {", "        return 1;", "    }"] if entry.may_fail else []
    arrays = [(target, value) for target, value in sets if isinstance(value, Num) and "[" in value.kind]
    sets = [(target, value) for target, value in sets if not (isinstance(value, Num) and "[" in value.kind)]
    body = f"{called} {' '.join(text(value) for _, value in sets)}"
    given = re.findall(r"(\w+)[,)]", f"{head})")
    unread = [
        name
        for name in given
        if name not in ("out", "state") and f"{name}->" not in body and name not in re.findall(r"\w+", body)
    ]
    if (
        not any(target.startswith("state") for target, _ in [*sets, *arrays])
        and "state->" not in body
        and "state" in given
    ):
        unread.append("state")
    return [
        f"int {head}",
        "    contact_message *why)",
        "{",
        *(f"    (void){name};" for name in unread),
        "    why->text[0] = '\\0';",
        *(f"    {declared(c_type(array.kind), array.text)};" for array in entry.arrays),
        *calls,
        *refuses,
        *(f"    memcpy({target}, {array.text}, sizeof {target});" for target, array in arrays),
        *(f"    {target} = {text(value)};" for target, value in sets),
        "    return 0;",
        "}",
    ]


def stack_of(texts: Sequence[str]) -> int:
    """Return the bytes of arrays that functions, each after those that it calls, hold at once, at most."""
    held: dict[str, int] = {}
    for text in texts:
        head = re.search(r"^static .*?(\w+)\(", text, re.MULTILINE)
        if head is None:
            continue
        own = sum(8 * int(size) for size in re.findall(r"^ +(?:double|int) \w+\[(\d+)\];", text, re.MULTILINE))
        held[head[1]] = own + max((held[name] for name in set(re.findall(r"\w+(?=\()", text)) & held.keys()), default=0)
    return max(held.values(), default=0)


def source(texts: Sequence[str]) -> str:
    """Return a C file of functions."""
    needs = {"refuse": REFUSE, "whole_number": WHOLE, "place_inside": INSIDE}
    found = [text for name, text in needs.items() if _calls(name, texts)]
    also = ["#include <string.h>"] if _calls("mem(cpy|set)", texts) else []
    own = ['#include "normal.h"'] if _calls("own_normal_score", texts) else []
    return "\n\n".join(["\n".join([INCLUDES, *also, *own]), *found, *texts]) + "\n"


def _calls(name: str, texts: Sequence[str]) -> bool:
    return any(re.search(rf"\b{name}\(", text) for text in texts)


def struct(name: str, members: Sequence[str], about: dict[str, Variable]) -> list[str]:
    """Return a struct of doubles, with a comment of what is known of each."""

    def line(member: str) -> str:
        if member not in about:
            return f"    double {member};"
        return f"    double {c_name(member)}; /* {about[member].text} [{about[member].unit or '1'}] */"

    return ["typedef struct {", *map(line, members or ["none"]), f"}} {name};", ""]


def header(
    about: str, table: Sequence[Variable], fields: Sequence[str], outputs: Sequence[str], also: Sequence[str] = ()
) -> str:
    """Return contact.h for a table of variables, members of the state, outputs of the equations, and more lines."""
    inputs = [v.name for v in table if v.causality == "input"]
    known = {v.name: v for v in table}
    return _HEADER.substitute(
        about=about,
        inputs="\n".join(struct("contact_inputs", inputs, known)),
        state="\n".join(struct("contact_state", fields, {})),
        outputs="\n".join(struct("contact_outputs", outputs, known)),
        also="".join(f"{line}\n" for line in also),
    )


_HEADER = Template(Path(__file__).with_name("contact.h.in").read_text("ascii"))
INCLUDES = """\
/* Written from contact_core; each function names the Python that it was written from. Do not edit. */

#include "contact.h"
#include "elementary_arrays.h"

#include <stdarg.h>
#include <stdio.h>"""

REFUSE = """\
static void refuse(contact_message *why, const char *format, ...)
{
    va_list operands;
    va_start(operands, format);
    vsnprintf(why->text, sizeof why->text, format, operands);
    va_end(operands);
}"""

WHOLE = """\
/* The whole number towards zero from a number; what no int can be is the nearest one, and no number 0. */
static inline int whole_number(double x)
{
    return x != x ? 0 : x >= 2147483647.0 ? 2147483647 : x <= -2147483647.0 ? -2147483647 : (int)x;
}"""

INSIDE = """\
/* The place in an array of a size that is nearest to one; negative ones count from its end. */
static inline int place_inside(int place, int size)
{
    const int from_start = place < 0 ? place + size : place;
    return from_start < 0 ? 0 : from_start >= size ? size - 1 : from_start;
}"""

HEAD = f"{INCLUDES}\n\n{REFUSE}"
