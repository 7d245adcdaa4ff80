"""Share of the load on the solids beside published fits: the table, the definition of lambda, faults that are seen."""

from dataclasses import replace
from math import erf, exp

import pytest
from comparison import approx
from scipy.integrate import quad

from contact_core import Scene
from contact_core.scene import Case
from system_models.validation import asperity_load
from system_models.validation.asperity_load import at_lambda, band, composite, fits
from system_models.validation.model import Verdict


def greenwood_tripp(ratio):
    def above(u):
        return quad(lambda s: (s - u) ** 2.5 * exp(-0.5 * s * s), u, u + 12.0)[0]

    return above(ratio) / above(0.0)


FORMULAS = {
    "aihara": lambda x: exp(-1.8 * x**1.2),
    "zh_ground016": lambda x: exp(-2.32 * x**0.97),
    "zh_rib024": lambda x: exp(-1.90 * x**0.99),
    "zh_fine010": lambda x: exp(-2.1 * x**0.85),
    "olaru": lambda x: 1.0 - 1.21 * x**0.64 / (1.0 + 0.37 * x**1.26),
    "erfc": lambda x: 1.0 - erf(x),
    "gt": greenwood_tripp,
}


@pytest.mark.parametrize("name", FORMULAS)
def test_the_table_is_what_the_formulas_of_its_head_give(name):
    """Greenwood & Tripp's integral is printed to two digits; beyond lambda 2 Olaru's formula rises again."""
    printed = 0.1 if name == "gt" else 2e-3
    for ratio, share in fits()[name].items():
        if ratio <= 2.0:
            assert share == approx(FORMULAS[name](ratio), rel=printed, abs=1e-7)


def test_the_fit_from_memory_is_not_compared_with():
    assert set(fits()) == set(FORMULAS)
    lows, highs = zip(*(band(ratio) for ratio in fits()["erfc"]), strict=True)
    assert list(lows) == sorted(lows, reverse=True)
    assert list(highs) == sorted(highs, reverse=True)


def test_lambda_counts_the_waves_below_the_grid():
    scene = Scene.from_toml("mtm_zddp", {"surface_2.microroughness.rms": "60 nm"})
    assert composite(scene) == approx((20.0**2 + 130.0**2 + 4.0**2 + 60.0**2) ** 0.5 * 1e-9)
    assert Case.bind(scene, at_lambda(scene, 1.5)).smooth_film == approx(1.5 * composite(scene), rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "verdict"), [({}, Verdict.AGREES), ({"surface_2.correlation_length": "25 um"}, Verdict.DISAGREES)]
)
def test_longer_waves_of_a_scene_are_seen(monkeypatch, changes, verdict):
    known = asperity_load.CONTACTS["mtm_zddp"]
    monkeypatch.setitem(asperity_load.CONTACTS, "mtm_zddp", replace(known, changes=changes))
    assert asperity_load._contact("mtm_zddp", 0).verdict is verdict


def test_our_dry_roughness_by_the_method_of_the_fits_lies_within_them():
    assert all(asperity_load._statistics(ratio).verdict is Verdict.AGREES for ratio in (0.5, 0.75, 1.0, 1.25, 1.5))
