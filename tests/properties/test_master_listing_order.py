"""Results do not depend on the order in which FMUs and connections are listed: bit for bit."""

from itertools import permutations
from pathlib import Path

import pytest
import xarray as xr

from benchmarks.models import build
from system_models.master import System, simulate

FMUS = {"one": "mass_1_force", "two": "mass_2_spring", "three": "point_mass", "four": "gain"}
WIRES = [
    ("one.x", "two.x1"),
    ("one.v", "two.v1"),
    ("two.F", "one.F"),
    ("two.F", "three.F", -3.0),
    ("three.x", "four.u"),
]
SETTINGS = [
    {"algorithm": "jacobi", "order": 1},
    {"algorithm": "gauss_seidel", "order": 1},
    {"algorithm": "jacobi", "order": 1, "iterate": "quasi_newton"},
    {"algorithm": "gauss_seidel", "iterate": "aitken"},
    {"algorithm": "jacobi", "order": 2, "tolerance": 1e-3},
]


@pytest.fixture(scope="module")
def paths(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("fmus")
    own = {"gain": {"unit_u": "m"}}
    return {name: build(model, folder, **own.get(model, {})) for name, model in FMUS.items()}


def same(one: xr.Dataset, other: xr.Dataset, renamed: dict[str, str] | None = None) -> bool:
    """Whether all that is recorded, and how each step went, is the same to the last bit."""
    names = {name: (renamed or {}).get(name, name) for name in map(str, one.variables)}
    assert set(names.values()) == set(other.variables)
    return all(one[name].values.tobytes() == other[names[name]].values.tobytes() for name in names)


@pytest.mark.parametrize("settings", SETTINGS, ids=str)
def test_the_order_of_listing_does_not_matter(paths, settings):
    reference = simulate(System(paths, WIRES), 0.1, 0.01, **settings)
    for names, wires in zip([*permutations(FMUS)][3::5], [*permutations(WIRES)][19::25], strict=True):
        system = System({name: paths[name] for name in names}, wires)
        assert same(reference, simulate(system, 0.1, 0.01, **settings)), (names, wires)


def test_the_order_of_outputs_and_parameters_does_not_matter(paths):
    parameters = {"one.x0": 0.7, "two.k": 12.0, "one.k": 9.0}
    reference = simulate(System(paths, WIRES, parameters), 0.1, 0.01)
    turned = System(paths, WIRES, dict(reversed(parameters.items())))
    assert same(reference, simulate(turned, 0.1, 0.01))
    outputs = ["two.F", "one.x"]
    listed, reversed_ = (simulate(turned, 0.1, 0.01, outputs=which) for which in (outputs, outputs[::-1]))
    assert same(listed, reversed_)


@pytest.mark.parametrize("algorithm", ["jacobi", "gauss_seidel"])
def test_names_of_fmus_do_not_matter(paths, algorithm):
    """Nor does the alphabet: where a Gauss-Seidel sequence is not free, it follows from the graph."""

    def renamed(name: str) -> str:
        fmu, _, variable = name.partition(".")
        return f"{new[fmu]}.{variable}"

    reference = simulate(System(paths, WIRES), 0.1, 0.01, algorithm=algorithm, order=1)
    for names in [*permutations(FMUS)][3::5]:
        new = dict(zip(FMUS, names, strict=True))
        wires = [(renamed(source), renamed(target), *factor) for source, target, *factor in WIRES]
        result = simulate(
            System({new[name]: path for name, path in paths.items()}, wires), 0.1, 0.01, algorithm=algorithm, order=1
        )
        variables = {str(name): renamed(str(name)) for name in reference.variables if str(name).split(".")[0] in FMUS}
        assert same(reference, result, variables), names
