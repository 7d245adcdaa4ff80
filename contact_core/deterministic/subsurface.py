"""Stresses below the surfaces, by some instants of a pass, and the load cycles that they make.

The tractions of some instants stand for one pass of a surface point, in which both bodies move as they do: in near
rolling a point meets one and the same asperity. The first block of an operating point is a whole pass; others are
pieces of one, and count once it is over. Each point of a patch has its own history, the unloaded state included.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..film import Deterministic
from ..film.shared import subsurface
from ..kernels.arrays import Array
from ..kernels.load_cycle import Cycle, cycle_of
from ..kernels.stress_measures import von_mises
from ..laws.stress import OF_STRESS, ratios, risk, share_down_to
from ..scene import Case, Scene
from ..scene.records import POISSON
from ..state import ContactState
from ..surfaces.patches import patch_nodes, track_rows
from .instant import ContactFields

Places = tuple[int, int]


class Traction(NamedTuple):
    """What presses and shears the surfaces in one instant. Arrays [ny, nx] on the grid of the contact."""

    pressure: Array  # [Pa]
    shear: Array  # on body 2 along +x [Pa]
    places: Places  # of the patches of both bodies along +x [nodes]


class Pass(NamedTuple):
    """What a pass does below the surfaces. Pairs are of body 1 and 2."""

    cycles: tuple[Cycle, Cycle]  # arrays [layers, rows, nx - 1]
    halved: tuple[Cycle, Cycle]  # by every other instant alone
    von_mises: Array  # largest of each layer, mean over the instants [Pa], [layers]
    scatter: float  # of the largest, mean over the instants: standard deviation over it


def traction_of(scene: Scene, state: ContactState, fields: ContactFields) -> Traction:
    """Return the tractions of an instant."""
    first, second = (patch_nodes(scene, body, state.window) for body in state.bodies)
    shear = fields.fluid_shear + fields.solid_shear
    return Traction(fields.pressure, shear, (first, second))


def pass_goes_on(case: Case, state: ContactState, same: bool) -> bool:
    """Return True if the next block continues a pass; `same`: the operating point has not changed since the last."""
    return same and state.below is not None and 0 < len(state.below.places) < case.scene.stress.instants


def begins_anew(case: Case, state: ContactState, same: bool) -> bool:
    """Return True if stresses are asked for and no pass of the operating point is known."""
    return case.scene.stress.samples and not (same and state.below is not None and len(state.below.places) > 0)


def steps_of_a_pass(case: Case) -> list[float]:
    """Return how far [m] both bodies move along +x from instant to instant of a pass of the faster one."""
    step = case.scene.film.domain / case.scene.stress.instants
    return [step * speed / case.fastest if case.fastest > 0.0 else 0.0 for speed in case.speeds]


def is_whole(case: Case, tractions: Sequence[Traction]) -> bool:
    """Return True if a pass is over."""
    return len(tractions) >= case.scene.stress.instants


def of_a_pass(case: Case, state: ContactState, found: Sequence[Traction], same: bool) -> list[Traction]:
    """Return the tractions of the pass in progress, the oldest first; `found` are those of the last block.

    Of instants that lie closer together than those of a pass only some count.
    """
    tractions = list(_kept(state)) if pass_goes_on(case, state, same) else []
    columns, fast = case.scene.film.points - 1, int(abs(case.op.speed_2) > abs(case.op.speed_1))
    apart, ahead = columns // case.scene.stress.instants, 1 if case.speeds[fast] > 0.0 else -1
    for traction in found:
        moved = (traction.places[fast] - tractions[-1].places[fast]) * ahead % columns if tractions else columns
        if moved >= apart or case.fastest == 0.0:
            tractions.append(traction)
    return tractions[: case.scene.stress.instants]


def _kept(state: ContactState) -> Iterator[Traction]:
    if state.below is None:
        return
    for k, (first, second) in enumerate(state.below.places):
        rows = slice(k * state.rows, (k + 1) * state.rows)
        yield Traction(state.below.pressure[rows], state.below.shear[rows], (int(first), int(second)))


def passed(case: Case, rows: int, tractions: Sequence[Traction]) -> Pass:
    """Return the load cycles of both bodies under the tractions of a pass."""
    scene, law = case.scene, case.scene.stress
    assert isinstance(scene.film, Deterministic)
    grid, depths = scene.grid(rows), tuple(scene.depths.tolist())
    kernel = subsurface(grid.shape, grid.spacing, depths, POISSON, scene.film.fft, periodic=grid.periodic)
    unloaded = law.residual_stress()
    largest = np.empty((2, len(tractions), len(depths)))
    cycles: list[Cycle] = []
    halved: list[Cycle] = []
    for side in case.sides:
        sign = 1.0 if side.body else -1.0
        stresses = [kernel.layers(traction.pressure, sign * traction.shear) for traction in tractions]
        layers: list[tuple[Cycle, Cycle]] = []
        for k, fields in enumerate(zip(*stresses, strict=True)):
            loaded = [field + unloaded[:, None, None] for field in fields]
            largest[side.body, :, k] = [von_mises(field).max() for field in loaded]
            places = [traction.places[side.body] for traction in tractions]
            seen = np.stack([_on_patch(*pair) for pair in zip(loaded, places, strict=True)])
            whole, half = (cycle_of(part, unloaded, law.dang_van_slope) for part in (seen, seen[::2]))
            layers.append((whole, half))
        for kept, found in zip((cycles, halved), zip(*layers, strict=True), strict=True):
            kept.append(Cycle(*(np.stack(parts) for parts in zip(*found, strict=True))))
    worse = largest.max(axis=0)
    peaks = worse.max(axis=1)
    scatter = float(peaks.std() / (peaks.mean() * len(peaks) ** 0.5)) if peaks.any() else 0.0
    return Pass((cycles[0], cycles[1]), (halved[0], halved[1]), worse.mean(axis=0), scatter)


def _on_patch(field: Array, place: int) -> Array:
    return np.roll(field[..., :-1], -place, axis=-1)


def outputs_of_stress(case: Case, rows: int, found: Pass) -> dict[str, float]:
    """Return `OF_STRESS` of a pass."""
    scene, law = case.scene, case.scene.stress
    depths, track = scene.depths, track_rows(scene, rows)
    deepest = int(found.von_mises.argmax())
    tracks = [Cycle(*(part[:, track] for part in cycle)) for cycle in found.cycles]
    risks = np.sum([risk(cycle.shear).mean(axis=(1, 2)) for cycle in tracks], axis=0)
    dang_van, crossland = np.max([ratios(law, cycle) for cycle in tracks], axis=0).tolist()
    values = (
        float(found.von_mises[deepest]),
        float(depths[deepest]),
        share_down_to(law.near_surface * case.hertz.a, risks, depths),
        dang_van,
        crossland,
    )
    return dict(zip(OF_STRESS, values, strict=True))
