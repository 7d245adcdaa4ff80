"""Initial values of coupled FMUs are consistent: against hand calculations."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from built import Built
from comparison import approx
from fmpy.fmi1 import FMICallException

from benchmarks.models import build
from benchmarks.models.description import inlet, output
from system_models.fmu.errors import CouplingError
from system_models.fmu.fmi2 import Fmi2Instance
from system_models.fmu.instance import Instance
from system_models.fmu.start import started
from system_models.master.initial import initialise
from system_models.master.system import Connection, System

Initialised = Callable[..., tuple[int, dict[str, float]]]


@pytest.fixture(scope="session")
def folder(built: Built) -> Path:
    return built.models


@pytest.fixture
def initialised() -> Iterator[Initialised]:
    """Evaluations, and the values at both ends of all connections afterwards."""
    with ExitStack() as exits:

        def values_of(
            fmus: dict[str, Path],
            connections: list[tuple[Any, ...]],
            start: dict[str, Any] | None = None,
            **options: Any,
        ) -> tuple[int, dict[str, Any]]:
            system = System(fmus=fmus, connections=connections)
            none: dict[str, list[Any]] = {name: [] for name in fmus}
            instances: dict[str, Instance] = started(system.models, none, none, False, exits)
            for instance in instances.values():
                instance.enter_initialization(0.0, 1.0, None)
            for name, value in (start or {}).items():
                port = system.port(name)
                instances[port.model.name].set(port.variable, value)
            evaluations = initialise(instances, system.connections, **options)
            ports = [port for c in system.connections for port in (c.source, c.target)]
            return evaluations, {p.name: instances[p.model.name].get(p.variable) for p in ports}

        yield values_of


def gain(folder: Path, a: float, b: float = 0.0, c: float = 0.0, fmi: int = 2, **options: Any) -> Path:
    """y = a u + b + c u^2."""
    return build("gain", folder, fmi, a=a, b=b, c=c, **options)


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (3, 2, 1, 0), (2, 0, 3, 1)])
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_chain_takes_one_evaluation_of_each_connection_in_any_order_of_listing(
    initialised: Initialised, folder: Path, order: tuple[int, ...], fmi: int
) -> None:
    names = ["d", "a", "e", "b", "c"]  # the order of the signal is not that of the alphabet
    fmus = {name: gain(folder, 2.0, 1.0, fmi=fmi) for name in names}
    links = [(f"{one}.y", f"{other}.u") for one, other in pairwise(names)]
    evaluations, values = initialised({n: fmus[n] for n in sorted(names)}, [links[n] for n in order])
    assert evaluations == len(links)
    assert [values[f"{name}.u"] for name in names[1:]] == [1.0, 3.0, 7.0, 15.0]


def test_a_connection_converts_its_value(initialised: Initialised, folder: Path) -> None:
    fmus = {"from": build("celsius", folder, start={"u": 20.0}), "to": build("kelvin", folder)}
    _, values = initialised(fmus, [("from.y", "to.u", 2.0)])
    assert values["to.u"] == approx(2.0 * 293.15, rel=1e-15)


def test_a_loop_of_three_linear_gains_is_solved(initialised: Initialised, folder: Path) -> None:
    fmus = {
        "a": gain(folder, 3.0, 1.0),
        "b": gain(folder, -2.0, 0.5),
        "c": gain(folder, 1.5, -4.0),
    }  # -9: diverges alone
    links = [("a.y", "b.u"), ("b.y", "c.u"), ("c.y", "a.u")]
    evaluations, values = initialised(fmus, links, tolerance=1e-13)
    u = (1.5 * (-2.0 * 1.0 + 0.5) - 4.0) / (1.0 + 9.0)
    assert values["a.u"] == approx(u, rel=1e-12)
    assert values["b.u"] == approx(3.0 * u + 1.0, rel=1e-12)
    assert evaluations < 10


def test_what_hangs_on_a_loop_is_worked_out_once(initialised: Initialised, folder: Path) -> None:
    fmus = {name: gain(folder, 0.5, 1.0) for name in "abcd"}
    loop, tail = [("b.y", "c.u"), ("c.y", "b.u")], [("c.y", "a.u"), ("a.y", "d.u")]
    alone, _ = initialised({name: fmus[name] for name in "bc"}, loop)
    evaluations, values = initialised(fmus, loop + tail)
    assert evaluations == alone + len(tail)
    assert values["d.u"] == approx(2.0, rel=1e-9)


def test_coupled_loops_are_solved_together(initialised: Initialised, folder: Path) -> None:
    random = np.random.default_rng(8)
    D, shift = random.normal(size=(3, 3)), random.normal(size=3)
    variables = (*(inlet(f"u{n}", None) for n in range(3)), *(output(f"y{n}", None) for n in range(3)))
    full = build(
        "linear", folder, variables=variables, A=[[0.0]], B=[[0.0] * 3], C=[[0.0]] * 3, D=D.tolist(), starts=[0.0],
        c=shift.tolist(),
    )  # fmt: skip
    fmus = {"full": full, **{f"g{n}": gain(folder, 1.0) for n in range(3)}}
    links = [link for n in range(3) for link in ((f"full.y{n}", f"g{n}.u"), (f"g{n}.y", f"full.u{n}"))]
    evaluations, values = initialised(fmus, links, tolerance=1e-12)
    expected = np.linalg.solve(np.eye(3) - D, shift)
    assert [values[f"full.u{n}"] for n in range(3)] == approx(expected, rel=1e-10)
    assert evaluations < 12


def test_a_loop_through_one_fmu_alone_is_solved(initialised: Initialised, folder: Path) -> None:
    _, values = initialised({"a": gain(folder, 0.0, 2.0, -1.0)}, [("a.y", "a.u")])  # u = 2 - u^2
    assert values["a.u"] == approx(1.0, rel=1e-9)


def test_the_start_value_chooses_among_the_solutions_of_a_quadratic_loop(
    initialised: Initialised, folder: Path
) -> None:
    fmus = {"a": gain(folder, 0.0, 2.0, -1.0), "b": gain(folder, 1.0)}
    links = [("a.y", "b.u"), ("b.y", "a.u")]
    for start, root in ((0.5, 1.0), (-1.5, -2.0)):
        _, values = initialised(fmus, links, {"a.u": start, "b.u": start})
        assert values["a.u"] == approx(root, rel=1e-9)


def plane_and_sphere(folder: Path) -> dict[str, Path]:
    """a + b + c = 0 and 2a - 3b + 2c = 9, solved for a and b; a^2 + b^2 + c^2 = 5, solved for c."""
    variables = inlet("c", None), output("a", None), output("b", None)
    plane = build(
        "linear", folder, variables=variables, A=[[0.0]], B=[[0.0]], C=[[0.0], [0.0]], D=[[-1.0], [0.0]], starts=[0.0],
        c=[1.8, -1.8],
    )  # fmt: skip
    return {"plane": plane, "sphere": build("sphere", folder)}


def test_one_of_two_roots_is_found_whatever_the_order_of_listing(initialised: Initialised, folder: Path) -> None:
    links = [("plane.a", "sphere.u"), ("plane.b", "sphere.v"), ("sphere.w", "plane.c")]
    roots = {
        (values["plane.a"], values["plane.b"], values["plane.c"])
        for listed in (links, links[::-1], [links[1], links[2], links[0]])
        for _, values in [initialised(plane_and_sphere(folder), listed, {"plane.c": 1.0}, tolerance=1e-12)]
    }
    ((a, b, c),) = roots
    both = 0.9 + np.sqrt(0.07) * np.array([-1.0, 1.0])  # of c
    assert min(abs(both - c)) < 1e-11
    assert (a + b + c, a * a + b * b + c * c) == approx((0.0, 5.0), abs=1e-11)


def test_a_loop_without_value_at_its_start_is_refused_with_its_variables(
    initialised: Initialised, folder: Path
) -> None:
    links = [("plane.a", "sphere.u"), ("plane.b", "sphere.v"), ("sphere.w", "plane.c")]
    with pytest.raises(CouplingError, match=r"loop plane.c, sphere.u has .* 'plane.c' = 0 .* 'plane.c' = nan"):
        initialised(plane_and_sphere(folder), links)


@pytest.mark.parametrize(("a", "b", "c"), [(1.0, 1.0, 0.0), (1.0, 1.0, 1.0)])  # u = u + 1, u = u + 1 + u^2
def test_a_loop_without_solution_is_refused(
    initialised: Initialised, folder: Path, a: float, b: float, c: float
) -> None:
    fmus = {"a": gain(folder, a, b, c), "b": gain(folder, 1.0)}
    message = r"The initial values of the loop a.u, b.u do not converge: after 50 evaluations, .*`parameters`"
    with pytest.raises(CouplingError, match=message):
        initialised(fmus, [("a.y", "b.u"), ("b.y", "a.u")], most=50)


def test_without_declared_dependencies_every_input_counts(initialised: Initialised, folder: Path) -> None:
    mass = build("mass_1_force", folder, dependencies=False, start={"x0": 0.25})
    spring = build("mass_2_spring", folder, dependencies=False)
    links = [("mass.x", "spring.x1"), ("mass.v", "spring.v1"), ("spring.F", "mass.F")]
    _, values = initialised({"mass": mass, "spring": spring}, links)
    assert values["spring.x1"] == approx(0.25, rel=1e-9)
    assert values["mass.F"] == approx(-2.5, rel=1e-9)


def test_values_of_all_types_are_passed_on(initialised: Initialised, folder: Path) -> None:
    kinds = {"real": 2.5, "integer": 3, "boolean": True, "string": "drei"}
    links = [(f"{n}.{kind}_out", f"{n + 1}.{kind}_in") for n in range(2) for kind in kinds]
    fmus = {f"{n}": build("echo", folder) for n in range(3)}
    _, values = initialised(fmus, links, {f"0.{kind}_in": value for kind, value in kinds.items()})
    assert {kind: values[f"2.{kind}_in"] for kind in kinds} == kinds


def test_a_loop_of_discrete_values_comes_to_rest(initialised: Initialised, folder: Path) -> None:
    fmus = {name: build("echo", folder) for name in "ab"}
    links = [("a.integer_out", "b.integer_in"), ("b.integer_out", "a.integer_in")]
    _, values = initialised(fmus, links, {"a.integer_in": 4})
    assert values == dict.fromkeys(values, 4)


def test_a_loop_of_discrete_values_without_rest_is_refused(
    initialised: Initialised, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Connection, "result", lambda connection, value: not value)
    with pytest.raises(CouplingError, match=r"loop a.boolean_in do not come to rest: .* 'a.boolean_in' still changes"):
        initialised({"a": build("echo", folder)}, [("a.boolean_out", "a.boolean_in")])


@pytest.mark.parametrize("status", [2, 3])
def test_an_fmu_that_cannot_give_a_value_is_named(
    initialised: Initialised, folder: Path, monkeypatch: pytest.MonkeyPatch, status: int
) -> None:
    def refused(instance: Instance, variable: Any) -> None:
        raise FMICallException(function="fmi2GetReal", status=status)

    monkeypatch.setattr(Fmi2Instance, "get", refused)
    with pytest.raises(
        CouplingError, match=r"The FMU 'a' failed to give 'a.y' while it was initialised: .*fmi2GetReal"
    ):
        initialised({"a": gain(folder, 1.0), "b": gain(folder, 1.0)}, [("a.y", "b.u")])
