"""Case A on a grid that costs next to nothing."""

from functools import cache

from contact_core import Scene, advance, initial_state

CHEAP = {
    "film.points": "33",
    "surface_1.correlation_length": "16 um",
    "surface_2.correlation_length": "16 um",
    "film.tolerance": "1e-2",
    "film.iterations": "60",
}


def cheap(changes=CHEAP, **more):
    scene = Scene.from_toml(
        "azam_case_a", changes | {key.replace("__", "."): str(value) for key, value in more.items()}
    )
    return scene, initial_state(scene), scene.operation.point


@cache
def settled(**more):
    """The same with its first block solved, which is most of a short run: the march until the film is settled."""
    scene, state, op = cheap(**more)
    return scene, advance(scene, op, state, 0.0)[0], op
