"""The command `tribofmu new`: a commented scene to start from."""

import argparse
import re
from importlib.resources import files as resources
from pathlib import Path

from contact_core.errors import ContactError, did_you_mean
from contact_core.scene.toml import shipped_scenes

from ..machines import files as machines

_BALL_ON_FLAT = "new_scene.toml"
_NAME = re.compile(r"[\w-]+")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="name of the scene: NAME.toml is written into the working folder")
    parser.add_argument(
        "--like",
        metavar="SHIPPED",
        help="copy a shipped scene or machine, such as mtm_zddp, instead of a ball on a flat in a mineral oil",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the file, and those that it names; return 0."""
    name = arguments.name.removesuffix(".toml")
    if not _NAME.fullmatch(name):
        raise ContactError(f"NAME = '{name}' must be of letters, digits, '_' and '-': it names files and results.")
    copies = _of_shipped(name, arguments.like) if arguments.like else _ball_on_flat(name)
    there = [str(path) for path in copies if path.exists()]
    if there:
        raise ContactError(f"'{there[0]}' is there already. Use another NAME, or another working folder.")
    for path, content in copies.items():
        path.write_bytes(content)
    print(f"Written: {', '.join(map(str, copies))}. Change its numbers, and run it: tribofmu run {name}.toml")
    return 0


def _ball_on_flat(name: str) -> dict[Path, bytes]:
    text = resources(__package__).joinpath(_BALL_ON_FLAT).read_text("utf-8")
    return {Path(f"{name}.toml"): text.replace("{name}", name).encode()}


def _of_shipped(name: str, like: str) -> dict[Path, bytes]:
    """Return the file of a shipped scene or machine under a new name, and the tables that lie beside it."""
    folder = resources("contact_core") / "data" / "scenes"
    shipped = {scene: folder / f"{scene}.toml" for scene in shipped_scenes()} | machines.shipped_files()
    if like not in shipped:
        raise ContactError(
            f"There is no scene or machine '{like}'.{did_you_mean(like, list(shipped))} "
            f"Shipped are {', '.join(shipped)}."
        )
    text = shipped[like].read_text("utf-8")
    text = re.sub(r'^name = ".*"', f'name = "{name}"', text, count=1, flags=re.MULTILINE)
    copies = {Path(f"{name}.toml"): text.encode()}
    for file in re.findall(r'^file = "(.+\.csv)"', text, re.MULTILINE):
        copies[Path(file)] = (Path(str(shipped[like])).parent / file).read_bytes()
    return copies
