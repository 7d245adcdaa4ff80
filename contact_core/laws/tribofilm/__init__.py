"""Growth and removal of the tribofilm.

    fitted      laws of nodes in contact, fitted to measured tribofilms
    activated   laws of reactions that stress activates
    arrhenius   a law of nodes in contact, fitted at several temperatures
    relaxation  growth by the room left under removal by the thickness, in closed form
    doses       from the instants of a pass to the exposure per test time

In each solved instant a law gives the exposure of every node (`exposure`). Its `dose` (`doses`) says how the instants
of a pass become the mean exposure per test time.

Mean exposure times test time is what `evolve` takes as `exposed`. A law that `abrades` also says how fast rubbing
takes away what there is (`abrasion`, by the solid pressure as mean over the track); times test time: `abraded`.

A law of wear may take the tribofilm, too (`wears_film`): it adds to `abraded`, which every law with `takes_abrasion`
heeds. `formed` is the ledger: what has grown meanwhile. What has been removed is that less what the film has gained.

A law carries two internal variables per node and body: `growth` (what tribochemistry has formed) and `removal` (what
rubbing has taken). They are autonomous, so a state needs no age and may be cut and continued anywhere. A law of
first-order removal needs one only: it keeps the thickness in `growth` and nothing in `removal`.
"""

from ..base import Tribofilm
from .activated import Combined, Gosvami, ZhangSpikes
from .arrhenius import Arrhenius
from .doses import DOSES, MeanPasses, Passes
from .fitted import Andersson, Ghanbarzadeh, NoTribofilm, thickness

LAWS: tuple[type[Tribofilm], ...] = (
    NoTribofilm,
    Ghanbarzadeh,
    Andersson,
    ZhangSpikes,
    Gosvami,
    Combined,
    Arrhenius,
)
