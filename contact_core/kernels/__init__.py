"""Numba and FFT: arrays in, arrays out. No laws, no units, no scene.

    half_space    deformation of an elastic half space by DC-FFT, and its approximate inverse
    dry           contact without a fluid
    reynolds      passes over the film: gap and mass, residual, fluid pressure under contacts, corrections
    mixed         the iteration that couples them
    anderson      acceleration of a fixed point

All kernels are serial, release the GIL, keep the order of summation and use no fast-math: the same input gives the
same bits.
"""
