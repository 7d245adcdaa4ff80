"""Equations as they are printed: laws compute them, their symbols are explained, their sources are named."""

import math
from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from printed import value_of

from contact_core.film import FILMS
from contact_core.film.deterministic import _CAVITATION, _GOVERNING, _SHARING
from contact_core.kernels.load_cycle import Cycle
from contact_core.laws import SLOTS
from contact_core.laws.asperity_layer import AsperityLayer
from contact_core.laws.boundary_friction import FilmBlend
from contact_core.laws.density import DowsonHigginson
from contact_core.laws.double_layer import Electroviscous
from contact_core.laws.equations import Equations
from contact_core.laws.fatigue import Basquin, DangVan, Morrow
from contact_core.laws.heat import FlashTemperature
from contact_core.laws.oxide import Logarithmic as Oxide
from contact_core.laws.plasticity import ElasticPerfectlyPlastic
from contact_core.laws.profile import Logarithmic, Rounded
from contact_core.laws.rheology import Carreau, Eyring, Newtonian
from contact_core.laws.scuffing import CriticalTemperature
from contact_core.laws.stress import HalfSpace, ratios
from contact_core.laws.symbols import UNEXPLAINED, common, explained, in_lines
from contact_core.laws.tribofilm import Andersson, Arrhenius, Combined, Ghanbarzadeh, Gosvami, ZhangSpikes
from contact_core.laws.viscosity import AstmD341, Barus, Modulus, Roelands, kinematic_viscosity
from contact_core.laws.wear import Archard, FilmFirst
from contact_core.reference import hertz_point, rolling_line, rolling_point
from contact_core.reference.constants import BOLTZMANN, ELEMENTARY_CHARGE, PLANCK, VACUUM_PERMITTIVITY
from contact_core.reference.oil import inlet_shear_factor
from contact_core.scene import SelfAffine, Surface
from contact_core.shapes import GEOMETRIES, LineGeometry, PointGeometry

P, T = 0.8e9, 350.0
NATURE = {"k_B": BOLTZMANN, "h_P": PLANCK}


def printed(law, symbol, given, *without, **swaps):
    return value_of(law.equations, symbol, law, given, *without, **swaps)


def one(value):
    return float(np.asarray(value).ravel()[0])


def at(value):
    return np.array([value])


# each law against its equations


def test_viscosities():
    roelands = Roelands(0.01, 363.15, 18e-9, 0.03)
    known, log_range = {"p": P, "T": T, "p_0": 1 / 5.1e-9}, math.log(0.01) + 9.67
    z, s = 18e-9 / 5.1e-9 / log_range, 0.03 * (363.15 - 138.0) / log_range
    assert printed(roelands, "η", known | {"z": z, "S": s}) == approx(one(roelands(P, T)), rel=1e-9)
    for law in (Barus(0.01, 363.15, 18e-9, 0.03), Modulus(86.86e-6, 890.0, -182.0, -2.28e7, 2.26e5, -0.0682, 27.68e-5)):
        assert printed(law, "η", known) == approx(one(law(P, T)), rel=1e-9)


def test_viscosity_of_a_data_sheet():
    law = AstmD341(99.386e-6, 10.989e-6, 900.0, 18.77e-9, 313.15, 5.5e-4)
    known = {"p": P, "T": T, "η_∞": math.exp(-9.67), "ν": one(kinematic_viscosity(law, T))}
    known["η_r"] = one(law(0.0, 313.15))
    assert printed(law, "ρ", known) == approx(law.density_at(T), rel=1e-12)
    assert printed(law, "η", known, η_r="η(0, T_0)", η_i="η(0, T)") == approx(one(law(P, T)), rel=1e-9)
    steps = np.array([300.0, 350.0, 400.0])
    heights = np.log10(np.log10(1e6 * kinematic_viscosity(law, steps) + 0.7))
    assert np.polyfit(np.log10(steps), heights, 2)[0] == approx(0.0, abs=1e-9)  # A - B log10 T


