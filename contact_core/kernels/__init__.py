"""Compiled loops and FFT: arrays in, arrays out. No laws, no units, no scene.

    half_space      deformation of an elastic half space by DC-FFT, free or periodic along y, and its inverse
    dry             contact without a fluid: coarse grids and windows
    dry_asperities  the same with asperities that are too short for the grid
    dry_giving      the same on surfaces that give way node by node
    dry_faces       conjugate gradients in one window
    surface_give    by how much nodes give way under their own pressure
    giving_half_space  a half space under such a surface
    mixed/          fluid and solids together, on rough bodies
    multigrid/      smooth films
    far_field       pressure and load beyond the edge of the grid
    thinning        flow of an oil that thins under shear
    subsurface      stress below a surface under pressure and shear, free or periodic along y
    stress_measures  von Mises, principal stresses, largest shear, mean of stress tensors
    moving_source   temperature of surfaces that move through heat
    load_cycle      stresses of a load cycle at material points
    smallest_sphere  the sphere around the deviators of a cycle
    damage          damage in layers below a surface that is worn, and what breaks out
    moving_layers   what material carries through such layers
    anderson        acceleration of a fixed point
    grids           between a grid and that of half its nodes
    convergence     the record of how a solution went
    arrays          types of arrays, for all rooms
    compiled        the decorator of all compiled kernels
    cache           folder of compiled kernels

All kernels are serial, release the GIL, keep the order of summation and use no fast-math: the same input gives the
same bits.
"""

from .cache import NOTICE as NOTICE  # before any kernel is read
