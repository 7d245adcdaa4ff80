"""Growth and removal of the tribofilm.

In each solved instant a law says how strongly every node is exposed (`exposure`). Its `dose` says how the instants of a
pass become the mean exposure per test time:

    clock            the largest exposure of any instant of the last pass, for the whole time; the pass stands for the
                     many real ones of a block, so a smooth body, which meets ever other asperities, is all exposed
    contact_length   the mean over the crossing of the contact's length 2a
    residence        the mean over the whole track

Mean exposure times test time is what `evolve` takes as `exposed`. A law that `abrades` also says how fast rubbing
takes away what there is (`abrasion`, by the solid pressure as mean over the track); times test time: `abraded`.

A law carries two internal variables per node and body: `growth` (what tribochemistry has formed) and `removal` (what
rubbing has taken). They are autonomous, so a state needs no age and may be cut and continued anywhere. A law of
first-order removal needs one only: it keeps the thickness in `growth` and nothing in `removal`.

`fitted` has laws of nodes in contact, fitted to films; `activated` those of reactions that stress speeds up.
"""

from .activated import Combined, Gosvami, ZhangSpikes
from .fitted import Andersson, Ghanbarzadeh, NoTribofilm, thickness

LAWS = (NoTribofilm, Ghanbarzadeh, Andersson, ZhangSpikes, Gosvami, Combined)

__all__ = ["LAWS", "Andersson", "Combined", "Ghanbarzadeh", "Gosvami", "NoTribofilm", "ZhangSpikes", "thickness"]
