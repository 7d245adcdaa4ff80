"""Asperities shorter than the grid: the pressure that they carry at a gap, and the gap at which they carry a pressure.

    s(h) = stress exp(-(h - floor) / depth) for floor < h < floor + reach,   reach = REACH depth

The total pressure is p = f + s(h). depth = 0: there are none, and solids touch at the floor. Units of `problem`.
"""

import numpy as np

from ..compiled import jit

REACH = 14.0  # depths above the floor at which the asperities end
# limits above which asperities decide the pressure of a node, and those down to which they go on deciding it: rise of
# their pressure per gap over that of a half space; mobility of a face next to the node over that of the stiff zone;
# their share of the pressure
_STIFFER, _STILL_STIFFER = 0.2, 0.1
_FREE, _STILL_FREE = 0.1, 0.03
_MOST, _STILL_MOST = 0.5, 0.25
_PART = 0.15  # of the missing pressure that an iteration adds: neighbours that rise too part the bodies further


@jit
def carried_at(h, floor, stress, depth):  # type: ignore[no-untyped-def]
    """Return the pressure that asperities carry at a gap."""
    if depth <= 0.0 or h >= floor + REACH * depth:
        return 0.0
    return stress * np.exp(-max(h - floor, 0.0) / depth)


@jit
def rest_gap(q, floor, stress, depth):  # type: ignore[no-untyped-def]
    """Return the gap at which asperities carry a pressure: the floor from `stress` on."""
    if depth <= 0.0 or q >= stress:
        return floor
    if q <= stress * np.exp(-REACH):
        return floor + REACH * depth
    return floor + depth * np.log(stress / q)


@jit
def missing(p, carried, solid):  # type: ignore[no-untyped-def]
    """Return by how much an iteration corrects a pressure that is below that of the asperities, at most 0.

    It is a part of the difference, and 0 where solids touch. The fluid pressure of such a node is zero, and stays so
    until the pressure has risen to that of the asperities.
    """
    return 0.0 if solid else _PART * min(p - carried, 0.0)


@jit
def share_out(  # type: ignore[no-untyped-def]
    p, pressing, solid, ex, ey, depth, softness, patch, limit, ruled, over_oil, lack
):
    """Update the nodes that asperities rule; compute how the fluid pressure rises with p, and `missing`, [ny, nx].

    Asperities rule a node where they carry most and are stiff against the half space, and oil flows freely: there a
    small error of the gap is a large one of the fluid pressure p - s(h). As on solid contacts, the flow gives the fluid
    pressure, p - f the gap. pressing: what asperities carry at the gap. softness: opening of a gap by a unit pressure
    on it; patch: by that on its eight neighbours, too; limit: mobility of the stiff zone. over_oil: d(p - s)/dp of a
    node.
    """
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx):
            carried = pressing[j, i]
            rise = carried / depth
            over_oil[j, i] = 1.0 + rise * softness
            lack[j, i] = missing(p[j, i], carried, solid[j, i])
            if carried <= 0.0 or i == 0 or j == 0 or i == nx - 1 or j == ny - 1:
                ruled[j, i] = False
                continue
            stiffness, share = rise * patch, carried / max(p[j, i], 1e-300)
            mobility = max(max(ex[j, i - 1], ex[j, i]), max(ey[j - 1, i], ey[j, i])) / limit
            if ruled[j, i]:
                ruled[j, i] = stiffness > _STILL_STIFFER and mobility > _STILL_FREE and share > _STILL_MOST
            else:
                ruled[j, i] = stiffness > _STIFFER and mobility > _FREE and share > _MOST


@jit
def sort_nodes(p, f, r, h, solid, floor, stress, depth, held, rest, give, gain, lack):  # type: ignore[no-untyped-def]
    """Compute the nodes that asperities or solids hold, and how asperities change with pressure and gap, [ny, nx].

    held: solid contacts, and nodes without fluid pressure that lose mass: p = s(h). There rest: the gap at which they
    rest, and give: its fall with p. Elsewhere gain: the rise of f with the gap, and lack: what p is short of s(h), < 0.
    """
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx):
            here, own = p[j, i], h[j, i]
            held[j, i], rest[j, i], give[j, i], gain[j, i], lack[j, i] = solid[j, i], floor, 0.0, 0.0, 0.0
            carried = carried_at(own, floor, stress, depth)
            if solid[j, i] or carried <= 0.0:
                continue
            if f[j, i] <= 0.0 and r[j, i] <= 0.0:
                held[j, i] = True
                rest[j, i] = rest_gap(here, floor, stress, depth)
                if here < stress:
                    give[j, i] = depth / max(here, stress * np.exp(-REACH))
                continue
            lack[j, i] = min(here - carried, 0.0)
            if own > floor:
                gain[j, i] = carried / depth
