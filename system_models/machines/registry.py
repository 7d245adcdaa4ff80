"""The kinds of machines: a new kind is a folder beside this file and one entry here."""

from .ball_bearing.machine import BALL_BEARING
from .ball_on_disc.machine import BALL_ON_DISC
from .cam_follower.machine import CAM_FOLLOWER
from .gear_pair.machine import GEAR_PAIR
from .kind import Kind

KINDS: dict[str, Kind] = {kind.name: kind for kind in (BALL_ON_DISC, BALL_BEARING, GEAR_PAIR, CAM_FOLLOWER)}
