"""Sections on the FMU as a component: status, variables, state, log, requirements, check and licence."""

import math
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import contact_core
from contact_core.scene import Scene
from contact_core.state import RangeFlag

from ...flavours import Flavour, Version
from ...html.markup import bullets, heading, paragraph, table
from ...runtime.guarded import LOG_CATEGORIES
from ...variables import INITIAL_STATE, Variable
from .. import evidence, licences
from ..describe import variables_of

_KINDS = (("Inputs", "input"), ("Outputs", "output"), ("Parameters", "parameter"), ("Time", "independent"))
_TEXTS: dict[str, dict[str, Any]] = tomllib.loads(Path(__file__).with_name("interface.toml").read_text("utf-8"))


def status(flavour: Flavour, fmi: Version) -> Iterator[str]:
    """Yield the section on status, valid and range_flags."""
    yield table(
        ("event", "status", "result"), ((what, f"fmi{fmi}{name}", then) for what, name, then in _events(flavour))
    )
    yield paragraph("Check valid after every step. range_flags is the sum of:")
    yield table(("value", "name", "meaning"), ((flag.value, flag.name, flag.text) for flag in RangeFlag))


def _events(flavour: Flavour) -> Iterator[Sequence[str]]:
    """Yield event, status and result of every row."""
    own = _TEXTS[flavour]
    yield "a usable step or value", "OK", "valid is true"
    yield (
        "an unusable input or step size, a contact that cannot be solved",
        own["unusable"],
        "valid is false; time advances, state and outputs do not change, the log gives the reason. The next "
        "step that can be computed sets valid to true again",
    )
    yield own["parameter"]
    yield (
        "a step that does not begin at the end of the last one, or that ends beyond the stop time",
        own["refused"],
        "valid is false; nothing changes, the log gives the reason",
    )
    yield "a state that cannot be used", own["refused"], f"{own['after_state']}, the log gives the reason"
    yield from own["failures"]


def variable_tables(scene: Scene, flavour: Flavour) -> Iterator[str]:
    """Yield the section of all variables."""
    yield paragraph(
        "All values are in SI units. Bounds are those of modelDescription.xml; those of an input are what this scene "
        "can use with the other inputs at their start values."
    )
    listed = variables_of(scene, flavour)
    for title, causality in _KINDS:
        yield heading(title)
        if causality == "parameter":
            yield paragraph(_TEXTS[flavour]["of_parameters"])
        rows = (_row(v) for v in listed if v.causality == causality)
        yield table(("name", "unit", "minimum", "maximum", "start", "meaning"), rows)


def _row(v: Variable) -> tuple[str, ...]:
    low, high = (f"{bound:.10g}" if math.isfinite(bound) else "" for bound in (v.minimum, v.maximum))
    start = f"{v.start:.10g}" if isinstance(v.start, float) else str(v.start)
    return v.name, v.unit, low, high, start if v.has_start else "", v.text


def state(flavour: Flavour, fmi: Version) -> Iterator[str]:
    """Yield the section on FMU states."""
    run_in = (
        "The first run, and every run after a reset, starts from fresh surfaces."
        if flavour == "native"
        else f"{INITIAL_STATE} names a file with the bytes of contact_core's ContactState.to_bytes(), to start from "
        "run-in surfaces; empty: fresh surfaces."
    )
    refused = "and changes nothing." if flavour == "native" else "when it is set: valid is false, nothing changes."
    yield bullets(
        (
            "FMU states can be got, set, serialised and deserialised at any time. A replay agrees bit for bit, also in "
            "another instance and in another process. A state includes parameters and inputs.",
            f"A damaged state, or a state of another FMU, is refused {refused}",
            run_in,
            f"fmi{fmi}Reset restores the start values; the next run repeats the first one.",
        )
    )


def log(flavour: Flavour, fmi: Version) -> Iterator[str]:
    """Yield the section on log messages."""
    yield paragraph(f"{_TEXTS[flavour]['logging'].format(fmi=f'fmi{fmi}')} Categories:")
    yield table(("category", "messages"), LOG_CATEGORIES.items())


def requirements(flavour: Flavour) -> Iterator[str]:
    """Yield the section on required packages and environment variables."""
    if flavour == "native":
        yield from _compilation()
        return
    exact = " and ".join(f"{name} {version}" for name, version in licences.exact().items())
    yield paragraph(
        f"{_TEXTS[flavour]['process']} It needs Python {licences.python()} with exactly {exact} and the packages that "
        f"pip installs with them: {', '.join(licences.dependencies())}. externalDependencies.txt lists the same."
    )
    yield table(("environment variable", "meaning"), licences.VARIABLES[flavour].items())


def _compilation() -> Iterator[str]:
    """Yield what a native FMU contains, and how to compile it."""
    yield paragraph(
        "This FMU is C99, generated for this contact alone: it needs neither Python nor other programs, files or "
        "processes, takes no memory after its instantiation, and answers each step in bounded time."
    )
    yield bullets(
        (
            "binaries/ has the libraries of the platforms for which it was built.",
            "sources/ has everything for any other platform: contact.c, the equations of the contact; model.c, its "
            "variables; the rest is the same for every contact. Compile without contraction of products and sums "
            "(-ffp-contract=off), and the results agree bit for bit on all platforms.",
            "CFLAGS=-ffp-contract=off fmpy compile FILE.fmu adds the library of the platform on which it runs; it "
            "needs CMake and a C compiler.",
        )
    )


def check(reference: bool) -> Iterator[str]:
    """Yield the section on reference data."""
    if not reference:
        yield paragraph("This FMU was built without reference data.")
        return
    names = {evidence.STIMULI: "stimuli", evidence.EXPECTED: "expected outputs", evidence.EXPERIMENT: "experiment"}
    links = [f'<a href="../{evidence.FOLDER}/{name}">{text}</a>' for name, text in names.items()]
    yield (
        f"<p>The FMU carries a short run of its own, {', '.join(links)}, in the layout of the FMI layered standard for "
        f'references. <a href="fmi-ls-ref.txt">How to replay it</a>; tolerance {evidence.TOLERANCE:g}.</p>'
    )
    yield paragraph("tribofmu check FILE.fmu --deep replays it, among other checks.")


def licence(flavour: Flavour, fmi: Version) -> Iterator[str]:
    """Yield the section on licences."""
    names = licences.licences(flavour, fmi)
    links = ", ".join(f'<a href="licenses/{name}">{name}</a>' for name in names)
    yield (
        f"<p>{licences.PACKAGE} {contact_core.__version__} is under the BSD 3-clause licence. Licences of the parts of "
        f"this FMU: {links}. Please cite the sources of the laws, too.</p>"
    )
