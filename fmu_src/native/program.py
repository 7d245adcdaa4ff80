"""contact.c and contact.h: the regression level of one scene in C99, written from its Python."""

import dataclasses
from typing import Any

from contact_core.errors import OperatingPointError
from contact_core.regression import evolution
from contact_core.regression.contact import evaluate
from contact_core.regression.surfaces import tribofilms_of
from contact_core.scene import Case, OperatingPoint, Scene
from contact_core.scene.case import _with_bulk_temperatures
from contact_core.state import ContactState, Outputs

from .translate import Num, Translator


def _case(scene: Scene, point: OperatingPoint, state: ContactState) -> Case:
    """Return the scene at an operating point, with what every part of a step asks for."""
    case = Case(scene, _with_bulk_temperatures(scene, point, state.temperatures))
    return case


def step(
    scene: Scene, point: OperatingPoint, state: ContactState, dt: float
) -> tuple[ContactState, Outputs]:
    """Return the state and the outputs after a step of `dt` [s]."""
    case = _case(scene, point, state)
    case.unit_hertz  # noqa: B018
    case.sides  # noqa: B018
    return evolution.advance(case, state, dt)
