"""Bodies at rest, which wear under the contact all the time: the pin on a disc.

Such a body conforms to the other one: within a small part of the time in which its scar grows, wear and pressure
balance on all waves up to the scar's length. Euler's steps would have to follow that; here a block takes the pressure
at its end, as backward Euler does. That is the dry contact of bodies whose nodes give way by their wear in the block,
besides the half space. In the mean over its passes the moving body is as smooth along x as its groove is, so nothing of
its roughness, of which a block samples a piece, is left in the body at rest. The volume stays that of the sampled load.
"""

import math
from dataclasses import replace

import numpy as np

from ..film import Deterministic
from ..kernels.arrays import Array
from ..scene import Case, Side
from ..state import Body, ContactState
from ..surfaces.patches import bare_heights, heights_of, on_grid, on_patches, patch_nodes
from .growth_and_wear import area_of_node, wear_speed, wear_volume_rate
from .instant import instant_of

_SCAR = 30e-9  # m: control.change over it is the part by which a scar may grow in a block


def scar_time(case: Case, side: Side, body: Body) -> float:
    """Return the time [s] in which the scar of a body at rest grows by the part that a block allows.

    Its volume counts together with that which Hertz's contact flattens. Infinite for moving bodies and without wear.
    """
    rate = 0.0 if side.moves or not case.loaded else wear_volume_rate(case, side, body)
    if rate <= 0.0:
        return math.inf
    flattened = case.hertz.area * 0.5 * case.hertz.a**2 / case.shape.radius_x
    worn = float(body.wear.sum()) * area_of_node(case, side)
    return case.scene.control.change / _SCAR * (flattened + worn) / rate


def conformed(case: Case, state: ContactState, bodies: tuple[Body, Body], fluid: Array) -> tuple[Body, Body]:
    """Return the bodies with, on those at rest, the pressure at the end of the block to come.

    `fluid` is the mean pressure [Pa] of the oil in the last block, on the grid.
    """
    scene = case.scene
    level = scene.film
    assert isinstance(level, Deterministic)
    time = min(scar_time(case, *pair) for pair in zip(case.sides, bodies, strict=True))
    if time == math.inf:
        return bodies
    time = min(time, scene.control.longest)
    heights, soft = np.zeros_like(fluid), np.zeros_like(fluid)
    load = 0.0
    for side, body, bare in zip(case.sides, bodies, bare_heights(scene, state.rows), strict=True):
        patch = heights_of(bare, body)
        if side.moves:
            heights += patch.mean(axis=1, keepdims=True)
            continue
        nodes = patch_nodes(scene, body, state.window)
        heights += on_grid(patch, nodes)
        unit = replace(body, pressure=np.ones_like(body.pressure))
        soft += time * on_grid(wear_speed(case, side, unit, body.tribofilm), nodes)
        load = float(body.pressure.sum()) * area_of_node(case, side)
    now = instant_of(case, heights, np.full_like(fluid, scene.plasticity.hardness))
    pressure = level.conformed(now, case.grid(state.rows), fluid, load, soft)
    first, second = (
        body if side.moves else replace(body, pressure=solid)
        for side, body, solid in zip(case.sides, bodies, on_patches(scene, state, (pressure, pressure)), strict=True)
    )
    return first, second
