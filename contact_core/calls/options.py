"""What `point_contact` and `line_contact` take beside the contact itself: names, choices, defaults."""

import inspect
from collections.abc import Callable, Mapping
from typing import Any, Literal, TypedDict, TypeVar, get_args, get_origin

from numpy.typing import ArrayLike

from ..errors import OperatingPointError, did_you_mean

Call = TypeVar("Call", bound=Callable[..., Any])


class ContactOptions(TypedDict, total=False):
    """Options of `point_contact` and `line_contact`, each by keyword.

    heights_1, heights_2
        Heights [ny, nx] of each body [m], positive toward the other one, centred on the contact. Of a line without
        ends their first row follows their last: an even number of rows, or one.
    spacing
        Distance between the nodes of the heights [m].
    hardness
        Largest pressure [Pa]; None: no limit.
    floor
        Gap at which solids touch [m]; 1e-9 if not given.
    supply
        Oil on both surfaces together before the contact [m]; None: flooded.
    meniscus
        Distance [m] before the centre at which the inlet begins to fill; None: at the edge of the grid.
    grid
        Nodes along x of smooth bodies, or (ny, nx). A point has as many along y as the film needs (the same for a
        circle), and 129 along the shorter side if not given. A line has 257 along x, and rows only if it has ends.
    accuracy
        Largest error of h_central, h_c and pressure_max, relative, and of contact_load_ratio and contact_area_ratio,
        absolute, instead of `grid` and `tolerance`: grids are refined until the stated errors (`error_estimate`) are
        within it; `steps` tells which. They have from 33 to 513 nodes along the shorter side; smooth lines without ends
        from 65 to 4097 along x, rough ones up to 1025. Heights then define a surface, by a cubic spline between their
        nodes, and all grids, coarser and finer ones, sample it over the same extent; rows that repeat keep their
        period. The fields of the result lie on the last grid (`x`, `y`), at least as fine as the heights. `warnings`
        tells where the accuracy is not reached.
    tolerance
        Relative pressure change of a converged solution; 1e-3 if not given.
    iterations
        Largest number of iterations; 2000 if not given.
    viscosity_law
        "roelands" or "barus".
    density_law
        "dowson_higginson" or "none".
    cavitation
        "reynolds": a gap without pressure counts as full; "mass_conserving": it holds what flows in.
    flux
        Flow between nodes: "fitted", exact for a constant flow in each cell, or "upwind", of second order.
    fft
        "pyfftw" or "scipy"; FFTW is under the GPL.

    The first of the choices is the one if none is given.
    """

    heights_1: ArrayLike | None
    heights_2: ArrayLike | None
    spacing: float | None
    hardness: float | None
    floor: float
    supply: float | None
    meniscus: float | None
    grid: int | tuple[int, int] | None
    accuracy: float | None
    tolerance: float | None
    iterations: int
    viscosity_law: Literal["roelands", "barus"]
    density_law: Literal["dowson_higginson", "none"]
    cavitation: Literal["reynolds", "mass_conserving"]
    flux: Literal["fitted", "upwind"]
    fft: Literal["pyfftw", "scipy"]


_KINDS = ContactOptions.__annotations__
CHOICES = {name: get_args(kind) for name, kind in _KINDS.items() if get_origin(kind) is Literal}
CHOICES["criterion"] = ("split", "lumped")  # of points alone
_DEFAULTS: dict[str, Any] = dict.fromkeys(_KINDS) | {"floor": 1e-9, "iterations": 2000}
_DEFAULTS |= {name: CHOICES[name][0] for name in _KINDS if name in CHOICES}


def shows_options(call: Call) -> Call:
    """Give a call the options one by one in its signature, for `help` and for editors that complete names."""
    shown = inspect.signature(call)
    *own, _ = shown.parameters.values()
    options = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=_DEFAULTS[name], annotation=kind)
        for name, kind in _KINDS.items()
    ]
    vars(call)["__signature__"] = shown.replace(parameters=[*own, *options])
    return call


def options_of(call: Callable[..., Any], given: ContactOptions) -> dict[str, Any]:
    """Return all options, those that are not given with their defaults. Raises TypeError for a name that is none."""
    for name in given:
        if name not in _KINDS:
            hint = did_you_mean(name, list(inspect.signature(call).parameters))
            raise TypeError(f"{call.__name__}() has no argument '{name}'.{hint}")
    return _DEFAULTS | given


def check_choices(given: Mapping[str, Any]) -> None:
    """Raise OperatingPointError for a value that is not among the choices of its argument."""
    faults = {name: value for name, value in given.items() if name in CHOICES and value not in CHOICES[name]}
    refuse(
        [
            f"{name} = {value!r} is not one of {', '.join(CHOICES[name])}."
            + did_you_mean(str(value), list(CHOICES[name]))
            for name, value in faults.items()
        ]
    )


def refuse(sentences: list[str]) -> None:
    """Raise OperatingPointError with the sentences, if there are any."""
    if sentences:
        raise OperatingPointError(" ".join(sentences))
