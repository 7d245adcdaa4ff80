"""A Python function as C: written, compiled by gcc and called."""

import ctypes
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fmu_src.native.build import FOLDER, WARNINGS
from fmu_src.native.calls import HEAD, INSIDE, WHOLE
from fmu_src.native.tables import tables_h
from fmu_src.native.translate import Num, Stored, Translator, c_type, declared, leaves, parts
from fmu_src.native.translate.values import is_dynamic, rebuilt

_HEADER = "typedef struct { char text[512]; } contact_message;\n"


def translated(folder: Path, function: Callable[..., Any], operands: list[Any]) -> Callable[..., Any]:
    """Return what calls a function in C, of the numbers that `operands` have as Num x0, x1 and so on, in that order.

    It gives the result in the form of Python's, or the message with which it refuses.
    """
    translator = Translator()
    entry = translator.program(function, operands)
    texts = translator.texts([entry])
    given = [number.text for number in entry.takes]
    every = [number for _, number in leaves(entry.result)]
    arrays, numbers = entry.arrays, [number for number in every if "[" not in number.kind]
    given += [array.text for array in arrays]
    call = f"{entry.name}({', '.join([*given, *(['why'] if entry.may_fail else [])])})"
    lines = [f"{declared(c_type(array.kind), array.text)};" for array in arrays]
    if len(numbers) == 1:
        lines += [f"const double only = {call};"]
    else:
        lines += [f"const struct {entry.name} found = {call};"] if numbers else [f"{call};"]
    size = 0
    for number in every:
        own = int(number.kind[2:-1]) if "[" in number.kind else 1
        value = "only" if len(numbers) == 1 else f"found.{number.text}"
        each = f"for (int i = 0; i < {own}; ++i) out[{size} + i] = {number.text}[i];"
        lines.append(each if "[" in number.kind else f"out[{size}] = {value};")
        size += own
    count = len(leaves(operands))
    text = "\n\n".join(
        [
            HEAD,
            "#include <string.h>",
            WHOLE,
            INSIDE,
            *texts,
            "\n".join(
                [
                    "void run(const double *in, double *out, contact_message *why);",
                    "void run(const double *in, double *out, contact_message *why)",
                    "{",
                    *(f"const double x{i} = in[{i}]; (void)x{i};" for i in range(count)),
                    '(void)out; why->text[0] = 0; if (0) refuse(why, " ");',
                    *lines,
                    "}",
                ]
            ),
        ]
    )
    for name, content in (("contact.h", _HEADER), ("tables.h", tables_h()), ("function.c", text)):
        (folder / name).write_text(content)
    library = folder / "function.so"
    command = ["gcc", "-O1", *WARNINGS, "-Wno-unused-function", "-ffp-contract=off", "-fPIC", "-shared"]
    command += [f"-I{FOLDER}", f"-I{folder}", str(folder / "function.c"), "-o", str(library), "-lm"]
    subprocess.run(command, check=True)
    run = ctypes.CDLL(str(library)).run

    def called(*values: float) -> Any:
        given, out = (ctypes.c_double * count)(*values), (ctypes.c_double * max(size, 1))()
        why = ctypes.create_string_buffer(512)
        run(given, out, why)
        found = iter(out)
        return why.value.decode() or _filled(entry.result, found)

    called.text = "\n\n".join(texts)  # type: ignore[attr-defined]
    return called


def _filled(form: Any, found: Iterator[float]) -> Any:
    """Return a result with the numbers found in place of those at run time; arrays are numpy's."""
    if isinstance(form, Stored):
        return np.array([next(found) for _ in range(form.size)]).reshape(form.shape)
    if isinstance(form, Num):
        return next(found)
    if not is_dynamic(form):
        return form
    return rebuilt(form, [_filled(item, found) for _, item in parts(form) or ()])


def unknown(count: int) -> list[Num]:
    """Return numbers that are known at run time only."""
    return [Num(f"x{i}") for i in range(count)]
