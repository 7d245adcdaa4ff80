"""Friction of one instant: local shear of solids and oil, what it adds up to, and its derivatives at a held film.

Body 1 slides over body 2 at (u_s - spin y, spin x). Every shear stress points that way on body 2.
"""

from dataclasses import dataclass

import numpy as np

from ..film.instant import Grid
from ..kernels.arrays import Array
from ..scene import Case, OperatingPoint

_STEP = 1e-5  # relative, of the differences that give a viscosity's slopes


@dataclass(frozen=True)
class Film:
    """The film of an instant as friction needs it. Arrays [ny, nx]."""

    grid: Grid
    fluid: Array  # pressure [Pa]
    solid: Array  # pressure [Pa]
    gap: Array  # [m]
    cover: Array  # mean tribofilm of both bodies / full thickness
    temperature: Array | float  # of the oil, mean across the film [K]
    oxide: Array | None = None  # what oxide adds to the coefficient of boundary friction; None: nothing


@dataclass(frozen=True)
class Shear:
    """Shear stresses on body 2 in the direction of the local sliding [Pa], [ny, nx], and that direction."""

    fluid: Array
    solid: Array
    speed: Array | float  # local sliding speed [m/s]
    along_x: Array | float  # direction of sliding
    along_y: Array | float

    @property
    def total(self) -> Array:
        """Both stresses together; never negative."""
        both: Array = self.fluid + self.solid
        return both

    @property
    def dissipation(self) -> Array:
        """Frictional power [W/m2]."""
        power: Array = self.total * self.speed
        return power


@dataclass(frozen=True)
class Friction:
    """Integrals over the contact."""

    force_solid: float  # on body 1 along +x [N]
    force_fluid: float
    spin_torque: float  # on body 1 about the axis from x to y [N m]
    power: float  # [W]
    slide: float  # sliding speed, mean weighted by the shear stress [m/s]


def sliding(op: OperatingPoint, grid: Grid) -> tuple[Array | float, Array | float, Array | float]:
    """Return the local speed [m/s] and direction at which body 1 slides over body 2; numbers if there is no spin."""
    if op.spin == 0.0:
        return abs(op.sliding_speed), float(np.sign(op.sliding_speed)), 0.0
    x, y = np.broadcast_arrays(op.sliding_speed - op.spin * grid.y[:, None], op.spin * grid.x[None, :])
    speed = np.hypot(x, y)
    moving = np.maximum(speed, 1e-300)
    return speed, np.where(speed > 0.0, x / moving, 1.0), y / moving


def shear(case: Case, film: Film) -> Shear:
    """Return the local shear stresses: the oil's by its rheology, the solids' by the law of boundary friction."""
    oil, boundary = case.scene.lubricant, case.scene.boundary_friction
    speed, along_x, along_y = sliding(case.op, film.grid)
    solid = _rubbing(case, film, speed)
    newtonian = _viscosity(case, film, film.fluid, film.temperature) * speed / film.gap
    limiting = film.fluid * boundary.grip(speed) * oil.rheology.limiting_left(film.temperature)
    fluid = oil.rheology(newtonian, limiting)
    return Shear(fluid, solid, speed, along_x, along_y)


def _viscosity(case: Case, film: Film, pressure: Array, temperature: Array | float) -> Array:
    """Return the viscosity [Pa s] of the oil in a film, which double layers on its surfaces may raise."""
    oil = case.scene.lubricant
    viscosity: Array = oil.viscosity(pressure, temperature)
    return viscosity * oil.double_layer(film.gap, case.op.inlet_temperature) if oil.double_layer.acts else viscosity


def _rubbing(case: Case, film: Film, speed: Array | float) -> Array:
    """Return the shear stress of the solids [Pa]."""
    boundary = case.scene.boundary_friction
    stress: Array = boundary(film.solid, film.cover, speed)
    return stress if film.oxide is None else stress + film.oxide * film.solid * boundary.grip(speed)


def _rubbing_slope(case: Case, film: Film, speed: Array | float) -> Array:
    """Return its derivative by the sliding speed [Pa s/m]."""
    boundary = case.scene.boundary_friction
    slope: Array = boundary.slope(film.solid, film.cover, speed)
    return slope if film.oxide is None else slope + film.oxide * film.solid * boundary.grip_slope(speed)


def friction(stress: Shear, grid: Grid) -> Friction:
    """Return the integrals of the stresses over the contact."""
    cell, total = grid.cell, stress.total
    lever = grid.x[None, :] * stress.along_y - grid.y[:, None] * stress.along_x if np.ndim(stress.speed) else 0.0
    power, pull = float((total * stress.speed).sum()), float(total.sum())
    return Friction(
        force_solid=-float((stress.solid * stress.along_x).sum()) * cell,
        force_fluid=-float((stress.fluid * stress.along_x).sum()) * cell,
        spin_torque=-float((total * lever).sum()) * cell,
        power=power * cell,
        slide=power / pull if pull > 0.0 else 0.0,
    )


def derivatives(case: Case, film: Film) -> dict[str, float]:
    """Return the derivatives of the friction force on body 1 by the operating point, at a held film.

    Gap, shares of solids and oil and the field of temperature are held, all pressures are in proportion to the load,
    and the oil is as much warmer as the input.
    """
    oil, boundary, grid = case.scene.lubricant, case.scene.boundary_friction, film.grid
    speed, along_x, along_y = sliding(case.op, grid)
    speed = np.maximum(speed, _STEP * boundary.slip_speed)  # at rest the slope is that of the limit
    viscosity = _viscosity(case, film, film.fluid, film.temperature)
    newtonian = viscosity * speed / film.gap
    left = oil.rheology.limiting_left(film.temperature)
    limiting = film.fluid * boundary.grip(speed) * left
    by_newtonian, by_pressure = oil.rheology.slopes(newtonian, limiting)
    more, less = (_viscosity(case, film, film.fluid * (1.0 + sign * _STEP), film.temperature) for sign in (1.0, -1.0))
    stiffening = (more - less) / (2.0 * _STEP)  # d viscosity / d ln p
    step = _STEP * float(np.mean(film.temperature))
    warmer, colder = (_viscosity(case, film, film.fluid, film.temperature + sign * step) for sign in (1.0, -1.0))
    solid, solid_by_speed = _rubbing(case, film, speed), _rubbing_slope(case, film, speed)
    cell = grid.cell

    def force(stress: Array) -> float:
        return -float((stress * along_x).sum()) * cell

    by_grip = by_pressure * film.fluid * left
    by_speed = by_newtonian * viscosity / film.gap + by_grip * boundary.grip_slope(speed) + solid_by_speed
    if np.ndim(speed):  # along the sliding the law decides, across it the direction
        across = (oil.rheology(newtonian, limiting) + solid) / np.maximum(speed, 1e-300)
        by_speed = by_speed * np.square(along_x) + across * np.square(along_y)
    sliding_slope = -float(by_speed.sum()) * cell
    by_load = by_newtonian * stiffening * speed / film.gap + by_pressure * limiting + solid
    by_temperature = by_newtonian * (warmer - colder) / (2.0 * step) * speed / film.gap
    by_temperature -= by_pressure * limiting * oil.rheology.limiting_fall
    return {
        "dfriction_dspeed_1": sliding_slope,
        "dfriction_dspeed_2": -sliding_slope,
        "dfriction_dload": force(by_load) / case.op.load if case.loaded else 0.0,
        "dfriction_dtemperature": force(by_temperature),
    }
