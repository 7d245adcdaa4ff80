"""Lubricated rollers with ends: every profile is solved, and says where its ends touch."""

from functools import cache

import numpy as np
import pytest
from comparison import approx

from contact_core import Logarithmic, Rounded, line_contact

E, LENGTH, RADIUS = 230e9, 3e-3, 10e-3
OIL = {"viscosity": 0.05, "pressure_viscosity": 2e-8}


@cache
def roller(profile, load=3e5, speed=5.0, nx=65, **more):
    return line_contact(
        load=load, radius=RADIUS, reduced_modulus=E, speed_1=speed, speed_2=speed, length=LENGTH, profile=profile,
        grid=nx, **OIL, **more,
    )  # fmt: skip


def middle(found):
    return int(np.abs(found.y).argmin())


@pytest.mark.parametrize("load", [5e4, pytest.param(8e5, marks=pytest.mark.long)])
@pytest.mark.parametrize(
    "profile",
    [
        Logarithmic(3e-6),
        pytest.param(Rounded(2.2e-3, 0.02), marks=pytest.mark.long),
        Rounded(2.2e-3, 1.0),
        pytest.param(Rounded(0.0, 1.0), marks=pytest.mark.long),
    ],
    ids=str,
)
def test_light_and_heavy_rollers_of_any_ends_are_solved_and_only_ends_touch(profile, load):
    found = roller(profile, load)
    solid = found.solid_pressure > 0.0
    assert found.converged, found.shortfall
    assert np.abs(found.pressure - found.pressure[::-1]).sum() < 0.02 * found.pressure.sum()
    assert (np.abs(found.y)[solid.any(axis=1)] > 0.38 * LENGTH).all()
    assert found.film[middle(found)].min() > 10e-9


def test_the_middle_of_a_roller_is_an_endless_line_under_the_load_of_its_middle():
    found = roller(Rounded(2.2e-3, 0.02))
    dx, row = found.x[1] - found.x[0], middle(found)
    line = line_contact(
        load=found.pressure[row].sum() * dx, radius=RADIUS, reduced_modulus=E, speed_1=5.0, speed_2=5.0, grid=65,
        domain=(found.x[0], found.x[-1]), **OIL,
    )  # fmt: skip
    assert line.h_central == approx(float(np.interp(0.0, found.x, found.film[row])), rel=0.02)
    assert line.film.min() == approx(found.film[row].min(), rel=0.02)


@pytest.mark.long
def test_a_sharp_end_touches_and_a_generous_one_does_not():
    assert roller(Rounded(2.2e-3, 1.0)).contact_load_ratio > 0.001
    assert roller(Logarithmic(3e-6)).contact_load_ratio == 0.0


def test_a_roller_rolls_either_way():
    ahead, back = roller(Logarithmic(3e-6)), roller(Logarithmic(3e-6), speed=-5.0)
    assert back.film[:, ::-1] == approx(ahead.film, rel=1e-9)


def test_the_end_film_falls_more_steeply_with_load_than_that_of_the_middle_and_lies_where_the_end_is_rounded():
    """As the finite elements of Alakhramsing, de Rooij, Schipper & van Drogen, Proc. IMechE J (2017),
    doi:10.1177/1350650117705037, have it for a straight roller with rounded edges.
    """
    profile, loads = Rounded(2.2e-3, 0.01), (1e5, 2e5, 4e5)
    found = [roller(profile, load) for load in loads]
    assert all(film.converged and film.contact_load_ratio == 0.0 for film in found)
    at = [abs(film.y[np.unravel_index(film.film.argmin(), film.film.shape)[0]]) for film in found]
    assert all(1.1e-3 < y < 1.45e-3 for y in at)
    assert at == sorted(at)
    ends, middles = (np.log([f.h_min for f in found]), np.log([f.film[middle(f)].min() for f in found]))
    slopes, own = (np.diff(films) / np.diff(np.log(loads)) for films in (ends, middles))
    assert (slopes < 2.0 * own).all()
    assert (own < -0.05).all()
    assert (slopes > -0.8).all()


@pytest.fixture(scope="module")
def on_grids():
    """Smallest film of a roller, and that of its middle, by flux on 33, 65 and 129 nodes along the flow."""
    films = {}
    for flux in ("upwind", "fitted"):
        found = [roller(Rounded(2.2e-3, 0.01), 2e5, nx=nx, flux=flux) for nx in (33, 65, 129)]
        assert all(film.converged for film in found)
        films[flux] = np.array([[film.h_min, film.film[middle(film)].min()] for film in found])
    return films


@pytest.mark.long
def test_both_films_of_upwind_flow_converge_with_the_grid(on_grids):
    coarse, fine, finest = on_grids["upwind"]
    assert (np.log2((fine - coarse) / (finest - fine)) > 1.2).all()


def test_both_films_of_fitted_flow_have_the_limit_of_upwind_flow_on_33_nodes_already(on_grids):
    _, fine, finest = on_grids["upwind"]
    errors = np.abs(on_grids["fitted"] / (finest + (finest - fine) / 3.0) - 1.0)
    assert errors[0].max() < 0.05
    assert errors[-1].max() < 0.01
