"""Fluid and solid pressure of one instant: what to solve, by which algorithm, and how well it converged.

    deterministic   the record of the deterministic level in a scene
    regression      the record of the regression level in a scene
    instant         grid, instant and solution, in SI
    scaled          an instant in the dimensionless units of the kernels
    starts          starts of the iterations
    solutions       what was found, in SI, and the load that it carries
    lengths         size of the loaded zone and of the inlet
    shared          half spaces and tables of oils that many instants share
    solids          solids that carry a load in dry contact
    routes          table of algorithms, and its execution
    thinning        flow of an oil that shear thins or heat warms
    outputs         outputs of a film from its fields
    fitted          grids that fit a film
    slow_film       film that stands still under a march whose nodes move with the oil
    estimate        error estimate from coarser grids
    refined         grids from coarse to fine, until an accuracy is met
    grid_steps      record of a grid that is solved on the way to an accuracy
    grid_error      errors of moving rough contacts by the distance of the nodes
    inlet_loss      film that is missing where the domain ends within the inlet

`FILMS` are the records that `scene.film` may be.
"""

from ..kernels.convergence import Convergence
from .deterministic import Deterministic
from .regression import Regression

FILMS: tuple[type[Deterministic] | type[Regression], ...] = (Deterministic, Regression)

__all__ = ["FILMS", "Convergence", "Deterministic", "Regression"]
