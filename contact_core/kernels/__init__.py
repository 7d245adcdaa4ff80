"""Numba and FFT: arrays in, arrays out. No laws, no units, no scene.

    half_space    deformation of an elastic half space by DC-FFT, free or periodic along y, and its approximate inverse
    dry           contact without a fluid
    mixed         fluid and solids together: the fixed point, its problem, its stopping rule
    reynolds      passes over the film: gap and mass, residual, fluid pressure under contacts, corrections
    anderson      acceleration of a fixed point
    direct        as mixed, with the fluid, the rigid gap and the load solved at once
    newton        light loads and smooth lines: Newton's method with the whole half space
    band          its local inverse on the single row of a smooth line
    multigrid     smooth films: full approximation scheme (level, relaxation, transfer, coarsest, mirrored)
    far_field     what lies beyond the edge of the grid
    grids         between a grid and that of half its nodes
    cache         where compiled kernels are kept

All kernels are serial, release the GIL, keep the order of summation and use no fast-math: the same input gives the
same bits.
"""

from .cache import NOTICE as NOTICE  # before any kernel is read
