"""The tables of the models by name; __init__.py describes each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from .description import Model, Variable, inlet, output, parameter
from .linear import linear

POSITION, SPEED = ("m", 1.0), ("m/s", 1.0)


def _oscillator(m: float, k: float, d: float, x0: float) -> tuple[Variable, ...]:
    return (
        parameter("m", "kg", m, minimum=1e-6),
        parameter("k", "N/m", k, minimum=0.0),
        parameter("d", "N.s/m", d, minimum=0.0),
        parameter("x0", "m", x0),
        parameter("v0", "m/s", 0.0),
    )


def _coupling(kc: float, dc: float) -> tuple[Variable, ...]:
    return parameter("kc", "N/m", kc, minimum=0.0), parameter("dc", "N.s/m", dc, minimum=0.0)


MOTION = output("x", *POSITION), output("v", *SPEED)
IDENTITY = ((1.0, 0.0), (0.0, 1.0))


def _mass_under_force(x0: float, text: str) -> Model:
    return linear(
        (*_oscillator(1.0, 10.0, 0.1, x0), inlet("F", "N", 10.0), *MOTION),
        A=((0.0, 1.0), ("-k / m", "-d / m")),
        B=((0.0,), ("1 / m",)),
        C=IDENTITY,
        D=((0.0,), (0.0,)),
        starts=("x0", "v0"),
        text=text,
    )


def _mass_with_spring(
    own: tuple[Variable, ...], spring: tuple[Variable, ...], other: tuple[str, str], force: float, text: str
) -> Model:
    """A mass that owns the spring to another one: gives the spring's force on that other mass."""
    return linear(
        (*own, *spring, inlet(other[0], *POSITION), inlet(other[1], *SPEED), output("F", "N", force), *MOTION),
        A=((0.0, 1.0), ("-(k + kc) / m", "-(d + dc) / m")),
        B=((0.0, 0.0), ("kc / m", "dc / m")),
        C=(("kc", "dc"), *IDENTITY),
        D=(("-kc", "-dc"), (0.0, 0.0), (0.0, 0.0)),
        starts=("x0", "v0"),
        text=text,
    )


def _mass_by_displacement(own: tuple[Variable, ...], spring: tuple[Variable, ...], text: str) -> Model:
    return linear(
        (*own, *spring, inlet("x_other", *POSITION), inlet("v_other", *SPEED), *MOTION),
        A=((0.0, 1.0), ("-(k + kc) / m", "-(d + dc) / m")),
        B=((0.0, 0.0), ("kc / m", "dc / m")),
        C=IDENTITY,
        D=((0.0, 0.0), (0.0, 0.0)),
        starts=("x0", "v0"),
        text=text,
    )


def mass_1_force() -> Model:
    return _mass_under_force(1.0, "First mass of the two-mass oscillator, moved by a force")


def mass_2_spring() -> Model:
    text = "Second mass of the two-mass oscillator, with the spring between the masses"
    return _mass_with_spring(_oscillator(1.0, 10.0, 0.1, 0.0), _coupling(10.0, 0.1), ("x1", "v1"), 10.0, text)


def mass_1_displacement() -> Model:
    text = "First mass of the two-mass oscillator, moved by the other mass through the spring between them"
    return _mass_by_displacement(_oscillator(1.0, 10.0, 0.1, 1.0), _coupling(10.0, 0.1), text)


def mass_2_displacement() -> Model:
    text = "Second mass of the two-mass oscillator, moved by the other mass through the spring between them"
    return _mass_by_displacement(_oscillator(1.0, 10.0, 0.1, 0.0), _coupling(10.0, 0.1), text)


def _wheel(own: tuple[Variable, ...]) -> tuple[Variable, ...]:
    tyre = parameter("m", "kg", 40.0, minimum=1e-6), parameter("kw", "N/m", 150e3, minimum=0.0)
    return (*tyre, parameter("x0", "m", 0.0), parameter("v0", "m/s", 0.0), *own, inlet("road", "m", 0.1, 0.1))


def wheel_force() -> Model:
    return linear(
        (*_wheel(()), inlet("F", "N", 1e3), output("x", "m", 0.1), output("v", "m/s", 1.0)),
        A=((0.0, 1.0), ("-kw / m", 0.0)),
        B=((0.0, 0.0), ("kw / m", "1 / m")),
        C=IDENTITY,
        D=((0.0, 0.0), (0.0, 0.0)),
        starts=("x0", "v0"),
        text="Wheel of the quarter car on its tyre, moved by the road and the force of the suspension",
    )


def wheel_displacement() -> Model:
    others = inlet("x_other", "m", 0.1), inlet("v_other", "m/s", 1.0)
    return linear(
        (*_wheel(_coupling(15e3, 1e3)), *others, output("x", "m", 0.1), output("v", "m/s", 1.0)),
        A=((0.0, 1.0), ("-(kw + kc) / m", "-dc / m")),
        B=((0.0, 0.0, 0.0), ("kw / m", "kc / m", "dc / m")),
        C=IDENTITY,
        D=((0.0,) * 3,) * 2,
        starts=("x0", "v0"),
        text="Wheel of the quarter car on its tyre, moved by the road and the chassis",
    )


