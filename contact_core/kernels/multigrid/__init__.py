"""Smooth films by full multigrid (full approximation scheme).

    cycle        nested grid levels, cycles over them, the solution
    level        one grid level: fields and share of the problem
    blended      mobilities of corrections to a fitted flow
    relaxation   film, mass balance and line relaxation on a grid level
    coarsest     Newton's method for pressure and rigid gap together on the coarsest grid level
    transfer     restriction and interpolation between grid levels
    mirrored     the half space under a symmetric pressure

The cycle calls the levels, the levels call the rest.
"""
