"""Flavours of an FMU, and the versions of FMI in which each is built.

"isolated": the model in Python, in a process of its own, for any host; "embedded": in a host that is Python; "native":
C, generated for one scene at a level that needs no solver, without Python.
"""

from typing import Literal, get_args

Flavour = Literal["isolated", "embedded", "native"]
Version = Literal[2, 3]

FLAVOURS: tuple[Flavour, ...] = get_args(Flavour)
WITH_PYTHON: tuple[Flavour, ...] = ("isolated", "embedded")
VERSIONS: dict[Flavour, tuple[Version, ...]] = {"isolated": (2, 3), "embedded": (2,), "native": (2, 3)}
