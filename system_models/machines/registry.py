"""The kinds of machines: a new kind is a folder beside this file and one entry here, or in a package of its own."""

from functools import cache

from contact_core.entry_points import offered
from contact_core.errors import SceneError

from ..parts.part import MACHINES
from .ball_bearing.machine import BALL_BEARING
from .ball_on_disc.machine import BALL_ON_DISC
from .cam_follower.machine import CAM_FOLLOWER
from .gear_pair.machine import GEAR_PAIR
from .kind import Kind

KINDS: dict[str, Kind] = {kind.name: kind for kind in (BALL_ON_DISC, BALL_BEARING, GEAR_PAIR, CAM_FOLLOWER)}


@cache
def kinds() -> dict[str, Kind]:
    """Return all kinds by name: those of this package, and those that other installed packages offer.

    Raises SceneError if a package offers what is no kind, or one under a name that is taken.
    """
    others = offered(MACHINES).get(MACHINES, {})
    for name, kind in others.items():
        if not isinstance(kind, Kind) or kind.name != name:
            raise SceneError(f"The entry point '{name}' of {MACHINES} must be a Kind of that name, not {kind!r:.80}.")
        if name in KINDS:
            raise SceneError(f"A package offers a machine '{name}', but that is one of tribofmu. Choose another name.")
    return KINDS | others