def chassis_spring() -> Model:
    text = "Chassis of the quarter car, with the suspension"
    own = _oscillator(400.0, 0.0, 0.0, 0.0)
    return _mass_with_spring(own, _coupling(15e3, 1e3), ("x_wheel", "v_wheel"), 1e3, text)


def chassis_displacement() -> Model:
    text = "Chassis of the quarter car, moved by the wheel through the suspension"
    return _mass_by_displacement(_oscillator(400.0, 0.0, 0.0, 0.0), _coupling(15e3, 1e3), text)


def point_mass() -> Model:
    return linear(
        (
            parameter("m", "kg", 1e-3, minimum=1e-9),
            parameter("F0", "N", 300.0),
            parameter("x0", "m", 0.0, nominal=1e-6),
            parameter("v0", "m/s", 0.0, nominal=1e-2),
            inlet("F", "N", 300.0),
            output("x", "m", 1e-6),
            output("v", "m/s", 1e-2),
        ),
        A=((0.0, 1.0), (0.0, 0.0)),
        B=((0.0,), ("-1 / m",)),
        C=IDENTITY,
        D=((0.0,), (0.0,)),
        starts=("x0", "v0"),
        b=(0.0, "F0 / m"),
        text="Mass that a constant force presses into a contact",
    )


def block() -> Model:
    return linear(
        (
            *_oscillator(1.0, 50.0, 0.0, 0.0),
            parameter("v_belt", "m/s", 0.1),
            inlet("F", "N", 1.0),
            output("x", "m", 0.1),
            output("v", "m/s", 0.1),
            output("u", "m/s", 0.1),
        ),
        A=((0.0, 1.0), ("-k / m", "-d / m")),
        B=((0.0,), ("1 / m",)),
        C=(*IDENTITY, (0.0, 1.0)),
        D=((0.0,), (0.0,), (0.0,)),
        starts=("x0", "v0"),
        c=(0.0, 0.0, "-v_belt"),
        text="Block on a moving belt, held by a spring",
    )


def contact_point() -> Model:
    moving = ("x", "v", "F_ref", "x_ref", "c")
    return Model(
        "contact_point",
        (
            parameter("F_ref", "N", 300.0, minimum=0.0, text="Force at rest at the approach x_ref"),
            parameter("x_ref", "m", 1.0795e-6, minimum=1e-12),
            parameter("c", "N.s/m", 50.0, minimum=0.0),
            inlet("x", "m", 1e-6),
            inlet("v", "m/s", 1e-2),
            output("F", "N", 300.0, moving),
            output("dF_dx", "N/m", 4e8, moving),
            output("dF_dv", "N.s/m", 50.0, moving),
            output("in_contact", None, needs=("x",), kind="Boolean"),
        ),
        partials=True,
        text="Force of a stiff one-sided contact",
    )


def friction() -> Model:
    law = ("u", "N", "mu_s", "mu_d", "u_s", "u_r")
    return Model(
        "friction",
        (
            parameter("N", "N", 10.0, minimum=0.0, text="Normal force"),
            parameter("mu_s", "1", 0.4, minimum=0.0),
            parameter("mu_d", "1", 0.25, minimum=0.0),
            parameter("u_s", "m/s", 0.1, minimum=1e-9, text="Speed over which friction falls"),
            parameter("u_r", "m/s", 0.01, minimum=1e-9, text="Speed over which it changes its sign"),
            inlet("u", "m/s", 0.1),
            output("F", "N", 1.0, law),
            output("dF_du", "N.s/m", 400.0, law),
        ),
        partials=True,
        text="Friction force that falls with the sliding speed",
    )


def drag() -> Model:
    return Model(
        "drag",
        (
            parameter("c", "N.s/m", 1.0, minimum=0.0),
            parameter("q", "N.s2/m2", 2.0, minimum=0.0),
            inlet("u", "m/s", 1.0),
            output("F", "N", 1.0),
            output("dF_du", "N.s/m", 1.0),
        ),
        memory=2,
        text="Resistance that answers for the speed held over a step",
    )


def gain(a: float = 1.0, b: float = 0.0, c: float = 0.0, unit_u: str = "1", unit_y: str = "1") -> Model:
    return Model(
        "gain",
        (
            parameter("a", None, a),
            parameter("b", None, b),
            parameter("c", None, c),
            inlet("u", unit_u, 1.0),
            output("y", unit_y, 1.0, ("u", "a", "b", "c")),
        ),
        partials=True,
        text="y = a u + b + c u^2",
    )


def sphere() -> Model:
    return Model(
        "sphere",
        (
            parameter("r2", None, 5.0, minimum=0.0, text="Square of the radius"),
            inlet("u", None, 1.0),
            inlet("v", None, 1.0),
            output("w", None, 1.0, ("u", "v", "r2")),
        ),
        text="The third coordinate of a point on a sphere, no number outside of it",
    )


