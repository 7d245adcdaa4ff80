"""On which connections the options of accuracy act: else it is refused; what it misses is named."""

import logging
from collections.abc import Callable, Iterator
from typing import NamedTuple

from ..fmu.errors import CouplingError
from .settings import Settings
from .system import Connection, System

log = logging.getLogger(__name__)

_NAMED = 3  # connections that are named in full


class _Option(NamedTuple):
    """An option as given, the connections that it acts on, and advice for the others."""

    given: str
    does: str
    acts: Callable[[Connection], bool]
    way_out: str


def check(settings: Settings, system: System) -> None:
    """Warn of connections that an option does not act on. Raises CouplingError if it acts on none."""
    for option in _given(settings, system):
        missed = [connection for connection in system.connections if not option.acts(connection)]
        if len(missed) == len(system.connections):
            raise CouplingError(f"{option.given} {option.does}, of which this system has none. Leave it out.")
        if missed:
            names = [f"'{c.source.name}' to '{c.target.name}'" for c in missed[:_NAMED]]
            more = f" and {len(missed) - _NAMED} more" if len(missed) > _NAMED else ""
            log.warning(
                "%s %s, not of the connections %s%s. %s",
                option.given,
                option.does,
                ", ".join(names),
                more,
                option.way_out,
            )


def _given(settings: Settings, system: System) -> Iterator[_Option]:
    if settings.tolerance is not None:
        yield _Option(
            f"tolerance = {settings.tolerance:g}",
            "bounds the errors of Real outputs that set inputs",
            lambda connection: connection.source.kind == "real" or connection.source in system.events,
            "Name their outputs in `events`, so that no step goes beyond a change.",
        )
    if settings.iterate is not None:
        yield _Option(
            f"iterate = '{settings.iterate}'",
            "finds the values of Real inputs that are set in every step",
            lambda connection: connection.coupled,
            "These are set after a step, when their values have changed: keep steps short.",
        )
    if settings.order:
        yield _Option(
            f"order = {settings.order}",
            "extrapolates the values of continuous Real inputs",
            lambda connection: connection.coupled and not connection.sampled,
            "These hold their values over a step: keep steps short.",
        )
