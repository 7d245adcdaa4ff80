"""The scene and duty that commands are given."""

import argparse
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from contact_core.errors import ContactError
from contact_core.quantities import UNSOLVED
from contact_core.scene import Assumed, Scene, ensemble, told
from contact_core.scene.ensemble import Members
from contact_core.scene.origins import Origin, origins
from contact_core.scene.toml import given

from ..machines import files
from .console import add_settings, note, refuse_empty, tell_replaced
from .overwriting import add_force

if TYPE_CHECKING:
    from ..run.duty import Duty


# keys of a scene that options stand for
_STAND_FOR = {
    "hours": "operation.duration",
    "accuracy": "control.accuracy",
    "grid": "film.points",
    "duty": "operation.file",
}


def add_scene(command: argparse.ArgumentParser, kinds: str) -> None:
    """Add the arguments that name one of `kinds`, such as "scene", and the folder of the results."""
    command.add_argument(
        "scene", metavar="NAME", help=f"a shipped {kinds} (`tribofmu list`), or the path of a .toml file"
    )
    command.add_argument("--out", metavar="DIR", help="folder of the results (default: results/NAME)")
    command.add_argument(
        "--grid", metavar="N", help="nodes along x and y: replaces film.points, of machines contact.film.points"
    )
    command.add_argument(
        "--accuracy",
        metavar="A",
        help="error of friction, film and W_c asked for, such as 5%%: replaces control.accuracy, which chooses grid, "
        "blocks and instants; of machines contact.control.accuracy",
    )
    add_force(command)
    add_settings(command, f"change values of the {kinds}, e.g. tribofilm.model=none surface_2.rq='50 nm'")


def members(arguments: argparse.Namespace) -> Members | None:
    """Return the members of the scene if it is an ensemble."""
    refuse_machine(arguments.scene)
    return ensemble.members(given(arguments.scene, settings_of(arguments))[0])


def contact(arguments: argparse.Namespace) -> "tuple[Scene, Duty]":
    """Return the scene, large enough for its duty, and the duty."""
    refuse_machine(arguments.scene)
    scene, duty, _, _ = contact_of(arguments, settings_of(arguments))
    return scene, duty


class Contact(NamedTuple):
    """A scene that commands are given, large enough for its duty."""

    scene: Scene
    duty: "Duty"
    settings: dict[str, str]  # overrides that make this scene
    assumed: tuple[Assumed, ...]  # values that the scene does not give


def contact_of(arguments: argparse.Namespace, overrides: dict[str, str]) -> Contact:
    """Return the scene with overrides and the duty; say on stderr what the scene does not give."""
    from ..run.duty import Duty, refuse_hidden

    tell_replaced(arguments, _STAND_FOR)
    scene, assumed = Scene.read(arguments.scene, overrides)
    folder = folder_of_duty(arguments)
    refuse_hidden(scene, folder, overrides)
    duty = Duty.of_scene(scene, folder)
    if more := duty.for_grid(scene, assumed):
        overrides = overrides | more
        scene, assumed = Scene.read(arguments.scene, overrides)
    ask_back(scene.doubts(duty.named(scene)), arguments.force)
    tell_assumed(assumed)
    tell_unreached(duty.times, scene.operation.duration)
    return Contact(duty.sized(scene), duty, overrides, assumed)


def tell_assumed(assumed: Sequence[Assumed]) -> None:
    """Say on stderr which values a scene does not give."""
    if assumed:
        note(told(assumed))


def tell_unreached(times: Sequence[float], end: float) -> None:
    """Say on stderr which rows of a duty, by their times [s], come after the end of the run [s]."""
    late = sum(time > end for time in times)
    if late:
        note(
            f"The run ends at {end:g} s, the duty's last change is at {times[-1]:g} s: {late} of its {len(times)} rows "
            "are not reached. Give the duration, such as --hours, if they should be."
        )


def ask_back(doubts: Sequence[str], force: bool) -> None:
    """Raise ContactError for numbers that look like mistakes, unless `force`d; then warn."""
    if doubts and not force:
        raise ContactError(f"{' '.join(doubts)} If this is meant, add --force.")
    for doubt in doubts:
        print(f"tribofmu: warning: {doubt}", file=sys.stderr)


def refuse_machine(name: str) -> None:
    """Raise ContactError if a command that needs a scene is given the name or the file of a machine."""
    if files.is_machine(name):
        raise ContactError(f"'{name}' is a machine: use `tribofmu run {name}`; with --ssp it exports the FMUs.")


def warn(sentences: Iterable[str]) -> None:
    """Print warnings, such as those of a scene, on stderr."""
    for warning in sentences:
        print(f"tribofmu: warning: {warning}", file=sys.stderr)


def microroughness(scene: Scene, source: str, settings: Mapping[str, str]) -> tuple[str, str]:
    """Return a few words for each body on its roughness below the grid, and where its value is from.

    source, settings: what the scene was read from.
    """
    layers = [surface.microroughness for surface in (scene.surface_1, scene.surface_2)]
    bare = not any(layer and layer.rms > 0.0 for layer in layers)
    none = "no microroughness" + (": solids touch at the floor" if bare else "")
    found = {} if bare else origins(source, scene.to_dict(), settings)
    first, second = (
        f"microroughness {1e9 * layer.rms:.3g} nm rms, waves below {1e6 * layer.longest:.3g} um "
        f"({_from(found[f'surface_{body}.microroughness.rms'])})"
        if layer and layer.rms > 0.0
        else none
        for body, layer in enumerate(layers, 1)
    )
    return first, second


def _from(origin: Origin) -> str:
    """Return where a value is from, in a few words."""
    if origin.set_name:
        return f"{origin.source or origin.remark or 'without a source'}; set {origin.set_name}"
    return origin.remark or origin.source or f"from {origin.kind.value}, without a source"


def chosen(scene: Scene) -> list[str]:
    """Return a sentence on what a scene's accuracy has chosen, if it asks for one."""
    accuracy, film, control = scene.control.accuracy, scene.film, scene.control
    if accuracy is None:
        return []
    if film.fidelity in UNSOLVED:
        return [f"Accuracy {100.0 * accuracy:g} %: larger stated errors are flagged; this level has nothing to choose."]
    return [
        f"Accuracy {100.0 * accuracy:g} %: {film.points} nodes over {1e3 * film.domain:.3g} mm, blocks of "
        f"{1e9 * control.change:.3g} nm, {control.dry_instants} dry and {control.mixed_instants} mixed instants."
    ]


def settings_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Return the changes of a scene's keys by --set, and by the options that stand for some of them."""
    refuse_empty(arguments)
    settings = dict(arguments.settings)
    if getattr(arguments, "hours", None):
        settings["operation.duration"] = f"{arguments.hours} h"
    if arguments.accuracy:
        settings["control.accuracy"] = _share("--accuracy", arguments.accuracy)
    if arguments.grid:
        settings["film.points"] = arguments.grid
    if getattr(arguments, "duty", None):
        settings["operation.file"] = arguments.duty
    return settings


def _share(option: str, text: str) -> str:
    """Return an option that is a share. Raises ContactError for a plain number above 1, most often per cent."""
    try:
        number = float(text)
    except ValueError:
        return text
    if number > 1.0:
        raise ContactError(f"{option} = {text} is more than the whole. Did you mean '{text} %'?")
    return text


def folder_of_duty(arguments: argparse.Namespace) -> Path:
    """Return the folder of a duty file: the working folder, or that of the scene's file."""
    if getattr(arguments, "duty", None) or not arguments.scene.endswith(".toml"):
        return Path()
    return Path(arguments.scene).parent
