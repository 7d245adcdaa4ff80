"""The coupled systems of exact.py as systems of the master; columns of states in the order of their names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from system_models.master import System

from . import exact
from .build import build

Floats = NDArray[np.float64]


class Case(NamedTuple):
    """A system, the outputs that are its states, and their exact course."""

    system: System
    states: list[str]
    solution: Callable[[ArrayLike], Floats]  # [times, states]

    def history(self) -> dict[str, Callable[[float], float]]:
        """The exact course of every state, also before t = 0 where the solution has a meaning there."""
        return {name: _course(self.solution, n) for n, name in enumerate(self.states)}


def two_mass_force(folder: Path, second: dict[str, Any] | None = None, **variant: Any) -> Case:
    """Two-mass oscillator: the second mass owns the spring between them, and gives its force."""
    fmus = {
        "one": build("mass_1_force", folder, **variant),
        "two": build("mass_2_spring", folder, **(second or variant)),
    }
    wires = [("one.x", "two.x1"), ("one.v", "two.v1"), ("two.F", "one.F")]
    return Case(System(fmus, wires), ["one.x", "two.x", "one.v", "two.v"], exact.two_mass)


def two_mass_displacement(folder: Path, **variant: Any) -> Case:
    """Two-mass oscillator: both masses own the spring between them."""
    fmus = {
        "one": build("mass_1_displacement", folder, **variant),
        "two": build("mass_2_displacement", folder, **variant),
    }
    return Case(System(fmus, _crossed("one", "two")), ["one.x", "two.x", "one.v", "two.v"], exact.two_mass)


def spring_force(t: float) -> float:
    """Force of the spring between the two masses on the first one."""
    x1, x2, v1, v2 = exact.two_mass(t)[0]
    return float(10.0 * (x2 - x1) + 0.1 * (v2 - v1))


def quarter_car_force(folder: Path, **variant: Any) -> Case:
    """Quarter car on a step of the road: the chassis owns the suspension, and gives its force."""
    fmus = {"wheel": build("wheel_force", folder, **variant), "chassis": build("chassis_spring", folder, **variant)}
    wires = [("wheel.x", "chassis.x_wheel"), ("wheel.v", "chassis.v_wheel"), ("chassis.F", "wheel.F")]
    return Case(System(fmus, wires), ["wheel.x", "chassis.x", "wheel.v", "chassis.v"], exact.quarter_car)


def quarter_car_displacement(folder: Path, **variant: Any) -> Case:
    """Quarter car on a step of the road: both bodies own the suspension."""
    models = {"wheel": "wheel_displacement", "chassis": "chassis_displacement"}
    fmus = {name: build(model, folder, **variant) for name, model in models.items()}
    states = ["wheel.x", "chassis.x", "wheel.v", "chassis.v"]
    return Case(System(fmus, _crossed("wheel", "chassis")), states, exact.quarter_car)


def stick_slip(folder: Path, **variant: Any) -> Case:
    """Block on a moving belt, and the friction between them."""
    fmus = {"block": build("block", folder, **variant), "friction": build("friction", folder, **variant)}
    wires = [("block.u", "friction.u"), ("friction.F", "block.F")]
    return Case(System(fmus, wires), ["block.x", "block.v"], exact.stick_slip)


def stiff_contact(folder: Path, **variant: Any) -> Case:
    """A mass of one gram that 300 N press into a contact."""
    fmus = {"contact": build("contact_point", folder, **variant), "mass": build("point_mass", folder, **variant)}
    wires = [("mass.x", "contact.x"), ("mass.v", "contact.v"), ("contact.F", "mass.F")]
    return Case(System(fmus, wires), ["mass.x", "mass.v"], exact.stiff_contact)


def _crossed(one: str, two: str) -> list[tuple[str, str]]:
    return [(f"{a}.{name}", f"{b}.{name}_other") for a, b in ((one, two), (two, one)) for name in ("x", "v")]


def _course(solution: Callable[[ArrayLike], Floats], column: int) -> Callable[[float], float]:
    return lambda t: float(solution(t)[0, column])