def test_density_and_shear():
    law = DowsonHigginson()
    assert printed(law, "ratio", {"p": P}, ratio="ρ/ρ_0") == approx(one(law(at(P))), rel=1e-12)
    for law in (Newtonian(), Eyring(5e6), Carreau(4e6, 0.4)):
        stress = one(law(at(2e7), at(P)))
        assert printed(law, "τ_{oil}", {"τ_N": 2e7}, ",   at most τ_L") == approx(stress, rel=1e-12)
        limited = replace(law, limiting_coefficient=0.06, limiting_fall=0.005)
        limit = one(limited(at(1e20), at(P * limited.limiting_left(T))))
        known = {"p_f": P, "T": T, "T_L": 313.15}
        assert printed(limited, "τ_L", known, ",   at most τ_L") == approx(limit, rel=1e-12)
    law, known = Carreau(4e6, 0.4), {"u_e": 2.0, "η_0": 0.05, "h_s": 2e-7, "S": 0.3}
    thinned = value_of(Carreau.inlet_thinning, "φ", law, known)
    assert thinned == approx(law.film_factor(2e-7, 2.0, 0.05, 0.3), rel=1e-12)


def test_inlet_heat():
    shown = FlashTemperature.equations.options["inlet_shear"]["gupta"]
    known = {"p_H": 1e9, "E′": 2.3e11, "η_0": 0.05, "β": 0.03, "u_e": 5.0, "k": 0.14, "S": 0.3}
    factor = inlet_shear_factor(0.05, 0.03, 5.0, 0.3, 0.14, 1e9, 2.3e11)
    assert value_of(shown, "φ", None, known) == approx(factor, rel=1e-12)


def test_double_layers():
    law = Electroviscous(0.05 * ELEMENTARY_CHARGE, 3e-8, 80.0, 2e-10)
    known = NATURE | {"h": 9e-8, "T": T, "ε": 80.0 * VACUUM_PERMITTIVITY, "ζ": 0.05, "c_k": math.cosh(1.5) ** 2}
    assert printed(law, "ratio", known, ratio="η_a/η", c_k="cosh^2 k") == approx(one(law(at(9e-8), T)), rel=1e-12)


def test_hardness_and_friction():
    law = ElasticPerfectlyPlastic(6e9, 2e9)
    films = {"h_1": 60e-9, "h_2": 30e-9, "U": 50e-9}
    limit = one(law.limit(at(60e-9), at(30e-9), 50e-9, 100e-9))
    cover = printed(law, "c", films, c="c h_{max}") / 100e-9
    assert printed(law, "H", {"c": cover}, H="H(c)") == approx(limit, rel=1e-12)
    law = FilmBlend(0.13, 0.1, 1e-3)
    known = {"p_s": 1e9, "v": 1e-3, "c": 0.4}
    assert printed(law, "τ_{solid}", known) == approx(one(law(at(1e9), at(0.4), 1e-3)), rel=1e-12)


def test_flash_temperature():
    law = FlashTemperature(46.0, 30.0, 1.25e-5, 1e-5)
    known = {"r": 2e-6, "τ": 1e8, "slide": 3.0}
    for body, diffusivity in ((1, 1.25e-5), (2, 1e-5)):
        known[f"Pe_{body}"] = value_of(law.equations, "Pe_i", law, known | {"κ_i": diffusivity}, slide="|u_1 − u_2|")
    assert printed(law, "ΔT", known, slide="|u_1 − u_2|") == approx(one(law.spot_rise(2e-6, 1e8, 3.0)), rel=1e-9)


def grown(law, exposed, temperature):
    growth, removal = law.evolve(at(0.0), at(0.0), at(exposed), at(0.0), temperature)
    return one(growth - removal)


def test_fitted_tribofilms():
    law, rubbed = Ghanbarzadeh(200e-9, 1.66e-16, 54e-9, 4e-4, 353.15), 900.0
    k = printed(law, "k", NATURE | {"T": 353.15})
    assert printed(law, "h_t", {"k": k, "t": rubbed}) == approx(grown(law, k * rubbed, 353.15), rel=1e-9)
    law = Arrhenius(333.15, 373.15, 353.15, 1.2e-3, 1e-19, 4e-4, 9e-20, 2e-7, 2e-7, 5e-8, 5e-8)
    known = NATURE | {"T": 360.0, "t": rubbed, "h_{max}": 2e-7, "C_3": 5e-8}
    k = printed(law, "k", known)
    assert k == approx(one(law.rate(360.0)), rel=1e-12)
    assert printed(law, "h_t", known) == approx(grown(law, k * rubbed, 360.0), rel=1e-9)


