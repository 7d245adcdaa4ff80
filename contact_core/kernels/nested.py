"""The same problem on a grid of half the nodes, and a film found there to begin with."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from . import grids
from .half_space import HalfSpace
from .mixed import Iterate, Problem
from .steady import shared_start, solve_steady

Array = NDArray[np.float64]

_COARSE_ITERATIONS = 54


def coarsen(problem: Problem) -> Problem:
    """The problem on every other node of an odd number, on the means of pairs of an even one.

    Its units are the same; its half space has twice the scale, since that goes with the spacing. The load, a sum over
    nodes, is a quarter. An edge pressure that falls by a factor in one spacing falls by its square in two, and what
    lies beyond the edge counts half as many nodes per edge node.
    """
    return replace(
        problem,
        undeformed=grids.restrict(problem.undeformed),
        cap=grids.restrict(problem.cap),
        spacing=2.0 * problem.spacing,
        load=0.25 * problem.load,
        mass_old=grids.restrict(problem.mass_old),
        edge=_edge_of(problem.edge) ** 2,
        weight=1.0 + 0.5 * _edge_of(problem.weight - 1.0),
    )


def _edge_of(field: Array) -> Array:
    """A field that lives on the edge nodes alone, on those of the coarser grid."""
    coarse = np.zeros_like(grids.restrict(field))
    coarse[:, 0], coarse[:, -1] = grids.restrict(field[:, 0]), grids.restrict(field[:, -1])
    coarse[0, :], coarse[-1, :] = grids.restrict(field[0]), grids.restrict(field[-1])
    return coarse


def prolong(iterate: Iterate, shape: tuple[int, int]) -> Iterate:
    """An iterate of the coarser grid on one of `shape` [ny, nx]: linear in between, contacts where most of it is."""
    pressure = grids.prolong(iterate.pressure, shape)
    fluid = np.minimum(grids.prolong(iterate.fluid, shape), pressure)
    solid = grids.prolong(iterate.solid.astype(np.float64), shape) > 0.5
    return Iterate(pressure, fluid, solid, iterate.rigid)


def nested_start(half_space: HalfSpace, problem: Problem, smooth: Array) -> Iterate:
    """A steady film of the coarser grid. smooth [ny, nx]: pressure of smooth bodies, of any size."""
    coarse = coarsen(problem)
    start = shared_start(half_space.coarser, coarse, grids.restrict(smooth))
    found = solve_steady(half_space.coarser, coarse, start, 0.0, _COARSE_ITERATIONS)
    return prolong(found.iterate, problem.cap.shape)


def lost(heights: Array) -> float:
    """Share of the rms of rough heights [ny, nx] that the coarser grid does not see.

    Above 0.05 (less than six nodes in a correlation length) its film is another one, and `steady.shared_start` is the
    better start.
    """
    seen = grids.prolong(grids.restrict(heights), heights.shape)
    return float((heights - seen).std()) / max(float(heights.std()), 1e-300)
