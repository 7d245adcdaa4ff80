"""Runs of contacts, machines and other systems: simulated with a checkpoint, checked and judged, in one call each.

    listener    what a run tells while it goes on
    replacing   no result of another run is replaced without a word
    job         a simulation with a checkpoint, and its result in a folder
    contact     a scene's contact through its duty
    machine     a machine through its duty, with double steps and states solved again

`run_contact(Scene.from_toml("mtm_zddp"), "results/mine")` is what `tribofmu run mtm_zddp` calls. It returns a
`Finished`, whose `dataset` is that of result.nc, and which is `reliable` where the command ends with 0.
"""

from .contact import run_contact
from .job import Finished
from .listener import Listener
from .machine import run_machine

__all__ = ["Finished", "Listener", "run_contact", "run_machine"]
