"""Runs a scene with several surfaces: each member as a sweep runs its points, and one result of them."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError

from .console import note, output_folder
from .contact import about
from .map import processes_of
from .scenes import ask_back, contact_of, folder_of_duty, settings_of, warn
from .sweep import solved_with_bar

if TYPE_CHECKING:
    from contact_core.scene import Scene
    from contact_core.scene.ensemble import Members

    from ..run.duty import Duty
    from ..sweep.points import Task


def run(arguments: argparse.Namespace, members: "Members") -> int:
    """Run the members of an ensemble, those kept from before apart; return the exit code."""
    from ..run.origin import attributes
    from ..runs.contact import introduction
    from ..runs.replacing import ask_before
    from ..store.checkpoint import alone
    from ..sweep.members import ATTRIBUTE, FILE, attribute
    from ..sweep.points import Task
    from .listener import CONSOLE

    if arguments.fields is not None:
        picked = " ".join(f"{key}={value}" for key, value in members.settings[0])
        raise ContactError(
            f"--fields keeps maps of one contact, and this is an ensemble of {len(members.names)}. Leave it out, or "
            f"pick a member by --set {picked}."
        )
    processes = processes_of(1 if arguments.processes is None else arguments.processes)
    scene, duty, settings = _checked(arguments, members)
    folder = output_folder(arguments.out, Path(arguments.scene).stem)
    points = output_folder(str(folder / FILE), "")
    task = Task(arguments.scene, tuple(settings.items()), folder_of_duty(arguments), points, arguments.force)
    with alone(folder):
        ask_before(folder, {**attributes(scene, duty), ATTRIBUTE: attribute(members)}, arguments.force, CONSOLE)
        lines = about(scene, arguments.scene, settings | dict(members.settings[0]))
        CONSOLE.say(members.text, *introduction(scene, duty, lines))
        return _run_in(task, members, scene, duty, folder, processes)


def _checked(arguments: argparse.Namespace, members: "Members") -> "tuple[Scene, Duty, dict[str, str]]":
    """Return scene and duty of the first member, and the overrides of all. Raises ContactError if one is refused."""
    from contact_core.scene import Scene

    base, first = settings_of(arguments), dict(members.settings[0])
    scene, duty, settings, _ = contact_of(arguments, base | first)
    settings = {key: value for key, value in settings.items() if key not in first}
    doubts = dict.fromkeys(scene.warnings())
    for name, chosen in zip(members.names[1:], members.settings[1:], strict=True):
        try:
            member = Scene.from_toml(arguments.scene, settings | dict(chosen))
            ask_back(member.doubts(), arguments.force)
        except ContactError as error:
            raise ContactError(f"Member '{name}' of the ensemble: {error}") from None
        doubts |= dict.fromkeys(member.warnings())
    warn(doubts)
    return scene, duty, settings


def _run_in(task: "Task", members: "Members", scene: "Scene", duty: "Duty", folder: Path, processes: int) -> int:
    """Run the members, print and write what they are together; return the exit code."""
    from ..charts import files
    from ..run import origin, report, trust
    from ..store import results
    from ..sweep import members as together
    from ..sweep.points import file_of, gathered

    plan = together.plan_of_members(members)
    there = sum(file_of(task, number).exists() for number in range(len(members.names)))
    if there:
        note(f"{there} members are in '{task.folder}' from before: those of this very scene are not run again.")
    outcomes = solved_with_bar(task, plan, processes, None)
    together.refuse_missing(members, outcomes)
    each = gathered(task, plan, outcomes)
    result = together.mean_of(members, plan, each)
    result = origin.with_scene(result, scene, duty)
    print(report.table(result, trust.width()), *trust.legend(together.HALVES), sep="\n")
    rows, words = together.table(members, result, each)
    print("", *rows, *trust.wrapped(words), sep="\n")
    print(*trust.after(scene, result, {}), sep="\n")
    written = results.write(result, folder, table=together.with_scatter(result))
    written += results.write(each, folder, together.FILE)
    written.append(files.save(report.overview(result), folder / "overview.png"))
    print(f"Written: {', '.join(map(str, written))}")
    return 1 if report.invalid_rows(result) else 0
