"""Formulas that functions and records state in their docstrings: closed forms, machines, co-simulation."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

_ROOT = Path(__file__).parents[2]
_REFERENCE, _MACHINES = "contact_core/reference/", "system_models/machines/"
_BEARING, _GEAR = f"{_MACHINES}ball_bearing/", f"{_MACHINES}gear_pair/"
_CAM, _PARTS = f"{_MACHINES}cam_follower/", "system_models/parts/"
# heading; files, and the names in them of which the docstrings are shown: without names that of the file
FORMULAS: dict[str, dict[str, tuple[str, ...]]] = {
    "Hertz's contacts": {
        f"{_REFERENCE}hertz.py": ("hertz_point", "hertz_line"),
    },
    "Films of smooth bodies": {
        f"{_REFERENCE}point_films.py": ("nijenbanning_venner_moes", "hamrock_dowson"),
        f"{_REFERENCE}line_films.py": ("moes_line_film", "dowson_line"),
        f"{_REFERENCE}starvation.py": ("supplied_film", "film_behind_meniscus"),
    },
    "Rolling": {
        f"{_REFERENCE}rolling.py": ("rolling_beyond_line", "rolling_beyond_point", "slipping_share"),
    },
    "Temperature": {
        f"{_REFERENCE}heat.py": ("jaeger_circle", "tian_kennedy_circle"),
    },
    "Stress below the surface and fatigue": {
        "contact_core/kernels/subsurface.py": (),
        "contact_core/kernels/stress_measures.py": ("von_mises", "principal", "largest_shear"),
        "contact_core/kernels/smallest_sphere.py": (),
        "contact_core/regression/near_surface.py": ("Pressures", "Added", "Largest"),
    },
    "Heat, growth and wear in a step": {
        "contact_core/kernels/moving_source.py": (),
        "contact_core/laws/tribofilm/relaxation.py": ("", "formed"),
        "contact_core/kernels/surface_give.py": (),
        "contact_core/deterministic/growth_and_wear.py": ("stable_time",),
    },
    "Roughness, exposure and errors at the regression level": {
        "contact_core/laws/load_sharing.py": (
            "rms_slope",
            "flattening_of",
            "FittedSharing.exposed",
            "FittedSharing.coverage",
            "Widths",
        ),
        "contact_core/regression/outputs.py": ("_lambda_ratio",),
    },
    "Fits": {
        "system_models/run/fit_estimate.py": (),
    },
    "Ball bearings": {
        f"{_BEARING}equilibrium.py": ("", "solve"),
        f"{_BEARING}geometry.py": ("BallBearingGeometry",),
        f"{_BEARING}kinematics.py": (),
        f"{_BEARING}load_classes.py": (),
        f"{_BEARING}textbook.py": ("skf_torque", "palmgren_torque"),
        f"{_BEARING}rating.py": ("dynamic_rating", "reference_life", "life_factor", "consumed"),
        f"{_BEARING}stress_life.py": (),
    },
    "Gears": {
        f"{_GEAR}path.py": ("radius", "surface_speeds"),
        f"{_GEAR}sharing.py": ("Sharing",),
        f"{_GEAR}shafts.py": ("GearShafts",),
        f"{_GEAR}textbook.py": ("ohlendorf", "schlenk", "michaelis", "iso_14179_1"),
        f"{_GEAR}micropitting.py": ("films", "safety"),
        f"{_GEAR}scuffing.py": ("by_flash", "by_integral"),
    },
    "Cams": {
        f"{_CAM}part.py": ("CamFollower",),
        f"{_CAM}profile.py": ("CamProfile",),
    },
    "Parts of machines": {
        f"{_PARTS}shaft.py": ("Shaft",),
        f"{_PARTS}spindle.py": ("Spindle",),
        f"{_PARTS}load_arm.py": ("LoadArm",),
        f"{_PARTS}brake.py": ("Brake",),
        f"{_PARTS}thermal.py": ("ThermalNetwork",),
        f"{_PARTS}linear.py": (),
    },
    "Errors of co-simulation": {
        "system_models/numerics/richardson.py": (),
        f"{_MACHINES}coupling_error.py": ("stated",),
    },
}
_LETTERS = "alpha beta delta epsilon zeta eta theta kappa lambda mu nu pi rho sigma tau phi psi omega"
_GREEK = dict(zip(_LETTERS.split(), "αβδεζηθκλμνπρστφψω", strict=True))
_TELLING = re.compile(r" = |\^|Sources?\b")
_NAME = re.compile(rf"(?<![A-Za-z`])(?:{'|'.join(_GREEK)})(?![A-Za-z`])")


def sections() -> Iterator[str]:
    """Yield the lines of the sections, in Markdown."""
    for title, files in FORMULAS.items():
        yield f"## {title}"
        yield ""
        for file, names in files.items():
            for name in names or ("",):
                place = f"`{file}`, `{name}`" if name else f"`{file}`"
                yield f"{place}:\n\n```text\n{_text(file, name)}\n```\n"


def _text(file: str, name: str) -> str:
    """Return the first paragraph of a docstring and those with formulas or sources, with Greek letters."""
    first, *others = _docstrings(file)[name].partition("\n\nParameters\n")[0].split("\n\n")
    text = "\n\n".join([first, *(other for other in others if _TELLING.search(other))])
    text = _NAME.sub(lambda match: _GREEK[match[0]], text).replace("sqrt", "√")
    for power, raised in (("2", "²"), ("3", "³")):
        text = re.sub(rf"\^{power}(?![\d/]|\.\d)", raised, text)
    return text


@cache
def _docstrings(file: str) -> dict[str, str]:
    """Return the docstrings of a file by name; its own by an empty one."""
    tree = ast.parse((_ROOT / file).read_text("utf-8"))
    return {"": ast.get_docstring(tree) or "", **_of(tree.body, "")}


def _of(body: list[ast.stmt], owner: str) -> dict[str, str]:
    """Return the docstrings of functions and classes, those of a class's own by Class.method."""
    found = {}
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found[owner + node.name] = ast.get_docstring(node) or ""
        if isinstance(node, ast.ClassDef):
            found |= _of(node.body, f"{node.name}.")
    return found
