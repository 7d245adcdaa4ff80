"""The command `tribofmu surfaces`: what a scene's grid shows of its surfaces, as new."""

import argparse

from contact_core.errors import ContactError
from contact_core.scene import Scene

from .console import add_settings
from .scenes import microroughness, tell_assumed, warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="NAME", help="a shipped name (`tribofmu list`), or the path of a .toml file")
    parser.add_argument("--grid", metavar="N", help="nodes along x and y: replaces film.points")
    add_settings(parser, "change values of the scene, e.g. surface_1.heights.file=patch.npy")


def run(arguments: argparse.Namespace) -> int:
    """Print the statistics of both surfaces, of all waves and of those on the grid; return 0."""
    settings = dict(arguments.settings)
    if arguments.grid == "":
        raise ContactError("--grid is empty. Give a value, or leave --grid out.")
    if arguments.grid:
        settings["film.points"] = arguments.grid
    scene, assumed = Scene.read(arguments.scene, settings)
    tell_assumed(assumed)
    warn(scene.warnings())
    print(f"Grid of {scene.film.points} nodes, {1e6 * scene.film.spacing:.3g} um apart")
    surfaces = (scene.surface_1, scene.surface_2)
    layers = microroughness(scene, arguments.scene, settings)
    for body, (surface, below) in enumerate(zip(surfaces, layers, strict=True), 1):
        heights = surface.heights
        made_of = ([surface.name] if surface.rq > 0.0 else []) + ([heights.file or "array"] if heights else [])
        print(f"\nBody {body}: {' and '.join(made_of) or 'smooth'}")
        if made_of:
            print("\n".join(_table(scene, body)))
        print(below)
    return 0


def _table(scene: Scene, body: int) -> list[str]:
    from contact_core.surfaces.laid import shown

    surface, found = scene.surface_1 if body == 1 else scene.surface_2, shown(scene, body)
    columns = {
        "file": surface.heights.statistics._asdict() if surface.heights else {},
        "all waves": {"rms": found.rms, "slope": found.slope},
        "on the grid": found.on_grid._asdict(),
    }
    columns = {name: column for name, column in columns.items() if column}
    lines = ["".join(f"{name:>22}" if i == 0 else f"{name:>14}" for i, name in enumerate(["", *columns]))]
    for name, text, factor in (
        ("rms", "rms height, nm", 1e9),
        ("ra", "Ra, nm", 1e9),
        ("skewness", "skewness", 1.0),
        ("peak_to_valley", "peak to valley, nm", 1e9),
        ("slope", "rms slope", 1.0),
    ):
        cells = [f"{factor * column[name]:.4g}" if name in column else "" for column in columns.values()]
        lines.append(f"{text:>22}" + "".join(f"{cell:>14}" for cell in cells))
    return [line.rstrip() for line in lines] + [f"{'cut by the grid, nm rms':>22} {1e9 * found.cut:.4g}"]
