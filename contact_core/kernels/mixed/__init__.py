"""Fluid and solid pressure together, from full film to dry contact, on one grid.

    problem         one instant in the units of the kernels; iterate and solution of it
    stopping_rule   when a solution counts as converged
    fixed_point     the iteration for rough contacts
    direct          the same with the fluid, the rigid gap and the load solved at once
    newton          Newton's method with the whole half space, for light loads and smooth lines
    reynolds        Reynolds' equation: gap and mass, residual, fluid pressure under contacts, imbalance
    corrections     corrections of `fixed_point`: of the gap in the stiff zone, of the pressure by lines elsewhere
    cavities        oil in cavities
    edge            the edge of the grid, and images of periodic rows
    linearisation   derivatives of a full film, for `newton`
    streaming       derivatives of a film with cavities, for `newton`
    band            local inverse on the single row of a smooth line, for `newton`
    linear_solver   GMRES and the order of elimination, for `newton`
    advection       prediction after the surfaces have moved

Imports run one way: problem <- stopping_rule, edge <- cavities <- reynolds <- corrections <- fixed_point <- direct;
newton stands beside fixed_point.
"""
