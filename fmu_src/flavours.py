"""Flavours of an FMU: "isolated", the model in a process of its own, for any host; "embedded", in a host in Python."""

from typing import Literal, get_args

Flavour = Literal["isolated", "embedded"]
FLAVOURS: tuple[Flavour, ...] = get_args(Flavour)
