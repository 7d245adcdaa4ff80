"""Build a model's FMU from its table and C source."""

from __future__ import annotations

import atexit
import functools
import hashlib
import os
import subprocess
import sys
import tempfile
import uuid
import zipfile
from pathlib import Path
from typing import Any

import fmpy
from pythonfmu.builder import FmuBuilder

from .catalogue import MODELS
from .description import Model, Variant, describe

SOURCES = Path(__file__).parent / "c"
SCRIPT = Path(__file__).parent / "python" / "python_mass.py"
HEADERS = Path(fmpy.__file__).parent / "c-code"
COMMON = {2: ("instance", "fmi2"), 3: ("instance", "fmi3", "unsupported3")}
PLATFORM = {2: "linux64", 3: "x86_64-linux"}
FLAGS = ("-std=gnu11", "-O2", "-fPIC", "-fvisibility=hidden", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror")


def build(
    name: str,
    folder: Path,
    fmi: int = 2,
    *,
    rollback: bool = True,
    interpolates: bool = True,
    intermediate: bool = False,
    dependencies: bool = True,
    start: dict[str, Any] | None = None,
    identifier: str | None = None,
    **variant: Any,
) -> Path:
    """Build a model's FMU in `folder`, unless it lies there already; returns its path.

    `rollback=False`: it neither saves nor restores its state. `interpolates=False`: derivatives of inputs have no
    effect (FMI 3 has none). `intermediate`: it asks for its inputs within a step, as FMI 3 can. `dependencies=False`:
    the description leaves out what outputs depend on. `start`: other start values of parameters and inputs.
    `identifier`: another name for the FMU. `variant`: what the model itself takes.
    """
    if name == "python_mass":
        if fmi != 2 or not rollback or start or identifier or variant:
            raise ValueError("python_mass is built for FMI 2 as it stands, and has no variants")
        return _python_mass(Path(folder))
    model = MODELS[name](**variant).starting(start or {})
    switches = Variant(fmi, rollback, interpolates, dependencies, intermediate)
    identifier = identifier or name
    header = _header(model, switches)
    digest = hashlib.sha256(repr((identifier, model, switches, _sources())).encode()).digest()
    token = str(uuid.UUID(bytes=digest[:16]))
    path = Path(folder) / f"{identifier}_fmi{fmi}_{token[:8]}.fmu"
    if not path.exists():
        library = _compiled(model.source, header + f'#define TOKEN "{token}"\n', fmi)
        _pack(path, identifier, describe(identifier, token, model, switches), library, fmi)
    return path


def _python_mass(folder: Path) -> Path:
    """The FMU that pythonfmu makes of python/python_mass.py."""
    path = folder / "python_mass_fmi2.fmu"
    if not path.exists():
        before = sys.path[:]  # pythonfmu leaves the folder of the script in it
        states = {"canGetAndSetFMUstate": True, "canSerializeFMUstate": True}
        part = path.with_suffix(f".{os.getpid()}.fmu")  # a second process may look for it
        FmuBuilder.build_FMU(SCRIPT, part, needsExecutionTool=False, **states)
        part.rename(path)
        sys.path[:] = before
    return path


@functools.cache
def _sources() -> str:
    """Digest of all that the compiler reads."""
    text = b"".join(path.read_bytes() for path in sorted(SOURCES.iterdir()))
    return hashlib.sha256(text + repr(FLAGS).encode()).hexdigest()


def _header(model: Model, variant: Variant) -> str:
    """variables.h, apart from the token."""
    numbers = [v for v in model.variables if v.kind != "String"]
    strings = [v for v in model.variables if v.kind == "String"]
    every = [v for v in model.variables for _ in range(v.size)]
    count = {c: sum(v.size for v in numbers if v.causality == c) for c in ("parameter", "input")}
    starts = ", ".join(repr(float(start or 0.0)) for v in numbers for start in v.starts)
    named = zip(model.variables, model.references, strict=False)
    texts = ", ".join(f'"{v.start or ""}"' for v in strings)
    lines = [
        f"#define N_VARIABLES {len(every)}",
        f"#define N_NUMBERS {len(every) - len(strings)}",
        f"#define N_STRINGS {len(strings)}",
        f"#define N_PARAMETERS {count['parameter']}",
        f"#define N_INPUTS {count['input']}",
        f"#define N_MEMORY {model.memory}",
        "#define FIRST_INPUT N_PARAMETERS",
        "#define FIRST_OUTPUT (N_PARAMETERS + N_INPUTS)",
        f"#define ROLLBACK {int(variant.rollback)}",
        f"#define INTERPOLATES {int(variant.interpolates)}",
        f"#define INTERMEDIATE {int(variant.intermediate)}",
        f"#define HAS_EVENT_MODE {int(model.events)}",
        f"enum {{ {', '.join(f'V_{v.name} = {reference}' for v, reference in named)} }};",
        f'#define KIND "{"".join(v.kind[0] for v in every)}"',
        f'#define CAUSALITY "{"".join(v.causality[0] for v in every)}"',
        f"static const unsigned SIZE[] = {{{', '.join(str(v.size) for v in every)}}};",
        f"static const double START[] = {{{starts or '0.0'}}};",
        f"static const char *const START_TEXT[] = {{{texts or '0'}}};",
        model.header,
    ]
    return "\n".join(lines) + "\n"


def _compiled(source: str, header: str, fmi: int) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "variables.h").write_text(header)
        library = Path(folder, "model.so")
        files = SOURCES / f"{source}.c", *(_objects() / f"{common}.o" for common in COMMON[fmi])
        subprocess.run(["gcc", *FLAGS, "-shared", f"-I{folder}", *files, "-o", library, "-lm"], check=True)
        return library.read_bytes()


@functools.cache
def _objects() -> Path:
    """Compile the sources that all models share, once per process."""
    folder = tempfile.TemporaryDirectory()
    atexit.register(folder.cleanup)
    sources = [SOURCES / f"{name}.c" for name in sorted({name for names in COMMON.values() for name in names})]
    subprocess.run(["gcc", *FLAGS, "-c", f"-I{HEADERS}", *sources], check=True, cwd=folder.name)
    return Path(folder.name)


def _pack(path: Path, identifier: str, description: bytes, library: bytes, fmi: int) -> None:
    """Write the archive under another name first: a second process may look for it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(f".{os.getpid()}")
    with zipfile.ZipFile(part, "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.writestr(f"binaries/{PLATFORM[fmi]}/{identifier}.so", library)
        archive.writestr("resources/", b"")
    part.rename(path)
