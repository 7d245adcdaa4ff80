import math
from itertools import pairwise

import numpy as np
import pytest
from closed_forms import chittenden
from comparison import approx

from contact_core import Scene
from contact_core.reference import (
    SmoothContact,
    hamrock_dowson,
    moes_film,
    nijenbanning_venner_moes,
    nvm_film,
)


def smooth(name: str) -> SmoothContact:
    scene = Scene.from_toml(name)
    point, oil = scene.operation.point, scene.lubricant.viscosity
    return SmoothContact(
        point.load, point.entrainment_speed, oil.viscosity, oil.pressure_coefficient, scene.geometry.radius_x,
        scene.geometry.radius_y, scene.solids.reduced_modulus,
    )  # fmt: skip


def of_moes(load: float, lubricant: float, speed: float = 1e-11, ratio: float = 1.0) -> SmoothContact:
    """A contact with given M, L and radius_x / radius_y; the speed parameter is of the sum of surface speeds."""
    radius, modulus, viscosity = 0.01, 230e9, 0.01
    return SmoothContact(
        load * speed**0.75 * modulus * radius**2, 0.5 * speed * modulus * radius / viscosity, viscosity,
        lubricant * speed**-0.25 / modulus, radius, radius / ratio, modulus,
    )  # fmt: skip


@pytest.mark.parametrize(("name", "parameters"), [("azam_case_a", (3757.0, 3.32)), ("mtm_zddp", (5475.0, 2.68))])
def test_moes_parameters_of_the_shipped_cases(name, parameters):
    assert smooth(name).moes_parameters == approx(parameters, rel=2e-3)


@pytest.mark.parametrize(
    ("name", "central", "minimum", "moes"),
    [("azam_case_a", 17.25e-9, 9.53e-9, 17.60e-9), ("mtm_zddp", 9.36e-9, 5.13e-9, 9.37e-9)],
)
def test_films_of_the_shipped_cases(name, central, minimum, moes):
    contact = smooth(name)
    assert hamrock_dowson(contact) == approx((central, minimum), abs=0.006e-9)
    assert nijenbanning_venner_moes(contact) == approx(moes, abs=0.006e-9)


@pytest.mark.parametrize(
    ("lubricant", "films"),
    [
        (5.0, (3.420, 3.276, 3.055, 2.944, 2.646)),
        (10.0, (4.832, 4.708, 4.497, 4.380, 4.035)),
        (20.0, (7.181, 7.076, 6.876, 6.756, 6.356)),
    ],
)
def test_central_films_of_circular_contacts_in_moes_units(lubricant, films):
    found = [moes_film(load, lubricant) for load in (10.0, 20.0, 100.0, 200.0, 1000.0)]
    assert found == approx(films, abs=6e-4)


@pytest.mark.parametrize(
    ("load", "lubricant", "central", "minimum"),
    [
        (20.0, 10.0, 4.571, 2.589), (100.0, 10.0, 4.103, 2.302), (200.0, 10.0, 3.917, 2.189),
        (1000.0, 10.0, 3.517, 1.946), (20.0, 5.0, 3.165, 1.844), (100.0, 5.0, 2.842, 1.639),
        (200.0, 5.0, 2.713, 1.558), (1000.0, 5.0, 2.436, 1.386), (20.0, 20.0, 6.600, 3.636),
        (100.0, 20.0, 5.925, 3.233), (200.0, 20.0, 5.656, 3.074), (1000.0, 20.0, 5.078, 2.733),
    ],
)  # fmt: skip
def test_hamrock_dowson_in_moes_units(load, lubricant, central, minimum):
    contact = of_moes(load, lubricant)
    assert contact.moes_parameters == approx((load, lubricant), rel=1e-12)
    films = np.array(hamrock_dowson(contact)) / contact.radius_x / np.sqrt(1e-11)
    assert films == approx((central, minimum), abs=6e-4)


def test_dimensions_drop_out_of_the_moes_film():
    contact = of_moes(50.0, 8.0)
    assert nijenbanning_venner_moes(contact) / contact.radius_x / np.sqrt(1e-11) == approx(moes_film(50.0, 8.0))


def test_light_load_and_thin_oil_reach_the_rigid_isoviscous_limit():
    assert moes_film(0.1, 0.1) == approx(145.0 * 1.796 ** (-15.0 / 7.0) / 0.1**2, rel=1e-5)
    assert moes_film(0.1, 0.1) == approx(4134.0, rel=2e-4)


def test_heavy_load_and_thin_oil_reach_the_elastic_isoviscous_limit():
    assert moes_film(1e4, 1e-3) == approx(3.18 * 1.63 ** (-14.0 / 25.0) * 1e4 ** (-2.0 / 15.0), rel=0.05)


def test_heavy_load_and_thick_oil_reach_the_elastic_piezoviscous_limit():
    limit = 1.48 * 1.63**-0.35 * 1e6 ** (-1.0 / 12.0) * 100.0**0.75
    assert moes_film(1e6, 100.0) == approx(limit, rel=0.01)


@pytest.mark.parametrize("ratio", [1.0, 2.0, 5.0])
def test_the_two_formulas_agree_for_ellipses_across_the_entrainment(ratio):
    contact = of_moes(200.0, 10.0, ratio=1.0 / ratio)
    assert nijenbanning_venner_moes(contact) == approx(hamrock_dowson(contact)[0], rel=0.15, abs=0.0)


@pytest.mark.parametrize(("load", "lubricant"), [(0.01, 0.01), (100.0, 0.01), (0.1, 10.0), (100.0, 20.0)])
def test_a_very_wide_ellipse_at_constant_load_per_length_is_a_line_contact(load, lubricant):
    # the contact's width grows with the root of the load and of radius_y: load ~ radius_y^(1/2)
    films = [moes_film(load * ratio**-0.5, lubricant, ratio) for ratio in (1e-4, 1e-6, 1e-8)]
    assert films == approx([films[0]] * 3, rel=0.05)


@pytest.mark.parametrize("ratio", [0.1, 0.2, 0.5, 1.0])
def test_chittenden_agrees_with_hamrock_and_dowson_for_ellipses_across_the_entrainment(ratio):
    contact = of_moes(200.0, 10.0, ratio=ratio)
    (central, minimum), (other, least) = chittenden(contact), hamrock_dowson(contact)
    assert minimum == approx(least, rel=0.02)
    assert central == approx(other, rel=0.06)


@pytest.mark.parametrize("ratio", [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0])
def test_chittenden_agrees_with_nijenbanning_for_either_axis_along_the_entrainment_under_a_light_load(ratio):
    contact = of_moes(20.0, 10.0, ratio=ratio)
    assert chittenden(contact)[0] == approx(nijenbanning_venner_moes(contact), rel=0.1)


@pytest.mark.parametrize("load", [*(10.0**n for n in range(-320, 7, 20)), 1e6])
def test_the_film_of_next_to_no_load_or_speed_is_a_number(load: float) -> None:
    films = [nvm_film(load, 10.0**n, 0.01, 2e-8, 0.01, 0.01, 2.2e11) for n in range(-320, 3, 2)]
    assert all(0.0 < film < math.inf for film in films)
    assert all(later >= film for film, later in pairwise(films))