@pytest.mark.parametrize(
    "law",
    [
        Andersson(176e-9, 2e-13, 1e3, 353.15),
        ZhangSpikes(200e-9, 17.0, 1.08e-19, 1.3e-28, 2e-8),
        Gosvami(200e-9, 6e3, 1.28e-19, 3.8e-30, 2e-8),
        Combined(200e-9, 0.5, 0.4, 1.66e-16, 353.15, 17.0, 1.08e-19, 1.3e-28, 2e-8),
    ],
    ids=lambda law: law.name,
)
def test_rates_of_tribofilms(law):
    film, pressure, shear, slide, dt = 50e-9, 1e9, 1.2e8, 0.1, 1e-6
    exposure = law.exposure(at(pressure), at(shear), slide, 353.15)
    after, _ = law.evolve(at(film), at(0.0), exposure * dt, law.abrasion(at(pressure), slide, None) * dt, 353.15)
    known = NATURE | {"h_t": film, "p_s": pressure, "τ": shear, "v": slide, "T": 353.15, "c": 1.0, "slide": slide}
    rate = printed(law, "rate", known, rate="∂h_t/∂t", slide="|u_1 − u_2|")
    assert rate == approx(one(after - film) / dt, rel=1e-4)


def test_wear_and_oxide():
    known = {"p_s": 1e7, "v": 0.1, "H": 6e9, "c": 0.3, "h_t": 30e-9, "H_{film}": 2e9, "h_{max}": 100e-9}
    for law in (Archard(1e-5, 1e-6), FilmFirst(1e-5, 1e-6)):
        depth = one(law.rate(at(1e7), at(0.3), (0.2, 0.1), 0, 6e9, 100e-9))
        assert printed(law, "rate", known, rate="∂w/∂t") == approx(depth, rel=1e-9)
    assert printed(law, "r", known) == approx(one(law.film_removal(1e7, (0.2, 0.1), 0, 2e9, 100e-9)), rel=1e-12)
    law, dt = Oxide(), 1e-5
    known = NATURE | {"x": 1e-9, "p_s": 1e6, "v": 0.1, "T": 300.0, "h_t": 5e-9}
    open_share = law.left_open(5e-9)
    growing, rubbing = law.growth(300.0) * open_share * dt, law.removal(1e6, 0.1) * open_share * dt
    after, _ = law.evolve(at(1e-9), at(growing), at(rubbing))
    assert printed(law, "rate", known, rate="∂x/∂t") == approx(one(after - 1e-9) / dt, rel=1e-4)


def test_fatigue():
    cycle, root = Cycle(at(3e8), at(1e8), at(3.4e8)), {"root": "√J_{2,a}"}
    law = Basquin(5.27e8, 12.25)
    cycles = printed(law, "N", {"root": 3e8}, " > S_{limit}", **root)
    assert 1.0 / cycles == approx(one(law.per_cycle(cycle)), rel=1e-9)
    law = Morrow(3.405e9, 0.1607, 1.3458e9, 1.5385)
    half_cycles = printed(law, "half_cycles", {"root": 3e8}, **root, half_cycles="2 N")
    assert 2.0 / half_cycles == approx(one(law.per_cycle(cycle)), rel=1e-9)
    law, cycles = DangVan(7e8, 2.5e7), math.exp((7e8 - 3.4e8) / 2.5e7)
    line = Equations(law.equations.lines[:1], symbols=law.equations.symbols)
    assert value_of(line, "S", law, {"N": cycles}) == approx(3.4e8, rel=1e-9)
    assert 1.0 / cycles == approx(one(law.per_cycle(cycle)), rel=1e-9)


def test_ratios_of_stress_and_scuffing():
    law = HalfSpace(torsion_limit=3.6e8, bending_limit=6.2e8)
    found = printed(law, "R_C", {"root": 3e8, "largest": 1e8}, root="√J_{2,a}", largest="max_t p_h(t)")
    assert found == approx(ratios(law, Cycle(at(3e8), at(1e8), at(0.0)))[1], rel=1e-9)
    found = printed(law, "R_D", {"shear": 3e8, "p_h": 1e8}, "max_t", shear="τ(t)", p_h="p_h(t)")
    dang_van = 3e8 + law.dang_van_slope * 1e8
    assert found == approx(ratios(law, Cycle(at(0.0), at(0.0), at(dang_van)))[0], rel=1e-9)
    law = CriticalTemperature(425.0)
    ratio = printed(law, "S", {"T_{max}": 400.0, "T_{oil}": 350.0})
    assert ratio == approx(law.ratio(400.0, 350.0), rel=1e-12)


