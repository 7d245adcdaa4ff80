"""Numerics of the master, on arrays: they know no FMU.

    algorithms    which outputs of the running step are seen: Jacobi, Gauss-Seidel
    hold          inputs over a step as polynomials
    richardson    the error of a step from its halves
    control       error norm and step size
    iteration     fixed point, Aitken; the table of all methods
    quasi_newton  interface quasi-Newton of least squares; secant: the same of one value
    arrays        their types

Arrays are in the order of the wiring that the master has made.
"""
