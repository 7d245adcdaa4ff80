"""The kinds of FMU: "isolated" loads in any host, its model in a process of its own; "embedded" runs in its host."""

from typing import Literal, get_args

Flavour = Literal["isolated", "embedded"]
FLAVOURS: tuple[Flavour, ...] = get_args(Flavour)