# shapes and surfaces


def test_profiles():
    for law in (Rounded(6e-3, 0.5), Logarithmic(4e-6)):
        drop = one(law.drop(at(4e-3), 10e-3))
        assert printed(law, "P", {"y": 4e-3, "b": 10e-3}, y="|y|") == approx(drop, rel=1e-6)


def test_asperities_below_the_grid():
    law, modulus, hardness = AsperityLayer(16e-9, 4e-6), 2.3e11, 6e9
    known = {"E′": modulus, "H": hardness, "h": 10e-9}
    assert printed(law, "s", known) == approx(one(law.pressure(at(10e-9), modulus, hardness)), rel=2e-3)  # 1.1 H
    pressure = one(law.pressure(at(10e-9), modulus, hardness))
    assert printed(law, "A", known | {"s": pressure}) == approx(
        one(law.area(at(pressure), modulus, hardness)), rel=2e-3
    )


def test_rolling_resistance():
    hertz, speed = hertz_point(50.0, 0.01, 0.02, 2.3e11), 2.0 * 0.02 * 1.0 / (2.3e11 * 0.01)
    known = {"a": hertz.a, "b": hertz.b, "p_H": hertz.pressure_max, "E′": 2.3e11, "R_x": 0.01, "U": speed, "W": 50.0}
    solids = {"W_c": 0.25, "h_s": 1e-8, "h_c": 4e-8}  # half of 1/2 is lost
    found = value_of(PointGeometry.rolling, "F_r", None, known | solids)
    assert found == approx(0.75 * rolling_point(50.0, 1.0, 0.02, 0.01, 0.02, 2.3e11), rel=1e-9)
    known = {"b": 0.014, "E′": 2.3e11, "R_x": 0.01, "U": speed, "W": 4000.0} | solids
    found = value_of(LineGeometry.rolling, "F_r", None, known)
    assert found == approx(0.75 * 0.014 * rolling_line(4000.0 / 0.014, 1.0, 0.02, 0.01, 2.3e11), rel=1e-3)


# all of them

LAWS = [law for laws in SLOTS.values() for law in laws]
WITHOUT_DOI = {  # books, theses, standards, papers before there were DOIs, our own
    *("roelands", "astm_d341", "dowson_higginson", "rounded", "field", "lumped", "critical_temperature", "measured"),
}


def shown():
    """Yield every equation with the record that it belongs to."""
    for law in (*LAWS, *GEOMETRIES, Surface, SelfAffine, AsperityLayer):
        yield law.equations, law
        yield from ((text, law) for choices in law.equations.options.values() for text in choices.values())
    yield from ((law.inlet_thinning, law) for law in SLOTS["rheology"] if law.inlet_thinning)
    for geometry in GEOMETRIES:
        for name in ("deformation", "load_balance", "smooth_film", "rolling"):
            yield getattr(geometry, name), geometry
    yield from ((film.friction, film) for film in FILMS)
    yield from ((text, None) for text in (*_GOVERNING, *_CAVITATION.values(), *_SHARING.values()))


def test_every_symbol_is_explained_with_a_unit_and_none_is_named_in_vain():
    for equations, law in shown():
        found = {symbol.symbol: symbol for symbol in explained(equations, law)}
        assert set(equations.symbols) <= set(found), equations.lines
        for symbol in found.values():
            assert symbol.text not in ("", UNEXPLAINED), symbol
            assert "]" not in symbol.unit, symbol


def test_an_unexplained_symbol_is_noticed():
    found = {symbol.symbol: symbol.text for symbol in explained(Equations(("h = Q p",)), None)}
    assert found == {"h": common()["h"][1], "Q": UNEXPLAINED, "p": common()["p"][1]}
    assert list(in_lines(("p_0 = 196 MPa,   η in pascal seconds", "log_{10} max_t p dx′"))) == ["p_0", "η", "p"]


def test_every_law_has_equations_and_a_source_or_says_what_is_left_out():
    for law in LAWS:
        assert law.equations.lines
        assert law.source or law.equations.left_out, law.name
    for laws in SLOTS.values():
        assert len([law for law in laws if not law.source]) <= 1


def test_sources_name_a_doi_but_for_those_that_have_none():
    said = ("doi:", "assumed", "given")
    bare = {law.name for law in LAWS if law.source and not any(word in law.source for word in said)}
    assert bare == WITHOUT_DOI
