"""The command `tribofmu surface-file`: makes a measured surface ready for a scene."""

import argparse
import itertools
import re
from pathlib import Path

from contact_core.errors import ContactError
from contact_core.scene import units

from .console import output_folder
from .overwriting import add_force, refuse_existing

_NAME = re.compile(r"[a-z0-9_-]+$")
_FORMS = ("none", "plane", "curvature")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "files",
        metavar="FILE",
        nargs="+",
        help="heights of an instrument: .al3d, .sdf, .opd, .x3p, .zmg, .sur, .plux, ...; several make an ensemble",
    )
    parser.add_argument(
        "--form",
        choices=_FORMS,
        default="plane",
        help="least-squares form to remove: the mean, a plane, or with curvature, as of balls (default: %(default)s)",
    )
    parser.add_argument(
        "--window",
        metavar="LOW:HIGH",
        nargs=2,
        help="part of the image along its x and y, from its first point: '0.1 mm:0.9 mm' '0 mm:0.5 mm' (default: all)",
    )
    parser.add_argument("--longest", metavar="L", help="longest wave to keep, e.g. '0.25 mm' (default: all)")
    parser.add_argument(
        "--shortest",
        metavar="S",
        help="shortest wave to keep, e.g. '2 um': two nodes of the finest grid that you mean to use; what is shorter "
        "is roughness below the grid (default: all)",
    )
    parser.add_argument(
        "--resolution", metavar="R", help="shortest wave that the instrument resolves (default: two of its points)"
    )
    parser.add_argument(
        "--along",
        choices=("x", "y"),
        default="x",
        help="axis of the image that lies along the entrainment (default: %(default)s)",
    )
    parser.add_argument("--unit", metavar="UNIT", help="of a file that does not say its own: m, mm, um, nm")
    parser.add_argument("--size", metavar=("X", "Y"), nargs=2, help="of a file that does not say it: '1 mm' '1 mm'")
    parser.add_argument(
        "--out",
        metavar="NAME",
        help="writes NAME.npy and NAME.toml, of several files NAME_1, NAME_2 and so on (default: the name of FILE)",
    )
    add_force(parser, "replace files that are there already")


def run(arguments: argparse.Namespace) -> int:
    """Read, prepare and write the surfaces, each in the same way; return 0."""
    folder, names = _out(arguments)
    written = [_one(arguments, Path(file), folder, name) for file, name in zip(arguments.files, names, strict=True)]
    if len(written) == 1:
        print(f"A scene uses it by --set surface_2.set='{written[0]}:{names[0]}', or set = ... in its [surface_2].")
        return 0
    listed = ", ".join(f'"{file}"' for file in written)
    print(f"An ensemble of them, which `tribofmu run` runs with a band, in a scene:\n\n[surface_2]\nfiles = [{listed}]")
    print(f"\nor by --set surface_2.files={','.join(map(str, written))}")
    return 0


def _one(arguments: argparse.Namespace, file: Path, folder: Path, name: str) -> Path:
    """Read, prepare and write one surface, say what was done; return the file of its set."""
    from ..instruments import patch, surface_file, surface_set

    refuse_existing([folder / f"{name}.npy", folder / f"{name}.toml"], arguments.force)
    size = tuple(_length(text, "--size") for text in arguments.size) if arguments.size else None
    image = surface_file.read(file, arguments.unit, size)  # type: ignore[arg-type]
    if arguments.window:
        image = image.window(*(_window(text) for text in arguments.window))
    if arguments.along == "y":
        image = image.turned()
    longest, shortest, resolution = (
        _length(given, f"--{option}") if given is not None else None
        for option in ("longest", "shortest", "resolution")
        for given in [getattr(arguments, option)]
    )
    found = patch.patch_of(image, arguments.form, longest, shortest, resolution)
    print(*surface_set.lines(image, found), sep="\n")
    written = surface_set.write(name, folder, image, found)
    print(f"Written: {', '.join(map(str, written))}")
    return written[1]


def _out(arguments: argparse.Namespace) -> tuple[Path, list[str]]:
    """Return the folder and the names of the sets, in small letters as sets are."""
    files = [Path(file) for file in arguments.files]
    given = Path(arguments.out or files[0].stem)
    if arguments.out:
        if not _NAME.match(given.name):
            raise ContactError(f"--out = '{arguments.out}' must end in a name of small letters, digits, '_' and '-'.")
        many = [f"{given.name}_{number}" for number in range(1, len(files) + 1)]
        names = many if len(files) > 1 else [given.name]
    else:
        names = [re.sub(r"[^a-z0-9_-]+", "_", file.stem.lower()) for file in files]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ContactError(f"Two files would be written as '{twice}'. Give --out NAME, for NAME_1, NAME_2 and so on.")
    folder = output_folder(str(given.parent), "")
    for name, file in itertools.product(names, files):
        if (folder / f"{name}.npy").resolve() == file.resolve():
            raise ContactError(
                f"'{file}' itself would be replaced by the prepared heights. Give another name by --out."
            )
    return folder, names


def _length(text: str, option: str) -> float:
    value = units.parse(text, "m", option)
    if value <= 0.0:
        raise ContactError(f"{option} = {text} must be above 0.")
    return value


def _window(text: str) -> tuple[float, float]:
    low, colon, high = text.partition(":")
    if not colon:
        raise ContactError(f"--window '{text}' is not LOW:HIGH, such as '0.1 mm:0.9 mm'.")
    return units.parse(low.strip(), "m", "--window"), units.parse(high.strip(), "m", "--window")
