"""Loss factors, mean friction and flash temperature of gears against closed forms and sums worked out otherwise."""

import math

import numpy as np
import pytest
from closed_forms import blok_line
from comparison import approx
from scipy.integrate import quad

from contact_core import Scene
from contact_core.reference import hertz_line
from system_models.machines.gear_pair.geometry import FZG_A, FZG_C, FZG_STAGES
from system_models.machines.gear_pair.path import radius, stations_of, surface_speeds
from system_models.machines.gear_pair.sharing import Sharing, loads
from system_models.machines.gear_pair.textbook import iso_14179_1, loss_factor, ohlendorf, schlenk

PINION = 2170.0 * 2.0 * math.pi / 60.0
ELASTIC = Sharing("elastic")


def factor(pair, sharing, force=4000.0) -> float:
    """Of many stations."""
    places = stations_of(pair, 2000)
    return loss_factor(pair, places, loads(pair, sharing, force, places.position) / force)


def counted(pair, share) -> float:
    """Loss over power at a coefficient of 1: the gears are turned through a base pitch, and all pairs counted."""
    turns = np.linspace(0.0, pair.base_pitch, 20_001)[:-1]
    pairs = pair.start + turns[:, None] + pair.base_pitch * np.arange(3)
    there = pairs < pair.end
    u1, u2 = surface_speeds(pair, pairs, 1.0, 1.0 / pair.ratio)
    sliding = np.where(there, share(pairs, there) * np.abs(u1 - u2), 0.0).sum(axis=1)
    return float(sliding.mean()) / pair.base_radius_1


def evenly(pairs, there):
    return there / there.sum(axis=1, keepdims=True)


def test_ohlendorfs_factor_of_type_c_is_the_integral_under_rigid_sharing():
    assert ohlendorf(FZG_C) == approx(0.1948, rel=2e-3)
    assert factor(FZG_C, Sharing()) == approx(ohlendorf(FZG_C), rel=1e-9)
    assert counted(FZG_C, evenly) == approx(ohlendorf(FZG_C), rel=1e-3)


def test_ohlendorfs_factor_of_type_a_is_not_as_two_pairs_carry_at_its_pitch_point():
    assert factor(FZG_A, Sharing()) == approx(0.3024, rel=1e-3)
    assert counted(FZG_A, evenly) == approx(0.3024, rel=1e-3)
    assert ohlendorf(FZG_A) == approx(0.3064, rel=1e-3)


@pytest.mark.parametrize("pair", [FZG_C, FZG_A])
def test_elastic_teeth_lose_less_as_the_ends_of_their_path_carry_less(pair):
    def by_stiffness(pairs, there):
        along = (pairs - pair.start) / (pair.end - pair.start)
        stiffness = np.where(there, 0.55 + 1.8 * along * (1.0 - along), 0.0)
        return stiffness / stiffness.sum(axis=1, keepdims=True)

    found = factor(pair, ELASTIC)
    assert found == approx(counted(pair, by_stiffness), rel=1e-3)
    assert 0.95 < found / factor(pair, Sharing()) < 1.0


def test_tip_relief_lowers_the_loss_of_light_loads_more():
    relief = Sharing("elastic", 20e-6, 20e-6, 3e-3, 3e-3)
    light, heavy = (factor(FZG_C, relief, force) for force in (1000.0, 20000.0))
    assert light < heavy < factor(FZG_C, ELASTIC)


def test_schlenks_friction_by_hand():
    """Load stage 7, 183.35 Nm at 2170 rpm, 14.2 mPa s, Ra 0.4 um: 387.1 N/mm over 6.349 m/s and 8.382 mm."""
    force = FZG_STAGES[0.5][6] / FZG_C.base_radius_1
    by_hand = 0.048 * (387.1 / (6.349 * 8.382)) ** 0.2 * 14.2**-0.05 * 0.4**0.25 * 0.846
    assert schlenk(FZG_C, force, PINION, 14.2e-3, 0.4e-6, 0.846) == approx(by_hand, rel=1e-3)
    assert 0.02 < by_hand < 0.06


def test_the_friction_of_iso_tr_14179_1_by_hand():
    """Load stage 7 at 8.317 m/s, 17 mm2/s: K = 183350 * 40 / (2 * 14 * 36.6^2 * 24) = 8.147 N/mm2."""
    by_hand = 17.0**-0.223 * 8.147**-0.40 / (3.239 * 8.317**0.70)
    assert iso_14179_1(FZG_C, FZG_STAGES[0.5][6], PINION, 17e-6) == approx(by_hand, rel=1e-3)
    assert 0.005 < by_hand < 0.1


def test_bloks_flash_is_that_of_a_fast_source_of_hertz_shape_shared_for_equal_heat():
    """Each body: rise = integral of flux / sqrt(pi * u * (x - x')) / effusivity over what has passed it."""
    conductivity, diffusivity = 46.0, 1.25e-5
    effusivity = conductivity / math.sqrt(diffusivity)
    place, force = 20e-3, 3000.0
    u1, u2 = surface_speeds(FZG_C, place, PINION, PINION / 1.5)
    a = hertz_line(force, radius(FZG_C, place), FZG_C.face_width, FZG_C.reduced_modulus).a

    def rise(x: float) -> float:  # of unit mean flux, in a / (u effusivity^2)
        def part(root: float) -> float:  # x' = x - root^2
            return 2.0 * math.sqrt(max(1.0 - (x - root * root) ** 2, 0.0)) * 4.0 / math.pi

        return quad(part, 0.0, math.sqrt(x + 1.0), epsabs=1e-10)[0] / math.sqrt(math.pi)

    hottest = max(rise(x) for x in np.linspace(0.3, 0.7, 81))
    mean_flux = 0.05 * force * abs(u1 - u2) / (2.0 * a * FZG_C.face_width)
    one, two = (hottest * math.sqrt(a / u) / effusivity for u in (u1, u2))  # per flux into the body
    together = mean_flux / (1.0 / one + 1.0 / two)
    blok = blok_line(force, FZG_C.face_width, 0.05, u1, u2, a, effusivity)
    assert blok == approx(together, rel=3e-3)


def test_the_oils_of_the_contacts_give_the_viscosity_of_the_friction_formulas():
    """FVA 3 at 90 degC: 12.85 mPa s, Wingertszahn et al. 2023."""
    oil = Scene.from_toml("fzg_flank").lubricant
    assert float(oil.viscosity(np.zeros(1), 363.15)[0]) == approx(12.85e-3, rel=1e-3)
