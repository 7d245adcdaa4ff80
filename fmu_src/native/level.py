"""The level of a native FMU: that of a shipped map of its scene where there is one, else the regression level."""

from contextlib import suppress

from contact_core import advance, initial_state
from contact_core.corrections.map import map_of
from contact_core.errors import ContactError
from contact_core.quantities import UNSOLVED
from contact_core.scene import Scene


def unsolved(scene: Scene) -> Scene:
    """Return the scene at a level that solves no contact; its own, if that is one."""
    if scene.film.fidelity in UNSOLVED:
        return scene
    with suppress(ContactError):
        mapped = scene.at_level("map")
        map_of(mapped)
        return mapped
    return scene.at_level("regression")


def other_level(scene: Scene, taken: Scene) -> str:
    """Return a sentence on the level `taken` in place of the scene's own, with its stated errors."""
    return (
        f"the level '{taken.film.fidelity}' in place of '{scene.film.fidelity}': a native FMU has no solver. Its "
        f"stated errors: {_stated_error(taken)}. --flavour isolated solves the contact."
    )


def _stated_error(scene: Scene) -> str:
    """Return the errors that a level states for the operating point of its scene, in words."""
    _, outputs = advance(scene, scene.operation.point, initial_state(scene), 0.0)
    friction, film = (f"{100.0 * error:.2g} %" for error in (outputs.error_friction, outputs.error_film))
    return (
        f"friction_coefficient +- {friction}, h_c +- {film}, contact_load_ratio +- "
        f"{outputs.error_load_ratio:.2g} (95 %, at the operating point of the scene)"
    )
