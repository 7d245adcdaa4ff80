"""Fluid and solid pressure together, from full film to dry contact, on one grid.

    problem         one instant in the units of the kernels; iterate and solution of it
    stopping_rule   when a solution counts as converged
    fixed_point     the iteration for rough contacts
    marched         steady film at the end of a march in time by that iteration
    held            that iteration in small steps, for films near the floor that do not settle otherwise
    pockets         oil in pockets that contacts all but close off, for `held`
    newton          Newton's method with the whole half space, for light loads and smooth lines
    reynolds        Reynolds' equation: gap and mass, residual, fluid pressure under contacts, imbalance
    corrections     corrections of `fixed_point`: of the gap in the stiff zone, of the pressure by lines elsewhere
    flow            flow of oil through the faces between nodes
    asperities      pressure that asperities below the grid carry at a gap
    cavities        oil in cavities
    edge            the edge of the grid, and images of periodic rows
    linearisation   derivatives of a film on a stencil, for the preconditioner of `newton`
    band            local inverse on the single row of a smooth line, for `newton`
    linear_solver   GMRES and the order of elimination, for `newton`
    advection       prediction after the surfaces have moved

Imports run one way: problem, asperities, edge <- flow <- stopping_rule, reynolds, cavities <- corrections <-
fixed_point <- held (with pockets), marched; newton stands beside fixed_point.
"""
