"""A Python function as C: written, compiled by gcc and called."""

import ctypes
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fmu_src.native.build import FOLDER, WARNINGS
from fmu_src.native.program import HEAD
from fmu_src.native.tables import tables_h
from fmu_src.native.translate import Num, Translator, leaves, replaced

_HEADER = "typedef struct { char text[512]; } contact_message;\n"


def translated(folder: Path, function: Callable[..., Any], operands: list[Any]) -> Callable[..., Any]:
    """Return what calls a function in C, of the numbers that `operands` have as Num x0, x1 and so on, in that order.

    It gives the result in the form of Python's, or the message with which it refuses.
    """
    translator = Translator()
    entry = translator.program(function, operands)
    texts = translator.texts([entry])
    given = [number.text for number in entry.takes]
    numbers = [number for _, number in leaves(entry.result)]
    call = f"{entry.name}({', '.join([*given, *(['why'] if entry.may_fail else [])])})"
    found = [f"out[{i}] = found.{number.text};" for i, number in enumerate(numbers)]
    if len(numbers) == 1:
        lines = [f"out[0] = {call};"]
    else:
        lines = [f"const struct {entry.name} found = {call};", *found] if numbers else [f"{call};"]
    count = len(leaves(operands))
    text = "\n\n".join(
        [
            HEAD,
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
        given, out = (ctypes.c_double * count)(*values), (ctypes.c_double * max(len(numbers), 1))()
        why = ctypes.create_string_buffer(512)
        run(given, out, why)
        found = iter(out)
        return why.value.decode() or replaced(entry.result, lambda _: next(found))  # type: ignore[return-value]

    called.text = "\n\n".join(texts)  # type: ignore[attr-defined]
    return called


def unknown(count: int) -> list[Num]:
    """Return numbers that are known at run time only."""
    return [Num(f"x{i}") for i in range(count)]
