"""One call each, without a scene.

    point_contact   the film of a circular or elliptical contact
    line_contact    the film of a line contact
    dry_contact     rough bodies without a film
    subsurface_stress  stress below one's own pressure and shear
    options         what films of a point and a line take beside the contact: names, choices, defaults
    common          what the calls of a film share
    inlet           what a domain that ends within the inlet takes from the film
    refinement      grids from coarse to fine, and the surface that all of them sample

Each call takes SI numbers and returns a record with the convergence of its solution.
"""