def millimetre() -> Model:
    return gain(a=10.0, unit_u="mm", unit_y="N")


def mismatch() -> Model:
    return gain(unit_u="s", unit_y="s")


def celsius() -> Model:
    return gain(unit_u="degC", unit_y="degC")


def kelvin() -> Model:
    return gain(unit_u="K", unit_y="K")


def echo(events: bool = False) -> Model:
    kinds = ("Real", 0.0), ("Integer", 0), ("Boolean", False), ("String", "")
    pairs = (
        (inlet(f"{kind.lower()}_in", None, start=start, kind=kind), output(f"{kind.lower()}_out", None, kind=kind))
        for kind, start in kinds
    )
    variables = tuple(v for i, o in pairs for v in (i, replace(o, needs=(i.name,))))
    return Model("echo", variables, events=events, text="Each output is the input of its type")


def arrays(events: bool = False) -> Model:
    row, square = {"shape": (3,)}, {"shape": (2, 2)}
    return Model(
        "arrays",
        (
            parameter("gains", None, (1.0, 2.0, 3.0, 4.0), **square),
            inlet("u", None, 1.0, (0.5, 1.0, 1.5), **row),
            inlet("counts", None, start=(10, 20, 30), kind="Integer", **row),
            inlet("flags", None, start=(True, False, False, True), kind="Boolean", **square),
            output("y", None, 1.0, **row),
            output("z", None, 1.0, ("u", "gains"), **square),
            output("counted", None, kind="Integer", needs=("counts",), **row),
            output("flagged", None, kind="Boolean", needs=("flags",), **square),
        ),
        memory=3,
        events=events,
        text="Arrays of one and of two dimensions",
    )


def _integrator(source: str, *own: Variable, text: str, **more: Any) -> Model:
    """y' = u and something that goes wrong."""
    line = parameter("y0", "m", 0.0), inlet("u", "m/s", 1.0), output("y", "m", 1.0, ("y0",))
    return Model(source, (*own, *line), memory=2, text=text, **more)


def discard(partial: bool = False) -> Model:
    own = parameter("h_max", "s", 0.1, minimum=1e-9), parameter("partial", None, partial, kind="Boolean")
    return _integrator("discard", *own, text="y' = u in steps of at most h_max", early=partial)


def terminator() -> Model:
    return _integrator("terminator", parameter("t_end", "s", 0.5), text="y' = u up to t_end", early=True)


def early() -> Model:
    times = parameter("period", "s", 0.25, minimum=1e-9), parameter("jump", "m", 1.0)
    counted = output("events", None, kind="Integer")
    text = "y' = u, with a jump at each multiple of the period"
    return _integrator("early", *times, counted, text=text, early=True, events=True)


def nan() -> Model:
    return _integrator("nan", parameter("t_nan", "s", 0.5), text="y' = u, no number after t_nan")


def failing() -> Model:
    return _integrator("failing", parameter("t_fail", "s", 0.5), text="y' = u, an error after t_fail")


def registrar() -> Model:
    return _integrator("registrar", text="y' = u, as long as the library is not loaded again")


def locker() -> Model:
    return _integrator("locker", text="y' = u, its instances made under a lock")


def bouncer() -> Model:
    return Model(
        "bouncer",
        (
            parameter("g", "m/s2", 9.81, minimum=1e-9),
            parameter("e", "1", 0.7, minimum=0.0, maximum=1.0, text="Coefficient of restitution"),
            parameter("h0", "m", 1.0, minimum=0.0),
            parameter("v0", "m/s", 0.0),
            output("h", "m", 1.0, ("h0",)),
            output("v", "m/s", 1.0, ("v0",)),
            output("bounces", None, kind="Integer"),
        ),
        memory=3,
        text="A bouncing ball",
    )


def tooth() -> Model:
    return Model(
        "tooth",
        (
            parameter("period", "s", 0.1, minimum=1e-9),
            parameter("k", "N/m", 1e8),
            parameter("a", "1", 0.5),
            output("tooth", None, kind="Integer"),
            output("stiffness", "N/m", 1e8, ("k", "a")),
        ),
        text="Teeth that come into mesh one after the other",
    )


MODELS: dict[str, Callable[..., Model]] = {
    f.__name__: f
    for f in (
        mass_1_force,
        mass_2_spring,
        mass_1_displacement,
        mass_2_displacement,
        wheel_force,
        wheel_displacement,
        chassis_spring,
        chassis_displacement,
        point_mass,
        block,
        contact_point,
        friction,
        drag,
        gain,
        sphere,
        millimetre,
        mismatch,
        celsius,
        kelvin,
        echo,
        arrays,
        discard,
        terminator,
        early,
        nan,
        failing,
        registrar,
        locker,
        bouncer,
        tooth,
        linear,
    )
}
