"""How far operating point, scene and state travel through the functions of the core in a step.

    python -m benchmarks.house.stays

Follows `advance` of mtm_zddp at each level while it runs and writes docs/measured/house.md.
"""

import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import FrameType
from typing import Any

import contact_core
from benchmarks.pages import Page
from contact_core import ContactState, OperatingPoint, Scene, advance, initial_state
from contact_core.quantities import LEVELS
from contact_core.scene import Case

CORE = Path(contact_core.__file__).parent
TRAVELLERS = {"operating point": OperatingPoint, "scene": Scene, "state": ContactState, "`Case`": Case}
MOST = 60  # stays of one of them
STEP = 10.0  # s

Stays = dict[str, set[tuple[str, str]]]  # file and function by what was passed


def followed(run: Callable[[], Any]) -> Stays:
    """Run something; return the functions of the core that were called with each of the travellers."""
    found: Stays = {name: set() for name in TRAVELLERS}

    def seen(frame: FrameType, event: str, _: Any) -> None:
        code = frame.f_code
        file = Path(code.co_filename)
        if event != "call" or CORE not in file.parents or "<" in code.co_name:
            return
        arguments = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        given = [frame.f_locals.get(name) for name in arguments if name not in ("self", "cls")]
        for name, kind in TRAVELLERS.items():
            if any(isinstance(value, kind) for value in given):
                found[name].add((file.relative_to(CORE).as_posix(), code.co_qualname))

    sys.setprofile(seen)
    try:
        run()
    finally:
        sys.setprofile(None)
    return found


def of_steps(level: str) -> Stays:
    """Return the stays of three steps: the first one, one under the same inputs, one under more load."""
    scene = Scene.from_toml("mtm_zddp").at_level(level)
    point, first = scene.operation.point, initial_state(scene)

    def run() -> None:
        state = first
        for op in (point, point, replace(point, load=1.2 * point.load)):
            state, _ = advance(scene, op, state, STEP)

    return followed(run)


def counted(stays: set[tuple[str, str]]) -> str:
    """Return the number of functions and of files."""
    return f"{len(stays)} in {len({file for file, _ in stays})} files"


def main() -> None:
    """Write the page."""
    page = Page("house/stays", "Functions through which operating point, scene and state travel")
    found = {
        level: of_steps(level) for level in LEVELS if level != "map"
    }  # its steps are those of the regression level
    page.say(
        "A stay is a function of `contact_core` that is called with such an object as an argument while `advance` takes a "
        "step of `mtm_zddp` on the shipped grid: the first one, one under the same inputs, and one under more load. A "
        "function counts once at each level, however often it is called and by whatever name it takes the object; `self` "
        "is no argument, and functions that the three steps do not reach do not count."
    )
    page.say(
        "`advance` binds scene and operating point in a `Case` and hands that on. A `Case` does not count as an operating "
        "point or a scene; its own stays have a column. Tools that follow all calls in the source, those that no step "
        "makes too, find more."
    )
    page.header("level", *TRAVELLERS)
    for level, stays in found.items():
        most = max(map(len, stays.values()))
        page.verdict(f"{level}: at most {MOST} stays of each", f"{most}", most <= MOST)
        page.row(level, *(counted(stays[name]) for name in TRAVELLERS))
    for level, stays in found.items():
        page.say(f"By file, {level}:")
        page.header("file", *TRAVELLERS)
        counts = {name: Counter(file for file, _ in stays[name]) for name in TRAVELLERS}
        for file in sorted(set().union(*counts.values())):
            page.row(f"`{file}`", *(counts[name][file] or "" for name in TRAVELLERS))
    page.write()


if __name__ == "__main__":
    main()
